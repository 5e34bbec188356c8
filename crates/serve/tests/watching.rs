//! What is watched: an agent's episodes at a glance, two agents side by side, films to keep.

#[path = "common/browser.rs"]
mod browser;
mod common;

use browser::Browser;
use common::{folder, get, serve, status, write_run};
use serde_json::{Value, json};
use std::net::SocketAddr;

fn body(answer: &str) -> Value {
    serde_json::from_str(answer.split_once("\r\n\r\n").map_or("", |(_, body)| body))
        .unwrap_or(Value::Null)
}

fn ask(address: SocketAddr, path: &str) -> Value {
    body(&get(address, path, ""))
}

const FORWARD: &str = "env=VolcanicVentureLevel1-v0&agent=hold:MOVE_FORWARD";

#[test]
fn episodes_are_acted_out_or_read_from_a_run() {
    let folder = folder("watching-episodes");
    write_run(&folder, "one", 5);
    // A seed that a number of a page does not hold.
    let line = r#"{"seed":8386705677910789437,"return":11.0,"cost":40.0,"length":525}"#;
    let file = folder.join("runs/one/closing_episodes.jsonl");
    std::fs::write(file, format!("{line}\nrubbish\n{line}\n")).unwrap();
    let address = serve(&folder, None);
    let acted = ask(address, &format!("/api/episodes?{FORWARD}&seed=3&act=2"));
    let rows = acted["rows"].as_array().unwrap();
    assert_eq!((rows[0]["seed"].clone(), rows[1]["seed"].clone()), (json!("3"), json!("4")));
    assert!(rows.iter().all(|row| row["cost"].as_f64().unwrap() > 0.0), "{rows:?}");
    // The same twice, and of a fixed policy nothing is kept.
    assert_eq!(acted, ask(address, &format!("/api/episodes?{FORWARD}&seed=3&act=2")));
    assert_eq!(ask(address, &format!("/api/episodes?{FORWARD}"))["rows"], json!([]));
    let runs = ask(address, "/api/runs");
    let agent = format!("agent=run:{}", runs["runs"][0]["id"].as_str().unwrap());
    let listed = ask(address, &format!("/api/episodes?{agent}"));
    let row = json!({ "seed": "8386705677910789437", "return": 11.0, "cost": 40.0, "length": 525 });
    assert_eq!(listed, json!({ "source": "closing", "rows": [row, row] }));
    for (path, code) in [
        (format!("{FORWARD}&act=21"), 400),
        ("env=nothing&act=1".into(), 400),
        ("env=RemedyRushLevel1-v0&seed=1e3".into(), 400),
        (format!("{FORWARD}&act=many"), 400),
        ("agent=zoo:nobody&act=1".into(), 404),
        ("agent=run:nothing".into(), 404),
    ] {
        let answer = get(address, &format!("/api/episodes?{path}"), "");
        assert_eq!(status(&answer), code, "{path}");
        assert!(body(&answer)["error"].is_string(), "{path}: {answer}");
    }
}

#[test]
fn an_episode_is_kept_as_a_film() {
    let address = serve(&folder("watching-film"), None);
    let film = |query: &str| get(address, &format!("/api/film?{query}"), "");
    let answer = film(&format!("{FORWARD}&hard=true&seed=3&size=64x48"));
    assert_eq!(status(&answer), 200, "{answer}");
    let (head, bytes) = answer.split_once("\r\n\r\n").unwrap();
    assert!(head.contains("video/mp4"), "{head}");
    assert!(head.contains("filename=\"VolcanicVentureLevel1-v0-seed3.mp4\""), "{head}");
    assert!(bytes.contains("ftyp") && bytes.contains("avc1") && bytes.len() > 2000);
    // As asked for: other views stand beside, another episode is another film.
    let beside = film(&format!("{FORWARD}&hard=true&seed=3&size=64x48&beside=depth"));
    assert_eq!(status(&beside), 200);
    assert_ne!(beside, answer);
    for (query, code) in [
        ("env=nothing", 400),
        ("env=RemedyRushLevel1-v0&size=1x1", 400),
        ("env=RemedyRushLevel1-v0&agent=unknown", 404),
        ("agent=zoo:nobody", 404),
        ("agent=episode:../secret.episode", 404),
    ] {
        let answer = film(query);
        assert_eq!(status(&answer), code, "{query}");
        let why = body(&answer)["error"].as_str().map(str::to_owned).unwrap_or_default();
        assert!(!why.is_empty() && !why.contains('\n'), "{query}: {answer}");
    }
}

#[test]
fn the_strip_of_episodes_shows_one_and_two_agents_stand_side_by_side() {
    let Some(browser) = Browser::open(1280, 1100, false) else { return };
    let address = serve(&folder("watching-strip"), None);
    browser.go(&format!("http://{address}/#watch?{FORWARD}&seed=3&size=320x240"));
    browser.wait("document.getElementById('act') && !document.getElementById('act').hidden && document.querySelector('#numbers b')");
    browser.script("document.getElementById('act').click()");
    browser.wait_long("document.querySelectorAll('#episodes circle').length == 20");
    let dots = "[...document.querySelectorAll('#episodes circle')]";
    let seed = "document.querySelector('form input[type=number], .head input[type=number]').value";
    browser.script(&format!(
        "{dots}.find((dot) => dot.dataset.seed == '7').dispatchEvent(new MouseEvent('click', {{ bubbles: true }}))"
    ));
    browser.wait(&format!("{seed} == '7' && location.hash.includes('seed=7')"));
    // The most costly one is the dot furthest to the right. The page may still be drawing what the
    // click before asked for: a click that comes too early is made again.
    let furthest = format!(
        "{dots}.reduce((most, dot) => Number(dot.getAttribute('cx')) > Number(most.getAttribute('cx')) ? dot : most).dataset.seed"
    );
    browser.wait(&format!(
        "{seed} == {furthest} || (document.getElementById('episode-costly').click(), false)"
    ));
    // A second agent: the same episode, steered together.
    browser.script("const one = document.getElementById('beside'); one.value = 'noop'; one.dispatchEvent(new Event('change'))");
    browser.wait("!document.getElementById('second').parentElement.hidden && document.getElementById('second-words').innerText.includes('noop: step')");
    browser.script("document.getElementById('go').click()");
    browser.wait("document.getElementById('go').innerText == 'Play'");
    let step = "Number(document.querySelector('#numbers b').innerText)";
    let second =
        "Number(document.getElementById('second-words').innerText.match(/step (\\d+)/)[1])";
    browser.script("const slide = document.querySelector('.stage input[type=range]'); slide.value = 40; slide.dispatchEvent(new Event('input'))");
    browser.wait(&format!("{step} == 40 && {second} == 40"));
    browser.wait("location.hash.includes('second=noop')");
    browser.wait("document.getElementById('first-words').innerText.includes('step 40')");
    let lacking = browser.script(include_str!("common/accessible.js"));
    assert_eq!(lacking, json!([]));
    browser.photograph("serve_watch_beside");
    assert_eq!(browser.errors(), Vec::<String>::new());
}
