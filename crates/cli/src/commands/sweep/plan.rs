//! What a sweep comes to, said before anything runs: runs, frames, hours on this machine, disk.

use crate::failure::Failure;
use crate::settings::Elsewhere;
use hasard_envs::EnvOptions;
use hasard_learn::config::{EnvConfig, TrainConfig};
use hasard_learn::networks::device::ComputeDevice;
use hasard_learn::runs::measure::measure;
use hasard_sweep::{Job, State};
use serde_json::{Value, json};
use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// Seconds of measuring, shared by the kinds of runs; and most kinds that are measured, evenly
/// chosen.
const SECONDS: f64 = 6.0;
const MOST_KINDS: usize = 6;

/// Once it has taken so long no further kind is measured: on a slow or busy machine each takes
/// longer than its share, for an update is not cut short.
const PATIENCE: Duration = Duration::from_secs(15);

/// Samples of an update above which rollouts are shortened to be measured; and steps of such a
/// rollout, if the run names no length to learn through.
const MANY_SAMPLES: usize = 8192;
const SHORT: usize = 32;

/// What is still to do.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// Runs of the whole sweep.
    pub runs: usize,
    /// Those that are finished already.
    pub finished: usize,
    /// Frames of the whole sweep.
    pub frames: u64,
    /// Frames that remain to be trained.
    pub left: u64,
    /// Hours that they take here, evaluations included; `None` where nothing was measured.
    pub hours: Option<f64>,
    /// Frames a second of one run's loop, the mean over the kinds of runs.
    pub rate: Option<f64>,
    /// Bytes that all runs keep when they are finished.
    pub bytes: Option<u64>,
    /// Kinds of runs that are left, and those of them that were measured; the others are taken for
    /// the mean of these.
    pub kinds: usize,
    pub measured: usize,
}

/// The kind of a run as far as its speed goes.
fn kind(config: &TrainConfig) -> String {
    let (env, learning) = (&config.env, &config.learning);
    let network = serde_json::to_string(&config.network).unwrap_or_default();
    let sampling = serde_json::to_string(&config.sampling).unwrap_or_default();
    format!(
        "{} {} {} {:?} {} {network} {sampling} {} {} {:?} {} {}",
        config.algorithm,
        config.preset,
        env.observation,
        env.size,
        env.full_actions,
        learning.epochs,
        learning.minibatches,
        learning.recurrence,
        learning.products,
        learning.portable,
    )
}

impl Plan {
    /// Counts what is to do, and measures for some seconds how fast it goes when `measures`.
    pub fn of(
        jobs: &[(Job, TrainConfig)],
        parallel: usize,
        measures: bool,
    ) -> Result<Plan, Failure> {
        let cores = crate::settings::cores();
        let at_once = parallel.clamp(1, jobs.len().max(1));
        let threads = (cores / at_once).max(1);
        let mut plan = Plan { runs: jobs.len(), ..Plan::default() };
        let mut kinds: BTreeMap<String, (&TrainConfig, u64)> = BTreeMap::new();
        for (job, config) in jobs {
            plan.frames = plan.frames.saturating_add(job.frames);
            let state = job.state();
            let done = match state {
                State::Finished => job.frames,
                State::Unfinished(frames) => frames.min(job.frames),
                State::New => 0,
            };
            plan.finished += usize::from(state == State::Finished);
            let left = job.frames - done;
            plan.left = plan.left.saturating_add(left);
            if left > 0 {
                let of_kind = &mut kinds.entry(kind(config)).or_insert((config, 0)).1;
                *of_kind = of_kind.saturating_add(left).saturating_add(tested(job, config));
            }
        }
        if !measures || kinds.is_empty() {
            return Ok(plan);
        }
        let measured = measured_within(PATIENCE, &kinds, |config, seconds| {
            let mut config = config.clone();
            (config.learning.threads, config.sampling.samplers) = (threads, threads);
            let options = crate::settings::trained_options(&config.env, Elsewhere::default())?;
            tried(&config, &options, seconds)
        })?;
        let count = measured.len();
        let mean = measured.values().map(|(rate, _)| rate).sum::<f64>() / count as f64;
        let size = measured.values().map(|(_, bytes)| bytes).sum::<u64>() / count as u64;
        let of_kind = |name: &String| measured.get(name).copied().unwrap_or((mean, size));
        let seconds: f64 =
            kinds.iter().map(|(name, (_, frames))| *frames as f64 / of_kind(name).0).sum();
        plan.rate = Some(mean);
        plan.hours = Some(seconds / at_once.min(cores) as f64 / 3600.0);
        plan.bytes = Some(jobs.iter().map(|(_, config)| of_kind(&kind(config)).1).sum());
        (plan.kinds, plan.measured) = (kinds.len(), count);
        Ok(plan)
    }

