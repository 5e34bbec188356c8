//! `hasard sweep`: many trainings.

mod looks;
mod options;
pub(super) mod plan;
mod progress;
mod rescale;
mod share;

use crate::args::SweepArgs;
use crate::failure::{Failure, Outcome};
use crate::interrupt::{self, Manner};
use hasard_learn::config::{AlgorithmKind, TrainConfig};
use hasard_learn::runs::run_directory::read_config;
use hasard_media::shell::quote;
use hasard_sweep::{Event, Job, State, Stop, Summary, Sweep, paper, run_jobs};
use plan::Plan;
use progress::Progress;
use serde_json::json;
use share::share;
use std::ffi::OsStr;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// A sweep of more hours than this is run only if its length was chosen.
const HOURS_WITHOUT_ASKING: f64 = 48.0;

/// Bytes of the longest name that common file systems have.
const LONGEST_NAME: usize = 255;

/// Runs the command.
pub fn run(args: &SweepArgs) -> Outcome {
    if let Some(seed) = args.seed {
        return Err(Failure::bad(format!(
            "--seed {seed}: a sweep has several; give --seeds {seed}"
        )));
    }
    if let Some(advice) = args.what.to_str().and_then(paper::advice) {
        if args.json {
            say!("{}", json!({ "advice": advice }));
        } else {
            say!("{advice}");
        }
        return Ok(());
    }
    let Described { mut sweep, chooses_frames } = description(&args.what)?;
    change(&mut sweep, args)?;
    let named = |error| Failure::bad(format!("{}: {error}", args.what.to_string_lossy()));
    let mut jobs = sweep.jobs().map_err(named)?;
    let mut configs = settings(&jobs)?;
    looks::check(args, &configs)?;
    if let Some(scale) = args.scale {
        for (job, config) in jobs.iter_mut().zip(&configs) {
            rescale::rescale(job, config, scale)?;
        }
        configs = settings(&jobs)?;
    }
    let all = jobs.len();
    let pairs = share(jobs.into_iter().zip(configs).collect());
    if pairs.len() < all && !args.json {
        note!(
            "hasard: {} of {all} runs repeat others by options that come to the same settings; each is made once",
            all - pairs.len()
        );
    }
    pairs.iter().try_for_each(|(job, _)| has_room(job))?;
    let longer =
        pairs.iter().map(|(job, config)| fits(job, config)).collect::<Result<Vec<_>, _>>()?;
    if !args.json {
        name_longer(&longer.into_iter().flatten().collect::<Vec<_>>(), pairs.len());
    }
    if args.dry_run {
        return list(args, &pairs, sweep.parallel);
    }
    can_be_made(&sweep.out)?;
    let plan = measured(args, &pairs, sweep.parallel)?;
    if args.json {
        say!("{}", plan.object());
    } else {
        say!("{}", plan.line());
    }
    // A share of the paper's length may still be days; frames are a length that was chosen.
    let chosen = chooses_frames || args.yes || args.frames.is_some();
    if let Some(hours) = plan.hours.filter(|&hours| hours > HOURS_WITHOUT_ASKING && !chosen) {
        let (what, day) = (
            args.what.to_string_lossy(),
            plan::two_digits(24.0 / hours * args.scale.unwrap_or(1.0)),
        );
        return Err(Failure::bad(format!(
            "sweep {what}: about {}; give --yes to run all of it, --scale {day} for a day of it, or --frames for the length of each run",
            plan::span(hours)
        )));
    }
    let (jobs, rate) = (pairs.into_iter().map(|(job, _)| job).collect::<Vec<_>>(), plan.rate);
    execute(args, &sweep, &jobs, rate)
}

/// Refuses a folder of runs that cannot be made; nothing of it is left.
fn can_be_made(out: &Path) -> Outcome {
    let missing: Vec<&Path> = out.ancestors().take_while(|path| !path.exists()).collect();
    let made = std::fs::create_dir_all(out);
    for path in missing {
        // What another program has put there meanwhile stays.
        std::fs::remove_dir(path).ok();
    }
    made.map_err(|error| {
        Failure::bad(format!(
            "{}: cannot be made: {error}; choose another `out`, here with --out DIR",
            out.display()
        ))
    })
}

/// Refuses a run whose folder cannot be made.
fn has_room(job: &Job) -> Result<(), Failure> {
    if let Some(file) = job.directory.ancestors().find(|path| path.is_file()) {
        return Err(Failure::bad(format!(
            "{}: is a file, and the sweep's folders would be in it; choose another `out`",
            file.display()
        )));
    }
    let longest = job.directory.iter().map(OsStr::len).max().unwrap_or_default();
    if longest > LONGEST_NAME {
        return Err(Failure::bad(format!(
            "{}: its options make a folder's name of {longest} bytes, more than the {LONGEST_NAME} of a file system; \
             give some of them as [settings], which are no part of the name",
            job.name()
        )));
    }
    Ok(())
}

