//! One environment, one episode of random actions: `cargo run --release -p hasard-envs --example
//! one_env`.

use hasard_engine::math::Rng;
use hasard_envs::{Env, EnvOptions};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut env = Env::new("VolcanicVentureLevel1-v0", &EnvOptions::default())?;
    let sizes = env.action_space().sizes();
    println!("observation {:?}, sub-actions {sizes:?}", env.observation_shape());
    let mut observation = vec![0; env.observation_shape().iter().product()];
    let mut random = Rng::new(7);
    env.reset(1);
    loop {
        env.observe(&mut observation);
        // One choice of each group of buttons; 0 is none of them.
        let action: Vec<u8> = sizes.iter().map(|&size| random.below(size as u32) as u8).collect();
        let step = env.step(&action, &[])?;
        if step.ended() {
            break;
        }
    }
    let episode = env.episode();
    println!(
        "{} steps, return {:.2}, cost {:.2}",
        episode.length, episode.episode_return, episode.cost
    );
    for term in &episode.costs {
        println!(
            "  {} {:.2}{}",
            term.name,
            term.cost,
            if term.counted { "" } else { " (not in the cost)" }
        );
    }
    Ok(())
}