    /// The plan in one line.
    pub fn line(&self) -> String {
        let runs = if self.runs == 1 { "run" } else { "runs" };
        let mut text = format!("{} {runs}, {} frames", self.runs, short(self.frames));
        if self.finished > 0 || self.left < self.frames {
            text += &format!("; {} finished, {} frames to go", self.finished, short(self.left));
        }
        if let (Some(hours), Some(rate)) = (self.hours, self.rate) {
            text += &format!(
                "; about {} here, at {rate:.0} frames/s and with evaluations",
                span(hours)
            );
        }
        if let Some(bytes) = self.bytes {
            text += &format!("; {} on disk", size(bytes));
        }
        if self.kinds > 1 {
            text += &format!("; measured on {} of {} kinds of runs", self.measured, self.kinds);
            if self.measured < self.kinds {
                text += ", the others taken for their mean";
            }
        }
        text
    }

    /// The plan as an object of JSON.
    pub fn object(&self) -> Value {
        json!({ "plan": {
            "runs": self.runs,
            "finished": self.finished,
            "frames": self.frames,
            "frames_left": self.left,
            "hours": self.hours,
            "frames_per_second": self.rate,
            "bytes": self.bytes,
            "kinds": self.kinds,
            "kinds_measured": self.measured,
        } })
    }
}

/// Measures at most [`MOST_KINDS`] kinds, evenly chosen, until `patience` is at its end, and the
/// first in any case: that of most frames. Gives the rate and the bytes of each.
fn measured_within(
    patience: Duration,
    kinds: &BTreeMap<String, (&TrainConfig, u64)>,
    mut measure: impl FnMut(&TrainConfig, f64) -> Result<(f64, u64), Failure>,
) -> Result<BTreeMap<String, (f64, u64)>, Failure> {
    let stride = kinds.len().div_ceil(MOST_KINDS).max(1);
    let mut chosen: Vec<_> = kinds.iter().step_by(stride).collect();
    chosen.sort_by_key(|(_, (_, frames))| Reverse(*frames));
    let (begun, seconds) = (Instant::now(), SECONDS / chosen.len() as f64);
    let mut found = BTreeMap::new();
    for (name, (config, _)) in chosen {
        if !found.is_empty() && begun.elapsed() >= patience {
            break;
        }
        found.insert(name.clone(), measure(config, seconds)?);
    }
    Ok(found)
}

/// Frames a second of a run's loop, measured for some seconds, and the bytes of its checkpoints.
fn tried(config: &TrainConfig, options: &EnvOptions, seconds: f64) -> Result<(f64, u64), Failure> {
    let config = &of_short_updates(config);
    let make = |env: &EnvConfig, worlds| env.worlds(options, worlds);
    let kernels = ComputeDevice::of(config).map_err(Failure::bad)?.kernels();
    let loops = measure(kernels, config, &make, 1, seconds, &mut |_| {}).map_err(Failure::bad)?;
    let rate = loops.steps_per_second * f64::from(config.env.frame_skip);
    Ok((rate, loops.checkpoint_bytes * (config.reporting.keep as u64 + 1)))
}

