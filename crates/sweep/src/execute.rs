//! Running jobs side by side.

use crate::job::{Job, State};
use hasard_media::shell::quote;
use std::collections::VecDeque;
use std::ffi::OsString;
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Variable of a job's process: it stops when its standard input ends, which it does with this
/// process, whatever ended that.
pub const STOPS_WITH_INPUT: &str = "HASARD_STOPS_WITH_INPUT";

/// Time between two looks at a process.
const LOOK_EVERY: Duration = Duration::from_millis(30);

/// Time between two looks at a run that another process trains.
const ASK_EVERY: Duration = Duration::from_millis(300);

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
    /// The caller stopped it.
    Stopped,
    /// Another process trains it: its turn comes again when that has ended.
    Elsewhere,
}

/// How the caller ends a sweep before its time.
#[derive(Clone, Copy)]
pub struct Stop<'a> {
    /// No job begins any more, and those that run stop with a checkpoint.
    pub soon: &'a AtomicBool,
    /// Those that run are killed.
    pub now: &'a AtomicBool,
}

/// How a sweep went.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Summary {
    /// Jobs that had been finished before.
    pub skipped: usize,
    /// Jobs that were run to their end.
    pub finished: usize,
    /// Jobs that the caller stopped.
    pub stopped: usize,
    /// Jobs that failed, with the reason.
    pub failed: Vec<(String, String)>,
}

/// Runs jobs, `parallel` processes of `program` at a time: finished ones are skipped, unfinished
/// ones resumed. A job that fails does not stop the others. What a process prints goes to the job's
/// log. `report` hears of every event. A run that another process trains waits until that has ended,
/// so that two sweeps share their work.
///
/// Several processes share the cores: each is given its number of threads, unless its job
/// chooses one. Otherwise every one of them would take all cores, and they would wait for each
/// other.
///
/// No process outlives this one: see [`STOPS_WITH_INPUT`].
pub fn run_jobs(
    program: &Path,
    jobs: &[Job],
    parallel: usize,
    stop: Stop<'_>,
    report: impl Fn(usize, &Event) + Sync,
) -> Summary {
    let parallel = parallel.clamp(1, jobs.len().max(1));
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let share = (parallel > 1).then(|| (cores / parallel).max(1));
    let queue = Mutex::new((0..jobs.len()).map(|index| (index, false)).collect::<VecDeque<_>>());
    let queue = || queue.lock().unwrap_or_else(PoisonError::into_inner);
    let summary = Mutex::new(Summary::default());
    let work = || {
        while !stop.soon.load(Ordering::SeqCst) {
            let Some((index, waits)) = queue().pop_front() else { break };
            let job = &jobs[index];
            let event = run_one(program, job, share, stop, |event| report(index, event));
            if event != Event::Elsewhere || !waits {
                report(index, &event);
            }
            let mut summary = summary.lock().unwrap_or_else(PoisonError::into_inner);
            match event {
                Event::Elsewhere => {
                    drop(summary);
                    queue().push_back((index, true));
                    std::thread::sleep(if waits { ASK_EVERY } else { LOOK_EVERY });
                }
                Event::Failed(why) => {
                    summary.failed.push((job.directory.display().to_string(), why))
                }
                Event::AlreadyFinished => summary.skipped += 1,
                Event::Stopped => summary.stopped += 1,
                Event::Started(_) | Event::Finished(_) => summary.finished += 1,
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..parallel {
            // Where the system gives no thread, the others do its work.
            let _ = std::thread::Builder::new().spawn_scoped(scope, work);
        }
        work();
    });
    let mut summary = summary.into_inner().unwrap_or_else(PoisonError::into_inner);
    summary.failed.sort();
    summary
}

/// Runs a process to its end, or until the caller stops it.
fn run(
    program: &Path,
    arguments: &[OsString],
    out: File,
    error: File,
    stop: Stop<'_>,
) -> std::io::Result<ExitStatus> {
    let mut command = Command::new(program);
    command
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(out)
        .stderr(error)
        .env(STOPS_WITH_INPUT, "1");
    let mut child = command.spawn()?;
    let mut line = child.stdin.take();
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(status);
        }
        if stop.soon.load(Ordering::SeqCst) {
            drop(line.take());
        }
        if stop.now.load(Ordering::SeqCst) {
            child.kill()?;
            return child.wait();
        }
        std::thread::sleep(LOOK_EVERY);
    }
}

