//! Planning with snapshots: looks some steps ahead at random, keeps the plan that earns most at no
//! cost, plays its first steps, and plans again: `cargo run --release -p hasard-envs --example
//! search`.

use hasard_envs::{Env, EnvOptions, Rng};

/// Plans that are tried, steps of each, and steps of the best that are played.
const PLANS: usize = 40;
const AHEAD: usize = 24;
const PLAYED: usize = 8;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut env = Env::new("RemedyRushLevel1-v0", &EnvOptions::default())?;
    let space = env.action_space().clone();
    let mut random = Rng::new(7);
    env.reset(1);
    'episode: loop {
        let here = env.snapshot();
        let mut best = (f64::MIN, Vec::new());
        for _ in 0..PLANS {
            env.restore(&here)?;
            // A plan holds each action for a while: moves that change at every step lead nowhere.
            let (mut plan, mut worth) = (Vec::new(), 0.0);
            let mut action = vec![0; space.groups.len()];
            for step in 0..AHEAD {
                if step % 6 == 0 {
                    space.sample(&mut random, &mut action, &mut []);
                }
                let result = env.step(&action, &[])?;
                worth += result.reward - 10.0 * result.cost;
                plan.push(action.clone());
                if result.ended() {
                    break;
                }
            }
            if worth > best.0 {
                best = (worth, plan);
            }
        }
        env.restore(&here)?;
        for action in best.1.iter().take(PLAYED) {
            if env.step(action, &[])?.ended() {
                break 'episode;
            }
        }
    }
    let episode = env.episode();
    println!(
        "return {:.2}, cost {:.2} in {} steps",
        episode.episode_return, episode.cost, episode.length
    );
    Ok(())
}
