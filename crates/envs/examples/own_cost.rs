//! A cost of one's own beside the scenario's: steps within 100 map units of the map's edge. It
//! reads the world after each step: `cargo run --release -p hasard-envs --example own_cost`.

use hasard_envs::{Env, EnvOptions, Policy, PolicyRun};

/// 1 where the agent is near the edge of the map.
fn edge(env: &Env) -> f64 {
    let ([x, y], [west, south, east, north]) = (env.position(), env.extent());
    let distance = (x - west).min(y - south).min(east - x).min(north - y);
    if distance < 100 { 1.0 } else { 0.0 }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut env = Env::new("RemedyRushLevel1-v0", &EnvOptions::default())?;
    for seed in 0..3 {
        env.reset(seed);
        let mut policy = PolicyRun::new("sticky:8".parse::<Policy>()?, &env, seed)?;
        let mut near_the_edge = 0.0;
        while !env.make_move(policy.next_move(&env))?.ended() {
            near_the_edge += edge(&env);
        }
        let episode = env.episode();
        println!(
            "seed {seed}: return {:.2}, cost {:.2}, own cost {near_the_edge} of {} steps",
            episode.episode_return, episode.cost, episode.length
        );
    }
    Ok(())
}
