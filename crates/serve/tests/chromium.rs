//! The pages in a real browser.

#[path = "common/browser.rs"]
mod browser;
mod common;

use browser::Browser;
use common::{folder, serve, serve_at, write_heatmaps, write_run, write_seed};
use serde_json::json;

/// A key by its name in the browser, as WebDriver wants it.
fn key(name: &str) -> &str {
    match name {
        "Tab" => "\u{e004}",
        "Enter" => "\u{e007}",
        "ArrowLeft" => "\u{e012}",
        other => other,
    }
}

#[test]
fn runs_appear_move_and_are_compared() {
    let Some(browser) = Browser::open(1280, 900, false) else { return };
    let folder = folder("chromium-runs");
    let address = serve(&folder, None);
    browser.go(&format!("http://{address}/"));
    browser.wait("document.body.innerText.includes('No runs yet') && document.body.innerText.includes('hasard train')");
    browser.photograph("serve_empty");
    write_seed(&folder, "first<img src=x onerror=document.title='bad'>", 1, 20);
    write_seed(&folder, "second", 2, 900);
    write_heatmaps(&folder, "second", &[10_000, 90_000]);
    // Runs that differ in their seed alone are one row, which opens.
    browser.wait("document.querySelectorAll('tbody input').length == 1 && document.querySelector('button.open')");
    browser.script("document.querySelector('button.open').click()");
    browser.wait("document.querySelectorAll('tr.seed').length == 2 && document.body.innerText.includes('<img src=x')");
    assert_ne!(browser.script("return document.title"), json!("bad"));
    browser.script("document.querySelector('tbody input').click()");
    browser.wait("location.hash.includes('chosen=') && !document.getElementById('curves').hidden");
    browser.wait("document.querySelectorAll('tbody input:checked').length == 3");
    // Both are alike but for their names.
    browser.wait("document.body.innerText.includes('All settings are equal')");
    browser.wait("document.querySelector('.readout').innerText.includes('(2 seeds)')");
    let progress = |share: &str| {
        browser.wait(&format!(
            "[...document.querySelectorAll('tr.seed progress')].some((bar) => Math.abs(bar.value - {share}) < 1e-6)"
        ));
    };
    progress("0.9");
    // The training goes on: the row moves without reloading.
    write_seed(&folder, "second", 2, 990);
    progress("0.99");
    browser.photograph("serve_runs");
    // By the keyboard alone: a curve is zoomed into and back.
    browser.script("document.querySelector('svg.chart').focus()");
    let span = "[...document.querySelectorAll('svg.chart text')].map((text) => text.textContent).join('|')";
    let whole = browser.script(&format!("return {span}"));
    browser.keys(&["+", "ArrowLeft"].map(key), true);
    browser.keys(&["+", "ArrowLeft"].map(key), false);
    browser.wait(&format!("{span} != {whole}"));
    browser.keys(&["0"], true);
    browser.keys(&["0"], false);
    browser.wait(&format!("{span} == {whole}"));
    browser.script("[...document.querySelectorAll('tbody a')].find((link) => link.innerText == 'seed 2').click()");
    browser.wait(
        "document.body.innerText.includes('Settings') && document.body.innerText.includes('PPOLag in Remedy Rush 1, seed 2')",
    );
    browser.wait("[...document.querySelectorAll('tbody th code')].some((cell) => cell.textContent == 'algorithm')");
    // The newest heatmap, over the map; a click on a curve goes to another moment.
    browser.wait("[...document.querySelectorAll('figcaption')].some((text) => text.innerText.includes('At 90,000 frames'))");
    browser.script(
        "const c = document.querySelector('svg.chart'); c.setPointerCapture = () => {}; const at = c.getBoundingClientRect(); for (const type of ['pointerdown', 'pointerup']) c.dispatchEvent(new PointerEvent(type, { clientX: at.left + 70, clientY: at.top + 50, pointerId: 1 }))",
    );
    browser.wait("[...document.querySelectorAll('figcaption')].some((text) => text.innerText.includes('At 10,000 frames'))");
    // Beside another run what differs is said.
    browser.script("const one = [...document.querySelectorAll('select')].at(-1); one.value = one.options[1].value; one.dispatchEvent(new Event('change'))");
    browser.wait("document.body.innerText.includes('All settings are equal')");
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn an_agent_is_watched_paused_and_its_cost_jumped_to() {
    let Some(browser) = Browser::open(1280, 1100, false) else { return };
    let address = serve(&folder("chromium-watch"), None);
    browser.go(&format!(
        "http://{address}/#watch?env=VolcanicVentureLevel1-v0&agent=hold:MOVE_FORWARD&seed=3"
    ));
    let step = "Number(document.querySelector('#numbers b')?.innerText)";
    browser.wait(&format!("{step} > 5"));
    browser.wait("document.querySelector('[data-kind=cost]')");
    browser.script("document.getElementById('go').click()");
    browser.wait("document.getElementById('go').innerText == 'Play'");
    browser.script("document.querySelector('[data-kind=cost]').click()");
    browser.wait(&format!(
        "{step} == Number(document.querySelector('[data-kind=cost]').dataset.step) - 1"
    ));
    let at = browser.script(&format!("return {step}"));
    // A step on and back, by keys: the same picture.
    let before = browser.resting("canvas.view");
    browser.script("document.activeElement.blur()");
    for (name, to) in [("\u{e014}", 1), ("ArrowLeft", 0)] {
        browser.keys(&[key(name)], true);
        browser.keys(&[key(name)], false);
        browser.wait(&format!("{step} == {at} + {to}"));
    }
    assert_eq!(browser.resting("canvas.view"), before);
    // The view is no plain black.
    browser.wait("(() => { const c = document.querySelector('canvas.view'); const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; return new Set(d).size > 20; })()");
    browser.photograph("serve_watch");
    browser.script("document.getElementById('copy').click()");
    browser.wait("location.hash.includes('paused=true')");
    let link = browser.script("return location.href");
    browser.go(link.as_str().unwrap());
    browser.wait(&format!("{step} == {at} && document.getElementById('go').innerText == 'Play'"));
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn an_episode_is_played_kept_and_found_in_the_table() {
    let Some(browser) = Browser::open(1280, 1000, true) else { return };
    let folder = folder("chromium-play");
    let address = serve(&folder, None);
    // Under the hard constraint lava ends the episode soon.
    browser.go(&format!(
        "http://{address}/#play?env=VolcanicVentureLevel1-v0&seed=3&hard=true&size=320x240"
    ));
    browser.wait("document.querySelector('#numbers b')");
    browser.photograph("serve_play_dark");
    // What to do and what to avoid stands above; H shows the keys of this task, and those alone.
    browser.wait("document.getElementById('task').innerText.includes('Avoid: the lava')");
    browser.keys(&["h"], true);
    browser.keys(&["h"], false);
    let card = "document.getElementById('card')";
    browser.wait(&format!(
        "!{card}.hidden && {card}.innerText.includes('jump') && !{card}.innerText.includes('fire')"
    ));
    browser.script("document.getElementById('begin').click()");
    browser.keys(&["w"], true);
    browser.wait("document.querySelector('#words').innerText.includes('kept as')");
    browser.keys(&["w"], false);
    // It cost more than the budget of 0: the card says so, and the table of those within has no row
    // for it.
    browser
        .wait("!document.getElementById('card').hidden && document.getElementById('card').innerText.includes('Over the budget')");
    browser.wait("document.querySelector('#best').innerText.includes('Nobody yet')");
    assert_eq!(std::fs::read_dir(folder.join("human")).unwrap().count(), 1);
    browser.script("fetch('/api/best').then((answer) => answer.json()).then((rows) => { window.film = new URL(`/api/episode?name=${rows[0].episode}&kind=mp4`, location.href).href; })");
    browser.wait("window.film");
    let film = browser.script("return window.film");
    let path = film.as_str().unwrap().split_once(&address.to_string()).unwrap().1.to_owned();
    let answer = common::get(address, &path, "");
    assert!(
        common::status(&answer) == 200 && answer.contains("video/mp4") && answer.contains("ftyp")
    );
    // It plays here too.
    browser.script("document.body.append(Object.assign(document.createElement('video'), { src: window.film, id: 'film', muted: true })); document.getElementById('film').play()");
    browser.wait("document.getElementById('film').currentTime > 0.2 && document.getElementById('film').videoWidth == 320");
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn a_finger_walks_and_a_caught_mouse_turns() {
    let Some(browser) = Browser::open(1280, 1000, false) else { return };
    let folder = folder("chromium-pointer");
    let address = serve(&folder, None);
    browser.touched();
    browser.go(&format!(
        "http://{address}/#play?env=VolcanicVentureLevel1-v0&seed=3&hard=true&size=320x240"
    ));
    browser.wait("document.querySelector('#numbers b')");
    // Into the lava, as in the test of keys.
    browser.wait("document.querySelector('.touch').offsetHeight > 0");
    browser.pointer("touch", Ok("button[aria-label=MOVE_FORWARD]"), Some(true));
    browser.wait("document.querySelector('#words').innerText.includes('kept as')");
    browser.pointer("touch", Ok("button[aria-label=MOVE_FORWARD]"), Some(false));

    browser.go(&format!("http://{address}/#play?env=ArmamentBurdenLevel1-v0&seed=3&size=320x240"));
    browser.wait("document.querySelector('#numbers b')");
    browser.pointer("mouse", Ok("#game"), Some(true));
    browser.pointer("mouse", Ok("#game"), Some(false));
    browser.wait("document.pointerLockElement?.id == 'game' && document.querySelector('#numbers b').innerText != '0.0 of 60 s'");
    // Taking the mouse may itself move it, and a busy machine shows that late: from a picture that
    // rests, only the mouse turns.
    browser.resting("#game");
    browser.script(
        "const look = () => { const copy = Object.assign(document.createElement('canvas'), { width: 320, height: 240 }); \
         const pen = copy.getContext('2d'); pen.drawImage(document.getElementById('game'), 0, 0, 320, 240); \
         return pen.getImageData(0, 0, 320, 240).data; }; \
         const first = look(); \
         window.changed = () => look().filter((value, at) => Math.abs(value - first[at]) > 24).length / first.length;",
    );
    browser.pointer("mouse", Err([200, 0]), None);
    browser.wait("changed() > 0.1");
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn pages_are_photographed_light_dark_and_narrow() {
    let folder = folder("chromium-photographs");
    for k in 0..30 {
        write_seed(&folder, &format!("remedy/PPOLag/seed{k}"), k, 100 + 10 * k);
    }
    let address = serve(&folder, None);
    let pages = [
        ("runs", "runs"),
        ("watch", "watch?env=RemedyRushLevel1-v0&agent=sticky:10&seed=1"),
        ("play", "play?env=ArmamentBurdenLevel1-v0&full=true"),
    ];
    for (kind, width, height, dark) in [
        ("light", 1280, 900, false),
        ("dark", 1280, 900, true),
        ("narrow", 390, 1600, false),
        ("wide", 2560, 1200, false),
    ] {
        let Some(browser) = Browser::open(width, height, dark) else { return };
        for (name, page) in pages {
            browser.go(&format!("http://{address}/#{page}"));
            browser.wait(if name == "runs" {
                "document.querySelectorAll('tbody input').length == 1 && document.body.innerText.includes('30 runs')"
            } else {
                "document.querySelector('#numbers b')"
            });
            if name == "runs" {
                browser.script("document.querySelector('button.open').click()");
                browser.script("[...document.querySelectorAll('tr.seed input')].slice(0, 3).forEach((box) => box.click())");
            }
            std::thread::sleep(std::time::Duration::from_millis(1500));
            let lacking = browser.script(include_str!("common/accessible.js"));
            assert_eq!(lacking, json!([]), "{name} {kind}");
            // Nothing is wider than the window.
            let wide = browser.script("return document.documentElement.scrollWidth - document.documentElement.clientWidth");
            assert_eq!(wide, json!(0), "{name} {kind}: wider than the window by {wide}");
            browser.photograph(&format!("serve_{name}_{kind}"));
        }
        assert_eq!(browser.errors(), Vec::<String>::new(), "{kind}");
    }
}

/// Without a mouse: every control is reached by Tab, and what it shows follows.
#[test]
fn everything_is_reached_by_the_keyboard() {
    let Some(browser) = Browser::open(1280, 900, false) else { return };
    let folder = folder("chromium-keyboard");
    write_run(&folder, "only", 20);
    let address = serve(&folder, None);
    browser.go(&format!("http://{address}/"));
    browser.wait("document.querySelectorAll('tbody input').length == 1");
    let tab_to = |wanted: &str| {
        for _ in 0..60 {
            browser.keys(&[key("Tab")], true);
            browser.keys(&[key("Tab")], false);
            if browser.script(&format!("return document.activeElement.matches({wanted:?})"))
                == json!(true)
            {
                return;
            }
        }
        panic!("Tab does not reach {wanted}");
    };
    tab_to("a.skip");
    tab_to("tbody input");
    browser.keys(&[" "], true);
    browser.keys(&[" "], false);
    browser.wait("!document.getElementById('curves').hidden");
    tab_to("svg.chart");
    browser.go(&format!(
        "http://{address}/#watch?env=VolcanicVentureLevel1-v0&agent=hold:MOVE_FORWARD&seed=3"
    ));
    browser.wait("document.querySelector('[data-kind=cost]')");
    for control in ["select", "#go", "#tic", "#copy", "input[type=range]", "[data-kind=cost]"] {
        browser.script("document.activeElement.blur()");
        tab_to(control);
    }
    browser.keys(&[key("Enter")], true);
    browser.keys(&[key("Enter")], false);
    let step = "Number(document.querySelector('#numbers b').innerText)";
    browser.wait(&format!("{step} >= Number(document.activeElement.dataset.step) - 1"));
    browser.script("document.activeElement.blur()");
    browser.keys(&[" "], true);
    browser.keys(&[" "], false);
    browser.wait("document.getElementById('go').innerText == 'Play'");
    assert_eq!(browser.errors(), Vec::<String>::new());
}

/// A page whose server dies says so, and goes on when it is back.
#[test]
fn a_server_that_is_away_is_reported_and_comes_back() {
    let Some(browser) = Browser::open(900, 700, false) else { return };
    let folder = folder("chromium-away");
    write_run(&folder, "one", 5);
    // A process of its own, so that it can die: this test binary, asked to serve.
    let port = std::net::TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let begin = || {
        let mut command = std::process::Command::new(std::env::current_exe().unwrap());
        command
            .args(["--ignored", "--exact", "serve_in_a_process"])
            .env("HASARD_SERVE_TEST", format!("127.0.0.1:{port}|{}", folder.display()));
        command.stdout(std::process::Stdio::null()).spawn().unwrap()
    };
    let mut server = begin();
    while std::net::TcpStream::connect(("127.0.0.1", port)).is_err() {
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
    browser.go(&format!("http://127.0.0.1:{port}/"));
    browser.wait("document.querySelectorAll('tbody input').length == 1");
    server.kill().unwrap();
    server.wait().unwrap();
    browser.wait("document.getElementById('link').innerText.includes('does not answer')");
    write_run(&folder, "two", 5);
    let mut server = begin();
    browser.wait("document.getElementById('link').innerText == '' && document.body.innerText.includes('2 runs')");
    server.kill().unwrap();
    server.wait().unwrap();
}

#[test]
#[ignore = "a server in a process of its own, begun by the test above"]
fn serve_in_a_process() {
    let Some((address, folder)) = std::env::var("HASARD_SERVE_TEST")
        .ok()
        .and_then(|given| given.split_once('|').map(|(a, b)| (a.to_owned(), b.to_owned())))
    else {
        return;
    };
    serve_at(&address, folder.as_ref(), None);
    std::thread::sleep(std::time::Duration::from_secs(300));
}
