//! One environment, one episode of random actions: `cargo run --release -p hasard-envs --example
//! one_env`.

use hasard_envs::{Env, EnvOptions, Rng};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut env = Env::new("VolcanicVentureLevel1-v0", &EnvOptions::default())?;
    let space = env.action_space().clone();
    println!("observation {:?}, sub-actions {:?}", env.observation_shape(), space.sizes());
    let mut observation = vec![0; env.observation_shape().iter().product()];
    // One choice of each group of buttons; 0 is none of them.
    let mut action = vec![0; space.groups.len()];
    let mut random = Rng::new(7);
    env.reset(1);
    loop {
        env.observe(&mut observation);
        space.sample(&mut random, &mut action, &mut []);
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