fn run_one(
    program: &Path,
    job: &Job,
    share: Option<usize>,
    stop: Stop<'_>,
    report: impl Fn(&Event),
) -> Event {
    let evaluated = |event: Event| match evaluate(program, job, stop) {
        Ok(()) if stop.soon.load(Ordering::SeqCst) && job.wants_evaluation() => Event::Stopped,
        Ok(()) => event,
        Err(why) => Event::Failed(why),
    };
    let state = job.state();
    if state == State::Finished {
        return evaluated(Event::AlreadyFinished);
    }
    if job.is_held() {
        return Event::Elsewhere;
    }
    let mut arguments = job.arguments_from(state);
    if let Some(threads) = share.filter(|_| !job.chooses_threads()) {
        arguments.extend(["--threads".into(), threads.to_string().into()]);
    }
    let outputs = log(program, job, &arguments).and_then(|file| Ok((file.try_clone()?, file)));
    let (out, error) = match outputs {
        Ok(outputs) => outputs,
        Err(error) => {
            return Event::Failed(format!("cannot write {}: {error}", job.log().display()));
        }
    };
    report(&Event::Started(state));
    let began = Instant::now();
    let status = run(program, &arguments, out, error, stop);
    match (status, job.state()) {
        (Ok(status), State::Finished) if status.success() => {
            evaluated(Event::Finished(began.elapsed()))
        }
        (Ok(_), _) if stop.soon.load(Ordering::SeqCst) => Event::Stopped,
        // Another sweep was faster by a moment.
        (Ok(_), _) if job.is_held() => Event::Elsewhere,
        (Ok(status), _) if status.success() => Event::Failed(format!(
            "ended before its {} frames; see {}",
            job.frames,
            job.log().display()
        )),
        (Ok(status), _) => {
            Event::Failed(format!("{status}; {}: {}", job.log().display(), last_line(&job.log())))
        }
        (Err(error), _) => Event::Failed(format!("cannot run {}: {error}", program.display())),
    }
}

/// A job's log, with the command at its end.
fn log(program: &Path, job: &Job, arguments: &[OsString]) -> std::io::Result<File> {
    let log = job.log();
    if let Some(folder) = log.parent() {
        std::fs::create_dir_all(folder)?;
    }
    let mut file = OpenOptions::new().create(true).append(true).open(&log)?;
    let words: Vec<String> = arguments.iter().map(quote).collect();
    writeln!(file, "$ {} {}", quote(program), words.join(" "))?;
    Ok(file)
}

/// Evaluates the agent of a finished run, if that is asked for, and keeps the episodes in its
/// directory, under a temporary name until they are all there. A caller who stops it has none.
fn evaluate(program: &Path, job: &Job, stop: Stop<'_>) -> Result<(), String> {
    if !job.wants_evaluation() {
        return Ok(());
    }
    // Of another name than that of a second sweep in the same folder.
    let path = job.evaluation();
    let partial = path.with_extension(format!("{}.partial", std::process::id()));
    let failed =
        |error: std::io::Error| format!("cannot evaluate into {}: {error}", path.display());
    let arguments = job.evaluation_arguments();
    let error = log(program, job, &arguments).map_err(failed)?;
    let out = File::create(&partial).map_err(failed)?;
    let status = run(program, &arguments, out, error, stop);
    if status.as_ref().is_ok_and(ExitStatus::success) {
        return std::fs::rename(&partial, &path).map_err(failed);
    }
    let _ = std::fs::remove_file(&partial);
    match status {
        _ if stop.soon.load(Ordering::SeqCst) => Ok(()),
        Ok(_) => Err(format!(
            "the evaluation of {} failed: {}",
            job.directory.display(),
            last_line(&job.log())
        )),
        Err(error) => Err(failed(error)),
    }
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
    text.lines()
        .rev()
        .map(str::trim)
        .find(|line| !line.is_empty())
        .unwrap_or("no output")
        .to_owned()
}
