//! What a person meets on the pages beside the usual way: the skip link, wrong addresses, a full
//! house, other keys.

#[path = "common/browser.rs"]
mod browser;
mod common;

use browser::Browser;
use common::{folder, get, serve, write_run};
use serde_json::json;
use std::net::{SocketAddr, TcpStream};
use std::time::Duration;
use tungstenite::{Message, WebSocket};

#[test]
fn the_skip_link_leads_into_the_page_and_names_of_objects_lead_nowhere() {
    let Some(browser) = Browser::open(1280, 900, false) else { return };
    let folder = folder("pages-skip");
    write_run(&folder, "one", 5);
    let address = serve(&folder, None);
    browser.go(&format!("http://{address}/#runs?text=one"));
    browser.wait("document.querySelectorAll('tbody tr').length == 1");
    browser.script("const skip = document.querySelector('a.skip'); skip.focus(); skip.click()");
    browser.wait("document.activeElement.id == 'page' && document.querySelector('tbody tr')");
    assert_eq!(browser.script("return location.hash"), json!("#runs?text=one"));
    for page in ["constructor", "toString", "__proto__", "nothing"] {
        browser.go(&format!("http://{address}/#{page}"));
        browser.wait("document.getElementById('page').innerText == 'There is no such page.'");
    }
    assert_eq!(browser.errors(), Vec::<String>::new());
}

fn connect(address: SocketAddr, path: &str) -> WebSocket<TcpStream> {
    let stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
    tungstenite::client(format!("ws://{address}{path}"), stream).unwrap().0
}

/// The first words of a show.
fn words(socket: &mut WebSocket<TcpStream>) -> serde_json::Value {
    loop {
        if let Message::Text(text) = socket.read().unwrap() {
            return serde_json::from_str(&text).unwrap();
        }
    }
}

/// The status of a refused handshake is hidden from a page: what is wrong is said on the line.
#[test]
fn a_show_that_cannot_be_says_why() {
    let address = serve(&folder("pages-why"), None);
    let env = "env=RemedyRushLevel1-v0";
    for (path, why) in [
        (format!("watch?{env}&seed=-1"), "seed"),
        (format!("watch?{env}&seed=1.5"), "seed"),
        (format!("play?{env}&seed=1e3"), "seed"),
        (format!("play?{env}&seed=18446744073709551616"), "seed"),
        (format!("watch?{env}&step=x"), "step"),
        (format!("play?{env}&size=9x9"), "size"),
        ("watch?env=NoSuch-v0".into(), "NoSuch-v0"),
        ("play?env=NoSuch-v0".into(), "NoSuch-v0"),
        ("play".into(), "env"),
    ] {
        let mut socket = connect(address, &format!("/api/{path}"));
        let said = words(&mut socket);
        assert_eq!(said["kind"], "error", "{path}: {said}");
        let said = said["why"].as_str().unwrap();
        assert!(said.contains(why) && !said.contains('\n'), "{path}: {said}");
        assert!(matches!(socket.read(), Ok(Message::Close(_)) | Err(_)), "{path}");
    }
}

#[test]
fn pages_show_what_is_wrong_with_a_link() {
    let Some(browser) = Browser::open(1280, 900, false) else { return };
    let address = serve(&folder("pages-wrong"), None);
    let alert = "document.querySelector('[role=alert]').innerText";
    for page in ["watch", "play"] {
        for (query, why) in [
            ("seed=-1", "“-1” is no seed"),
            ("seed=1.5", "no seed"),
            ("seed=1e3", "no seed"),
            ("seed=18446744073709551616", "from 0 to 18446744073709551615"),
            ("size=9x9", "size is WIDTHxHEIGHT"),
        ] {
            browser.go(&format!("http://{address}/#{page}?env=RemedyRushLevel1-v0&{query}"));
            browser.wait(&format!(
                "document.querySelector('[role=alert]') && {alert}.includes('{why}')"
            ));
        }
        browser.go(&format!("http://{address}/#{page}?env=NoSuch-v0"));
        browser.wait(&format!(
            "document.querySelector('[role=alert]') && {alert}.includes('NoSuch-v0')"
        ));
        // A right one, and the line is empty again: the largest there is, to its last digit.
        browser.go(&format!("http://{address}/#{page}?env=RemedyRushLevel1-v0&seed=-1"));
        browser.wait(&format!("document.querySelector('input[type=number]') && {alert}"));
        browser.script("const seed = document.querySelector('input[type=number]'); seed.value = '18446744073709551615'; seed.dispatchEvent(new Event('change'))");
        browser.wait(&format!("document.querySelector('#numbers b') && {alert} == ''"));
        browser.wait("location.hash.includes('seed=18446744073709551615')");
    }
}

