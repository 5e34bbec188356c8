//! Every command against everything that is not what it wants: one line that names it, exit code 2,
//! nothing left behind.

use hasard_learn::config::{AlgorithmKind, EnvConfig, Preset, TrainConfig};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

const ENV: &str = "RemedyRushLevel1-v0";

/// A folder of things that no command wants; gone after the test.
struct Den(PathBuf);

impl Den {
    fn new(name: &str) -> Den {
        let path =
            std::env::temp_dir().join(format!("hasard-hostile-{}-{name}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(path.join("folder")).unwrap();
        let den = Den(path);
        den.file("empty", b"");
        let garbage: Vec<u8> =
            (0..5000u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 13) as u8).collect();
        den.file("garbage", &garbage);
        den.file("text", b"to be, or not to be\n");
        den.file("actions.csv", b"action\nnoop\n");
        den.file("nested", "[".repeat(100_000).as_bytes());
        // A name that would command the terminal.
        den.file("\u{1b}[31mred", b"{}");
        // Run directories, each spoiled in its way.
        den.file("run_garbage/config.json", &garbage);
        den.file("run_other/config.json", b"{\"algorithm\": \"PPO\"}");
        den.file("run_nested/config.json", "{\"a\":".repeat(100_000).as_bytes());
        let settings =
            TrainConfig::new(AlgorithmKind::PpoLag, Preset::Paper, EnvConfig::new(ENV)).unwrap();
        let mut settings = serde_json::to_value(&settings).unwrap();
        den.file("run_unbegun/config.json", settings.to_string().as_bytes());
        for (file, bytes) in [
            ("state.json", &garbage[..]),
            ("weights.safetensors", b""),
            ("training.safetensors", b"{}"),
        ] {
            den.file(&format!("run_damaged/checkpoints/frames_000000004096/{file}"), bytes);
        }
        den.file("run_damaged/config.json", settings.to_string().as_bytes());
        settings["network"]["dense"] = serde_json::json!([1u64 << 60]);
        den.file("run_giant/config.json", settings.to_string().as_bytes());
        den
    }

    fn file(&self, name: &str, bytes: &[u8]) {
        let path = self.0.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }

    fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hasard"));
        command.args(words).current_dir(&self.0);
        for display in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
            command.env_remove(display);
        }
        command
    }

    /// The one line of a command that must be refused.
    fn refused(&self, words: &[&str]) -> String {
        one_line(&self.command(words).output().unwrap(), &words.join(" "))
    }

    /// Every file and folder with its length.
    fn contents(&self) -> BTreeMap<PathBuf, u64> {
        fn list(folder: &Path, into: &mut BTreeMap<PathBuf, u64>) {
            for entry in std::fs::read_dir(folder).unwrap().map(Result::unwrap) {
                let data = entry.metadata().unwrap();
                into.insert(entry.path(), if data.is_dir() { 0 } else { data.len() });
                if data.is_dir() {
                    list(&entry.path(), into);
                }
            }
        }
        let mut found = BTreeMap::new();
        list(&self.0, &mut found);
        found
    }
}

