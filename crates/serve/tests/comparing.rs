//! The pages that put runs and metrics side by side: what is counted, drawn, named and kept.

#[path = "common/browser.rs"]
#[allow(dead_code, reason = "another test takes photographs")]
mod browser;
mod common;

use browser::Browser;
use common::{folder, get, serve, status, write_seed};
use serde_json::{Value, json};
use std::net::SocketAddr;

fn ask(address: SocketAddr, path: &str) -> Value {
    let answer = get(address, path, "");
    serde_json::from_str(answer.split_once("\r\n\r\n").unwrap().1).unwrap()
}

/// The ids of all runs, by commas.
fn all(address: SocketAddr) -> String {
    let list = ask(address, "/api/runs");
    let ids = list["runs"].as_array().unwrap().iter().map(|run| run["id"].as_str().unwrap());
    ids.collect::<Vec<_>>().join(",")
}

/// A module of the pages, under its name in the window.
fn load(browser: &Browser, module: &str) {
    browser.script(&format!("import('/{module}.js').then((all) => {{ window.{module} = all; }})"));
    browser.wait(&format!("window.{module}"));
}

/// Two folders hold a run of the same settings and seed: it is one seed, by the run that got
/// furthest.
#[test]
fn a_seed_that_was_run_twice_counts_once() {
    let folder = folder("comparing-twice");
    write_seed(&folder, "quick/seed11", 11, 20);
    write_seed(&folder, "safety-budget=5/seed11", 11, 40);
    write_seed(&folder, "quick/seed12", 12, 60);
    let address = serve(&folder, None);
    let row = &ask(address, &format!("/api/compare?runs={}", all(address)))[0]["rows"][0];
    assert_eq!((&row["n"], &row["repeats"]), (&json!(2), &json!(1)), "{row}");
    assert_eq!(row["returns"], json!([40.0, 60.0]));
    let Some(browser) = Browser::open(1280, 900, false) else { return };
    browser.go(&format!("http://{address}/#runs"));
    browser.wait("document.querySelector('button.open')");
    let cell = |place: u32| {
        browser.script(&format!(
            "return document.querySelectorAll('tbody tr:first-child td')[{place}].innerText"
        ))
    };
    assert_eq!(cell(3), json!("2 + 1 repeat"));
    // Means of 40 and 60, not of 20, 40 and 60.
    assert_eq!(cell(6), json!("50"));
    browser.script("document.querySelector('button.open').click()");
    browser.wait("document.querySelectorAll('tr.seed').length == 3");
    let repeats = browser.script("return [...document.querySelectorAll('tr.seed')].filter((row) => row.innerText.includes('repeats')).map((row) => row.innerText.includes('quick'))");
    assert_eq!(repeats, json!([true]));
    browser.script("document.querySelector('tbody input').click()");
    browser.wait("document.querySelector('#means td.number')?.innerText == '2 + 1 repeat'");
    browser.wait("document.querySelector('.readout').innerText.includes('(2 seeds)')");
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn more_columns_than_a_page_takes_are_refused_in_words() {
    let folder = folder("comparing-columns");
    write_seed(&folder, "one", 1, 20);
    let address = serve(&folder, None);
    let id = all(address);
    let many = |count: usize| {
        let names = (1..count).map(|k| format!("eval/some_metric_{k}")).collect::<Vec<_>>();
        format!("/api/curves?runs={id}&columns={},fps", names.join(","))
    };
    // The last of them is not left out.
    assert!(ask(address, &many(256))[&id]["fps"].is_array());
    let answer = get(address, &many(257), "");
    assert_eq!(status(&answer), 400, "{answer}");
    assert!(answer.contains("257 columns") && answer.contains("choose 256 at most"), "{answer}");
}

#[test]
fn every_metric_of_a_run_is_drawn_and_none_makes_up_an_axis() {
    let folder = folder("comparing-metrics");
    write_seed(&folder, "one", 1, 3);
    let names: Vec<String> = (0..40).map(|k| format!("stats/metric_{k}")).collect();
    let row = |frames: u32| {
        let all: String = names.iter().map(|name| format!(",\"{name}\":{frames}")).collect();
        // One that was never a number.
        format!("{{\"frames\":{frames},\"return_mean\":1,\"cost_mean\":null{all}}}\n")
    };
    let rows: String = [100, 200, 300].map(row).concat();
    std::fs::write(folder.join("runs/one/metrics.jsonl"), rows).unwrap();
    let address = serve(&folder, None);
    let Some(browser) = Browser::open(1280, 900, false) else { return };
    let all_metrics = names.join(",");
    browser.go(&format!(
        "http://{address}/#run?id={}&metrics=return_mean,cost_mean,{all_metrics}",
        all(address)
    ));
    browser.wait("document.querySelectorAll('figure[data-chart]').length >= 41");
    browser.wait("[...document.querySelectorAll('figure[data-chart^=stats]')].every((one) => one.querySelector('.readout').innerText.includes('300'))");
    // Charts that hold nothing: the words of the axes and no numbers.
    load(&browser, "chart");
    browser.script("const { Chart, Shared } = window.chart; const one = new Chart(new Shared(), { title: 'Nothing', file: 'nothing' }); document.getElementById('page').append(one.element); one.draw()");
    browser.wait(
        "document.querySelector('[data-chart=nothing] .readout').innerText == 'not reported'",
    );
    let words = "[...document.querySelectorAll('[data-chart=nothing] svg text')].map((text) => text.textContent).join('|')";
    let words = browser.script(&format!("return {words}"));
    assert_eq!(words, json!("frames (1 frame = 1 game tic)|Nothing"));
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn a_logarithmic_axis_always_has_numbers() {
    let Some(browser) = Browser::open(1280, 900, false) else { return };
    let address = serve(&folder("comparing-scale"), None);
    browser.go(&format!("http://{address}/"));
    load(&browser, "scale");
    let ticks = |low: f64, high: f64| {
        browser.script(&format!("return window.scale.logTicks({low}, {high})"))
    };
    assert_eq!(ticks(1.0, 1e4), json!([1, 10, 100, 1000, 10000]));
    assert_eq!(ticks(1.0, 10.0), json!([1, 2, 5, 10]));
    // Powers alone would be two.
    assert_eq!(ticks(0.5, 12.0), json!([0.5, 1, 2, 5, 10]));
    // None of 1, 2 and 5 lies between.
    assert_eq!(ticks(21.0, 45.0), json!([25, 30, 35, 40, 45]));
    for (low, high) in [(0.9, 1.1), (6.0, 9.0), (2.1e-4, 4.4e-4), (7.0, 7.0)] {
        let found = ticks(low, high);
        assert!(found.as_array().unwrap().len() >= 2 || low == high, "{low} {high}: {found}");
    }
}

/// The page's own script runs, and none that a name might bring.
#[test]
fn a_reports_tables_sort_where_it_is_served() {
    let folder = folder("comparing-report");
    for seed in 1..=3 {
        write_seed(&folder, &format!("seed{seed}"), seed, 10 * seed);
    }
    let address = serve(&folder, None);
    let path = format!("/api/report?runs={}", all(address));
    let answer = get(address, &path, "");
    let policy = answer.lines().find(|line| line.starts_with("content-security-policy")).unwrap();
    assert!(policy.contains("script-src 'sha256-") && policy.contains("default-src 'none'"));
    assert!(!policy.contains("script-src 'unsafe"), "{policy}");
    let Some(browser) = Browser::open(1280, 900, false) else { return };
    browser.go(&format!("http://{address}{path}"));
    browser.wait("document.querySelector('#runs .heads th')");
    browser.script("document.querySelector('#runs details').open = true; document.querySelector('#runs .heads th').click()");
    browser.wait("document.querySelector('#runs .heads th').ariaSort == 'ascending'");
    // A click in the row of links, which has several lines here, leads to a heading that shows.
    browser.script("document.querySelector('nav').style.paddingRight = '700px'; [...document.querySelectorAll('nav a')].forEach((link) => { link.style.width = '300px'; })");
    browser.wait("document.documentElement.style.getPropertyValue('--nav') == `${document.querySelector('nav').offsetHeight}px`");
    browser.script("document.querySelector('nav a[href=\"#safety\"]').click()");
    browser.wait("(() => { const below = document.querySelector('#safety h2').getBoundingClientRect().top - document.querySelector('nav').getBoundingClientRect().bottom; return scrollY > 0 && below >= 0 && below < 60; })()");
    let refused = browser.errors();
    assert!(!refused.iter().any(|line| line.contains("Content Security Policy")), "{refused:?}");
}

/// A reader who has scrolled the table and stands on a control stays there while a run goes on.
#[test]
fn a_comparison_that_is_renewed_keeps_scroll_and_focus() {
    let Some(browser) = Browser::open(390, 900, false) else { return };
    let folder = folder("comparing-live");
    write_seed(&folder, "one", 1, 20);
    let address = serve(&folder, None);
    browser.go(&format!("http://{address}/#runs?chosen={}", all(address)));
    browser.wait("document.querySelector('#means td') && document.querySelector('.legend button')");
    let table = "document.getElementById('means').parentElement";
    // The table is made too narrow for its words, whatever they are.
    let narrow = "document.head.append(Object.assign(document.createElement('style'), { textContent: '#means { display: table; width: 3000px }' }))";
    browser.script(narrow);
    browser.script(&format!("window.old = {table}; {table}.scrollLeft = 77; document.querySelector('.legend button').focus()"));
    assert_eq!(browser.script(&format!("return {table}.scrollLeft")), json!(77));
    write_seed(&folder, "one", 1, 40);
    browser.wait(&format!("{table} != window.old && {table}.innerText.includes('40')"));
    assert_eq!(browser.script(&format!("return {table}.scrollLeft")), json!(77));
    let focused = "return document.activeElement.closest('.legend') != null";
    assert_eq!(browser.script(focused), json!(true));
    // The same of a button beneath a picture.
    browser.script("document.querySelector('[aria-label^=\"Save return against cost\"]').focus(); window.label = document.activeElement.ariaLabel");
    browser.script("window.old = document.getElementById('means')");
    write_seed(&folder, "one", 1, 60);
    browser.wait("document.getElementById('means') != window.old");
    let label = browser.script("return document.activeElement.ariaLabel == window.label");
    assert_eq!(label, json!(true));
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn charts_follow_the_system_into_the_dark() {
    let Some(browser) = Browser::open(1280, 900, false) else { return };
    let folder = folder("comparing-dark");
    write_seed(&folder, "one", 1, 20);
    let address = serve(&folder, None);
    browser.go(&format!("http://{address}/#runs?chosen={}", all(address)));
    // Curves, and return against cost.
    browser.wait("document.querySelectorAll('svg.chart text').length > 20 && document.querySelector('svg[aria-label*=against] text')");
    let fills = "[...new Set([...document.querySelectorAll('svg.chart text')].map((text) => text.getAttribute('fill')))].sort().join()";
    let light = browser.script(&format!("return {fills}"));
    browser.colours(true);
    browser.wait(&format!("{fills} != {light}"));
    let dark = browser.script(&format!("return {fills}"));
    let (light, dark) = (light.as_str().unwrap(), dark.as_str().unwrap());
    assert!(
        light.split(',').all(|one| !dark.split(',').any(|other| one == other)),
        "{light} {dark}"
    );
    browser.colours(false);
    browser.wait(&format!("{fills} == '{light}'"));
}

#[test]
fn metrics_of_every_chosen_run_can_be_picked() {
    let folder = folder("comparing-picked");
    write_seed(&folder, "plain", 1, 20);
    write_seed(&folder, "other", 2, 20);
    let path = folder.join("runs/other/metrics.jsonl");
    let row = "{\"frames\":2100,\"stats/only_here\":7}\n";
    let rows = std::fs::read_to_string(&path).unwrap() + row;
    std::fs::write(&path, rows).unwrap();
    let address = serve(&folder, None);
    let metrics = ask(address, &format!("/api/metrics?runs={}", all(address)));
    let names: Vec<&str> =
        metrics.as_array().unwrap().iter().map(|one| one["name"].as_str().unwrap()).collect();
    assert!(names.contains(&"stats/only_here") && names.contains(&"fps"), "{names:?}");
    assert_eq!(names.iter().filter(|name| **name == "fps").count(), 1);
    let Some(browser) = Browser::open(1280, 900, false) else { return };
    let list = ask(address, "/api/runs");
    let id = |name: &str| {
        let runs = list["runs"].as_array().unwrap();
        runs.iter().find(|run| run["name"] == name).unwrap()["id"].as_str().unwrap().to_owned()
    };
    browser.go(&format!("http://{address}/#runs?chosen={}", id("plain")));
    browser.wait("document.querySelector('[data-metric=fps]')");
    assert_eq!(
        browser.script("return document.querySelector('[data-metric=\"stats/only_here\"]')"),
        json!(null)
    );
    // The second is ticked beside the first.
    browser.script("document.querySelector('button.open').click()");
    browser.wait("document.querySelectorAll('tr.seed input').length == 2");
    browser.script(
        "[...document.querySelectorAll('tr.seed input')].find((box) => !box.checked).click()",
    );
    browser.wait("document.querySelector('[data-metric=\"stats/only_here\"]')");
    assert_eq!(browser.errors(), Vec::<String>::new());
}

/// A row shows the mean over seeds, and is sorted by what it shows.
#[test]
fn frames_are_sorted_by_what_the_rows_show() {
    let folder = folder("comparing-frames");
    for seed in 1..=3 {
        write_seed(&folder, &format!("three/seed{seed}"), seed, 20);
    }
    write_seed(&folder, "long", 9, 40);
    let config = folder.join("runs/long/config.json");
    let text = std::fs::read_to_string(&config).unwrap().replace("PPOLag", "PPO");
    std::fs::write(&config, text).unwrap();
    let address = serve(&folder, None);
    let Some(browser) = Browser::open(1280, 900, false) else { return };
    browser.go(&format!("http://{address}/#runs?sort=-frames"));
    browser.wait("document.querySelectorAll('tbody input').length == 2");
    let first = browser.script("return document.querySelector('tbody tr').innerText");
    // 4,000 frames of one seed before 2,000 of each of three.
    assert!(first.as_str().unwrap().contains("seed 9"), "{first}");
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn a_film_that_cannot_be_made_says_why() {
    let folder = folder("comparing-film");
    write_seed(&folder, "one", 1, 20);
    let address = serve(&folder, None);
    let Some(browser) = Browser::open(1280, 900, false) else { return };
    let said = "document.querySelector('.bad[role=status]')?.innerText";
    // A run without checkpoints.
    browser.go(&format!("http://{address}/#run?id={}", all(address)));
    browser.wait("document.getElementById('film')");
    browser.script("document.getElementById('film').click()");
    browser.wait(&format!("{said}?.includes('Film: ') && {said}.includes('no checkpoint')"));
    // One that can is kept under the server's name for it.
    browser.go(&format!(
        "http://{address}/#watch?env=VolcanicVentureLevel1-v0&agent=hold:MOVE_FORWARD&seed=3&hard=true&size=160x120&beside="
    ));
    browser.wait("document.querySelector('#numbers b')");
    browser.script("window.kept = null; const click = HTMLAnchorElement.prototype.click; HTMLAnchorElement.prototype.click = function () { if (this.href.startsWith('blob:')) window.kept = this.download; else click.call(this); }; document.getElementById('film').click()");
    browser.wait_long("window.kept == 'VolcanicVentureLevel1-v0-seed3.mp4'");
    browser.wait("document.getElementById('film').ariaBusy == 'false'");
}

#[test]
fn a_game_that_is_left_before_it_begins_does_not_begin() {
    let Some(browser) = Browser::open(1280, 900, false) else { return };
    let address = serve(&folder("comparing-left"), None);
    browser.go(&format!("http://{address}/#runs"));
    browser.wait("document.querySelector('#page section')");
    // The list of environments comes when the page of it has been left.
    browser.script("window.games = 0; window.answered = 0; const Socket = WebSocket; window.WebSocket = function (...all) { window.games += 1; return new Socket(...all); }; Object.assign(window.WebSocket, { OPEN: 1, CONNECTING: 0 }); const ask = window.fetch; window.fetch = async (path) => { const answer = await ask(path); if (path !== '/api/envs') return answer; await new Promise((done) => { window.go_on = done; }); window.answered += 1; return answer; }; location.hash = '#play'");
    browser.wait("window.go_on");
    browser.script("location.hash = '#runs'");
    browser.wait("!document.getElementById('game')");
    browser.script("window.go_on()");
    browser.wait("window.answered == 1");
    std::thread::sleep(std::time::Duration::from_millis(500));
    assert_eq!(browser.script("return window.games"), json!(0));
    // Who stays gets one.
    browser.script("window.go_on = null; location.hash = '#play'");
    browser.wait("window.go_on");
    browser.script("window.go_on()");
    browser.wait("document.querySelector('#numbers b') && window.games == 1");
    assert_eq!(browser.errors(), Vec::<String>::new());
}