/// The largest seed there is, which a number of JavaScript does not hold.
const LARGEST: &str = "18446744073709551615";

#[test]
fn seeds_keep_all_their_digits() {
    let folder = folder("pages-seeds");
    write_run(&folder, "one", 5);
    let config = format!(
        r#"{{"algorithm":"PPOLag","env":{{"id":"RemedyRushLevel1-v0","rules":"paper"}},"seed":{LARGEST},"frames":100000}}"#
    );
    std::fs::write(folder.join("runs/one/config.json"), config).unwrap();
    let address = serve(&folder, None);
    let list = get(address, "/api/runs", "");
    assert!(list.contains(&format!("\"seed\":\"{LARGEST}\"")), "{list}");
    let id = list.split("\"id\":\"").nth(1).unwrap().split('"').next().unwrap().to_owned();
    let detail = get(address, &format!("/api/run?id={id}"), "");
    assert!(detail.contains(&format!("\"value\":\"{LARGEST}\"")), "{detail}");
    let Some(browser) = Browser::open(1280, 900, false) else { return };
    browser.go(&format!("http://{address}/#run?id={id}"));
    browser.wait(&format!("document.querySelector('h1').innerText.includes('seed {LARGEST}')"));
    browser
        .go(&format!("http://{address}/#play?env=RemedyRushLevel1-v0&size=320x240&seed={LARGEST}"));
    browser.wait(&format!("document.getElementById('numbers').innerText.includes('{LARGEST}')"));
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn a_task_of_ones_own_says_what_it_is_and_how_long() {
    let folder = folder("pages-own");
    let file = folder.join("pages_own.toml");
    let text = hasard_envs::own::template("PagesOwn").replace("tics = 2100", "tics = 1400");
    let text =
        text.replace("budget = 25", "summary = \"Glass is worth more than gold.\"\nbudget = 25");
    std::fs::write(&file, text).unwrap();
    hasard_envs::own::open(&file.to_string_lossy()).unwrap();
    let address = serve(&folder, None);
    let mut socket = connect(address, "/api/play?env=PagesOwn-v0&size=64x48");
    let scene = words(&mut socket);
    assert_eq!((&scene["kind"], &scene["seconds"]), (&json!("scene"), &json!(40.0)), "{scene}");
    let Some(browser) = Browser::open(1280, 900, false) else { return };
    browser.go(&format!("http://{address}/#play?env=PagesOwn-v0&size=320x240"));
    browser.wait("document.getElementById('numbers').innerText.includes('of 40 s')");
    let task = browser.script("return document.getElementById('task').innerText");
    let wanted = "Collect vials, keep off the lava Glass is worth more than gold.";
    assert_eq!(task, json!(wanted));
    browser.photograph("serve_play_own");
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn keys_fire_and_are_let_go_and_an_episode_is_not_lost_by_a_slip() {
    let Some(browser) = Browser::open(1280, 900, false) else { return };
    let address = serve(&folder("pages-keys"), None);
    browser.go(&format!(
        "http://{address}/#play?env=DetonatorsDilemmaLevel1-v0&size=320x240&full=true"
    ));
    browser.wait("document.querySelector('#numbers b')");
    browser.script("window.sent = []; const send = WebSocket.prototype.send; WebSocket.prototype.send = function (text) { window.sent.push(text); return send.call(this, text); }");
    let sent = |what: &str, key: &str| {
        browser.wait(&format!(
            "window.sent.map(JSON.parse).some((one) => one.do == '{what}' && one.key == '{key}')"
        ));
    };
    let asks = |wanted: bool| {
        browser.wait(&format!(
            "(() => {{ const leave = new Event('beforeunload', {{ cancelable: true }}); dispatchEvent(leave); return leave.defaultPrevented == {wanted}; }})()"
        ));
    };
    browser.keys(&["h"], true);
    browser.keys(&["h"], false);
    browser.wait("document.getElementById('card').innerText.includes('F, Ctrl, left button')");
    asks(false);
    browser.script("document.getElementById('begin').click()");
    browser.wait("document.querySelector('#numbers b').innerText != '0.0 of 60 s'");
    asks(true);
    browser.keys(&["f"], true);
    sent("press", "ATTACK");
    browser.keys(&["f"], false);
    sent("release", "ATTACK");
    // Let go with Alt held, over a button.
    let key = |kind: &str, place: &str, alt: bool| {
        browser.script(&format!("{place}.dispatchEvent(new KeyboardEvent('{kind}', {{ code: 'KeyW', altKey: {alt}, bubbles: true }}))"));
    };
    key("keydown", "document.body", false);
    sent("press", "MOVE_FORWARD");
    key("keyup", "document.getElementById('begin')", true);
    sent("release", "MOVE_FORWARD");
    browser.keys(&["p"], true);
    browser.keys(&["p"], false);
    asks(false);
    assert_eq!(browser.errors(), Vec::<String>::new());
}

#[test]
fn a_search_takes_any_case_and_paths_any_separator() {
    let Some(browser) = Browser::open(1280, 900, false) else { return };
    let folder = folder("pages-search");
    write_run(&folder, "Sweep/One", 5);
    write_run(&folder, "sweep/two", 5);
    let address = serve(&folder, None);
    for (text, rows) in
        [("sWEEP/o", "1 run of"), ("SWEEP", "2 runs of"), ("remedyRUSH", "2 runs of")]
    {
        browser.go(&format!("http://{address}/#runs?text={text}"));
        browser.wait(&format!("document.body.innerText.includes('{rows}')"));
    }
    let rest = |name: &str| {
        browser.script(&format!("return import('/names.js').then(({{ path_rest }}) => path_rest({{ name: {name:?}, env: 'RemedyRushLevel1-v0', algo: 'PPO', seed: '1' }}))"))
    };
    assert_eq!(rest("study/RemedyRushLevel1/PPO/seed1"), "study");
    assert_eq!(rest(r"study\RemedyRushLevel1\PPO\seed1\b"), r"study\b");
    assert_eq!(rest(r"st\udy/PPO"), r"st\udy");
}

#[test]
fn a_full_house_and_a_lost_token_are_named() {
    let Some(browser) = Browser::open(1280, 900, false) else { return };
    let address = serve(&folder("pages-full"), None);
    let watch = "/api/watch?env=RemedyRushLevel1-v0&size=64x48&paused=true";
    let shows: Vec<_> = (0..64)
        .map(|_| {
            let mut socket = connect(address, watch);
            assert_eq!(words(&mut socket)["kind"], "scene");
            socket
        })
        .collect();
    let mut socket = connect(address, watch);
    assert_eq!(words(&mut socket)["again"], true);
    browser.go(&format!("http://{address}/#watch?env=RemedyRushLevel1-v0&size=160x120"));
    let alert = "document.querySelector('[role=alert]').innerText";
    browser.wait(&format!(
        "document.querySelector('[role=alert]') && {alert}.includes('all places are taken')"
    ));
    // Others leave: the show begins by itself.
    drop(shows);
    browser.wait(&format!("document.querySelector('#numbers b') && {alert} == ''"));

    let address = serve(&folder("pages-token"), Some("letmein12345"));
    browser.go(&format!("http://{address}/?token=letmein12345"));
    browser.script("location.hash = '#play?env=RemedyRushLevel1-v0&size=320x240'");
    browser.wait("document.querySelector('#numbers b')");
    browser.forget();
    browser.script("const size = [...document.querySelectorAll('select')].at(-1); size.value = '640x480'; size.dispatchEvent(new Event('change'))");
    browser.wait(&format!("{alert}.includes('wants its token')"));
}
