//! `hasard sweep`: many trainings.

use crate::args::SweepArgs;
use crate::failure::{Failure, Outcome};
use crate::interrupt::{self, Manner};
use hasard_learn::config::AlgorithmKind;
use hasard_sweep::{Event, Job, State, Stop, Summary, Sweep, paper, run_jobs};
use serde_json::json;
use std::ffi::OsStr;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// Runs the command.
pub fn run(args: &SweepArgs) -> Outcome {
    let mut sweep = description(&args.what)?;
    if let Some(out) = &args.out {
        sweep.out.clone_from(out);
    }
    if let Some(parallel) = args.parallel {
        sweep.parallel = usize::from(parallel);
    }
    if let Some(scale) = args.scale {
        if !(scale.is_finite() && scale > 0.0) {
            return Err(Failure::bad(format!("--scale {scale}: give a number above 0")));
        }
        sweep.scale_frames(scale);
    }
    // Directories bear the algorithms' own names, however they were typed.
    for algorithm in sweep.grids.iter_mut().flat_map(|grid| &mut grid.algorithms) {
        *algorithm = algorithm.parse::<AlgorithmKind>().map_err(Failure::bad)?.name().to_string();
    }
    let jobs = sweep.jobs().map_err(Failure::bad)?;
    if args.dry_run {
        for job in &jobs {
            if args.json {
                say!("{}", json!({ "directory": job.directory.display().to_string(), "command": job.command_line("hasard") }));
            } else {
                say!("{}", job.command_line("hasard"));
            }
        }
        return Ok(());
    }
    // The Python package tells where its script is: there this process is the interpreter.
    let program = match std::env::var_os("HASARD_PROGRAM") {
        Some(program) => program.into(),
        None => std::env::current_exe().map_err(|error| Failure::bad(format!("this program's own path: {error}")))?,
    };
    let total = jobs.len();
    interrupt::behave(Manner::Parent);
    // A reader who goes away does not stop the runs; lines that are lost otherwise make the sweep fail once the runs are done.
    let lost = Mutex::new(None);
    let stop = Stop { soon: &interrupt::STOP, now: &interrupt::GIVE_UP };
    let summary = run_jobs(&program, &jobs, sweep.parallel, stop, |index, event| {
        if let Err(failure) = tell(args.json, index, total, &jobs[index], event) {
            lost.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(failure);
        }
    });
    match lost.into_inner().unwrap_or_else(PoisonError::into_inner) {
        None => end(args.json, &summary)?,
        Some(Failure::OutputClosed) => {}
        Some(failure) => return Err(failure),
    }
    interrupt::check()?;
    match summary.failed.len() {
        0 => Ok(()),
        n => Err(Failure::Negative(format!("{n} of {total} runs failed; run the same command again to resume them"))),
    }
}

/// Says how the sweep went.
fn end(as_json: bool, summary: &Summary) -> Outcome {
    let (finished, skipped, stopped, failed) = (summary.finished, summary.skipped, summary.stopped, summary.failed.len());
    if as_json {
        let counts = json!({ "skipped": skipped, "finished": finished, "stopped": stopped, "failed": failed });
        say!("{}", json!({ "summary": counts }));
        return Ok(());
    }
    let stopped = if stopped > 0 { format!(", {stopped} stopped: the same command goes on") } else { String::new() };
    say!("{finished} finished, {skipped} had been finished before, {failed} failed{stopped}");
    Ok(())
}

/// A TOML file's sweep, or an experiment by name.
fn description(what: &OsStr) -> Result<Sweep, Failure> {
    let path = Path::new(what);
    let what = what.to_string_lossy();
    if path.extension().is_none_or(|ending| ending != "toml") && !path.is_file() {
        return paper::experiment(&what).map_err(Failure::bad);
    }
    let bytes = hasard_media::files::read_limited(path, 1 << 20).map_err(Failure::bad)?;
    let text = String::from_utf8(bytes).map_err(|_| Failure::bad(format!("{what}: not text; write a TOML file")))?;
    Sweep::parse(&text).map_err(|error| Failure::bad(format!("{what}: {error}")))
}

fn tell(as_json: bool, index: usize, total: usize, job: &Job, event: &Event) -> Outcome {
    let directory = job.directory.display().to_string();
    let (name, text) = match event {
        Event::AlreadyFinished => ("already_finished", "had been finished before".to_string()),
        Event::Started(State::Unfinished(frames)) => ("resumed", format!("goes on from {frames} frames")),
        Event::Started(_) => ("started", "begins".to_string()),
        Event::Finished(time) => ("finished", format!("finished in {:.0} s", time.as_secs_f64())),
        Event::Failed(why) => ("failed", format!("failed: {why}")),
        Event::Stopped => ("stopped", "stopped; the same command goes on".to_string()),
    };
    if as_json {
        say!("{}", json!({ "job": index, "directory": directory, "event": name, "text": text }));
    } else {
        say!("[{}/{total}] {directory}: {text}", index + 1);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::{Cli, Command};
    use clap::Parser;

    /// Every run of every experiment of the paper is a command that this program takes and can begin.
    #[test]
    fn the_papers_experiments_are_commands_of_this_program() {
        for (name, _) in paper::EXPERIMENTS {
            let jobs = paper::experiment(name).unwrap().jobs().unwrap();
            assert!(!jobs.is_empty(), "{name}");
            for job in jobs {
                let line = std::iter::once("hasard".into()).chain(job.arguments.iter().cloned());
                let Command::Train(args) = Cli::try_parse_from(line).unwrap_or_else(|error| panic!("{error}")).command else {
                    panic!("{} is not a training", job.command_line("hasard"));
                };
                if let Err(failure) = crate::commands::train::configuration(&args) {
                    panic!("{}: {failure:?}", job.command_line("hasard"));
                }
            }
        }
    }
}
