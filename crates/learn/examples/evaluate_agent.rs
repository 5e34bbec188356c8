//! A trained agent plays 20 episodes, and is judged by its budget: `cargo run --release -p
//! hasard-learn --example evaluate_agent -- zoo/RemedyRushLevel1.agent`, or a run directory.

use hasard_envs::Env;
use hasard_learn::config::EnvConfig;
use hasard_learn::networks::distribution::ActionShape;
use hasard_learn::runs::agent::{Choice, TrainedPolicy, Which, run_config};
use hasard_learn::runs::evaluate::{Evaluation, play};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).ok_or("give a run directory or an agent's file")?;
    // An agent knows the environment that it was trained in.
    let config = run_config(path.as_ref())?;
    let options = config.env.options()?;
    let env = Env::new(&config.env.id, &options)?;
    let action = ActionShape::from(env.action_space());
    let mut warn = |warning: String| eprintln!("{warning}");
    let policy = TrainedPolicy::load(
        path.as_ref(),
        Which::Selected,
        env.observation_shape(),
        action,
        &mut warn,
    )?;
    let make_envs = |env: &EnvConfig, lanes| env.worlds(&options, lanes);
    let seeds: Vec<u64> = (1_000_000..1_000_020).collect();
    let episodes = play(&policy, Choice::Sampled, &make_envs, &seeds, 2)?;
    let judged = Evaluation::of(&episodes, &config.constraints)?;
    println!(
        "{}: return {:.2} ± {:.2}",
        config.env.id, judged.episode_return.mean, judged.episode_return.half_width
    );
    for one in &judged.constraints {
        let (term, within) =
            (one.term.as_deref().unwrap_or("cost"), if one.within() { "within" } else { "over" });
        println!(
            "{term} {:.2} ± {:.2}, {within} the budget of {}",
            one.cost.mean, one.cost.half_width, one.budget
        );
    }
    Ok(())
}