impl Drop for Den {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn one_line(output: &Output, line: &str) -> String {
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{line}: {error}");
    let text = error.strip_suffix('\n').unwrap_or(&error);
    // Each damaged checkpoint that is passed over is named before.
    let text =
        text.rsplit_once("going back to the checkpoint before it\n").map_or(text, |(_, last)| last);
    assert!(text.starts_with("hasard: ") && text.len() < 2000, "{line}: {error}");
    assert!(!text.contains(char::is_control), "{line}: {}", error.escape_debug());
    assert!(!text.contains("panicked") && output.stdout.is_empty(), "{line}: {error}");
    text.to_owned()
}

#[test]
fn no_command_knows_an_unknown_environment() {
    let den = Den::new("environments");
    let before = den.contents();
    for command in [
        "rollout",
        "trace --actions actions.csv",
        "bench",
        "play",
        "render",
        "train",
        "record",
        "export-wad",
    ] {
        for env in ["RemedyRushLevel4-v0", "remedy", "\u{1b}[31m", "é", "--", "-1"] {
            let mut words: Vec<&str> = command.split(' ').collect();
            words.insert(1, env);
            let error = den.refused(&words);
            assert!(
                error.contains("RemedyRushLevel") || !env.starts_with("Remedy"),
                "{command} {env}: {error}"
            );
        }
    }
    assert_eq!(den.contents(), before, "a refused command left something behind");
}

#[test]
fn a_word_without_end_is_not_printed_whole() {
    let den = Den::new("endless");
    let word = "A".repeat(100_000);
    for command in [
        "rollout",
        "train",
        "eval",
        "record -o a.gif",
        "verify",
        "replay",
        "sweep",
        "train RemedyRushLevel1-v0 --out new --rules",
        "train RemedyRushLevel1-v0 --out new --init-from",
        "train RemedyRushLevel1-v0 --out new --set",
    ] {
        let words: Vec<&str> = command.split(' ').chain([word.as_str()]).collect();
        let error = den.refused(&words);
        assert!(error.contains("AAAAAAAA"), "{command}: the word is not named: {error}");
    }
}

#[test]
fn what_cannot_be_read_is_named() {
    let den = Den::new("inputs");
    let before = den.contents();
    let files = [
        "none",
        "folder",
        "empty",
        "garbage",
        "text",
        "nested",
        "\u{1b}[31mred",
        "empty/below",
        "/proc/self/mem",
    ];
    for command in [
        "render ENV -o a.png --iwad",
        "rollout ENV --episodes 1 --iwad",
        "bench ENV --seconds 0.1 --iwad",
        "record ENV --steps 1 -o a.gif --iwad",
        "trace ENV --actions",
        "replay",
        "record",
        "eval",
        "report",
        "sweep",
        "train ENV --frames 1 --out new --init-from",
    ] {
        for file in files {
            let line = command.replace("ENV", ENV);
            let mut words: Vec<&str> = line.split(' ').collect();
            words.push(file);
            let error = den.refused(&words);
            let named = file.trim_start_matches("\u{1b}");
            assert!(error.contains(named), "{line} {file}: the file is not named: {error}");
        }
    }
    for run in [
        "folder",
        "run_garbage",
        "run_other",
        "run_nested",
        "run_unbegun",
        "run_damaged",
        "run_giant",
        "garbage",
        "none",
    ] {
        let policy = format!("run:{run}");
        for words in [
            &["eval", run][..],
            &["record", run, "-o", "a.mp4"],
            &["rollout", ENV, "--policy", &policy],
        ] {
            let error = den.refused(words);
            assert!(
                error.contains(run) || run == "run_giant",
                "{words:?}: the run is not named: {error}"
            );
        }
    }
    for run in ["run_garbage", "run_other", "run_nested"] {
        let error = den.refused(&["train", ENV, "--resume", "--out", run]);
        assert!(error.contains(run), "{run}: {error}");
    }
    assert_eq!(den.contents(), before, "a refused command left something behind");
}

#[test]
fn what_cannot_be_written_is_named() {
    let den = Den::new("outputs");
    let before = den.contents();
    for command in [
        "render ENV -o",
        "record ENV --steps 1 -o",
        "export-wad ENV -o",
        "train ENV --frames 1 --quiet --out",
    ] {
        let ends = match command.split(' ').next() {
            Some("render") => &[".png"][..],
            Some("record") => &[".mp4", ".gif", ".episode"],
            Some("export-wad") => &[".wad"],
            _ => &[""],
        };
        for end in ends {
            for place in ["empty/x", "/proc/x", "/proc/none/x", "/dev/null/x"] {
                let line = command.replace("ENV", ENV);
                let out = format!("{place}{end}");
                let mut words: Vec<&str> = line.split(' ').collect();
                words.push(&out);
                let error = den.refused(&words);
                let folder = Path::new(place).parent().unwrap().to_str().unwrap();
                assert!(error.contains(folder), "{line} {out}: the place is not named: {error}");
            }
        }
    }
    assert_eq!(den.contents(), before, "a refused command left something behind");
}

#[test]
fn a_full_standard_output_is_reported() {
    let den = Den::new("full");
    let Ok(full) = std::fs::File::options().write(true).open("/dev/full") else {
        // Past the capture of the test runner: ./check counts it.
        let _ = writeln!(std::io::stderr(), "skipped: this system has no /dev/full");
        return;
    };
    for line in ["envs --json", "rollout RemedyRushLevel1-v0 --policy noop --episodes 1 --json"] {
        let words: Vec<&str> = line.split(' ').collect();
        let output = den
            .command(&words)
            .stdout(Stdio::from(full.try_clone().unwrap()))
            .stderr(Stdio::piped())
            .output()
            .unwrap();
        let error = one_line(&output, line);
        assert!(error.contains("standard output"), "{line}: {error}");
    }
}

/// The files that fuzzing and hand have made to do harm, given to the commands that read their
/// kind.
#[test]
fn hostile_files_are_turned_away_at_the_door() {
    let den = Den::new("samples");
    let crates = Path::new("..").canonicalize().unwrap();
    let mut tried = 0;
    for (folder, command) in [
        ("engine/attacks", "render RemedyRushLevel1-v0 -o a.png --iwad"),
        ("fuzz/hostile/iwad", "render RemedyRushLevel1-v0 -o a.png --iwad"),
        ("fuzz/hostile/episode", "replay"),
    ] {
        let Ok(files) = std::fs::read_dir(crates.join(folder)) else { continue };
        for path in files.map(|entry| entry.unwrap().path()) {
            let mut words: Vec<&str> = command.split(' ').collect();
            words.push(path.to_str().unwrap());
            den.refused(&words);
            tried += 1;
        }
    }
    assert!(tried >= 8, "{tried} files");
}
