//! What shorter runs need so that they make sense: multipliers that move as far in fewer updates.

use super::plan::two_digits;
use crate::args::{Cli, Command};
use crate::commands::init_from::of_job;
use crate::commands::kept_task::named as named_tasks;
use crate::commands::train_settings::fresh;
use crate::failure::Failure;
use clap::error::ErrorKind;
use clap::{CommandFactory, FromArgMatches};
use hasard_learn::config::{AlgorithmKind, TrainConfig};
use hasard_sweep::Job;

/// The settings that a job's run would begin with.
pub fn settings(job: &Job) -> Result<TrainConfig, Failure> {
    let line = std::iter::once("hasard".into()).chain(job.arguments.iter().cloned());
    let named = |why: &str| Failure::bad(format!("{}: {why}", job.command_line("hasard")));
    let wrong = |error: clap::Error| match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
            named("help and version are no options of a training; leave them out")
        }
        _ => named(&crate::failure::usage_line(&error)),
    };
    let typed = Cli::command().try_get_matches_from(line).map_err(wrong)?;
    match (Cli::from_arg_matches(&typed).map_err(wrong)?.command, typed.subcommand()) {
        (Command::Train(args), Some((_, typed))) => {
            let begun = named_tasks(&args).and_then(|args| {
                let mut config = fresh(&args, typed)?;
                config.init_from = of_job(&args, &job.directory)?;
                Ok(config)
            });
            begun.map_err(|error| error.about(&job.command_line("hasard")))
        }
        _ => Err(named("not a training")),
    }
}

/// Adds to a job whose frames were multiplied by `scale` what keeps its run in proportion.
///
/// A multiplier moves by a fixed rate an update. In a hundredth of the frames it would come to a
/// hundredth of where it has to be, so that no budget could bind: rates, and integral gains of
/// controllers, grow as the run shrinks. Schedules of rates of learning need nothing, since they
/// last as long as the run. Rates are never lowered for longer runs.
///
/// A preset's rates are made for its own number of frames; where that is below the experiment's, it
/// is what the run is measured by.
pub fn rescale(job: &mut Job, config: &TrainConfig, scale: f64) -> Result<(), Failure> {
    let own = TrainConfig::plain(config.algorithm, config.preset, config.env.clone()).frames;
    let reference = (job.frames as f64 / scale).min(own as f64);
    let factor = job.frames as f64 / reference;
    let first_episodes = config.sampling.lanes as u64
        * u64::from(config.episode_steps)
        * u64::from(config.env.frame_skip);
    if job.frames < first_episodes {
        let least = scale * first_episodes as f64 / job.frames as f64;
        return Err(Failure::bad(format!(
            "--scale {scale}: the runs of {} would end after {} frames, before the first episodes of their {} worlds ({first_episodes} \
             frames); give --scale {} or more",
            config.algorithm,
            job.frames,
            config.sampling.lanes,
            // Two digits, upward.
            two_digits(least * 1.05)
        )));
    }
    if factor >= 0.999 || !config.algorithm.has_multipliers() {
        return Ok(());
    }
    let settings = &config.algorithm_settings;
    let (name, value) = match config.algorithm {
        AlgorithmKind::PpoPid | AlgorithmKind::TrpoPid => {
            let (proportional, integral, derivative) = settings.pid_gains;
            (
                "algorithm_settings.pid_gains",
                format!("[{proportional},{},{derivative}]", rounded(integral / factor)),
            )
        }
        _ => (
            "algorithm_settings.multiplier_rate",
            rounded(settings.multiplier_rate / factor).to_string(),
        ),
    };
    // What the sweep itself sets stays as it is.
    let is_set = |word: &str| {
        word.starts_with(&format!("{name}="))
            || word.starts_with(&format!("{}=", name.replace('.', "/")))
    };
    if !job.words().any(|word| is_set(&word)) {
        job.add_option("set", &format!("{name}={value}"));
    }
    Ok(())
}

/// Four digits, so that the number reads well in a command.
fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}
