//! What is said of runs is what is there now: directories are resumed, replaced, renamed and
//! deleted while a page is open.

mod common;

use common::{folder, get, serve, write_run};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::net::SocketAddr;
use std::path::Path;
use std::time::{Duration, Instant};

fn ask(address: SocketAddr, path: &str) -> Value {
    let answer = get(address, path, "");
    serde_json::from_str(answer.split_once("\r\n\r\n").map_or("", |(_, body)| body))
        .unwrap_or(Value::Null)
}

/// A page that adds up what changed, as the list of runs does.
struct Page {
    address: SocketAddr,
    since: u64,
    runs: BTreeMap<String, Value>,
}

impl Page {
    fn look(&mut self) {
        let news = ask(self.address, &format!("/api/runs?since={}", self.since));
        if news["whole"] == true {
            self.runs.clear();
        }
        for run in news["runs"].as_array().unwrap() {
            self.runs.insert(run["id"].as_str().unwrap().to_owned(), run.clone());
        }
        self.since = news["change"].as_u64().unwrap();
    }

    /// Looks until the runs by name are as wanted.
    fn wait(&mut self, what: &str, wanted: impl Fn(&BTreeMap<&str, &Value>) -> bool) {
        let begun = Instant::now();
        loop {
            self.look();
            let named =
                self.runs.values().map(|run| (run["name"].as_str().unwrap(), run)).collect();
            if wanted(&named) {
                return;
            }
            assert!(begun.elapsed() < Duration::from_secs(20), "{what}: {named:?}");
            std::thread::sleep(Duration::from_millis(100));
        }
    }

    fn id(&self, name: &str) -> String {
        self.runs.values().find(|run| run["name"] == name).unwrap()["id"]
            .as_str()
            .unwrap()
            .to_owned()
    }
}

fn settings(folder: &Path, name: &str, algorithm: &str, seed: u32, frames: u32) {
    let config = json!({ "algorithm": algorithm, "env": { "id": "RemedyRushLevel1-v0", "rules": "paper" }, "seed": seed, "frames": frames });
    std::fs::write(folder.join("runs").join(name).join("config.json"), config.to_string()).unwrap();
}

#[test]
fn pages_follow_runs_that_are_resumed_replaced_renamed_and_deleted() {
    let folder = folder("present");
    write_run(&folder, "one", 1000);
    write_run(&folder, "two", 3);
    let mut page = Page { address: serve(&folder, None), since: 0, runs: BTreeMap::new() };
    page.wait("at first", |runs| {
        runs.len() == 2
            && runs["one"]["state"] == "done"
            && runs["one"]["last"]["frames"] == 100_000
    });
    let id = page.id("one");
    let curve = |page: &Page| {
        ask(page.address, &format!("/api/curves?runs={id}&columns=fps"))[&id]["frames"].clone()
    };
    assert_eq!(curve(&page).as_array().unwrap().last(), Some(&json!(100_000.0)));
    // Resumed to more frames.
    settings(&folder, "one", "PPOLag", 1, 900_000);
    page.wait("resumed", |runs| {
        runs["one"]["state"] == "running" && runs["one"]["total"] == 900_000.0
    });
    // Another run in its place, at first without rows.
    let run = folder.join("runs/one");
    std::fs::remove_dir_all(&run).unwrap();
    std::fs::create_dir(&run).unwrap();
    settings(&folder, "one", "PPO", 7, 50_000);
    page.wait("replaced", |runs| {
        let one = &runs["one"];
        (&one["algo"], &one["seed"], &one["last"], &one["state"])
            == (&json!("PPO"), &json!("7"), &json!({}), &json!("stopped"))
    });
    assert_eq!(curve(&page), json!([]));
    // Its rows are more than the former run's were, and none of those is among them.
    let rows: String = (1..=3000)
        .map(|k| format!("{{\"frames\":{},\"fps\":1.0,\"return_mean\":{k}}}\n", k * 7))
        .collect();
    std::fs::write(run.join("metrics.jsonl"), rows).unwrap();
    page.wait("its rows", |runs| runs["one"]["last"]["frames"] == 21_000);
    let frames = curve(&page);
    assert!(
        frames.as_array().unwrap().iter().all(|frames| frames.as_f64().unwrap() % 7.0 == 0.0),
        "{frames}"
    );
    // Renamed: it is there once. Deleted: it is gone, and others can be chosen all the same.
    std::fs::rename(folder.join("runs/two"), folder.join("runs/zwei")).unwrap();
    page.wait("renamed", |runs| runs.keys().copied().eq(["one", "zwei"]));
    std::fs::remove_dir_all(folder.join("runs/zwei")).unwrap();
    page.wait("deleted", |runs| runs.keys().copied().eq(["one"]));
    let best = ask(page.address, "/api/best");
    assert!(
        best.as_array().unwrap().iter().all(|row| !row["who"].as_str().unwrap().contains("seed 1")),
        "{best}"
    );
}

/// Rows come late in a long evaluation, and the last one before the closing is over.
#[test]
fn a_training_that_holds_its_run_is_at_work() {
    let folder = folder("present-held");
    write_run(&folder, "slow", 3);
    write_run(&folder, "closing", 1000);
    let long_ago = std::time::SystemTime::now() - Duration::from_secs(3600);
    let locks = ["slow", "closing"].map(|name| {
        let run = folder.join("runs").join(name);
        let rows = std::fs::File::options().append(true).open(run.join("metrics.jsonl")).unwrap();
        rows.set_modified(long_ago).unwrap();
        let lock = std::fs::File::create(run.join("lock")).unwrap();
        lock.lock().unwrap();
        lock
    });
    let mut page = Page { address: serve(&folder, None), since: 0, runs: BTreeMap::new() };
    page.wait("held", |runs| {
        runs.len() == 2
            && runs["slow"]["state"] == "running"
            && runs["closing"]["state"] == "evaluating"
    });
    drop(locks);
    page.wait("let go", |runs| {
        runs["slow"]["state"] == "stopped" && runs["closing"]["state"] == "done"
    });
}

/// To open a pipe that nobody writes into is to wait for ever.
#[cfg(unix)]
#[test]
fn a_pipe_in_a_files_place_is_passed_over() {
    let folder = folder("present-pipes");
    for name in ["metrics.jsonl", "heatmaps.jsonl", "selected.json", "notes.json", "lock"] {
        write_run(&folder, name, 3);
        let path = folder.join("runs").join(name).join(name);
        let _ = std::fs::remove_file(&path);
        assert!(std::process::Command::new("mkfifo").arg(path).status().unwrap().success());
    }
    let mut page = Page { address: serve(&folder, None), since: 0, runs: BTreeMap::new() };
    page.wait("beside pipes", |runs| {
        runs.len() == 5
            && runs["metrics.jsonl"]["last"] == json!({})
            && runs["lock"]["last"] != json!({})
    });
    for name in ["metrics.jsonl", "heatmaps.jsonl", "selected.json", "notes.json", "lock"] {
        let id = page.id(name);
        assert_eq!(ask(page.address, &format!("/api/run?id={id}"))["run"]["name"], name);
        assert!(ask(page.address, &format!("/api/curves?runs={id}&columns=fps"))[&id].is_object());
        assert!(ask(page.address, &format!("/api/heatmap?id={id}"))["error"].is_string());
    }
}
