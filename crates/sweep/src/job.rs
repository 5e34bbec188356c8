//! One run of a sweep.

use crate::option::OptionValue;
use hasard_media::shell::quote;
use std::ffi::OsString;
use std::path::{Component, Path, PathBuf};

/// One run: a directory and the arguments of its process.
#[derive(Clone, PartialEq, Debug)]
pub struct Job {
    /// The run directory: `OUT/ENV/ALGORITHM[/option=value,...]/seedN`. Equal runs of different
    /// sweeps into one folder share it, so that none is made twice.
    pub directory: PathBuf,
    /// Arguments of `hasard`, beginning with `train`, for a fresh start.
    pub arguments: Vec<OsString>,
    /// The environment's id.
    pub environment: String,
    /// The algorithm's name.
    pub algorithm: String,
    /// Options that make it another run, as in its directory's name; empty if none.
    pub options: String,
    /// Its seed.
    pub seed: u64,
    /// Frames to reach.
    pub frames: u64,
    /// Episodes that its agent is evaluated on when it is finished; 0 for none.
    pub evaluate: u32,
}

/// How far a run is.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum State {
    /// Nothing there yet.
    New,
    /// Begun, and not at its frames.
    Unfinished(u64),
    /// At its frames.
    Finished,
}

/// Options that change where or how fast a run is made but not what it is: they stay out of its
/// directory's name.
pub(crate) const NOT_IDENTITY: [&str; 4] = ["device", "threads", "json", "quiet"];

/// The folder of an environment below a sweep's own: its id, or its file's path without what leads
/// out of there.
fn folder(environment: &str) -> PathBuf {
    let normal = |part| match part {
        Component::Normal(name) => Some(name.to_owned()),
        _ => None,
    };
    Path::new(&environment.replace(',', "+")).components().filter_map(normal).collect()
}

/// What is in a file of a run: nothing where it cannot be read, or is a pipe that nobody fills.
fn read(path: &Path) -> Vec<u8> {
    hasard_media::files::read_limited(path, 1 << 40).unwrap_or_default()
}

impl Job {
    pub(crate) fn new(
        out: &Path,
        environment: &str,
        algorithm: &str,
        frames: u64,
        seed: u64,
        options: &[(String, OptionValue)],
    ) -> Job {
        let mut arguments: Vec<OsString> =
            ["train", environment, "--algo", algorithm].map(OsString::from).to_vec();
        let (frames_text, seed_text) = (frames.to_string(), seed.to_string());
        arguments.extend(["--frames", &frames_text, "--seed", &seed_text].map(OsString::from));
        let mut names = Vec::new();
        // In the order of names, so that a run has one directory however its options were put
        // together.
        let mut options: Vec<&(String, OptionValue)> = options.iter().collect();
        options.sort_by(|a, b| a.0.cmp(&b.0));
        for (name, value) in options {
            let named = match value {
                OptionValue::Switch(false) => continue,
                OptionValue::Switch(true) => {
                    arguments.push(format!("--{name}").into());
                    name.clone()
                }
                OptionValue::Text(text) => {
                    arguments.extend([format!("--{name}"), text.clone()].map(OsString::from));
                    format!(
                        "{name}={}",
                        text.replace(
                            |c: char| !c.is_ascii_alphanumeric() && !".+-_,".contains(c),
                            "_"
                        )
                    )
                }
            };
            if !NOT_IDENTITY.contains(&name.as_str()) {
                names.push(named);
            }
        }
        let mut directory = out.join(folder(environment)).join(algorithm);
        let options = names.join(",");
        if !options.is_empty() {
            directory.push(&options);
        }
        directory.push(format!("seed{seed}"));
        arguments.extend(["--out".into(), directory.clone().into_os_string()]);
        let (environment, algorithm) = (environment.to_owned(), algorithm.to_owned());
        Job { directory, arguments, environment, algorithm, options, seed, frames, evaluate: 0 }
    }

    /// What it is called in a line: `PPOPID RemedyRushLevel1 seed 1, rules=released`.
    #[must_use]
    pub fn name(&self) -> String {
        let environment = self.environment.strip_suffix("-v0").unwrap_or(&self.environment);
        let options =
            if self.options.is_empty() { String::new() } else { format!(", {}", self.options) };
        format!("{} {environment} seed {}{options}", self.algorithm, self.seed)
    }

