//! Notes of runs: only where the server was begun for it, only from its own page.

#[path = "common/browser.rs"]
mod browser;
mod common;

use browser::Browser;
use common::{folder, get, raw, serve, serve_edited, status, write_run};
use serde_json::{Value, json};
use std::net::SocketAddr;

fn body(answer: &str) -> Value {
    serde_json::from_str(answer.split_once("\r\n\r\n").map_or("", |(_, body)| body))
        .unwrap_or(Value::Null)
}

fn post(address: SocketAddr, what: &Value, headers: &str) -> String {
    let text = what.to_string();
    raw(
        address,
        &format!(
            "POST /api/edit HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\nContent-Length: {}\r\n{headers}\r\n{text}",
            text.len()
        ),
    )
}

fn runs(address: SocketAddr) -> Vec<Value> {
    body(&get(address, "/api/runs", ""))["runs"].as_array().cloned().unwrap_or_default()
}

fn own(address: SocketAddr) -> String {
    format!("Origin: http://{address}\r\nContent-Type: application/json\r\n")
}

#[test]
fn notes_are_kept_and_runs_thrown_away_only_by_name() {
    let folder = folder("notes-kept");
    write_run(&folder, "sweep/one", 5);
    write_run(&folder, "sweep/two", 5);
    let address = serve_edited(&folder);
    let all = runs(address);
    let id = |name: &str| all.iter().find(|run| run["name"] == name).unwrap()["id"].clone();
    let (one, two) = (id("sweep/one"), id("sweep/two"));
    let edit = |what: Value| post(address, &what, &own(address));
    let given = json!({ "id": one, "note": "best <b>so far</b>", "tags": ["keep", " keep ", ""] });
    assert_eq!(status(&edit(given)), 200);
    assert_eq!(status(&edit(json!({ "id": one, "archived": true }))), 200);
    let kept = runs(address).into_iter().find(|run| run["id"] == one).unwrap();
    let notes = json!({ "note": "best <b>so far</b>", "tags": ["keep"], "archived": true });
    assert_eq!(kept["notes"], notes);
    let file = std::fs::read(folder.join("runs/sweep/one/notes.json")).unwrap();
    assert_eq!(serde_json::from_slice::<Value>(&file).unwrap(), notes);
    // What is too much, unknown or not named is refused, and nothing changes.
    for (what, code) in [
        (json!({ "id": one, "note": "x".repeat(4001) }), 422),
        (json!({ "id": one, "tags": ["y".repeat(41)] }), 422),
        (json!({ "id": one, "colour": "red" }), 422),
        (json!({ "id": "nothing", "note": "" }), 404),
        (json!({ "id": two, "throw_away": "two" }), 422),
    ] {
        assert_eq!(status(&edit(what.clone())), code, "{what}");
    }
    assert_eq!(runs(address).len(), 2);
    // A run that trains stays.
    let lock = std::fs::File::create(folder.join("runs/sweep/two/lock")).unwrap();
    lock.lock().unwrap();
    let away = json!({ "id": two, "throw_away": "sweep/two" });
    let answer = edit(away.clone());
    assert_eq!((status(&answer), answer.contains("is running")), (422, true), "{answer}");
    drop(lock);
    // Thrown away it lies in the trash, whole, and is not listed.
    assert_eq!(status(&edit(away)), 200);
    assert!(folder.join("runs/.trash/sweep_two/metrics.jsonl").is_file());
    assert_eq!(runs(address).len(), 1);
}

