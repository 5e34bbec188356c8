//! How commands end before their time: by signals, by streams that cannot be written, and what is
//! there afterwards.
//!
//! Long because each way to end is tried with the commands that have it.

#![cfg(unix)]

use serde_json::Value;
use std::fs::{self, File};
use std::io::Write;
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Output, Stdio};
use std::time::{Duration, Instant};

/// A training of rollouts that take milliseconds.
const SMALL: &str = "train RemedyRushLevel1-v0 --envs 4 --threads 1 --set network.dense=[32] --set network.recurrent=32 \
                     --set sampling.rollout=8 --set episode_steps=8 --observation grey --size 64x48";
const ENDLESS: &str = "--frames 900000000";

/// A folder that is gone after the test; commands run in it.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Folder {
        let path =
            std::env::temp_dir().join(format!("hasard-endings-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    fn command(&self, line: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hasard"));
        command.args(line.split_whitespace()).current_dir(&self.0).stdin(Stdio::null());
        command
    }

    fn run(&self, line: &str) -> Output {
        self.command(line).output().unwrap()
    }

    fn ok(&self, line: &str) -> String {
        let output = self.run(line);
        assert!(output.status.success(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stderr).into_owned()
            + &String::from_utf8_lossy(&output.stdout)
    }

    fn start(&self, line: &str) -> Running {
        let mut command = self.command(line);
        Running(interruptible(command.stdout(Stdio::null()).stderr(Stdio::null())).spawn().unwrap())
    }

    fn checkpoints(&self, run: &str) -> Vec<String> {
        names(&self.0.join(run).join("checkpoints"))
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

/// Where the tests run in the background of a script, SIGINT is ignored, and what they start would
/// inherit that.
fn interruptible(command: &mut Command) -> &mut Command {
    // SAFETY: `signal` may be called between fork and exec.
    unsafe {
        command.pre_exec(|| {
            libc::signal(libc::SIGINT, libc::SIG_DFL);
            Ok(())
        })
    }
}

/// A process that ends with the test.
struct Running(Child);

/// A process that takes longer to end does not end.
const HANGS: Duration = Duration::from_secs(120);

impl Running {
    fn signal(&self, name: &str) {
        let status = Command::new("kill")
            .args([&format!("-{name}"), &self.0.id().to_string()])
            .status()
            .unwrap();
        assert!(status.success());
    }

    fn wait(&mut self) -> ExitStatus {
        let begun = Instant::now();
        loop {
            if let Some(status) = self.0.try_wait().unwrap() {
                return status;
            }
            assert!(begun.elapsed() < HANGS, "it does not end");
            std::thread::sleep(Duration::from_millis(10));
        }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> =
        entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

fn wait_for(what: &str, there: impl Fn() -> bool) {
    let begun = Instant::now();
    while !there() {
        assert!(begun.elapsed() < HANGS, "{what} does not come");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Rows of a run's metrics.
fn rows(run: &Path) -> usize {
    fs::read_to_string(run.join("metrics.jsonl")).map_or(0, |text| text.lines().count())
}

fn full() -> Option<File> {
    let full = File::options().write(true).open("/dev/full").ok();
    if full.is_none() {
        // Past the capture of the test runner: ./check counts it.
        let _ = writeln!(std::io::stderr(), "skipped: this system has no /dev/full");
    }
    full
}

/// A pipe that nobody reads.
fn closed_pipe() -> Stdio {
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    Stdio::from(writer)
}

#[test]
fn standard_error_that_cannot_be_written_changes_nothing() {
    let folder = Folder::new("stderr");
    let Some(full) = full() else { return };
    let train = format!("{SMALL} --frames 256");
    for (line, code) in [
        (format!("{train} --out RUN"), 0),
        (format!("{SMALL} --out RUN --resume --frames 512"), 0),
        (format!("{train} --out RUN"), 2),
        ("rollout NoSuchLevel1-v0".to_string(), 2),
        ("rollout --no-such-flag".to_string(), 2),
        ("eval none".to_string(), 2),
        ("bench RemedyRushLevel1-v0 --envs 64 --seconds 0.01".to_string(), 0),
        ("report RUN -o report".to_string(), 0),
        ("sweep none".to_string(), 2),
    ] {
        for (name, stream) in
            [("full", Stdio::from(full.try_clone().unwrap())), ("pipe", closed_pipe())]
        {
            let line = line.replace("RUN", name);
            let status =
                folder.command(&line).stdout(Stdio::null()).stderr(stream).status().unwrap();
            assert_eq!(status.code(), Some(code), "{line}, standard error {name}");
        }
    }
    for run in ["full", "pipe"] {
        assert!(!folder.checkpoints(run).is_empty(), "{run} has no checkpoint");
    }
}

/// Rows that are lost in silence would be missed when it is too late; a reader who has seen enough
/// is another matter.
#[test]
fn standard_output_on_a_full_disk_is_an_error_and_a_closed_one_is_not() {
    let folder = Folder::new("stdout");
    let Some(full) = full() else { return };
    fs::write(
        folder.0.join("a.toml"),
        format!("out='swept'\nframes=256\nscenarios='RemedyRush'\nalgorithms='PPO'\n{SWEPT}"),
    )
    .unwrap();
    for line in [
        format!("{SMALL} {ENDLESS} --set reporting.report_seconds=0 --json --out run"),
        "sweep a.toml --json".into(),
    ] {
        let output = folder.command(&line).stdout(full.try_clone().unwrap()).output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{line}: {error}");
        assert!(error.contains("standard output") && error.lines().count() == 1, "{line}: {error}");
    }
    assert!(!folder.checkpoints("run").is_empty(), "the run stopped without a checkpoint");
    for line in ["--help", "train --help", "--version"] {
        let status = folder
            .command(line)
            .stdout(full.try_clone().unwrap())
            .stderr(Stdio::null())
            .status()
            .unwrap();
        assert_eq!(status.code(), Some(2), "{line}");
    }
    for line in [
        format!("{SMALL} --frames 256 --set reporting.report_seconds=0 --json --out piped"),
        "--help".into(),
    ] {
        let status =
            folder.command(&line).stdout(closed_pipe()).stderr(Stdio::null()).status().unwrap();
        assert_eq!(status.code(), Some(0), "{line}");
    }
    assert_eq!(folder.checkpoints("piped"), ["frames_000000000256"]);
}

/// The small training as a sweep's options.
const SWEPT: &str =
    "[options]\nenvs=4\nthreads=1\nset='sampling.rollout=8'\nobservation='grey'\nsize='64x48'\n";

#[test]
fn signals_end_a_training_with_a_checkpoint_and_loops_with_it() {
    let folder = Folder::new("signals");
    for (name, number) in [("INT", 2), ("TERM", 15)] {
        let mut run = folder.start(&format!("{SMALL} {ENDLESS} --out {name}"));
        wait_for("the run", || folder.0.join(name).join("metrics.jsonl").exists());
        run.signal(name);
        let status = run.wait();
        assert_eq!(status.signal(), Some(number), "{name}: {status}");
        assert!(!folder.checkpoints(name).is_empty(), "{name}: no checkpoint");
    }
    // Under `nohup` it outlives its terminal.
    let script = format!(
        "trap '' HUP; exec {} {SMALL} {ENDLESS} --quiet --out nohup",
        env!("CARGO_BIN_EXE_hasard")
    );
    let mut run =
        Running(Command::new("bash").args(["-c", &script]).current_dir(&folder.0).spawn().unwrap());
    wait_for("the run", || folder.0.join("nohup/metrics.jsonl").exists());
    run.signal("HUP");
    std::thread::sleep(Duration::from_millis(300));
    assert!(run.0.try_wait().unwrap().is_none(), "it ended with its terminal");
    run.signal("TERM");
    run.wait();
    // A shell's loop ends, and its code is the usual one.
    let line = format!("{} {SMALL} {ENDLESS} --quiet", env!("CARGO_BIN_EXE_hasard"));
    let script =
        format!("for seed in 1 2 3; do {line} --seed $seed --out loop$seed; echo code $?; done");
    let mut shell = Command::new("bash");
    let shell = shell
        .args(["-c", &script])
        .current_dir(&folder.0)
        .stderr(Stdio::null())
        .stdout(Stdio::piped());
    let mut shell = Running(interruptible(shell).process_group(0).spawn().unwrap());
    wait_for("the loop", || folder.0.join("loop1/metrics.jsonl").exists());
    let group = format!("-{}", shell.0.id());
    assert!(Command::new("kill").args(["-INT", "--", &group]).status().unwrap().success());
    shell.wait();
    assert!(!folder.0.join("loop2").exists(), "the loop went on");
    let script = format!(
        "{line} --out coded & until [ -e coded/metrics.jsonl ]; do sleep 0.05; done; kill -TERM $!; wait $!; echo $?"
    );
    let mut shell = Command::new("bash");
    let code =
        shell.args(["-c", &script]).current_dir(&folder.0).stderr(Stdio::null()).output().unwrap();
    assert_eq!(String::from_utf8_lossy(&code.stdout).trim(), "143");
}

/// Not before they are over: an evaluation of thousands of episodes, and the closing episodes.
#[test]
fn signals_end_a_training_in_the_midst_of_an_evaluation() {
    let folder = Folder::new("evaluation");
    let evaluated =
        "--eval-every 1 --set evaluation.episodes=90000 --set evaluation.confirming_episodes=90000";
    let mut run = folder.start(&format!("{SMALL} {ENDLESS} {evaluated} --out run"));
    wait_for("the run", || folder.0.join("run/metrics.jsonl").exists());
    std::thread::sleep(Duration::from_secs(2));
    run.signal("TERM");
    assert_eq!(run.wait().signal(), Some(15));
    assert_eq!(
        (folder.checkpoints("run"), rows(&folder.0.join("run"))),
        (vec!["frames_000000000128".to_string()], 0)
    );
    // It goes on with that evaluation, and with the closing episodes if it was stopped among them.
    let few = "--set evaluation.episodes=2 --set evaluation.confirming_episodes=90000 --frames 128";
    let mut run = folder.start(&format!("{SMALL} --resume --out run {few}"));
    std::thread::sleep(Duration::from_secs(2));
    run.signal("INT");
    assert_eq!(run.wait().signal(), Some(2));
    let few = "--set evaluation.episodes=2 --set evaluation.confirming_episodes=3";
    folder.ok(&format!("{SMALL} --resume --out run {few}"));
    let row: Value =
        serde_json::from_str(&fs::read_to_string(folder.0.join("run/metrics.jsonl")).unwrap())
            .unwrap();
    assert_eq!((&row["frames"], &row["eval/episodes"]), (&Value::from(128), &Value::from(2)));
    assert!(folder.0.join("run/selected.json").exists());
    assert_eq!(folder.checkpoints("run"), ["best_000000000128", "frames_000000000128"]);
}

#[test]
fn other_long_commands_end_at_once_and_leave_no_half_of_a_file() {
    let folder = Folder::new("others");
    folder.ok(&format!("{SMALL} --frames 128 --out run"));
    folder.ok("record RemedyRushLevel1-v0 -o long.episode");
    fs::create_dir(folder.0.join("out")).unwrap();
    for (line, begun) in [
        ("eval run --episodes 4000000", ""),
        ("rollout RemedyRushLevel1-v0 --episodes 4000000", ""),
        ("bench RemedyRushLevel1-v0 --seconds 600", ""),
        ("bench RemedyRushLevel1-v0 --seconds 600 --learn --preset quick", ""),
        ("record RemedyRushLevel1-v0 --size 1920x1080 -o out/a.mp4", ".a.mp4"),
        ("replay long.episode --size 1920x1080 -o out/b.mp4", ".b.mp4"),
        ("serve --listen 127.0.0.1:0", ""),
        ("contact-sheet -o out", ""),
    ] {
        for (name, number) in [("INT", 2), ("TERM", 15)] {
            let mut run = folder.start(line);
            match begun {
                "" => std::thread::sleep(Duration::from_millis(500)),
                _ => wait_for(begun, || {
                    names(&folder.0.join("out")).iter().any(|name| name.starts_with(begun))
                }),
            }
            run.signal(name);
            assert_eq!(run.wait().signal(), Some(number), "{line}");
        }
    }
    let left = names(&folder.0.join("out"));
    assert!(left.iter().all(|name| name.ends_with(".png") && !name.starts_with('.')), "{left:?}");
}

/// Processes whose working directory is a folder: all that was started in it.
#[cfg(target_os = "linux")]
fn processes(folder: &Path) -> usize {
    let inside = |process: fs::DirEntry| {
        fs::read_link(process.path().join("cwd")).is_ok_and(|cwd| cwd == folder)
    };
    fs::read_dir("/proc").unwrap().flatten().map(inside).filter(|inside| *inside).count()
}

/// However a sweep ends, its runs stop with a checkpoint.
#[cfg(target_os = "linux")]
#[test]
fn nothing_that_a_sweep_started_outlives_it() {
    for (name, number) in [("INT", 2), ("TERM", 15), ("KILL", 9)] {
        let folder = Folder::new(&format!("sweep-{name}"));
        let text = format!(
            "out='runs'\nparallel=2\nframes=900000000\nscenarios='RemedyRush'\nalgorithms='PPO'\nseeds=[1,2,3]\n{SWEPT}"
        );
        fs::write(folder.0.join("a.toml"), text).unwrap();
        let mut sweep = folder.start("sweep a.toml");
        let run = |seed: u32| {
            let set = "observation=grey,set=sampling.rollout_8,size=64x48";
            folder.0.join(format!("runs/RemedyRushLevel1-v0/PPO/envs=4,{set}/seed{seed}"))
        };
        wait_for("the runs", || {
            [1, 2].iter().all(|seed| run(*seed).join("metrics.jsonl").exists())
        });
        assert_eq!(processes(&folder.0), 3);
        sweep.signal(name);
        assert_eq!(sweep.wait().signal(), Some(number), "{name}");
        if name == "KILL" {
            wait_for("the runs' end", || processes(&folder.0) == 0);
        }
        assert_eq!(processes(&folder.0), 0, "{name}: something lives on");
        for seed in [1, 2] {
            assert!(!names(&run(seed).join("checkpoints")).is_empty(), "{name}: no checkpoint");
        }
        assert!(!run(3).exists(), "{name}: a run began after the sweep was ended");
    }
}

/// A row a moment, on disk and in TensorBoard's files, however often a run is killed and resumed.
#[test]
fn what_a_killed_run_wrote_is_one_story_after_it_was_resumed() {
    let folder = Folder::new("story");
    let often = "--set reporting.report_seconds=0 --set reporting.checkpoint_seconds=0.3";
    for _ in 0..2 {
        let mut run = folder.start(&format!("{SMALL} {ENDLESS} {often} --resume --out run"));
        let before = rows(&folder.0.join("run"));
        wait_for("rows", || rows(&folder.0.join("run")) > before + 40);
        run.signal("KILL");
        run.wait();
    }
    let more = folder.config("run")["frames"].as_u64().unwrap();
    assert_eq!(more, 900_000_000);
    let mut run = folder.start(&format!("{SMALL} --resume --out run"));
    wait_for("the checkpoint", || folder.0.join("run/metrics.jsonl").exists());
    std::thread::sleep(Duration::from_millis(800));
    run.signal("TERM");
    run.wait();
    let text = fs::read_to_string(folder.0.join("run/metrics.jsonl")).unwrap();
    let frames: Vec<u64> = text
        .lines()
        .map(|row| serde_json::from_str::<Value>(row).unwrap()["frames"].as_u64().unwrap())
        .collect();
    let whole: Vec<u64> = (1..=frames.len() as u64).map(|k| k * 128).collect();
    assert_eq!(frames, whole, "rows are missing or there twice");
    let mut steps = Vec::new();
    for name in
        names(&folder.0.join("run")).iter().filter(|name| name.starts_with("events.out.tfevents"))
    {
        steps.extend(scalar_steps(&fs::read(folder.0.join("run").join(name)).unwrap()));
    }
    steps.sort_unstable();
    assert_eq!(steps, whole, "TensorBoard has others");
}

/// Steps of the events of a file that hold a summary (field 5), by TensorBoard's own layout.
fn scalar_steps(bytes: &[u8]) -> Vec<u64> {
    let (mut at, mut steps) = (0, Vec::new());
    while at < bytes.len() {
        let length = u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize;
        let event = &bytes[at + 12..at + 12 + length];
        let (mut step, mut place) = (0u64, 10);
        loop {
            step |= u64::from(event[place] & 127) << (7 * (place - 10));
            place += 1;
            if event[place - 1] < 128 {
                break;
            }
        }
        if event.get(place) == Some(&(5 << 3 | 2)) {
            steps.push(step);
        }
        at += 16 + length;
    }
    steps
}

#[test]
fn a_log_says_how_far_a_training_is() {
    let folder = Folder::new("log");
    let output =
        folder.ok(&format!("{SMALL} --frames 20000 --set reporting.report_seconds=1000 --out run"));
    // A slow machine says before that it is starting.
    let line = output.lines().find(|line| line.contains("frames/s")).unwrap();
    for word in
        [" of 20,000 frames (", " frames/s, ", " left; return ", ", cost ", " of 5, multiplier "]
    {
        assert!(line.contains(word), "'{word}' is missing in: {line}");
    }
    assert!(!output.contains('\r') && !output.contains('\u{1b}'), "{output:?}");
    let again = folder.ok(&format!("{SMALL} --resume --out run"));
    assert!(again.contains("run was finished before, at ") && !again.contains("0/s"), "{again}");
}
