//! The process that tries inputs. It may die of one; what it was trying then lies in its notebook.

use crate::coverage::Coverage;
use crate::mutation::mutated;
use crate::targets::Target;
use crate::verdict::{Verdict, listen, try_input};
use hasard_engine::math::Rng;
use std::collections::BTreeSet;
use std::fs::File;
use std::io;
use std::os::unix::fs::FileExt;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Most inputs that are kept to be spoiled further.
const CORPUS_LIMIT: usize = 4096;

/// What a search has done.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// Inputs tried.
    pub executions: u64,
    /// Inputs that were read without an error.
    pub accepted: u64,
    /// Inputs kept because they reached something new.
    pub corpus: usize,
    /// What was reached, see [`Coverage::reached`].
    pub reached: usize,
    /// Failures found, each kind once: its kind and text.
    pub findings: Vec<(String, String)>,
}

/// A file in which the input under trial is noted, so that a supervisor finds it after a crash.
pub struct Notebook {
    file: File,
}

impl Notebook {
    /// Makes the file.
    ///
    /// # Errors
    /// When it cannot be made.
    pub fn create(path: &Path) -> io::Result<Notebook> {
        Ok(Notebook {
            file: File::options().create(true).truncate(true).read(true).write(true).open(path)?,
        })
    }

    fn note(&self, number: u64, input: &[u8]) -> io::Result<()> {
        let mut head = [0; 16];
        head[..8].copy_from_slice(&number.to_le_bytes());
        head[8..].copy_from_slice(&(input.len() as u64).to_le_bytes());
        self.file.write_all_at(input, 16)?;
        self.file.write_all_at(&head, 0)
    }

    /// The number of the input under trial, and the input.
    ///
    /// # Errors
    /// When nothing was noted yet.
    pub fn read(path: &Path) -> io::Result<(u64, Vec<u8>)> {
        let bytes = std::fs::read(path)?;
        let word = |at: usize| Some(u64::from_le_bytes(bytes.get(at..at + 8)?.try_into().ok()?));
        let (number, length) = word(0).zip(word(8)).ok_or(io::ErrorKind::UnexpectedEof)?;
        Ok((number, bytes[16..].iter().copied().take(length as usize).collect()))
    }
}

/// Searches until the time is over; failing inputs are written into `findings`.
///
/// # Errors
/// When the notebook or a finding cannot be written.
pub fn search(
    target: &Target,
    seconds: f64,
    seed: u64,
    notebook: &Path,
    findings: &Path,
) -> io::Result<Tally> {
    listen();
    let notebook = Notebook::create(notebook)?;
    let mut rng = Rng::new(seed);
    let mut coverage = Coverage::new();
    let mut corpus = (target.samples)();
    let samples = corpus.len();
    let mut tally = Tally::default();
    let mut known = BTreeSet::new();
    let until = Instant::now() + Duration::from_secs_f64(seconds);
    let mut next = 0;
    while Instant::now() < until {
        // Every valid sample once as it is, then spoiled ones; what was kept last is tried most.
        let mut input = if next < samples {
            corpus[next].clone()
        } else {
            let count = corpus.len() as u32;
            let pick = if rng.below(2) == 0 {
                rng.below(count)
            } else {
                count - 1 - rng.below(count.min(32))
            };
            mutated(&mut rng, &corpus[pick as usize], target.words, &corpus)
        };
        if next >= samples && rng.below(8) > 0 {
            input = (target.repair)(input);
        }
        next += 1;
        tally.executions += 1;
        notebook.note(tally.executions, &input)?;
        coverage.clear();
        match try_input(target, &input) {
            Verdict::Accepted => tally.accepted += 1,
            Verdict::Refused => {}
            Verdict::Failed(kind, text) => {
                // One of each place is enough to mend it.
                let place = if kind == "panic" {
                    text.split(": ").next().unwrap_or_default().to_owned()
                } else {
                    String::new()
                };
                if known.insert((kind, place)) {
                    keep(findings, target.name, kind, &input)?;
                    tally.findings.push((kind.to_owned(), text));
                }
            }
        }
        if coverage.note() && next > samples && corpus.len() < CORPUS_LIMIT {
            corpus.push(input);
        }
    }
    (tally.corpus, tally.reached) = (corpus.len() - samples, coverage.reached());
    Ok(tally)
}

/// Writes a failing input under a name that follows from it.
///
/// # Errors
/// When it cannot be written.
pub fn keep(findings: &Path, target: &str, kind: &str, input: &[u8]) -> io::Result<PathBuf> {
    use std::hash::Hasher;
    let mut hasher = hasard_engine::world::Fingerprint::default();
    hasher.write(input);
    let folder = findings.join(target);
    std::fs::create_dir_all(&folder)?;
    let path = folder.join(format!("{kind}_{:08x}", hasher.finish() as u32));
    std::fs::write(&path, input)?;
    Ok(path)
}
