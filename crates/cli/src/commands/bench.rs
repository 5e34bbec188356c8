//! `hasard bench`: policy steps per second of a batch of worlds.

use crate::args::{BenchArgs, Size};
use crate::failure::{Failure, Outcome};
use crate::settings;
use hasard_envs::{ObservationKind, bench};
use serde_json::json;

/// Runs the command.
pub fn run(args: &BenchArgs) -> Outcome {
    if !(args.seconds.is_finite() && args.seconds > 0.0 && args.seconds <= 86_400.0) {
        return Err(Failure::bad(format!("--seconds {}: give a number above 0, at most 86400", args.seconds)));
    }
    let options = settings::observed(settings::env_options(&args.env_args, Size::LEARNER)?, &args.observation);
    let report = bench(&args.env, &options, args.envs as usize, args.threads as usize, args.seconds).map_err(Failure::bad)?;
    let (depth, labels) = (options.observation == ObservationKind::RgbDepth, options.observation == ObservationKind::Segmented);
    if args.json {
        let object = json!({
            "env": args.env,
            "steps_per_second": report.steps_per_second,
            "tics_per_second": report.tics_per_second,
            "resets": report.resets,
            "envs": args.envs,
            "threads": args.threads,
            "size": options.size.to_string(),
            "depth": depth,
            "labels": labels,
            "obs_bytes_per_step": report.observation_bytes,
        });
        say!("{object}");
    } else {
        say!(
            "{}: {:.0} policy steps/s ({:.0} tics/s), {} worlds, {} thread(s), {}, {} bytes an observation, {} resets",
            args.env,
            report.steps_per_second,
            report.tics_per_second,
            args.envs,
            args.threads,
            options.size,
            report.observation_bytes,
            report.resets
        );
    }
    Ok(())
}
