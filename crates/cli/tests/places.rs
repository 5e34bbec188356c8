//! Where things lie: runs and maps in other folders than before, names that no text holds, commands
//! that are to be pasted.

#![cfg(unix)]

use serde_json::Value;
use std::ffi::{OsStr, OsString};
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const ENV: &str = "VolcanicVentureLevel1-v0";
/// A training of one rollout of milliseconds.
const SMALL: &str = "train VolcanicVentureLevel1-v0 --envs 4 --threads 1 --set network.dense=[32] --set network.recurrent=32 \
                     --set sampling.rollout=8 --set episode_steps=8 --observation grey --size 64x48";

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Folder {
        let path =
            std::env::temp_dir().join(format!("hasard-places-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    /// Runs a command in a folder below; words that a text cannot hold come after it.
    fn run(&self, below: &str, line: &str, words: &[&OsStr]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hasard"));
        command
            .args(line.split_whitespace())
            .args(words)
            .current_dir(self.0.join(below))
            .output()
            .unwrap()
    }

    /// What a command that must succeed prints.
    fn ok(&self, below: &str, line: &str, words: &[&OsStr]) -> String {
        let output = self.run(below, line, words);
        let printed = String::from_utf8_lossy(&output.stderr).into_owned()
            + &String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success(), "{line} {words:?}: {printed}");
        printed
    }

    fn refused(&self, below: &str, line: &str) -> String {
        let output = self.run(below, line, &[]);
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{line}: {error}");
        assert_eq!(error.lines().count(), 1, "{line}: {error}");
        error
    }

    /// Pastes a command into a shell.
    fn pasted(&self, command: &str) {
        let command = command.replacen("hasard ", &format!("{} ", env!("CARGO_BIN_EXE_hasard")), 1);
        let output =
            Command::new("bash").args(["-c", &command]).current_dir(&self.0).output().unwrap();
        assert!(output.status.success(), "{command}: {}", String::from_utf8_lossy(&output.stderr));
    }

    fn config(&self, run: &str) -> Value {
        serde_json::from_slice(&fs::read(self.0.join(run).join("config.json")).unwrap()).unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn a_run_is_not_bound_to_the_folder_that_it_was_started_in() {
    let folder = Folder::new("folders");
    fs::create_dir_all(folder.0.join("project/maps")).unwrap();
    folder.ok("", &format!("export-wad {ENV} -o project/maps/mine.wad"), &[]);
    folder.ok("project", &format!("{SMALL} --frames 128 --maps maps/mine.wad --out runs/one"), &[]);
    let run = "project/runs/one";
    folder.ok("", &format!("eval {run} --episodes 1"), &[]);
    folder.ok("", &format!("{SMALL} --resume --out {run} --frames 256"), &[]);
    // The same words from the same folder name the same map.
    folder.ok(
        "project",
        &format!("{SMALL} --resume --out runs/one --frames 384 --maps maps/mine.wad"),
        &[],
    );
    assert!(
        folder
            .config(run)
            .get("changes")
            .is_some_and(|changes| !changes.to_string().contains("env.maps"))
    );
}

#[test]
fn every_command_takes_a_map_from_where_it_is_now() {
    let folder = Folder::new("moved");
    folder.ok("", &format!("export-wad {ENV} -o mine.wad"), &[]);
    folder.ok("", &format!("{SMALL} --frames 128 --eval-every 128 --set evaluation.episodes=2 --set evaluation.confirming_episodes=2 --maps mine.wad --out run"), &[]);
    folder.ok("", "export-agent run -o one.agent", &[]);
    fs::rename(folder.0.join("mine.wad"), folder.0.join("moved.wad")).unwrap();
    let before = fs::read(folder.0.join("run/config.json")).unwrap();
    for line in [
        "eval run --episodes 1".to_string(),
        "eval one.agent --episodes 1".to_string(),
        "record run --steps 2 -o a.gif".to_string(),
        format!("record {ENV} --policy run:run --steps 2 -o b.gif"),
        format!("rollout {ENV} --policy run:run --episodes 1"),
        format!("render {ENV} --policy run:run --step 2 -o c.png"),
        format!("{SMALL} --resume --out run --frames 256"),
    ] {
        let error = folder.refused("", &line);
        assert!(error.contains("mine.wad") && error.contains("--maps"), "{line}: {error}");
        assert_eq!(fs::read(folder.0.join("run/config.json")).unwrap(), before, "{line}");
        folder.ok("", &line, &["--maps", "moved.wad"].map(OsStr::new));
    }
    // A run that went on keeps the new place.
    folder.ok("", "eval run --episodes 1", &[]);
    assert!(folder.config("run")["env"]["maps"].as_str().unwrap().ends_with("/moved.wad"));
    let serve = folder.run("", "serve --help", &[]);
    assert!(String::from_utf8_lossy(&serve.stdout).contains("--maps"));
}

/// A folder and a map from an old Latin-1 disk.
#[test]
fn names_that_are_not_text_are_taken_by_every_command() {
    let folder = Folder::new("names");
    let run = OsStr::from_bytes(b"l\xe4ufe");
    let wad = OsStr::from_bytes(b"k\xe4rte.wad");
    let with = |beginning: &str, name: &OsStr| {
        let mut word = OsString::from(beginning);
        word.push(name);
        word
    };
    folder.ok("", &format!("export-wad {ENV} -o"), &[wad]);
    let output = folder.ok(
        "",
        &format!(
            "{SMALL} --frames 128 --eval-every 128 --set evaluation.episodes=2 --set evaluation.confirming_episodes=2 --out"
        ),
        &[run, OsStr::new("--maps"), wad],
    );
    let hint =
        output.split("is a run directory: ").nth(1).unwrap().split(", hasard").next().unwrap();
    folder.pasted(&format!("{hint} --episodes 1"));
    folder.ok("", &format!("{SMALL} --resume --frames 256 --out"), &[run]);
    folder.ok("", "eval --episodes 1", &[run]);
    folder.ok("", "record --steps 2 -o a.gif", &[run]);
    let agent = OsStr::from_bytes(b"\xe4.agent");
    folder.ok("", "export-agent", &[run, OsStr::new("-o"), agent]);
    folder.ok("", "eval --episodes 1", &[agent]);
    folder.ok("", "record --steps 2 -o b.gif", &[agent]);
    for policy in [with("run:", run), with("run:", agent), agent.to_owned()] {
        folder.ok("", &format!("rollout {ENV} --episodes 1 --policy"), &[&policy]);
        folder.ok("", &format!("render {ENV} --step 1 -o c.png --policy"), &[&policy]);
        folder.ok("", &format!("record {ENV} --steps 1 -o d.gif --policy"), &[&policy]);
    }
    let episode = OsStr::from_bytes(b"\xe4.episode");
    folder.ok("", &format!("record {ENV} --steps 3 -o"), &[episode]);
    folder.ok("", "replay", &[episode]);
    folder.ok("", "replay --step 2 -o", &[OsStr::from_bytes(b"\xe4.png"), episode]);
    folder.ok("", &format!("rollout {ENV} --episodes 1 --maps"), &[wad]);
    folder.ok("", &format!("bench {ENV} --envs 1 --seconds 0.1 --maps"), &[wad]);
    fs::write(folder.0.join(OsStr::from_bytes(b"\xe4.csv")), "action\nnoop\n").unwrap();
    folder.ok("", &format!("trace {ENV} --actions"), &[OsStr::from_bytes(b"\xe4.csv")]);
    folder.ok("", "report -o", &[OsStr::from_bytes(b"\xe4_report"), run]);
    folder.ok("", "contact-sheet VolcanicVenture -o", &[OsStr::from_bytes(b"\xe4_sheets")]);
    folder.ok("", &format!("{SMALL} --frames 128 --out other --init-from"), &[run]);
    let sweep = "out='x'\nframes=128\nevaluate=1\nscenarios='VolcanicVenture'\nalgorithms='PPO'\n[options]\nenvs=4\nset='sampling.rollout=8'\n";
    let file = OsStr::from_bytes(b"\xe4.toml");
    fs::write(folder.0.join(file), sweep).unwrap();
    let swept = OsStr::from_bytes(b"\xe4_runs");
    folder.ok("", "sweep", &[file, OsStr::new("--out"), swept]);
    let below = folder
        .0
        .join(swept)
        .join("VolcanicVentureLevel1-v0/PPO/envs=4,set=sampling.rollout_8/seed1");
    assert!(below.join("eval.jsonl").is_file() && below.join("checkpoints").is_dir());
    let line = folder.ok("", "sweep --dry-run", &[file, OsStr::new("--out"), swept]);
    assert!(line.contains("--out $'\\xe4_runs/"), "{line}");
}

#[test]
fn commands_in_hints_can_be_pasted() {
    let folder = Folder::new("hints");
    let run = OsStr::new("my runs/it's one");
    // A short run was never evaluated: there is no agent to export yet, and the command that is
    // named makes one.
    let output = folder.ok("", &format!("{SMALL} --frames 128 --out"), &[run]);
    let hints = output.split("is a run directory: ").nth(1).unwrap();
    let (eval, report) = hints.trim().split_once(", hasard report").unwrap();
    folder.pasted(&format!("{eval} --episodes 1"));
    folder.pasted(&format!("hasard report{report}"));
    let unevaluated = folder.run("", "export-agent -o a.agent", &[run]);
    let error = String::from_utf8_lossy(&unevaluated.stderr).into_owned();
    let command = error.trim().rsplit_once("hasard train").unwrap().1;
    folder.pasted(&format!(
        "hasard train{command} --set evaluation.episodes=2 --set evaluation.confirming_episodes=2"
    ));
    let output =
        folder.ok("", "export-agent", &[run, OsStr::new("-o"), OsStr::new("an agent.agent")]);
    folder.pasted(&format!(
        "hasard eval{} --episodes 1",
        output.trim().rsplit_once("hasard eval").unwrap().1
    ));
    let again = folder.ok("", &format!("{SMALL} --resume --out"), &[run]);
    let command = again.lines().find(|line| line.contains("was finished before")).unwrap();
    let command = command.rsplit_once("hasard train").unwrap().1.replace("MORE", "256");
    folder.pasted(&format!("hasard train{command}"));
    // A run that has no checkpoint yet says how to go on, and that goes on.
    let checkpoints = folder.0.join(run).join("checkpoints");
    for entry in fs::read_dir(&checkpoints).unwrap() {
        fs::remove_dir_all(entry.unwrap().path()).unwrap();
    }
    fs::remove_file(folder.0.join(run).join("selected.json")).unwrap();
    let error = String::from_utf8_lossy(&folder.run("", "eval", &[run]).stderr).into_owned();
    folder.pasted(&format!("hasard train{}", error.trim().rsplit_once("hasard train").unwrap().1));
    let refused = folder.run("", "record --hard -o a.gif", &[run]);
    let error = String::from_utf8_lossy(&refused.stderr).into_owned();
    let command = error.trim().rsplit_once("hasard record").unwrap().1.replace("ENV", ENV);
    folder.pasted(&format!("hasard record{command} --hard --steps 2 -o a.gif"));
}

/// Everything below a folder, with its content.
fn content(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut all = Vec::new();
    for entry in fs::read_dir(folder).unwrap().flatten() {
        let path = entry.path();
        if path.is_dir() {
            all.extend(content(&path))
        } else {
            all.push((path.clone(), fs::read(&path).unwrap()))
        }
    }
    all.sort();
    all
}

#[test]
fn a_resume_that_is_refused_leaves_the_run_as_it_was() {
    let folder = Folder::new("refused");
    folder.ok("", &format!("{SMALL} --frames 1000 --out run"), &[]);
    let version = folder.config("run")["version"].clone();
    assert_eq!(version, env!("CARGO_PKG_VERSION"));
    let before = content(&folder.0);
    for (flags, word) in [
        ("--frames 1", "1024"),
        ("--frames 1023", "1024"),
        ("--frames 2000 --set learning.gamma=0.9", "learning.gamma"),
        ("--frames 2000 --device vulkan", "vulkan"),
        ("--frames 2000 --set reporting.keep=0", "checkpoints"),
        ("--frames 2000 --set version=7", "version"),
        ("--frames 2000 --maps none.wad", "--maps"),
        ("--frames 2000 --iwad none.wad", "--iwad"),
        ("--frames 2000 --algo PPO", "--algo"),
    ] {
        let error = folder.refused("", &format!("{SMALL} --resume --out run {flags}"));
        assert!(error.contains(word), "{flags}: {error}");
        assert!(content(&folder.0) == before, "{flags}: the run was changed");
    }
    folder.ok("", &format!("{SMALL} --resume --out run --frames 1000"), &[]);
}

/// The run of a graphics card goes on where there is none, with the flag that the refusal names.
#[test]
fn the_run_of_a_graphics_card_goes_on_on_the_processor() {
    let folder = Folder::new("card");
    folder.ok("", &format!("{SMALL} --frames 128 --out run"), &[]);
    let mut config = folder.config("run");
    config["device"] = "cuda".into();
    config["sampling"]["synchronous"] = false.into();
    fs::write(folder.0.join("run/config.json"), config.to_string()).unwrap();
    folder.ok("", "eval run --episodes 1", &[]);
    if cfg!(not(feature = "cuda")) {
        let resume = format!("{SMALL} --resume --out run --frames 256");
        assert!(folder.refused("", &resume).contains("--device cpu"));
        folder.ok("", &format!("{resume} --device cpu"), &[]);
        let config = folder.config("run");
        assert_eq!(
            (&config["device"], &config["changes"][0]["setting"]),
            (&"cpu".into(), &"device".into())
        );
    }
}

/// A link to itself stands for what the system does not show, such as a run in a folder that is
/// closed to us: that is not "no such run".
#[test]
fn what_cannot_be_seen_is_not_said_to_be_absent() {
    let folder = Folder::new("closed");
    std::os::unix::fs::symlink("circle", folder.0.join("circle")).unwrap();
    fs::create_dir(folder.0.join("run")).unwrap();
    std::os::unix::fs::symlink("config.json", folder.0.join("run/config.json")).unwrap();
    for run in ["circle", "run"] {
        for line in [
            format!("eval {run} --episodes 1"),
            format!("export-agent {run} -o a.agent"),
            format!("record {run} --steps 2 -o a.gif"),
            format!("rollout {ENV} --policy run:{run} --episodes 1"),
            format!("report {run}"),
        ] {
            let error = folder.refused("", &line);
            assert!(error.contains(run) && error.contains("cannot read"), "{line}: {error}");
        }
    }
    if cfg!(feature = "serve") {
        assert!(folder.refused("", "serve circle").contains("cannot read"));
    }
}
