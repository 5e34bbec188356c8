//! The pages that put runs and metrics side by side: what is counted, drawn, named and kept.

#[path = "common/browser.rs"]
mod browser;
mod common;

use browser::Browser;
use common::{folder, get, serve, write_seed};
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
