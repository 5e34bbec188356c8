//! A run's directory: its settings, its lock, its metrics.

use std::fs::{self, File, TryLockError};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Duration;

use hasard_media::files::{NO_FILE, is_special, what_lies_at};
use hasard_media::shell::quote;
use serde_json::{Value, json};

use crate::config::TrainConfig;
use crate::error::LearnError;
use crate::runs::calibration::{calibrate, predictions};
use crate::runs::episode_row::episode_row;
use crate::runs::evaluation::Closing;
use crate::runs::selection::Selection;
use crate::runs::tensorboard;

/// Reports, a line each.
pub(super) const METRICS: &str = "metrics.jsonl";
/// Where the agents have been, a line a moment.
pub(super) const HEATMAPS: &str = "heatmaps.jsonl";
/// Which checkpoint the run selects, and its name in runs of older versions.
const SELECTION: [&str; 2] = ["selected.json", "hand_out.json"];
/// Episodes of the closing evaluations, one a line: of the selected checkpoint, and of the last
/// policy.
const EPISODES: [&str; 2] = ["closing_episodes.jsonl", "last_policy_episodes.jsonl"];
/// What the selected checkpoint's critics of the costs expected, and what came.
const CALIBRATION: &str = "calibration.json";

/// What is said of a run that has judged checkpoints and none any more.
pub(crate) const GONE: &str = "its checkpoints are gone; bring its folder checkpoints back";

/// A run's directory, locked against a second trainer for as long as this value lives.
pub struct RunDirectory {
    path: PathBuf,
    /// The folder was made for the run, and the lock's file.
    made: (bool, bool),
    /// Which folder that is, whatever its path becomes; not all systems say.
    folder: Option<(u64, u64)>,
    /// The system gives the lock back when the process ends, however it ends.
    _lock: File,
}

impl RunDirectory {
    /// Makes a new run's directory and writes its settings. A directory with a run in it is
    /// refused.
    pub fn create(path: &Path, config: &TrainConfig) -> Result<RunDirectory, LearnError> {
        let made_folder = !path.exists();
        fs::create_dir_all(path).map_err(LearnError::file(path, "create"))?;
        let mut directory = RunDirectory::lock(path)?;
        directory.made.0 = made_folder;
        let checkpoints = path.join("checkpoints");
        let rests = fs::read_dir(&checkpoints).is_ok_and(|mut entries| entries.next().is_some())
            || [METRICS, HEATMAPS].iter().any(|name| {
                fs::metadata(path.join(name)).is_ok_and(|data| data.is_file() && data.len() > 0)
            })
            || !tensorboard::files(path).is_empty()
            || SELECTION.iter().any(|name| path.join(name).exists());
        let problem = if path.join("config.json").exists() {
            "there is a run already; go on with --resume, or choose another directory with --out"
        } else if rests {
            "rows, checkpoints or a selection of a run are here, but not its config.json; bring it back, or choose another directory with --out"
        } else {
            ""
        };
        if !problem.is_empty() {
            directory.unlock();
            return Err(LearnError::content(path, problem));
        }
        let made =
            fs::create_dir_all(&checkpoints).map_err(LearnError::file(&checkpoints, "create"));
        match made.and_then(|()| write_json(&path.join("config.json"), config)) {
            Ok(()) => Ok(directory),
            Err(error) => {
                directory.withdraw();
                Err(error)
            }
        }
    }

    /// Opens the directory of a run to go on with it.
    pub fn open(path: &Path) -> Result<(RunDirectory, TrainConfig), LearnError> {
        let config = read_config(path)?;
        let directory = RunDirectory::lock(path)?;
        // A run that was killed early, or whose files were copied without what is empty.
        let checkpoints = path.join("checkpoints");
        fs::create_dir_all(&checkpoints).map_err(LearnError::file(&checkpoints, "create"))?;
        Ok((directory, config))
    }

    /// Takes a new run back that could not begin, so that the same command, mended, finds its
    /// directory free. What was there before stays.
    pub fn withdraw(self) {
        // Nothing hangs on it: at worst the next attempt finds a run there already.
        for name in ["config.json", "config.partial"] {
            let _ = fs::remove_file(self.path.join(name));
        }
        if self.holds_no_row() {
            for name in [METRICS, HEATMAPS] {
                let _ = fs::remove_file(self.path.join(name));
            }
            tensorboard::files(&self.path).iter().for_each(|file| drop(fs::remove_file(file)));
        }
        let _ = fs::remove_dir(self.path.join("checkpoints"));
        self.unlock();
    }

    /// Leaves no lock and no empty folder behind that were not there before.
    fn unlock(self) {
        if self.made.1 {
            let _ = fs::remove_file(self.path.join("lock"));
        }
        if self.made.0 {
            let _ = fs::remove_dir(&self.path);
        }
    }

    /// Whether nothing was learned yet that could be gone on with or looked at.
    #[must_use]
    pub fn is_blank(&self) -> bool {
        let checkpoints = fs::read_dir(self.path.join("checkpoints"));
        self.holds_no_row() && checkpoints.is_ok_and(|mut entries| entries.next().is_none())
    }