/// Refuses a run that lies where the sweep would train one by other settings; gives the frames of
/// one that was made for more than the sweep asks for.
fn fits<'a>(job: &'a Job, config: &TrainConfig) -> Result<Option<(&'a Job, u64)>, Failure> {
    let Ok(mut found) = read_config(&job.directory) else { return Ok(None) };
    // Runs of older versions do not say what they began with; the name of their folder does.
    found.init_from = found.init_from.or(config.init_from.clone());
    match found.unlike(&config.clone().begun()) {
        None if found.frames <= config.frames => Ok(None),
        None if job.state() == State::Finished => Ok(Some((job, found.frames))),
        None => Err(Failure::bad(format!(
            "{}: is a run of {} frames that has not ended, and the sweep asks for {}; choose another `out`, or end that run first \
             with hasard train {} --resume --out {}",
            job.directory.display(),
            found.frames,
            config.frames,
            config.env.id,
            quote(&job.directory)
        ))),
        Some((name, was, wanted)) => Err(Failure::bad(format!(
            "{}: was trained with {name} = {was}, the sweep asks for {wanted}; choose another `out`, or move that run away",
            job.directory.display()
        ))),
    }
}

/// Says which runs are there already whose schedules were made for more frames than are asked for:
/// they count as finished, and are not what the sweep alone would make.
fn name_longer(longer: &[(&Job, u64)], all: usize) {
    if let Some((job, frames)) = longer.first() {
        note!(
            "hasard: {} of {all} runs were made for more frames than this sweep asks for, and count as finished; {} for {frames}. Another `out` makes them anew",
            longer.len(),
            job.directory.display()
        );
    }
}

/// Runs the jobs, saying how they go.
fn execute(args: &SweepArgs, sweep: &Sweep, jobs: &[Job], rate: Option<f64>) -> Outcome {
    // The Python package names its script: there this process is the interpreter.
    let program = match std::env::var_os("HASARD_PROGRAM") {
        Some(program) => program.into(),
        None => std::env::current_exe()
            .map_err(|error| Failure::bad(format!("this program's own path: {error}")))?,
    };
    interrupt::behave(Manner::Parent);
    // A reader who goes away does not stop the runs; lines that are lost otherwise make the sweep
    // fail once the runs are done.
    let lost = Mutex::new(None);
    let progress = Mutex::new(Progress::new(jobs, sweep.parallel, rate));
    let stop = Stop { soon: &interrupt::STOP, now: &interrupt::GIVE_UP };
    let summary = run_jobs(&program, jobs, sweep.parallel, stop, |index, event| {
        let mut progress = progress.lock().unwrap_or_else(PoisonError::into_inner);
        progress.hear(index, event);
        if let Err(failure) = write(args.json, index, &jobs[index], event, &progress) {
            lost.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(failure);
        }
    });
    let elapsed = progress.into_inner().unwrap_or_else(PoisonError::into_inner).elapsed();
    match lost.into_inner().unwrap_or_else(PoisonError::into_inner) {
        None => end(args.json, &summary, &elapsed)?,
        Some(Failure::OutputClosed) => {}
        Some(failure) => return Err(failure),
    }
    interrupt::check()?;
    match summary.failed.len() {
        0 => Ok(()),
        n => Err(Failure::Negative(format!(
            "{n} of {} runs failed; run the same command again to resume them",
            jobs.len()
        ))),
    }
}

/// What the words of the command change of the description.
fn change(sweep: &mut Sweep, args: &SweepArgs) -> Result<(), Failure> {
    if let Some(out) = &args.out {
        sweep.out.clone_from(out);
    }
    if let Some(parallel) = args.parallel {
        sweep.parallel = usize::from(parallel);
    }
    if let Some(episodes) = args.evaluate {
        sweep.evaluate = episodes;
    }
    // Directories bear the algorithms' own names, however they were typed.
    let own_name = |name: &String| -> Result<String, Failure> {
        Ok(name.parse::<AlgorithmKind>().map_err(Failure::bad)?.name().to_string())
    };
    for algorithm in sweep.grids.iter_mut().flat_map(|grid| &mut grid.algorithms) {
        let named = |error: Failure| error.about(&args.what.to_string_lossy());
        *algorithm = own_name(algorithm).map_err(named)?;
    }
    if !args.algos.is_empty() {
        sweep.restrict_algorithms(
            &args.algos.iter().map(own_name).collect::<Result<Vec<_>, Failure>>()?,
        );
    }
    if !args.scenarios.is_empty() {
        sweep.restrict_scenarios(&args.scenarios);
    }
    if !args.levels.is_empty() {
        sweep.restrict_levels(&args.levels);
    }
    if !args.seeds.is_empty() {
        let seeds = seeds(&args.seeds)?;
        sweep.grids.iter_mut().for_each(|grid| grid.seeds.clone_from(&seeds));
    }
    options::give(sweep, args)?;
    if let Some(frames) = args.frames {
        sweep.grids.iter_mut().for_each(|grid| grid.frames = frames);
    }
    if let Some(scale) = args.scale {
        if !(scale.is_finite() && scale > 0.0) {
            return Err(Failure::bad(format!("--scale {scale}: give a number above 0")));
        }
        sweep.scale_frames(scale);
    }
    Ok(())
}

