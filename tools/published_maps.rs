//! Every published map at play: what its file holds, what is left out of it, how long it takes to
//! load, and how random agents fare.
//!
//! ```sh
//! cargo run --release -p hasard-envs --example published_maps -- [EPISODES]
//! ```
//!
//! The maps and Freedoom are those of the Python packages `hasard` and `vizdoom`, where the
//! `python3` on the path has them.

use hasard_envs::maps::{Maps, find_iwad, find_maps};
use hasard_envs::{Env, EnvId, EnvOptions, Policy, RuleSet, rollout};
use std::sync::Arc;
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let episodes = std::env::args().nth(1).map_or(Ok(1), |text| text.parse())?;
    let maps = Arc::new(Maps::new(&find_maps()?, Some(&find_iwad(true)?)));
    println!(
        "| map | loaded in ms | sectors | lines | reset in us | return | cost | left out |\n|---|--:|--:|--:|--:|--:|--:|---|"
    );
    for id in EnvId::all() {
        for hard in [false, true] {
            if hard && id.level != 1 {
                continue;
            }
            let options = EnvOptions {
                rules: RuleSet::Released,
                hard,
                maps: Some(Arc::clone(&maps)),
                ..EnvOptions::default()
            };
            let started = Instant::now();
            let mut env = Env::new(&id.to_string(), &options)?;
            let loaded = started.elapsed().as_millis();
            let (sectors, lines) = (env.world().map.sectors.len(), env.world().map.lines.len());
            let started = Instant::now();
            (0..20).for_each(|seed| env.reset(seed));
            let reset = started.elapsed().as_micros() / 20;
            let policy: Policy = "random".parse()?;
            let played: Vec<_> = (1..=episodes)
                .map(|seed| rollout(&mut env, &policy, seed))
                .collect::<Result<_, _>>()?;
            let mean = |of: &dyn Fn(&hasard_envs::Episode) -> f64| {
                played.iter().map(of).sum::<f64>() / played.len() as f64
            };
            let (reward, cost) =
                (mean(&|episode| episode.episode_return), mean(&|episode| episode.cost));
            let left_out = env.left_out().unwrap_or_default();
            let name = format!("{id}{}", if hard { " hard" } else { "" });
            println!(
                "| {name} | {loaded} | {sectors} | {lines} | {reset} | {reward:.2} | {cost:.2} | {left_out} |"
            );
        }
    }
    Ok(())
}