    fn holds_no_row(&self) -> bool {
        fs::symlink_metadata(self.path.join(METRICS))
            .map_or(true, |data| data.is_file() && data.len() == 0)
    }

    fn lock(path: &Path) -> Result<RunDirectory, LearnError> {
        let file = path.join("lock");
        // Who only asks whether a training is here, as `hasard serve` does, has it for a moment.
        for _ in 0..3 {
            let made = !file.exists();
            let lock = File::options()
                .create(true)
                .truncate(false)
                .write(true)
                .open(&file)
                .map_err(LearnError::file(&file, "open"))?;
            match lock.try_lock() {
                // A run that withdrew took the file with it: who comes next makes another.
                Ok(()) if !is_at(&lock, &file) => {}
                Ok(()) => {
                    let folder = fs::metadata(path).ok().as_ref().and_then(identity);
                    let path = path.to_path_buf();
                    return Ok(RunDirectory { path, made: (false, made), folder, _lock: lock });
                }
                Err(TryLockError::WouldBlock) => std::thread::sleep(Duration::from_millis(20)),
                Err(TryLockError::Error(source)) => {
                    return Err(LearnError::File { path: file, doing: "lock", source });
                }
            }
        }
        Err(LearnError::content(
            path,
            "another trainer works in this directory; wait for it, stop it, or choose another one with --out",
        ))
    }

    /// Refuses to go on where the folder was moved or removed meanwhile: half of the run would be
    /// elsewhere.
    pub fn check_is_there(&self) -> Result<(), LearnError> {
        let gone = |error: &std::io::Error| {
            matches!(error.kind(), std::io::ErrorKind::NotFound | std::io::ErrorKind::NotADirectory)
        };
        match fs::metadata(&self.path) {
            Ok(data) if self.folder.is_none_or(|folder| identity(&data) == Some(folder)) => {
                return Ok(());
            }
            // A disk that is busy for a moment says nothing of it; what is written next does.
            Err(error) if !gone(&error) => return Ok(()),
            _ => {}
        }
        Err(LearnError::content(
            &self.path,
            "the run's folder was moved or removed while it trained; put it back and go on with --resume, or train anew with another --out",
        ))
    }

    /// Writes the settings of a run that goes on with others than before.
    pub fn rewrite_config(&self, config: &TrainConfig) -> Result<(), LearnError> {
        write_json(&self.path.join("config.json"), config)
    }

