//! What a person meets on the pages beside the usual way: the skip link, wrong addresses, a full
//! house, other keys.

#[path = "common/browser.rs"]
mod browser;
mod common;

use browser::Browser;
use common::{folder, serve, write_run};
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
