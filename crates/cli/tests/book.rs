//! Every command of the README and of the book is run, made short: a command that is neither run
//! nor named here with a reason fails the test.

#![cfg(all(unix, feature = "serve"))]

mod folder;
mod pages;

use folder::Folder;
use pages::{pages, shell_commands, words};
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

/// What makes a training take a quarter of a second.
const SMALL: &str = "--threads 1 --set network.dense=[32] --set network.recurrent=32 --set sampling.rollout=8 --eval-every 64 \
                     --set episode_steps=8 --set sampling.spread_out=false --size 64x48 --quiet";

/// Commands of other programs, and what tries them instead.
const OTHERS: [(&str, &str); 8] = [
    ("./check", "continuous integration is it"),
    ("cargo install --path crates/cli", "`./check` builds the same crate"),
    ("cargo test --release -p hasard-learn --lib algorithms", "`./check` runs all tests"),
    ("pip install .", "python/check installs the wheel"),
    ("pip install '.[torch]'", "test_tools.py holds extras against imports"),
    ("pip install hasard==0.2.0 vizdoom==1.3.2", "other people's packages"),
    ("python", "test_pages.py runs the blocks of Python, python/compat/run the examples"),
    ("tensorboard --logdir runs", "another program, which waits"),
];

/// Commands of ours that are not run, and why.
const NOT_RUN: [(&str, &str); 7] = [
    ("--scale 0.01", "`sweep main` is run; each dry run measures for six seconds"),
    ("sweep main --preset quick", "likewise"),
    ("sweep main --preset tables", "likewise"),
    ("sweep quick", "likewise"),
    ("--algo MINE", "the reader's own algorithm"),
    ("--maps auto", "needs the published package"),
    ("--maps my_maps", "needs a folder of maps and an IWAD of the reader's"),
];

/// The same command for a moment, in a folder where `runs/vv1` is a run.
fn shortened(command: &str, number: usize) -> String {
    let words = words(command).unwrap();
    let has = |option: &str| words.iter().any(|word| word == option);
    // Options that are said anew.
    let mut kept = Vec::new();
    let mut rest = words.iter();
    while let Some(word) = rest.next() {
        let film = words[0] == "eval" && word == "-o";
        if film
            || matches!(
                word.as_str(),
                "--frames" | "--episodes" | "--threads" | "--seconds" | "--worst"
            )
        {
            rest.next();
        } else {
            kept.push(word.as_str());
        }
    }
    let more = match words[0].as_str() {
        "train" if has("--resume") => "--frames 128 --quiet".into(),
        "train" => {
            let frames = if has("--curriculum") { 192 } else { 64 };
            let out = if has("--out") { String::new() } else { format!("--out runs/{number}") };
            // Of several tasks each has a world and an episode.
            let tasks = words[1].split(',').count().max(2);
            let each = ["evaluation.episodes", "evaluation.confirming_episodes"]
                .map(|setting| format!("--set {setting}={tasks}"))
                .join(" ");
            format!("--frames {frames} {out} --envs {tasks} {each} {SMALL}")
        }
        // A whole episode as a film of 640x480 would take as long as all others together.
        "eval" if has("--worst") => "--episodes 1 --worst 1 -o worst.gif".into(),
        "eval" => "--episodes 3".into(),
        "rollout" | "claim" => "--episodes 2".into(),
        "record" => "--steps 3".into(),
        "bench" => "--threads 2 --seconds 0.1".into(),
        "highlights" => "--episodes 1 --seconds 1 --size 64x48".into(),
        "site" => format!("--root {}", std::fs::canonicalize("../..").unwrap().display()),
        "serve" => "--listen 127.0.0.1:0".into(),
        "sweep" if has("--dry-run") => String::new(),
        "sweep" => "--dry-run".into(),
        _ => String::new(),
    };
    // A sweep's frames are part of what it prints; nothing runs.
    let kept = if words[0] == "sweep" { words.join(" ") } else { kept.join(" ") };
    format!("{kept} {more}").trim().to_string()
}

/// Starts a server, and ends it when it has printed its address.
fn serve(folder: &Folder, line: &str) {
    let mut server = Command::new(env!("CARGO_BIN_EXE_hasard"))
        .args(line.split_whitespace())
        .current_dir(&folder.0)
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut first = String::new();
    BufReader::new(server.stdout.take().unwrap()).read_line(&mut first).unwrap();
    server.kill().unwrap();
    server.wait().unwrap();
    assert!(first.starts_with("http://127.0.0.1:"), "{line}: {first}");
}

#[test]
fn commands_of_the_book_run() {
    let folder = Folder::new("book");
    folder.ok(&format!("train VolcanicVentureLevel1-v0 --out runs/vv1 --frames 64 {SMALL}"));
    folder.ok("export-wad CollateralDamageLevel1-v0 -o my_room.wad");
    let sweep = std::fs::read_to_string("../../docs/extend/sweep_file.md").unwrap();
    let block = sweep.split("```toml\n").nth(1).unwrap().split("```").next().unwrap();
    folder.file("my.toml", block.as_bytes());
    folder.ok(&format!("train VolcanicVentureLevel1-v0 --out runs/budgets/a --frames 64 {SMALL}"));
    let mut done = Vec::new();
    for page in pages() {
        let text = std::fs::read_to_string(&page).unwrap();
        for (at, command) in shell_commands(&text).into_iter().enumerate() {
            let page = page.display();
            if words(&command).is_none() {
                let example = command.starts_with("python python/examples/");
                let known = example || OTHERS.iter().any(|(other, _)| command == *other);
                assert!(known, "{page}: nothing tries `{command}`");
                continue;
            }
            if NOT_RUN.iter().any(|(part, _)| command.contains(part)) {
                continue;
            }
            let line = shortened(&command, done.len() * 100 + at);
            if done.contains(&line) {
                continue;
            }
            let name = line.split_whitespace().next().unwrap();
            let began = std::time::Instant::now();
            if name == "train" && !line.contains("--resume") {
                // A run of the same name may be there from another page.
                let out = line.split("--out ").nth(1).unwrap().split(' ').next().unwrap();
                let _ = std::fs::remove_dir_all(folder.0.join(out));
            }
            match name {
                "serve" => serve(&folder, &line),
                // Without a display it says so.
                "play" => assert!(folder.refused(&line).contains("display"), "{page}: {line}"),
                // A scoreboard lists claims of 200 episodes; these have two.
                "scoreboard" => {
                    let output = folder.run(&line);
                    let error = String::from_utf8_lossy(&output.stderr).into_owned();
                    assert!(error.contains("not listed"), "{page}: {line}: {error}");
                }
                _ => drop(folder.ok(&line)),
            }
            println!("{:6.2} s  {line}", began.elapsed().as_secs_f64());
            done.push(line);
        }
    }
    assert!(done.len() > 60, "only {} commands were run", done.len());
}