/// What stands in the file by another hand is somebody's work.
#[test]
fn notes_of_another_hand_are_not_wiped() {
    let folder = folder("notes-hand");
    write_run(&folder, "one", 5);
    let address = serve_edited(&folder);
    let id = runs(address)[0]["id"].clone();
    let file = folder.join("runs/one/notes.json");
    let save = || post(address, &json!({ "id": id, "archived": true }), &own(address));
    // A comma is missing; then no text at all.
    let halves: [&[u8]; 2] = [b"{\"note\": \"long thoughts\"\n\"tags\": []}", &[0xff, 0xfe, b'{']];
    for (half, said) in halves.into_iter().zip(["line 2 column", "is no readable text file"]) {
        std::fs::write(&file, half).unwrap();
        let answer = save();
        assert_eq!(status(&answer), 422, "{answer}");
        let why = body(&answer)["error"].as_str().unwrap().to_owned();
        assert!(why.starts_with("one/notes.json: ") && why.contains(said), "{why}");
        assert!(why.contains("move it away") && !why.contains('\n'), "{why}");
        assert_eq!(std::fs::read(&file).unwrap(), half);
    }
    // What this page does not know stays beside what it changes.
    std::fs::write(&file, r#"{"note":"mine","stars":5,"by":{"name":"Ada"}}"#).unwrap();
    assert_eq!(status(&save()), 200);
    let kept: Value = serde_json::from_slice(&std::fs::read(&file).unwrap()).unwrap();
    let wanted = json!({ "note": "mine", "tags": [], "archived": true, "stars": 5, "by": { "name": "Ada" } });
    assert_eq!(kept, wanted);
}

#[test]
fn nobody_else_writes() {
    let folder = folder("notes-others");
    write_run(&folder, "one", 5);
    let (edited, read_only) = (serve_edited(&folder), serve(&folder, None));
    let id = runs(edited)[0]["id"].clone();
    let what = json!({ "id": id, "note": "mine" });
    assert_eq!(status(&post(read_only, &what, &own(read_only))), 405);
    let json_alone = "Content-Type: application/json\r\n";
    let evil = format!("Origin: http://evil.example\r\n{json_alone}");
    let form = format!("Origin: http://{edited}\r\nContent-Type: text/plain\r\n");
    for headers in [json_alone, &evil, &form] {
        assert_eq!(status(&post(edited, &what, headers)), 403, "{headers}");
    }
    let elsewhere = format!(
        "POST /api/runs HTTP/1.1\r\nHost: {edited}\r\nConnection: close\r\nContent-Length: 0\r\n{}\r\n",
        own(edited)
    );
    assert_eq!(status(&raw(edited, &elsewhere)), 405);
    assert!(!folder.join("runs/one/notes.json").exists());
}

#[test]
fn notes_are_written_on_the_page() {
    let Some(browser) = Browser::open(1280, 1000, false) else { return };
    let folder = folder("notes-page");
    write_run(&folder, "one", 5);
    write_run(&folder, "other", 5);
    let address = serve_edited(&folder);
    let id = runs(address).iter().find(|run| run["name"] == "one").unwrap()["id"].clone();
    browser.go(&format!("http://{address}/#run?id={}", id.as_str().unwrap()));
    browser.wait("document.getElementById('save')");
    browser.script("document.querySelector('#notes details').open = true; document.getElementById('note').value = '<img src=x onerror=alert(1)>'; document.getElementById('tags').value = 'first, good'; document.getElementById('save').click()");
    browser.wait("document.getElementById('notes').innerText.includes('Saved.')");
    assert_eq!(browser.script(include_str!("common/accessible.js")), json!([]));
    browser.photograph("serve_notes");
    // The list shows the tags and finds them; what is archived is put aside.
    browser.go(&format!("http://{address}/#runs?text=good"));
    browser.wait("document.body.innerText.includes('#good') && document.querySelectorAll('tbody tr').length == 1");
    browser.go(&format!("http://{address}/#run?id={}", id.as_str().unwrap()));
    browser.wait("document.getElementById('aside')");
    browser.script(
        "document.getElementById('aside').click(); document.getElementById('save').click()",
    );
    browser.wait("document.getElementById('notes').innerText.includes('Saved.')");
    browser.go(&format!("http://{address}/#runs"));
    browser.wait("document.body.innerText.includes('1 run of 1 experiment') && !document.getElementById('archived').parentElement.hidden");
    browser.script("document.getElementById('archived').click()");
    browser.wait("document.body.innerText.includes('2 runs of 1 experiment')");
    // It is asked twice before a run is thrown away.
    browser.go(&format!("http://{address}/#run?id={}", id.as_str().unwrap()));
    browser.wait("document.getElementById('away')");
    browser.script("document.getElementById('away').click()");
    browser.wait("document.getElementById('sure').offsetHeight > 0");
    assert!(folder.join("runs/one").is_dir());
    browser.script("document.getElementById('sure').click()");
    browser.wait(
        "location.hash.startsWith('#runs') && document.querySelectorAll('tbody tr').length == 1",
    );
    assert!(folder.join("runs/.trash/one/config.json").is_file());
    assert_eq!(browser.errors(), Vec::<String>::new());
}
