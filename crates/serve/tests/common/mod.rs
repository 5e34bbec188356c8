//! A server in the test's process, with runs and episodes of its own.

#![allow(dead_code, reason = "each test file uses some of it")]

use hasard_envs::{Env, EnvOptions};
use hasard_learn::runs::evaluate::{Agent, Choice};
use hasard_serve::{Agents, Server, Settings};
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// No trained agents.
struct Nobody;

impl Agents for Nobody {
    fn options(&self, run: &Path) -> Result<(String, EnvOptions), String> {
        Err(format!("{}: no checkpoint", run.display()))
    }

    fn load(&self, run: &Path, _: bool, _: Choice, _: &Env) -> Result<Agent, String> {
        Err(format!("{}: no checkpoint", run.display()))
    }

    fn zoo(&self) -> Vec<String> {
        Vec::new()
    }

    fn zoo_run(&self, name: &str) -> Result<PathBuf, String> {
        Err(format!("{name}: no such agent"))
    }
}

/// A folder for a test, which is gone after it.
pub struct Folder(PathBuf);

impl std::ops::Deref for Folder {
    type Target = Path;

    fn deref(&self) -> &Path {
        &self.0
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// A folder for a test, emptied.
pub fn folder(name: &str) -> Folder {
    let folder = std::env::temp_dir().join(format!("hasard-serve-{}-{name}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(folder.join("runs")).unwrap();
    std::fs::create_dir_all(folder.join("human")).unwrap();
    Folder(folder)
}

/// Serves `FOLDER/runs`, and episodes in `FOLDER/human`, until the test's process ends.
pub fn serve_at(address: &str, folder: &Path, token: Option<&str>) -> SocketAddr {
    serve_as(address, folder, token, false)
}

/// The same, with notes that may be written.
pub fn serve_edited(folder: &Path) -> SocketAddr {
    serve_as("127.0.0.1:0", folder, None, true)
}

fn serve_as(address: &str, folder: &Path, token: Option<&str>, edit: bool) -> SocketAddr {
    let server = Server::bind(Settings {
        address: address.parse().unwrap(),
        token: token.map(str::to_owned),
        folders: vec![folder.join("runs")],
        episodes: folder.join("human"),
        agents: Arc::new(Nobody),
        edit,
    })
    .unwrap();
    let address = server.address();
    std::thread::spawn(move || server.run());
    address
}

pub fn serve(folder: &Path, token: Option<&str>) -> SocketAddr {
    serve_at("127.0.0.1:0", folder, token)
}

/// Writes a run of some rows.
pub fn write_run(folder: &Path, name: &str, rows: u32) {
    write_seed(folder, name, 1, rows);
}

/// Writes a run of some rows and a seed.
pub fn write_seed(folder: &Path, name: &str, seed: u32, rows: u32) {
    let run = folder.join("runs").join(name);
    std::fs::create_dir_all(&run).unwrap();
    let config = format!(
        r#"{{"algorithm":"PPOLag","env":{{"id":"RemedyRushLevel1-v0","rules":"paper"}},"seed":{seed},"frames":100000}}"#
    );
    std::fs::write(run.join("config.json"), config).unwrap();
    let row = |k: u32| {
        let (frames, cost) = (k * 100, 9.0 - f64::from(k) * 0.01);
        format!(
            "{{\"frames\":{frames},\"fps\":900.0,\"return_mean\":{k},\"cost_mean\":{cost},\"length_mean\":525.0,\"budget\":5.0,\"multiplier\":0.1}}\n"
        )
    };
    std::fs::write(run.join("metrics.jsonl"), (1..=rows).map(row).collect::<String>()).unwrap();
}

/// Writes heatmaps of a run at some moments, without a map beneath.
pub fn write_heatmaps(folder: &Path, name: &str, moments: &[u32]) {
    let row = |frames: &u32| {
        let steps: Vec<u32> = (0..144).map(|cell| (cell * frames / 1000) % 60).collect();
        format!(
            "{{\"frames\":{frames},\"columns\":12,\"rows\":12,\"extent\":[0,0,768,768],\"episodes\":60,\"steps\":{steps:?}}}\n"
        )
    };
    std::fs::write(
        folder.join("runs").join(name).join("heatmaps.jsonl"),
        moments.iter().map(row).collect::<String>(),
    )
    .unwrap();
}

/// The answer to a request as it is, status line and all.
pub fn raw(address: SocketAddr, request: &str) -> String {
    let mut stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    stream.write_all(request.as_bytes()).unwrap();
    let mut bytes = Vec::new();
    let _ = stream.read_to_end(&mut bytes);
    String::from_utf8_lossy(&bytes).into_owned()
}

/// The answer to a plain request.
pub fn get(address: SocketAddr, path: &str, headers: &str) -> String {
    raw(
        address,
        &format!("GET {path} HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\n{headers}\r\n"),
    )
}

/// The status of an answer.
pub fn status(answer: &str) -> u16 {
    answer.split(' ').nth(1).and_then(|code| code.parse().ok()).unwrap_or(0)
}