/// The same training with shorter rollouts, and as much work for a frame, where an update would
/// take a core half a minute: those of the second order learn from 16,000 samples at once, and any
/// other may be asked to.
fn of_short_updates(config: &TrainConfig) -> TrainConfig {
    let mut config = config.clone();
    let (rollout, steps) = (config.sampling.rollout, config.learning.recurrence.unwrap_or(SHORT));
    let many = config.sampling.lanes * rollout > MANY_SAMPLES;
    if (many || config.algorithm.is_second_order()) && steps < rollout {
        config.sampling.rollout = steps;
        let critic_steps = &mut config.algorithm_settings.critic_steps;
        *critic_steps = (*critic_steps * steps / rollout).max(1);
    }
    config
}

/// How long a run takes here, evaluations included, and what it keeps on disk, in a line: measured
/// for a second.
pub fn outlook(config: &TrainConfig, options: &EnvOptions) -> Result<String, Failure> {
    let (rate, bytes) = tried(config, options, 1.0)?;
    let hours = config.frames.saturating_add(evaluated(config)) as f64 / rate / 3600.0;
    Ok(format!(
        "about {} here, at {rate:.0} frames/s and with evaluations; {} on disk",
        span(hours),
        size(bytes)
    ))
}

/// Frames that a job's evaluations play beside what it learns from.
fn tested(job: &Job, config: &TrainConfig) -> u64 {
    evaluated(config).saturating_add(u64::from(job.evaluate) * tics(config))
}

/// Tics of an episode that only time ends.
fn tics(config: &TrainConfig) -> u64 {
    u64::from(config.episode_steps) * u64::from(config.env.frame_skip)
}

/// Frames that a run's own evaluations play.
fn evaluated(config: &TrainConfig) -> u64 {
    let evaluation = &config.evaluation;
    let during = match evaluation.every {
        Some(0) => 0,
        Some(every) => config.frames / every,
        None if config.evaluates(0, config.frames) => 20,
        None => 0,
    };
    // Up to three candidates are confirmed as a rule, and the selected checkpoint closes the run.
    let further =
        if during > 0 { (during.min(3) + 1) * config.confirming_episodes() as u64 } else { 0 };
    let episodes = during.saturating_mul(evaluation.episodes as u64).saturating_add(further);
    episodes.saturating_mul(tics(config))
}

/// `270 G`, `8.0 M`, `300`.
pub fn short(count: u64) -> String {
    let value = count as f64;
    let (scaled, unit) = match count {
        1_000_000_000.. => (value / 1e9, " G"),
        1_000_000.. => (value / 1e6, " M"),
        10_000.. => (value / 1e3, " k"),
        _ => return count.to_string(),
    };
    if scaled < 10.0 { format!("{scaled:.1}{unit}") } else { format!("{scaled:.0}{unit}") }
}

/// A time that hours say badly: `267 days`, `5.2 hours`, `3 min`, `40 s`.
pub fn span(hours: f64) -> String {
    match hours {
        h if h >= 48.0 => format!("{:.0} days", h / 24.0),
        h if h >= 2.0 => format!("{h:.1} hours"),
        h if h >= 1.0 / 30.0 => format!("{:.0} min", h * 60.0),
        h => format!("{:.0} s", h * 3600.0),
    }
}

