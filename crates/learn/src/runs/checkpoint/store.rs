//! The checkpoints of a run: which there are, and which are kept.

use crate::error::LearnError;
use crate::runs::checkpoint::progress::{Progress, STATE, StateFile, read_progress};
use crate::runs::checkpoint::read::Loaded;
use crate::runs::checkpoint::write::Checkpoint;
use crate::runs::run_directory::{read_selection, write_whole};
use crate::runs::selection::Candidates;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

pub(super) fn remove(path: &Path) -> Result<(), LearnError> {
    fs::remove_dir_all(path).map_err(LearnError::file(path, "remove"))
}

/// The checkpoints of a run.
#[derive(Clone, Debug)]
pub struct Store {
    pub(super) directory: PathBuf,
    pub(super) keep: usize,
}

impl Store {
    /// The store in a run's directory.
    #[must_use]
    pub fn new(run: &Path, keep: usize) -> Store {
        Store { directory: run.join("checkpoints"), keep }
    }

    /// The checkpoint that the run selects, or would as far as it has come; `None` if it was never
    /// evaluated.
    fn selected(&self) -> Option<PathBuf> {
        let kept = self.numbered("best_");
        let closed = self
            .directory
            .parent()
            .and_then(read_selection)
            .map(|selection| self.best_of(selection.selected.frames));
        if let Some(closed) = closed.filter(|path| kept.contains(path)) {
            return Some(closed);
        }
        // The newest candidate knows of those before it. Files of older versions, which kept one,
        // say nothing of it.
        let newest = kept.into_iter().next()?;
        let known = read_progress(&newest)
            .ok()
            .and_then(|progress| Some(self.best_of(progress.candidates.ranked.first()?.frames)));
        Some(known.filter(|path| path.is_dir()).unwrap_or(newest))
    }

    /// The selected checkpoint, read. A run that goes on may drop it meanwhile: then it is the one
    /// that it selects by then.
    pub fn read_selected(&self) -> Result<Option<(PathBuf, Loaded)>, LearnError> {
        let Some(mut path) = self.selected() else { return Ok(None) };
        loop {
            let error = match Loaded::read(&path) {
                Ok(loaded) => return Ok(Some((path, loaded))),
                Err(error) => error,
            };
            path = self.selected().filter(|other| *other != path).ok_or(error)?;
        }
    }

    /// Whether the run has judged a checkpoint, so that one must have been written.
    #[must_use]
    pub fn has_judged(&self) -> bool {
        let closed = self.directory.parent().and_then(read_selection);
        closed.is_some() || !self.numbered("best_").is_empty()
    }

    /// All checkpoints to go on from, newest first.
    #[must_use]
    pub fn all(&self) -> Vec<PathBuf> {
        self.numbered("frames_")
    }

    /// Frames that the run has made, as far as its checkpoints say; `None` without any.
    #[must_use]
    pub fn frames(&self) -> Option<u64> {
        ["frames_", "best_"].iter().filter_map(|kind| Some(self.counted(kind).last()?.0)).max()
    }

    pub(super) fn numbered(&self, beginning: &str) -> Vec<PathBuf> {
        self.counted(beginning).into_iter().rev().map(|(_, path)| path).collect()
    }

    /// Checkpoints of a kind with the frames in their names, those of fewest frames first.
    fn counted(&self, beginning: &str) -> Vec<(u64, PathBuf)> {
        let Ok(entries) = fs::read_dir(&self.directory) else { return Vec::new() };
        let mut found: Vec<(u64, PathBuf)> = entries
            .filter_map(|entry| {
                let path = entry.ok()?.path();
                let frames = path.file_name()?.to_str()?.strip_prefix(beginning)?.parse().ok()?;
                Some((frames, path))
            })
            .collect();
        found.sort();
        found
    }

