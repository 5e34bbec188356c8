//! The pages on runs that were trained for them: `data/runs` holds the small files of runs of
//! 300,000 frames.

#[path = "common/browser.rs"]
mod browser;
mod common;

use browser::Browser;
use common::{folder, serve};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

fn data() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/runs")
}

/// A folder with links to the runs, and a server of it.
fn served(name: &str) -> std::net::SocketAddr {
    let folder = folder(name);
    std::fs::remove_dir(folder.join("runs")).unwrap();
    std::os::unix::fs::symlink(data(), folder.join("runs")).unwrap();
    serve(&folder, None)
}

const RUN: &str = "RemedyRushLevel1-v0/PPOPID/seed1";

fn lines(name: &str) -> Vec<Value> {
    let text = std::fs::read_to_string(data().join(RUN).join(name)).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// Opens the page of that run.
fn open_run(browser: &Browser, address: std::net::SocketAddr) {
    browser.go(&format!("http://{address}/#runs?text=seed1"));
    browser.wait("document.querySelector('tbody a')");
    let link = browser.script(&format!(
        "return fetch('/api/runs').then((answer) => answer.json()).then((list) => list.runs.find((run) => run.name == '{RUN}').id)"
    ));
    browser.go(&format!("http://{address}/#run?id={}", link.as_str().unwrap()));
    browser.wait("document.querySelectorAll('svg.chart path').length > 20");
}

#[test]
fn every_metric_of_a_run_is_explained() {
    let address = served("real-explained");
    let ask = |path: &str| -> Value {
        let answer = common::get(address, path, "");
        serde_json::from_str(answer.split_once("\r\n\r\n").unwrap().1).unwrap()
    };
    let runs = ask("/api/runs");
    for run in runs["runs"].as_array().unwrap() {
        let detail = ask(&format!("/api/run?id={}", run["id"].as_str().unwrap()));
        let metrics = detail["metrics"].as_array().unwrap();
        assert!(metrics.len() > 40);
        for metric in metrics {
            assert!(
                metric["group"] != "other" && metric["meaning"].as_str().unwrap().len() > 8,
                "{metric}"
            );
        }
    }
}

#[test]
fn a_run_says_first_what_it_is_worth() {
    let Some(browser) = Browser::open(1280, 1200, false) else { return };
    let address = served("real-run");
    open_run(&browser, address);
    // The strip shows the closing evaluation as the run's own file has it.
    let selected: Value = serde_json::from_str(
        &std::fs::read_to_string(data().join(RUN).join("selected.json")).unwrap(),
    )
    .unwrap();
    let closing = &selected["closing"];
    let strip = browser.script("return document.getElementById('strip').innerText");
    let strip = strip.as_str().unwrap();
    let plain = |value: &Value| format!("{}", (value.as_f64().unwrap() * 100.0).round() / 100.0);
    let returns = &closing["episode_return"];
    let wanted = format!("{} ± {}", plain(&returns["mean"]), plain(&returns["half_width"]));
    assert!(strip.contains(&wanted), "{wanted}: {strip}");
    assert!(strip.contains(&plain(&closing["cost"]["mean"])), "{strip}");
    let episodes = lines("closing_episodes.jsonl");
    let over =
        episodes.iter().filter(|one| one["cost"].as_f64().is_some_and(|cost| cost > 5.0)).count();
    assert!(
        strip.contains(&format!("{} %", (100.0 * over as f64 / episodes.len() as f64).round())),
        "{over}: {strip}"
    );
    let within = closing["cost"]["mean"].as_f64().unwrap() <= 5.0;
    let said = browser
        .script("return document.querySelectorAll('.tile')[1].querySelector('.note').innerText");
    assert_eq!(said == "over", !within, "{strip}");
    // Training and evaluation on one chart, a point an evaluation, and the selected checkpoint.
    let evaluations =
        lines("metrics.jsonl").iter().filter(|row| row["eval/return_mean"].is_number()).count();
    let chart = "document.querySelector('[data-chart=return_mean]')";
    assert_eq!(
        browser.script(&format!("return {chart}.querySelectorAll('circle:not(.pointer)').length")),
        json!(evaluations)
    );
    browser.wait(&format!("{chart}.querySelector('.selected')"));
    browser.wait(&format!("{chart}.querySelector('.readout').innerText.includes('training') && {chart}.querySelector('.readout').innerText.includes('evaluation')"));
    browser.wait(
        "document.querySelector('[data-chart=cost_mean] svg').textContent.includes('budget 5')",
    );
    // The pointer over one chart is read in all.
    browser.script(&format!(
        "const svg = {chart}.querySelector('svg'), at = svg.getBoundingClientRect(); svg.dispatchEvent(new PointerEvent('pointermove', {{ clientX: at.left + 200, clientY: at.top + 50, pointerId: 1 }}))"
    ));
    browser.wait("[...document.querySelectorAll('.readout')].every((one) => /^at \\d/.test(one.innerText)) && new Set([...document.querySelectorAll('.readout')].map((one) => one.firstChild.textContent)).size == 1");
    browser.wait("document.querySelectorAll('svg.chart path.pointer').length >= document.querySelectorAll('svg.chart').length");
    // What differs from the preset stands first, how often it was evaluated among it, and nothing
    // that does not differ; all others are folded away below.
    let rows = "[...document.querySelectorAll('#settings > .scroll tbody tr')]";
    browser.wait(&format!("{rows}.some((row) => row.innerText.includes('evaluation.every'))"));
    browser.wait(&format!(
        "{rows}.every((row) => row.cells.length == 3 && row.cells[1].innerText != row.cells[2].innerText)"
    ));
    // What is folded away is as in the preset, but for what every run has of its own.
    let folded = "[...document.querySelectorAll('#settings details tbody tr')]";
    browser.wait(&format!("{folded}.length > 50"));
    let differ = browser.script(&format!(
        "return {folded}.filter((row) => row.cells[1].textContent != row.cells[2].textContent).map((row) => row.querySelector('code').textContent)"
    ));
    let own = [
        "version",
        "seed",
        "frames",
        "device",
        "learning.schedule_frames",
        "learning.threads",
        "sampling.samplers",
    ];
    for name in differ.as_array().unwrap() {
        assert!(own.contains(&name.as_str().unwrap()), "{name} is folded away: {differ}");
    }
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn metrics_are_picked_axes_changed_and_pictures_saved() {
    let Some(browser) = Browser::open(1280, 1200, false) else { return };
    let address = served("real-metrics");
    open_run(&browser, address);
    browser.script("document.querySelector('.picker').open = true; document.querySelector('[data-metric=fps]').click()");
    browser.wait(
        "document.querySelector('[data-chart=fps] .note').innerText.includes('Frames per second') && location.hash.includes('fps')",
    );
    let title = |words: &str| {
        browser.wait(&format!(
            "document.querySelector('[data-chart=fps] svg').textContent.includes('{words}')"
        ))
    };
    title("frames (1 frame");
    let select = |value: &str| {
        browser.script(&format!(
            "const one = document.querySelector('.tools select'); one.value = '{value}'; one.dispatchEvent(new Event('change'))"
        ));
    };
    select("steps");
    title("policy steps");
    select("time");
    title("time of training");
    browser
        .script("const log = document.querySelector('.tools input[type=checkbox]'); log.click()");
    title("log scale");
    browser.script("const smooth = document.querySelector('.tools input[type=range]'); smooth.value = 0.9; smooth.dispatchEvent(new Event('input'))");
    browser.wait("document.querySelector('.tools output').innerText.includes('weight 0.9')");
    browser
        .wait("location.hash.includes('x=time') && location.hash.includes('smooth=0.9') && location.hash.includes('log=true')");
    // What is saved: the numbers as they were reported, and pictures with title and colours of
    // their own.
    browser.script("window.saved = []; const make = URL.createObjectURL; URL.createObjectURL = (blob) => { saved.push(blob); return make.call(URL, blob); }; document.querySelectorAll('[data-chart=return_mean] .saves button').forEach((button) => button.click())");
    browser.wait("saved.filter((blob) => blob.type == 'image/png').length == 1");
    browser.script("Promise.all(saved.map((blob) => blob.text())).then((texts) => { window.texts = Object.fromEntries(texts.map((text, k) => [saved[k].type, text])); })");
    browser.wait("window.texts");
    let rows = lines("metrics.jsonl");
    let reported = rows.iter().filter(|row| row["return_mean"].is_number()).count();
    let evaluated = rows.iter().filter(|row| row["eval/return_mean"].is_number()).count();
    let csv = browser.script("return texts['text/csv']");
    let csv: Vec<&str> = csv.as_str().unwrap().lines().collect();
    assert_eq!(
        (csv[0], csv.len()),
        ("series,seconds,Return,half width of the 95 % interval", 1 + reported + evaluated)
    );
    let svg = browser.script("return texts['image/svg+xml']");
    let svg = svg.as_str().unwrap();
    assert!(
        svg.starts_with("<svg")
            && svg.contains(">Return</text>")
            && svg.contains(">evaluation</text>")
            && !svg.contains("var(")
    );
    browser.wait("saved.find((blob) => blob.type == 'image/png').size > 5000");
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn a_heatmap_lies_on_its_map_as_in_the_report() {
    let Some(browser) = Browser::open(1280, 1200, false) else { return };
    let address = served("real-heatmap");
    open_run(&browser, address);
    // North is up: the first row of cells that is painted is the last of the file.
    let painted = "const { cells, heat_colour } = window.heat; return cells({ rows: 2, columns: 1, steps: [3, 0] }).colours.map(Boolean)";
    browser.script("import('/heat.js').then((heat) => { window.heat = heat; })");
    browser.wait("window.heat");
    assert_eq!(browser.script(painted), json!([false, true]));
    for part in 0..=10 {
        let heat = f64::from(part) / 10.0;
        assert_eq!(
            browser.script(&format!("return heat.heat_colour({heat})")),
            json!(hasard_report::heat::heat_colour(heat))
        );
    }
    // The most visited place's share stands at the end of the colour bar.
    let heat = lines("heatmaps.jsonl").pop().unwrap();
    let steps: Vec<f64> =
        heat["steps"].as_array().unwrap().iter().map(|one| one.as_f64().unwrap()).collect();
    let most = 100.0 * steps.iter().copied().fold(0.0, f64::max) / steps.iter().sum::<f64>();
    let bar = "Number(document.querySelector('.ends').lastChild.innerText.replace(' %', ''))";
    browser.wait(&format!("Math.abs({bar} - {most}) < 0.006 * {most}"));
    // Between two moments some places gain and some lose.
    browser.script("const one = document.querySelector('.heat select'); one.value = '0'; one.dispatchEvent(new Event('change'))");
    browser.wait("document.querySelector('.heat figcaption').innerText.includes('are visited more') && document.querySelector('.ends').innerText.includes('+')");
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn a_heatmap_plays_through_training() {
    let Some(browser) = Browser::open(1280, 1200, false) else { return };
    let address = served("real-heat-film");
    open_run(&browser, address);
    let slide = "document.querySelector('.heat input[type=range]')";
    browser.wait(&format!("{slide}.max > 1 && {slide}.value == {slide}.max"));
    browser.wait("document.querySelector('.ends').innerText.includes('%')");
    // Every moment is shown, from the first to the last.
    browser.script("window.seen = []; new MutationObserver(() => seen.push(document.querySelector('.heat figcaption').innerText)).observe(document.querySelector('.heat figcaption'), { childList: true, characterData: true, subtree: true }); document.getElementById('heat-film').click()");
    browser.wait("document.getElementById('heat-film').innerText == 'Stop'");
    browser.wait_long("document.getElementById('heat-film').innerText == 'Play through training'");
    let moments: Vec<u64> =
        lines("heatmaps.jsonl").iter().map(|line| line["frames"].as_u64().unwrap()).collect();
    let seen = browser
        .script("return seen.map((text) => Number(text.match(/At ([\\d,]+) frames/)[1].replaceAll(',', '')))");
    let seen: Vec<u64> = seen.as_array().unwrap().iter().filter_map(Value::as_u64).collect();
    assert!(seen.is_sorted() && moments.iter().all(|one| seen.contains(one)), "{seen:?}");
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn experiments_are_folded_and_compared_by_environment() {
    let Some(browser) = Browser::open(1280, 1200, false) else { return };
    let address = served("real-compare");
    browser.go(&format!("http://{address}/"));
    browser.wait("document.querySelectorAll('tbody tr').length > 2");
    let runs = browser.script("return fetch('/api/runs').then((answer) => answer.json())");
    let runs = runs["runs"].as_array().unwrap();
    let mut experiments: Vec<&str> =
        runs.iter().map(|run| run["experiment"].as_str().unwrap()).collect();
    experiments.sort_unstable();
    experiments.dedup();
    assert!(experiments.len() < runs.len());
    assert_eq!(
        browser.script("return document.querySelectorAll('tbody tr').length"),
        json!(experiments.len())
    );
    // Seeds are below their experiment, once asked for.
    browser.script("document.querySelector('button.open').click()");
    browser.wait("document.querySelectorAll('tr.seed').length > 1");
    browser
        .script("[...document.querySelectorAll('button')].find((button) => button.innerText.startsWith('Compare all')).click()");
    browser.wait("document.querySelectorAll('.facet').length == 2");
    browser.wait("document.querySelectorAll('#means tbody tr').length > 2");
    // Few words name a curve, and a click takes it away in every facet.
    let words = browser
        .script("return Math.max(...[...document.querySelectorAll('.legend button')].map((button) => button.innerText.length))");
    assert!(words.as_u64().unwrap() < 40, "{words}");
    let curves =
        "document.querySelectorAll('.facet svg.chart g path:not([stroke-dasharray])').length";
    browser.wait(&format!("{curves} > 4"));
    let before = browser.script(&format!("return {curves}"));
    browser.script("document.querySelector('.legend button').click()");
    browser.wait(&format!(
        "document.querySelector('.legend [aria-pressed=false]') && {curves} < {before}"
    ));
    // Names of points that lie together do not cover each other.
    browser.script("window.placed = null; import('/scatter.js').then((all) => { window.placed = all.places([[200, 100, 'CPO · quick'], [196, 103, 'TRPOPID · quick'], [190, 104, 'TRPOLag · quick'], [193, 101, 'PPO · quick']], 400); })");
    browser.wait("window.placed?.length == 4");
    let apart = browser
        .script("return window.placed.every((one, k) => window.placed.every((other, n) => n <= k || Math.abs(one.y - other.y) >= 12 || one.anchor != other.anchor))");
    assert_eq!(apart, json!(true));
    browser.photograph("serve_compare");
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn a_run_is_photographed_light_dark_and_narrow() {
    let address = served("real-photographs");
    for (kind, width, height, dark) in [
        ("serve_run", 1280, 1100, false),
        ("serve_run_dark", 1280, 1100, true),
        ("serve_run_narrow", 390, 1600, false),
        ("serve_run_wide", 1920, 1100, false),
    ] {
        let Some(browser) = Browser::open(width, height, dark) else { return };
        open_run(&browser, address);
        browser.wait("document.querySelector('.ends')?.innerText.includes('%')");
        let lacking = browser.script(include_str!("common/accessible.js"));
        assert_eq!(lacking, json!([]), "{kind}");
        let wide = browser.script(
            "return document.documentElement.scrollWidth - document.documentElement.clientWidth",
        );
        assert_eq!(wide, json!(0), "{kind}: wider than the window by {wide}");
        browser.photograph(kind);
        assert_eq!(browser.errors(), Vec::<String>::new(), "{kind}");
    }
}
