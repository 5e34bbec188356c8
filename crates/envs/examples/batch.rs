//! 32 environments stepped together on two threads: `cargo run --release -p hasard-envs --example
//! batch`.
//!
//! The results are the same for any number of threads.

use hasard_envs::{EnvOptions, FrameSize, Rng, VecEnv, VecOptions};
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let options = EnvOptions { size: FrameSize::LEARNER, ..EnvOptions::default() };
    let lanes = VecOptions { lanes: 32, threads: 2, seed: 1, ..VecOptions::default() };
    let mut envs = VecEnv::new("RemedyRushLevel1-v0", &options, lanes)?;
    let mut batch = envs.whole_batch();
    envs.reset(&mut batch)?;
    let (mut random, mut episodes, begun) = (Rng::new(7), Vec::new(), Instant::now());
    for _ in 0..600 {
        envs.action_space().sample(&mut random, &mut batch.actions, &mut batch.deltas);
        // Observations, rewards, costs and flags of all lanes are in the batch afterwards. Lanes
        // that end start anew by themselves.
        envs.step(&mut batch)?;
        episodes.append(&mut batch.episodes);
    }
    let mean = |value: &dyn Fn(&hasard_envs::Episode) -> f64| {
        episodes.iter().map(value).sum::<f64>() / episodes.len() as f64
    };
    println!("{:.0} steps/s", 600.0 * 32.0 / begun.elapsed().as_secs_f64());
    println!(
        "{} episodes: mean return {:.2}, mean cost {:.2}",
        episodes.len(),
        mean(&|episode| episode.episode_return),
        mean(&|episode| episode.cost)
    );
    Ok(())
}