    /// Writes a checkpoint to go on from; older ones beyond the number to keep go, and so do those
    /// that are no candidates any more by what it knows. Not earlier: whenever the run is killed,
    /// the candidates of its newest checkpoint are there.
    pub fn write(&self, checkpoint: &Checkpoint) -> Result<(), LearnError> {
        let written = self.directory.join(format!("frames_{:012}", checkpoint.progress.frames));
        checkpoint.write(&written)?;
        // Newer ones are damaged: the run went back behind them. They count for nothing.
        let older = self.all().into_iter().skip_while(|path| *path != written);
        older.skip(self.keep).try_for_each(|old| remove(&old))?;
        self.keep_candidates(&checkpoint.progress.candidates)
    }

    /// Writes the checkpoint of a candidate.
    pub fn write_best(&self, checkpoint: &Checkpoint) -> Result<(), LearnError> {
        checkpoint.write(&self.best_of(checkpoint.progress.frames))
    }

    /// Replaces what the checkpoint of so many frames says of itself, all at once; weights and
    /// states stay as they are.
    pub fn amend(&self, progress: &Progress) -> Result<(), LearnError> {
        let path = self.directory.join(format!("frames_{:012}", progress.frames)).join(STATE);
        let state = StateFile { progress: progress.clone(), ..StateFile::read(&path)? };
        write_whole(&path, &state.text()?)
    }

    /// Where the candidate of so many frames is.
    #[must_use]
    pub fn best_of(&self, frames: u64) -> PathBuf {
        self.directory.join(format!("best_{frames:012}"))
    }

    pub(super) fn keep_candidates(&self, candidates: &Candidates) -> Result<(), LearnError> {
        let kept: Vec<PathBuf> =
            candidates.ranked.iter().map(|one| self.best_of(one.frames)).collect();
        if kept.is_empty() {
            return Ok(());
        }
        self.keep_only(&kept)
    }

    /// Removes all candidates but some.
    pub fn keep_only(&self, kept: &[PathBuf]) -> Result<(), LearnError> {
        self.numbered("best_")
            .into_iter()
            .filter(|path| !kept.contains(path))
            .try_for_each(|old| remove(&old))
    }

    /// Makes the directory agree with a checkpoint that the run goes on from, and gives its
    /// candidates so far: what a killed run left half-written goes, and so does what was a
    /// candidate in a future that will not be. A damaged candidate is none: `warn` gets a line.
    pub fn go_back_to(
        &self,
        progress: &Progress,
        warn: &mut dyn FnMut(String),
    ) -> Result<Candidates, LearnError> {
        if let Ok(entries) = fs::read_dir(&self.directory) {
            let half = entries.filter_map(|entry| Some(entry.ok()?.path()));
            // A file of another program's that ends so is left alone.
            let half = half.filter(|path| path.is_dir());
            half.filter(|path| path.extension().is_some_and(|ending| ending == "partial"))
                .try_for_each(|path| remove(&path))?;
        }
        let whole: Vec<(PathBuf, Progress)> = self
            .numbered("best_")
            .into_iter()
            .filter_map(|path| match Loaded::read(&path) {
                Ok(loaded) => Some((path, loaded.progress)),
                Err(error) => {
                    warn(format!("{error}; it is a candidate no more"));
                    None
                }
            })
            .collect();
        let is_whole = |frames| whole.iter().any(|(path, _)| *path == self.best_of(frames));
        let mut known = progress.all_candidates();
        let had_any = !known.ranked.is_empty();
        known.ranked.retain(|one| is_whole(one.frames));
        if known.ranked.is_empty()
            && had_any
            && let Some((_, left)) = whole.first()
        {
            // The newer checkpoints were damaged, but a candidate is whole: better than nothing.
            known = left.all_candidates();
            known.ranked.retain(|one| is_whole(one.frames));
        }
        let chosen = self.directory.parent().and_then(read_selection);
        let chosen = chosen.map(|selection| selection.selected.frames);
        let kept: Vec<PathBuf> = known
            .ranked
            .iter()
            .map(|one| one.frames)
            .chain(chosen)
            .map(|frames| self.best_of(frames))
            .collect();
        self.keep_only(&kept)?;
        Ok(known)
    }