    /// Writes which checkpoint the run selects and what it is worth, with the episodes that say so.
    /// The selection comes last: where it is written, the others are.
    pub fn write_selection(
        &self,
        selection: &Selection,
        closings: &[Closing],
        config: &TrainConfig,
    ) -> Result<(), LearnError> {
        for closing in closings {
            let mut lines = String::new();
            for (number, (episode, _)) in closing.played.iter().enumerate() {
                lines += &format!("{}\n", episode_row(&config.env.id, number as u64, episode));
            }
            write_whole(
                &self.path.join(EPISODES[usize::from(!closing.selected)]),
                lines.as_bytes(),
            )?;
        }
        for closing in closings.iter().filter(|closing| closing.selected) {
            let gamma = config.cost_gamma_after(closing.frames);
            let all = calibrate(&predictions(&closing.played, config, gamma), config, gamma);
            if !all.is_empty() {
                write_json(
                    &self.path.join(CALIBRATION),
                    &json!({ "frames": closing.frames, "constraints": all }),
                )?;
            }
        }
        write_json(&self.path.join(SELECTION[0]), selection)
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Drops the rows after `rows` frames from metrics and TensorBoard's files, and those after
    /// `frames` from heatmaps: a run that goes on from there writes them again. Rows that are no
    /// JSON are dropped too, and named to `warn`. A selection that was made after `frames` goes too:
    /// other checkpoints will come in the place of those that it chose from.
    pub fn rewind(
        &self,
        rows: u64,
        frames: u64,
        warn: &mut dyn FnMut(String),
    ) -> Result<(), LearnError> {
        self.rewind_lines(METRICS, rows, warn)?;
        self.rewind_lines(HEATMAPS, frames, warn)?;
        if read_selection(&self.path).is_some_and(|known| known.is_made_after(frames)) {
            for name in SELECTION.into_iter().chain(EPISODES).chain([CALIBRATION]) {
                remove_if_there(&self.path.join(name))?;
            }
        }
        for file in tensorboard::files(&self.path) {
            let bytes = read_regular(&file)?;
            let kept = tensorboard::until(&bytes, rows);
            if kept.len() < bytes.len() {
                write_whole(&file, &kept)?;
            }
        }
        Ok(())
    }

    fn rewind_lines(
        &self,
        name: &str,
        frames: u64,
        warn: &mut dyn FnMut(String),
    ) -> Result<(), LearnError> {
        let path = self.path.join(name);
        if matches!(fs::metadata(&path), Err(error) if error.kind() == std::io::ErrorKind::NotFound)
        {
            return Ok(());
        }
        let text = String::from_utf8_lossy(&read_regular(&path)?).into_owned();
        let mut kept = String::new();
        for (number, line) in text.lines().enumerate() {
            match serde_json::from_str::<Value>(line)
                .ok()
                .and_then(|row| row.get("frames")?.as_u64())
            {
                Some(at) if at <= frames => {
                    kept.push_str(line);
                    kept.push('\n');
                }
                Some(_) => {}
                None => warn(format!(
                    "{}: line {} is damaged and was dropped",
                    path.display(),
                    number + 1
                )),
            }
        }
        write_whole(&path, kept.as_bytes())
    }
}

/// Reads a file of a run. A pipe would be waited for without end, and a device may have none.
///
/// # Errors
/// One line that names the file.
pub(crate) fn read_regular(path: &Path) -> Result<Vec<u8>, LearnError> {
    let kind = fs::metadata(path).map_err(LearnError::file(path, "read"))?;
    if is_special(&kind) {
        return Err(LearnError::content(path, NO_FILE));
    }
    fs::read(path).map_err(LearnError::file(path, "read"))
}

/// What the run in a directory selected when it ended, if it did.
#[must_use]
pub fn read_selection(path: &Path) -> Option<Selection> {
    let read = |name: &&str| serde_json::from_slice(&read_regular(&path.join(name)).ok()?).ok();
    SELECTION.iter().find_map(read)
}

/// What keeps the word of a run on what it selected from being read; nothing if it is whole, or if
/// there is none.
#[must_use]
pub fn damaged_selection(path: &Path) -> Option<String> {
    let file = SELECTION.iter().map(|name| path.join(name)).find(|file| file.exists())?;
    read_selection(path).is_none().then(|| format!("{}: damaged or not to be read", file.display()))
}

/// What to do where the checkpoint that a run selected cannot be read.
pub(super) fn spoiled_selection(error: &LearnError) -> LearnError {
    LearnError::Config(format!(
        "{error}; --latest takes the newest checkpoint, and once this folder is gone the next candidate is selected"
    ))
}

/// The settings of the run in a directory.
pub fn read_config(path: &Path) -> Result<TrainConfig, LearnError> {
    let file = path.join("config.json");
    let is_absent = |place: &Path| {
        let there = what_lies_at(place).map_err(|error| LearnError::Config(error.to_string()));
        there.map(|kind| kind.is_none())
    };
    if is_absent(path)? {
        return Err(LearnError::content(
            path,
            "nothing is here; give the directory of `hasard train --out` or a file of `hasard export-agent`",
        ));
    }
    if is_absent(&file)? {
        return Err(LearnError::content(
            path,
            "no run is here (config.json is missing); give the directory of `hasard train --out`",
        ));
    }
    let text = read_regular(&file)?;
    let config: TrainConfig = serde_json::from_slice(&text).map_err(|error| {
        LearnError::content(&file, format!("damaged or of another version: {error}"))
    })?;
    config.check().map_err(|error| LearnError::content(&file, error.to_string()))?;
    Ok(config)
}

/// The command that goes on with the run in a directory, to be pasted into a shell.
#[must_use]
pub fn go_on(config: &TrainConfig, directory: &Path) -> String {
    format!("hasard train {} --resume --out {}", config.env.id, quote(directory))
}

fn write_json(path: &Path, value: &impl serde::Serialize) -> Result<(), LearnError> {
    let text = serde_json::to_vec_pretty(value)
        .map_err(|error| LearnError::content(path, format!("cannot be written: {error}")))?;
    write_whole(path, &text)
}

/// What stays the same of a folder when it is moved, where the system says so.
#[cfg(unix)]
fn identity(folder: &fs::Metadata) -> Option<(u64, u64)> {
    use std::os::unix::fs::MetadataExt;
    Some((folder.dev(), folder.ino()))
}

#[cfg(not(unix))]
fn identity(_: &fs::Metadata) -> Option<(u64, u64)> {
    None
}

/// Whether an open file is still the one at its path.
fn is_at(file: &File, path: &Path) -> bool {
    let at = fs::metadata(path).ok();
    at.is_some_and(|at| file.metadata().is_ok_and(|own| identity(&own) == identity(&at)))
}

fn remove_if_there(path: &Path) -> Result<(), LearnError> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(LearnError::file(path, "remove")(error))
        }
        _ => Ok(()),
    }
}

/// Writes a file under another name and renames it when it is complete.
pub(crate) fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), LearnError> {
    let temporary = path.with_extension("partial");
    write_through(&temporary, bytes).and_then(|()| fs::rename(&temporary, path)).map_err(|error| {
        let _ = fs::remove_file(&temporary);
        LearnError::file(path, "write")(error)
    })
}

/// Writes a file and waits until it is on the disk.
pub(crate) fn write_through(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut file = File::create(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}