/// Seeds from words such as `3` and `11-15`.
fn seeds(words: &[String]) -> Result<Vec<u64>, Failure> {
    let wrong = |word: &str| {
        Failure::bad(format!(
            "--seeds {word}: give whole numbers from 0 or ranges, such as 1,2,3 or 11-15"
        ))
    };
    let mut seeds = Vec::new();
    for word in words {
        let (first, last) = word.split_once('-').unwrap_or((word, word));
        let (Ok(first), Ok(last)) = (first.parse::<u64>(), last.parse::<u64>()) else {
            return Err(wrong(word));
        };
        if last < first || last - first >= 100_000 {
            return Err(wrong(word));
        }
        seeds.extend(first..=last);
    }
    Ok(seeds)
}

/// The settings of every run, so that whatever is wrong with one is said before any begins.
fn settings(jobs: &[Job]) -> Result<Vec<TrainConfig>, Failure> {
    jobs.iter().map(rescale::settings).collect()
}

/// What the runs come to on this machine, which takes some seconds to know.
fn measured(
    args: &SweepArgs,
    pairs: &[(Job, TrainConfig)],
    parallel: usize,
) -> Result<Plan, Failure> {
    if !args.json {
        note!("hasard: measuring for some seconds how fast this machine is");
    }
    Plan::of(pairs, parallel, true)
}

/// The command lines and what they come to.
fn list(args: &SweepArgs, pairs: &[(Job, TrainConfig)], parallel: usize) -> Outcome {
    for (job, _) in pairs {
        if args.json {
            say!(
                "{}",
                json!({ "directory": job.directory.display().to_string(), "command": job.command_line("hasard") })
            );
        } else {
            say!("{}", job.command_line("hasard"));
        }
    }
    if !args.json {
        // Beside the lines, which a script may run.
        note!("hasard: {}", measured(args, pairs, parallel)?.line());
    }
    Ok(())
}

/// Says how the sweep went.
fn end(as_json: bool, summary: &Summary, elapsed: &str) -> Outcome {
    let (finished, skipped, stopped, failed) =
        (summary.finished, summary.skipped, summary.stopped, summary.failed.len());
    if as_json {
        let counts = json!({ "skipped": skipped, "finished": finished, "stopped": stopped, "failed": failed });
        say!("{}", json!({ "summary": counts }));
        return Ok(());
    }
    let stopped = if stopped > 0 {
        format!(", {stopped} stopped: the same command goes on")
    } else {
        String::new()
    };
    say!(
        "{finished} finished, {skipped} had been finished before, {failed} failed{stopped}, in {elapsed}"
    );
    Ok(())
}

/// A sweep, and whether its description says how long runs are.
struct Described {
    sweep: Sweep,
    chooses_frames: bool,
}

/// A TOML file's sweep, or an experiment by name.
fn description(what: &OsStr) -> Result<Described, Failure> {
    let path = Path::new(what);
    let what = what.to_string_lossy();
    if path.extension().is_none_or(|ending| ending != "toml") && !path.is_file() {
        return Ok(Described {
            sweep: paper::experiment(&what).map_err(Failure::bad)?,
            chooses_frames: false,
        });
    }
    let bytes = hasard_media::files::read_limited(path, 1 << 20).map_err(Failure::bad)?;
    let text = String::from_utf8(bytes)
        .map_err(|_| Failure::bad(format!("{what}: not text; write a TOML file")))?;
    let wrong = |error: String| Failure::bad(format!("{what}: {error}"));
    Ok(Described {
        sweep: Sweep::parse(&text).map_err(wrong)?,
        chooses_frames: Sweep::chooses_frames(&text),
    })
}

fn write(as_json: bool, index: usize, job: &Job, event: &Event, progress: &Progress) -> Outcome {
    let outcome =
        matches!(event, Event::Finished(_)).then(|| progress::RunResult::of(job)).flatten();
    let line = progress.line(job, event, outcome.as_ref());
    if !as_json {
        if let Some(line) = line {
            say!("{line}");
        }
        return Ok(());
    }
    let name = match event {
        Event::AlreadyFinished => "already_finished",
        Event::Started(hasard_sweep::State::Unfinished(_)) => "resumed",
        Event::Started(_) => "started",
        Event::Finished(_) => "finished",
        Event::Failed(_) => "failed",
        Event::Stopped => "stopped",
        Event::Elsewhere => "elsewhere",
    };
    let mut object = progress.object(event, outcome.as_ref());
    object.insert("job".into(), json!(index));
    object.insert("directory".into(), json!(job.directory.display().to_string()));
    object.insert("event".into(), json!(name));
    object.insert("text".into(), json!(line.unwrap_or_else(|| format!("{}: {name}", job.name()))));
    say!("{}", serde_json::Value::Object(object));
    Ok(())
}

#[cfg(test)]
mod tests;
