//! Running jobs side by side.

use crate::job::{Job, State};
use std::fs::OpenOptions;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// What happens to a job.
#[derive(Clone, PartialEq, Debug)]
pub enum Event {
    /// It had reached its frames before.
    AlreadyFinished,
    /// Its process began, from this state.
    Started(State),
    /// Its process ended well, after this time.
    Finished(Duration),
    /// Its process did not end well: why, in one line that ends with the last line of its log.
    Failed(String),
}

/// How a sweep went.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Summary {
    /// Jobs that had been finished before.
    pub skipped: usize,
    /// Jobs that were run to their end.
    pub finished: usize,
    /// Jobs that failed, with the reason.
    pub failed: Vec<(String, String)>,
}

/// Runs jobs, `parallel` processes of `program` at a time: finished ones are skipped, unfinished ones resumed. A job that
/// fails does not stop the others. What a process prints goes to the job's log. `tell` hears of every event.
///
/// Several processes share the cores out: each is told its number of threads, unless its job chooses one. Otherwise every one
/// of them would take all cores, and they would wait for each other.
///
/// Ctrl-C reaches the processes as well (they are of the same group), and each stops with a checkpoint; the next call
/// resumes them.
pub fn run_jobs(program: &Path, jobs: &[Job], parallel: usize, tell: impl Fn(usize, &Event) + Sync) -> Summary {
    let parallel = parallel.clamp(1, jobs.len().max(1));
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let share = (parallel > 1).then(|| (cores / parallel).max(1));
    let next = AtomicUsize::new(0);
    let summary = Mutex::new(Summary::default());
    std::thread::scope(|scope| {
        for _ in 0..parallel {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(job) = jobs.get(index) else { break };
                    let event = run_one(program, job, share, |event| tell(index, event));
                    tell(index, &event);
                    let mut summary = summary.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                    match event {
                        Event::Failed(why) => summary.failed.push((job.directory.display().to_string(), why)),
                        Event::AlreadyFinished => summary.skipped += 1,
                        _ => summary.finished += 1,
                    }
                }
            });
        }
    });
    let mut summary = summary.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    summary.failed.sort();
    summary
}

fn run_one(program: &Path, job: &Job, share: Option<usize>, tell: impl Fn(&Event)) -> Event {
    let state = job.state();
    if state == State::Finished {
        if !job.wants_evaluation() {
            return Event::AlreadyFinished;
        }
        return evaluate(program, job).map_or_else(Event::Failed, |()| Event::AlreadyFinished);
    }
    let log = job.log();
    let mut arguments = job.arguments_from(state);
    if let Some(threads) = share.filter(|_| !job.chooses_threads()) {
        arguments.extend(["--threads".into(), threads.to_string()]);
    }
    let open = || -> std::io::Result<std::fs::File> {
        if let Some(folder) = log.parent() {
            std::fs::create_dir_all(folder)?;
        }
        let mut file = OpenOptions::new().create(true).append(true).open(&log)?;
        writeln!(file, "$ {} {}", program.display(), arguments.join(" "))?;
        Ok(file)
    };
    let outputs = open().and_then(|file| Ok((file.try_clone()?, file)));
    let (out, error) = match outputs {
        Ok(outputs) => outputs,
        Err(error) => return Event::Failed(format!("cannot write {}: {error}", log.display())),
    };
    tell(&Event::Started(state));
    let began = Instant::now();
    let status = Command::new(program).args(&arguments).stdin(Stdio::null()).stdout(out).stderr(error).status();
    match status {
        Ok(status) if status.success() => match job.state() {
            State::Finished if job.wants_evaluation() => {
                evaluate(program, job).map_or_else(Event::Failed, |()| Event::Finished(began.elapsed()))
            }
            State::Finished => Event::Finished(began.elapsed()),
            _ => Event::Failed(format!("ended before its {} frames; see {}", job.frames, log.display())),
        },
        Ok(status) => Event::Failed(format!("{status}; {}: {}", log.display(), last_line(&log))),
        Err(error) => Event::Failed(format!("cannot run {}: {error}", program.display())),
    }
}

/// Evaluates the agent of a finished run and keeps the episodes in its directory, under a temporary name until they are all
/// there.
fn evaluate(program: &Path, job: &Job) -> Result<(), String> {
    let (path, partial) = (job.evaluation(), job.evaluation().with_extension("partial"));
    let failed = |error: std::io::Error| format!("cannot evaluate into {}: {error}", path.display());
    let output = Command::new(program).args(job.evaluation_arguments()).stdin(Stdio::null()).output().map_err(failed)?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr).trim().to_owned();
        return Err(format!("the evaluation of {} failed: {said}", job.directory.display()));
    }
    std::fs::write(&partial, &output.stdout).and_then(|()| std::fs::rename(&partial, &path)).map_err(failed)
}

/// The last line of a log that says anything; only the file's end is read.
fn last_line(log: &Path) -> String {
    use std::io::{Read, Seek, SeekFrom};
    let read = || -> std::io::Result<String> {
        let mut file = std::fs::File::open(log)?;
        let length = file.metadata()?.len();
        file.seek(SeekFrom::Start(length.saturating_sub(4096)))?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes)?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    };
    let text = read().unwrap_or_default();
    text.lines().rev().map(str::trim).find(|line| !line.is_empty()).unwrap_or("no output").to_owned()
}