    /// The words of its command, from `train` on, as far as they are text.
    pub fn words(&self) -> impl Iterator<Item = std::borrow::Cow<'_, str>> {
        self.arguments.iter().map(|word| word.to_string_lossy())
    }

    /// The directories of the other runs of its environment, algorithm and seed in the same folder,
    /// in the order of their names.
    #[must_use]
    pub fn siblings(&self) -> Vec<PathBuf> {
        let up = if self.options.is_empty() { 1 } else { 2 };
        let Some(family) = self.directory.ancestors().nth(up) else { return Vec::new() };
        let options = std::fs::read_dir(family).into_iter().flatten().flatten();
        let own = format!("seed{}", self.seed);
        let mut found: Vec<PathBuf> =
            options.map(|entry| entry.path().join(&own)).chain([family.join(&own)]).collect();
        found.retain(|directory| *directory != self.directory && directory.is_dir());
        found.sort();
        found
    }

    /// Gives it another directory: that of an equal run.
    pub fn move_to(&mut self, directory: PathBuf) {
        if let Some(out) = self.arguments.iter().position(|word| word == "--out") {
            self.arguments[out + 1] = directory.clone().into_os_string();
        }
        self.directory = directory;
    }

    /// Adds an option of `hasard train`, which leaves its directory as it is.
    pub fn add_option(&mut self, name: &str, value: &str) {
        self.arguments.extend([format!("--{name}"), value.to_owned()].map(OsString::from));
    }

    /// Whether nothing is there yet.
    #[must_use]
    pub fn is_new(&self) -> bool {
        !self.directory.join("config.json").is_file()
    }

    /// Whether a training has the run's folder.
    #[must_use]
    pub fn is_held(&self) -> bool {
        hasard_media::files::is_locked(&self.directory.join("lock"))
    }

    /// How far the run is, by its `config.json` and the last whole line of its `metrics.jsonl`.
    #[must_use]
    pub fn state(&self) -> State {
        if self.is_new() {
            return State::New;
        }
        let text = read(&self.directory.join("metrics.jsonl"));
        let reached = text.split(|byte| *byte == b'\n').rev().find_map(|line| {
            let value: serde_json::Value = serde_json::from_slice(line).ok()?;
            value.get("frames")?.as_f64()
        });
        match reached.unwrap_or(0.0) as u64 {
            frames if frames >= self.frames && self.is_closed(frames) => State::Finished,
            frames => State::Unfinished(frames),
        }
    }

    /// Whether a run whose rows have reached their end was not killed before its last checkpoint,
    /// nor before the closing episodes of the one that it selected.
    fn is_closed(&self, frames: u64) -> bool {
        let names: Vec<String> =
            self.checkpoints().filter_map(|entry| entry.file_name().into_string().ok()).collect();
        let newest = |kind: &str| {
            names.iter().filter_map(|name| name.strip_prefix(kind)?.parse::<u64>().ok()).max()
        };
        let saved = newest("frames_").is_none_or(|saved| saved >= frames);
        let written = |name: &str| -> serde_json::Value {
            serde_json::from_slice(&read(&self.directory.join(name))).unwrap_or_default()
        };
        // The last policy is closed with the selected one; of runs of older versions it was not.
        let last = written("selected.json")["last"]["frames"].as_u64();
        let closed = newest("best_").is_none_or(|best| match last {
            Some(last) => last >= frames,
            None => written("hand_out.json")["frames"] == best,
        });
        saved && closed
    }

    /// What lies among the run's checkpoints.
    fn checkpoints(&self) -> impl Iterator<Item = std::fs::DirEntry> {
        std::fs::read_dir(self.directory.join("checkpoints")).into_iter().flatten().flatten()
    }

    /// The arguments that take the run from where it is to its end.
    #[must_use]
    pub fn arguments_from(&self, state: State) -> Vec<OsString> {
        let mut arguments = self.arguments.clone();
        if matches!(state, State::Unfinished(_)) {
            arguments.push("--resume".into());
        }
        arguments
    }

    /// Whether its agent still has to be evaluated once the run is finished.
    #[must_use]
    pub fn wants_evaluation(&self) -> bool {
        if self.evaluate == 0 {
            return false;
        }
        // Episodes of an agent that the run has replaced since, or fewer than are asked for, count
        // as none.
        let written = |path: PathBuf| std::fs::metadata(path).and_then(|data| data.modified()).ok();
        let kept = written(self.evaluation());
        // A short run has no selection, and its latest checkpoint is what is evaluated.
        let newest = self.checkpoints().filter_map(|entry| written(entry.path())).max();
        let stale = kept < written(self.directory.join("selected.json")).or(newest);
        let rows = read(&self.evaluation());
        // Its last row sums up the others.
        let is_episode = |row: &&[u8]| {
            serde_json::from_slice::<serde_json::Value>(row)
                .is_ok_and(|row| row.get("episode").is_some())
        };
        let rows = rows.split(|byte| *byte == b'\n').filter(is_episode).count() as u64;
        kept.is_none() || stale || rows < u64::from(self.evaluate)
    }

    /// Where the episodes of its agent are kept: reports find them there. The file is there when it
    /// is whole.
    #[must_use]
    pub fn evaluation(&self) -> PathBuf {
        self.directory.join("eval.jsonl")
    }

    /// The arguments that evaluate its agent.
    #[must_use]
    pub fn evaluation_arguments(&self) -> Vec<OsString> {
        let episodes = self.evaluate.to_string();
        vec![
            "eval".into(),
            self.directory.clone().into(),
            "--episodes".into(),
            episodes.into(),
            "--json".into(),
        ]
    }

    /// Whether the number of threads was chosen for it.
    #[must_use]
    pub fn chooses_threads(&self) -> bool {
        self.arguments.iter().any(|argument| argument == "--threads")
    }

    /// The command as one line for a shell, for a fresh start.
    #[must_use]
    pub fn command_line(&self, program: &str) -> String {
        std::iter::once(quote(program))
            .chain(self.arguments.iter().map(quote))
            .collect::<Vec<_>>()
            .join(" ")
    }

    /// Where what the process prints is kept: beside the run directory, which the trainer wants to
    /// itself.
    #[must_use]
    pub fn log(&self) -> PathBuf {
        self.directory.with_extension("log")
    }
}
