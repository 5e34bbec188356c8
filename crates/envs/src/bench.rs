//! How fast a batch of worlds runs.

use crate::error::EnvError;
use crate::options::EnvOptions;
use crate::scenarios::common::spec::EPISODE_TICS;
use crate::vec_env::{VecEnv, VecOptions};
use hasard_engine::math::Rng;
use std::time::Instant;

/// What a measurement gave.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct BenchReport {
    /// Policy steps a second, all lanes together, resets and observations included.
    pub steps_per_second: f64,
    /// The same in tics.
    pub tics_per_second: f64,
    /// Episodes that ended meanwhile.
    pub resets: u64,
    /// Seconds that an episode of full length takes in every lane, where not even one fitted the
    /// time.
    pub lacking_seconds: Option<f64>,
    /// Bytes that a lane's step writes to the observation buffer.
    pub observation_bytes: usize,
}

/// Steps a batch with uniform random actions for about `seconds`. Observations are written and
/// episodes follow each other without a pause, so that rendering and resets are part of what is
/// measured.
///
/// All lanes begin together, and the beginning of an episode costs more or less than its end (a
/// third more in Volcanic Venture). So that batches of different widths compare, the rate is that
/// of as many episodes of full length as fit the time; where none does, see
/// [`BenchReport::lacking_seconds`], that of all of the time.
pub fn bench(
    id: &str,
    options: &EnvOptions,
    lanes: usize,
    threads: usize,
    seconds: f64,
) -> Result<BenchReport, EnvError> {
    // One of the threads is the caller's own, which helps while it waits.
    let hired = threads.saturating_sub(1);
    let mut worlds =
        VecEnv::new(id, options, VecOptions { lanes, threads: hired, ..VecOptions::default() })?;
    let space = worlds.action_space().clone();
    let mut rng = Rng::new(0);
    let mut batch = worlds.whole_batch();
    worlds.reset(&mut batch)?;
    let episode = u64::from(EPISODE_TICS.div_ceil(options.frame_skip));
    let (mut steps, mut resets, mut elapsed) = (0, 0, 0.0);
    let mut whole = None;
    let start = Instant::now();
    while elapsed < seconds {
        space.sample(&mut rng, &mut batch.actions, &mut batch.deltas);
        worlds.step(&mut batch)?;
        steps += 1;
        resets += batch.episodes.len() as u64;
        elapsed = start.elapsed().as_secs_f64();
        if steps % episode == 0 {
            whole = Some((steps, resets, elapsed));
        }
    }
    let lacking_seconds = whole.is_none().then(|| elapsed * episode as f64 / steps as f64);
    let (steps, resets, elapsed) = whole.unwrap_or((steps, resets, elapsed));
    let rate = (steps * lanes as u64) as f64 / elapsed;
    Ok(BenchReport {
        steps_per_second: rate,
        tics_per_second: rate * f64::from(options.frame_skip),
        resets,
        lacking_seconds,
        observation_bytes: batch.observations.len() / lanes,
    })
}