    /// The newest whole checkpoint, or else the newest whole candidate: a run that was killed early
    /// may have been judged before its first checkpoint was due. `warn` gets a line for each damaged
    /// one that is passed over.
    pub fn newest(&self, warn: &mut dyn FnMut(String)) -> Result<Option<Loaded>, LearnError> {
        if let Err(error) = fs::read_dir(&self.directory)
            && error.kind() != ErrorKind::NotFound
        {
            return Err(LearnError::file(&self.directory, "read")(error));
        }
        let list = || [self.all(), self.numbered("best_")].concat();
        let mut all = list();
        let mut next = 0;
        while let Some(path) = all.get(next) {
            let error = match Loaded::read(path) {
                Ok(loaded) => return Ok(Some(loaded)),
                Err(error) => error,
            };
            // A run that goes on has dropped it for newer ones.
            let now = list();
            if now.first() == all.first() {
                warn(format!("{error}; going back to the checkpoint before it"));
                next += 1;
            } else {
                (all, next) = (now, 0);
            }
        }
        if all.is_empty() {
            return Ok(None);
        }
        Err(LearnError::content(
            &self.directory,
            "every checkpoint is damaged; start a new run, or copy a whole checkpoint here",
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn checkpoint(frames: u64) -> Checkpoint {
        let progress = json!({
            "frames": frames, "rollouts": 1, "updates": 1, "wall_seconds": 1.0, "returns": [], "optimiser_steps": [],
            "algorithm": null, "watch": { "recent": [], "episodes": 0, "waited": [], "window": 1 }, "samplers": [],
            "pixel_count": 0.0,
        });
        let progress = serde_json::from_value(progress).unwrap();
        Checkpoint { weights: vec![1], training: vec![2], progress }
    }

    /// Another process, such as `export-agent`, reads while the run goes on: what it was about to read
    /// is dropped for newer ones.
    #[test]
    fn who_reads_while_a_run_writes_always_gets_a_checkpoint() {
        let run = std::env::temp_dir().join(format!("hasard-read-{}", std::process::id()));
        let store = Store::new(&run, 1);
        fs::create_dir_all(run.join("checkpoints")).unwrap();
        store.write(&checkpoint(1)).unwrap();
        store.write_best(&checkpoint(1)).unwrap();
        std::thread::scope(|threads| {
            let writer = threads.spawn(|| {
                for frames in 2..400 {
                    store.write(&checkpoint(frames)).unwrap();
                    store.write_best(&checkpoint(frames)).unwrap();
                    store.keep_only(&[store.best_of(frames)]).unwrap();
                }
            });
            let (mut frames, mut selected) = (0, 0);
            while !writer.is_finished() {
                let newest = store.newest(&mut |line| panic!("{line}")).unwrap().unwrap();
                assert!(newest.progress.frames >= frames);
                frames = newest.progress.frames;
                let (_, best) = store.read_selected().unwrap().unwrap();
                assert!(best.progress.frames >= selected);
                selected = best.progress.frames;
            }
        });
        fs::remove_dir_all(&run).unwrap();
    }

    /// A run went back behind damaged checkpoints: those that it writes on its way do not go for them.
    #[test]
    fn newer_checkpoints_take_no_room_from_what_is_written() {
        let run = std::env::temp_dir().join(format!("hasard-store-{}", std::process::id()));
        let store = Store::new(&run, 1);
        fs::create_dir_all(run.join("checkpoints")).unwrap();
        let frames = || {
            let names = store.all();
            let name = |path: &PathBuf| path.file_name().unwrap().to_str().unwrap().to_owned();
            names.iter().map(name).collect::<Vec<_>>()
        };
        store.write(&checkpoint(900)).unwrap();
        fs::write(store.directory.join("frames_000000000900").join(STATE), "").unwrap();
        store.write(&checkpoint(300)).unwrap();
        store.write(&checkpoint(400)).unwrap();
        assert_eq!(frames(), ["frames_000000000900", "frames_000000000400"]);
        // Once it is past them they go as others do.
        store.write(&checkpoint(1_000)).unwrap();
        assert_eq!(frames(), ["frames_000000001000"]);
        fs::remove_dir_all(&run).unwrap();
    }
}
