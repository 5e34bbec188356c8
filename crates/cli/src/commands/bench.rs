//! `hasard bench`: policy steps per second of a batch of worlds, or of the whole training loop.

use crate::args::{BenchArgs, Size};
use crate::failure::{Failure, Outcome};
use crate::settings;
use hasard_engine::simd::Simd;
use hasard_envs::{ObservationKind, bench};
use hasard_learn::config::{EnvConfig, Preset, TrainConfig};
use hasard_learn::runs::measure::{Measurement, measure};
use serde_json::json;

/// Runs the command.
pub fn run(args: &BenchArgs) -> Outcome {
    if !(args.seconds.is_finite() && args.seconds > 0.0 && args.seconds <= 86_400.0) {
        return Err(Failure::bad(format!(
            "--seconds {}: give a number above 0, at most 86400",
            args.seconds
        )));
    }
    if args.learn {
        return learn(args);
    }
    let options = settings::observed(
        settings::env_options(&args.env_args, Size::LEARNER)?,
        &args.observation,
    );
    let report =
        bench(&args.env, &options, args.envs as usize, args.threads as usize, args.seconds)
            .map_err(Failure::bad)?;
    let (depth, labels) = (
        options.observation == ObservationKind::RgbDepth,
        options.observation == ObservationKind::Segmented,
    );
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
    if let Some(seconds) = report.lacking_seconds {
        note!(
            "hasard: this is the rate of episodes' beginnings, which cost more or less than the rest: --seconds {:.0} has whole ones of all {}",
            seconds.ceil(),
            args.envs
        );
    }
    Ok(())
}

/// Seconds that a round of products and training takes, about; a measurement has at least
/// [`LEAST_ROUNDS`].
const ROUND_SECONDS: f64 = 5.0;
const LEAST_ROUNDS: usize = 3;

/// The loop with every family of kernels that this processor has and may use, on one thread and on
/// as many as asked for.
fn learn(args: &BenchArgs) -> Outcome {
    let chosen = ["learning.threads", "sampling.samplers"]
        .into_iter()
        .find(|name| args.set.iter().any(|set| set.replace('/', ".").starts_with(name)));
    if let Some(name) = chosen {
        return Err(Failure::bad(format!(
            "--set {name}: bench --learn measures with 1 thread and with --threads; give that"
        )));
    }
    let env = settings::env_config(&args.env, &args.env_args, &args.observation);
    let preset: Preset = args.preset.parse().map_err(Failure::bad)?;
    let mut config = TrainConfig::new(args.algo.parse().map_err(Failure::bad)?, preset, env)
        .map_err(Failure::bad)?;
    (config.learning.epochs, config.learning.minibatches) = (1, 1);
    config.seed = args.seed;
    config.sampling.lanes = args.envs as usize;
    let mut config =
        config.with_all(&args.set).map_err(|error| Failure::bad(format!("--set {error}")))?;
    config.check().map_err(Failure::bad)?;
    let options = settings::trained_options(&config.env, args.env_args.elsewhere())?;
    let make = |env: &EnvConfig, worlds| env.worlds(&options, worlds);
    let families: Vec<Simd> = match Simd::forced().map_err(Failure::bad)? {
        _ if args.portable => vec![Simd::PLAIN],
        Some(forced) => vec![forced],
        None => Simd::all().into_iter().rev().collect(),
    };
    let mut threads = vec![1, args.threads as usize];
    threads.dedup();
    let rounds = ((args.seconds / ROUND_SECONDS).ceil() as usize).max(LEAST_ROUNDS);
    if !args.json {
        let (algorithm, epochs, worlds) =
            (config.algorithm, config.learning.epochs, config.sampling.lanes);
        let set: String = args.set.iter().map(|setting| format!(", {setting}")).collect();
        say!(
            "{algorithm} on {}, preset {preset}{set}, {epochs} epoch(s), {worlds} worlds: worlds, inference and learning",
            args.env
        );
    }
    for (threads, kernels) in
        threads.iter().flat_map(|threads| families.iter().map(move |kernels| (*threads, *kernels)))
    {
        (config.learning.threads, config.sampling.samplers) = (threads, threads);
        let mut on_round = |round| {
            if !args.json {
                note!("{kernels}, {threads} thread(s): round {round} of {rounds}");
            }
        };
        let seconds = args.seconds / rounds as f64;
        let measured = measure(kernels, &config, &make, rounds, seconds, &mut on_round)
            .map_err(Failure::bad)?;
        report(args, &config, &measured)?;
    }
    Ok(())
}

fn report(args: &BenchArgs, config: &TrainConfig, measured: &Measurement) -> Outcome {
    if args.json {
        let object = json!({
            "env": args.env,
            "algorithm": config.algorithm.name(),
            "preset": config.preset.name(),
            "kernels": measured.kernels.name(),
            "threads": measured.threads,
            "learning_steps_per_second": measured.steps_per_second,
            "product_flops": measured.product_rate,
            "flop_per_step": measured.flop_per_step,
            "bound_steps_per_second": measured.bound(),
            "share": measured.share(),
            "envs": config.sampling.lanes,
            "set": args.set,
            "rounds": measured.rounds,
        });
        say!("{object}");
        return Ok(());
    }
    say!(
        "{:>10}, {} thread(s): {:.0} steps/s; {:.1} GFLOP/s in large products / {:.1} MFLOP forward and backward = {:.0} steps/s: {:.1} % of that",
        measured.kernels.name(),
        measured.threads,
        measured.steps_per_second,
        measured.product_rate / 1e9,
        measured.flop_per_step / 1e6,
        measured.bound(),
        100.0 * measured.share()
    );
    Ok(())
}
