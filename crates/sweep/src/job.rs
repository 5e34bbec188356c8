//! One run of a sweep.

use crate::grid::OptionValue;
use std::path::{Path, PathBuf};

/// One run: a directory and the arguments of its process.
#[derive(Clone, PartialEq, Debug)]
pub struct Job {
    /// The run directory: `OUT/ENV/ALGORITHM[/option=value,...]/seedN`. Equal runs of different sweeps into one folder
    /// share it, so that none is made twice.
    pub directory: PathBuf,
    /// Arguments of `hasard`, beginning with `train`, for a fresh start.
    pub arguments: Vec<String>,
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

/// Options that change where or how fast a run is made but not what it is: they stay out of its directory's name.
const NOT_IDENTITY: [&str; 4] = ["device", "threads", "json", "quiet"];

impl Job {
    pub(crate) fn new(
        out: &Path,
        environment: &str,
        algorithm: &str,
        frames: u64,
        seed: u64,
        options: &[(String, OptionValue)],
    ) -> Job {
        let mut arguments: Vec<String> = ["train", environment, "--algo", algorithm].map(String::from).to_vec();
        arguments.extend(["--frames".into(), frames.to_string(), "--seed".into(), seed.to_string()]);
        let mut names = Vec::new();
        // In the order of names, so that a run has one directory however its options were put together.
        let mut options: Vec<&(String, OptionValue)> = options.iter().collect();
        options.sort_by(|a, b| a.0.cmp(&b.0));
        for (name, value) in options {
            let named = match value {
                OptionValue::Switch(false) => continue,
                OptionValue::Switch(true) => {
                    arguments.push(format!("--{name}"));
                    name.clone()
                }
                OptionValue::Text(text) => {
                    arguments.extend([format!("--{name}"), text.clone()]);
                    format!("{name}={}", text.replace(|c: char| !c.is_ascii_alphanumeric() && !".+-_,".contains(c), "_"))
                }
            };
            if !NOT_IDENTITY.contains(&name.as_str()) {
                names.push(named);
            }
        }
        let mut directory = out.join(environment).join(algorithm);
        if !names.is_empty() {
            directory.push(names.join(","));
        }
        directory.push(format!("seed{seed}"));
        arguments.extend(["--out".into(), directory.display().to_string()]);
        Job { directory, arguments, frames, evaluate: 0 }
    }

    /// How far the run is, by its `config.json` and the last whole line of its `metrics.jsonl`.
    #[must_use]
    pub fn state(&self) -> State {
        if !self.directory.join("config.json").is_file() {
            return State::New;
        }
        let text = std::fs::read(self.directory.join("metrics.jsonl")).unwrap_or_default();
        let reached = text.split(|byte| *byte == b'\n').rev().find_map(|line| {
            let value: serde_json::Value = serde_json::from_slice(line).ok()?;
            value.get("frames")?.as_f64()
        });
        match reached.unwrap_or(0.0) as u64 {
            frames if frames >= self.frames => State::Finished,
            frames => State::Unfinished(frames),
        }
    }

    /// The arguments that take the run from where it is to its end.
    #[must_use]
    pub fn arguments_from(&self, state: State) -> Vec<String> {
        let mut arguments = self.arguments.clone();
        if matches!(state, State::Unfinished(_)) {
            arguments.push("--resume".into());
        }
        arguments
    }

    /// Whether its agent still has to be evaluated once the run is finished.
    #[must_use]
    pub fn wants_evaluation(&self) -> bool {
        self.evaluate > 0 && !self.evaluation().is_file()
    }

    /// Where the episodes of its agent are kept: reports find them there. The file is there when it is whole.
    #[must_use]
    pub fn evaluation(&self) -> PathBuf {
        self.directory.join("eval.jsonl")
    }

    /// The arguments that evaluate its agent.
    #[must_use]
    pub fn evaluation_arguments(&self) -> Vec<String> {
        let directory = self.directory.display().to_string();
        ["eval", &directory, "--episodes", &self.evaluate.to_string(), "--json"].map(String::from).to_vec()
    }

    /// Whether the number of threads was chosen for it.
    #[must_use]
    pub fn chooses_threads(&self) -> bool {
        self.arguments.iter().any(|argument| argument == "--threads")
    }

    /// The command as one line for a shell, for a fresh start.
    #[must_use]
    pub fn command_line(&self, program: &str) -> String {
        std::iter::once(program).chain(self.arguments.iter().map(String::as_str)).map(quote).collect::<Vec<_>>().join(" ")
    }

    /// Where what the process prints is kept: beside the run directory, which the trainer wants to itself.
    #[must_use]
    pub fn log(&self) -> PathBuf {
        self.directory.with_extension("log")
    }
}

/// A word that a shell reads as it is.
fn quote(word: &str) -> String {
    if !word.is_empty() && word.chars().all(|c| c.is_ascii_alphanumeric() || "-_./=,+:@%".contains(c)) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}