/// The two leading digits of a number: 0.0037.
pub fn two_digits(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

fn size(bytes: u64) -> String {
    let value = bytes as f64;
    if value >= 1e9 {
        format!("{:.1} GB", value / 1e9)
    } else {
        format!("{:.0} MB", (value / 1e6).max(1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hasard_learn::config::{AlgorithmKind, Preset};

    #[test]
    fn numbers_are_said_in_the_unit_that_fits() {
        assert_eq!(
            [270_000_000_000, 8_000_000, 67_200, 300].map(short),
            ["270 G", "8.0 M", "67 k", "300"]
        );
        assert_eq!(
            [6_400.0, 47.0, 1.5, 0.01].map(span),
            ["267 days", "47.0 hours", "90 min", "36 s"]
        );
        assert_eq!([0.00374, 0.015, 1.26].map(two_digits), [0.0037, 0.015, 1.3]);
        assert_eq!([60_300_000_000, 114_000_000, 3].map(size), ["60.3 GB", "114 MB", "1 MB"]);
    }

    #[test]
    fn a_training_says_how_long_it_takes_and_what_it_keeps() {
        let env = EnvConfig { size: (64, 48), ..EnvConfig::new("RemedyRushLevel1-v0") };
        let (algorithm, preset) = (AlgorithmKind::PpoPid, Preset::Quick);
        let mut config = TrainConfig::new(algorithm, preset, env).unwrap();
        (config.sampling.lanes, config.sampling.rollout) = (4, 8);
        (config.network.dense, config.network.recurrent) = (vec![32], Some(32));
        config.learning.recurrence = None;
        let options = config.env.options().unwrap();
        let line = outlook(&config, &options).unwrap();
        assert!(line.starts_with("about ") && line.ends_with(" MB on disk"), "{line}");
    }

    /// As much is computed for a frame: only rollouts, and what is made of each, are shorter.
    #[test]
    fn long_updates_are_measured_by_short_ones() {
        let make = |algorithm| {
            let env = EnvConfig::new("RemedyRushLevel1-v0");
            TrainConfig::new(algorithm, Preset::Quick, env).unwrap()
        };
        let steps_a_sample = |config: &TrainConfig| {
            let samples = config.sampling.lanes * config.sampling.rollout;
            config.algorithm_settings.critic_steps as f64 / samples as f64
        };
        let whole = make(AlgorithmKind::TrpoPid);
        let short = of_short_updates(&whole);
        assert!(short.sampling.lanes * short.sampling.rollout <= 2048);
        assert_eq!(steps_a_sample(&short), steps_a_sample(&whole));
        let ppo = make(AlgorithmKind::PpoPid);
        assert_eq!(of_short_updates(&ppo), ppo);
        let mut long = ppo;
        long.sampling.rollout = 4096;
        assert_eq!(of_short_updates(&long).sampling.rollout, SHORT);
    }

    /// A sweep of many kinds was measured for minutes before its plan was said.
    #[test]
    fn kinds_are_measured_once_each_while_there_is_time() {
        let env = EnvConfig::new("RemedyRushLevel1-v0");
        let config = TrainConfig::new(AlgorithmKind::Ppo, Preset::Quick, env).unwrap();
        let kinds: BTreeMap<String, (&TrainConfig, u64)> =
            (0..13).map(|number| (format!("{number:02}"), (&config, number))).collect();
        let measured = |patience| {
            let mut seconds = 0.0;
            let found = measured_within(patience, &kinds, |_, share| {
                seconds += share;
                Ok((1.0, 2))
            });
            (found.unwrap().into_keys().collect::<Vec<_>>(), seconds)
        };
        let (all, seconds) = measured(Duration::MAX);
        assert_eq!(all, ["00", "03", "06", "09", "12"]);
        assert!(seconds <= SECONDS + 1e-9);
        assert_eq!(measured(Duration::ZERO).0, ["12"], "the kind of most frames, without time");
    }

    #[test]
    fn a_line_says_what_remains() {
        let plan = Plan {
            runs: 540,
            frames: 270_000_000_000,
            left: 270_000_000_000,
            hours: Some(6408.0),
            rate: Some(11_700.0),
            ..Plan::default()
        };
        let line = Plan { bytes: Some(60_000_000_000), ..plan.clone() }.line();
        assert_eq!(
            line,
            "540 runs, 270 G frames; about 267 days here, at 11700 frames/s and with evaluations; 60.0 GB on disk"
        );
        let some = Plan { kinds: 13, measured: 2, bytes: Some(3), ..plan.clone() };
        assert!(
            some.line().ends_with(
                "; 1 MB on disk; measured on 2 of 13 kinds of runs, the others taken for their mean"
            ),
            "{}",
            some.line()
        );
        let all = Plan { kinds: 2, measured: 2, ..plan.clone() }.line();
        assert!(all.ends_with("; measured on 2 of 2 kinds of runs"), "{all}");
        let line = Plan { finished: 500, left: 20_000_000_000, hours: None, ..plan }.line();
        assert_eq!(line, "540 runs, 270 G frames; 500 finished, 20 G frames to go");
    }
}
