//! `hasard eval`, and `rollout --policy run:DIR`: a trained agent at work.

use crate::args::EvalArgs;
use crate::episode_lines::EpisodeLines;
use crate::failure::{Failure, Outcome};
use hasard_envs::{Env, EnvOptions};
use hasard_learn::networks::distribution::ActionShape;
use hasard_learn::runs::evaluate::{Agent, Choice, Which, run_config};
use std::path::Path;

/// Runs the command.
pub fn run(args: &EvalArgs) -> Outcome {
    let config = run_config(&args.run).map_err(Failure::bad)?;
    let mut lines = EpisodeLines::new(args.json);
    if let Some(constraint) = config.constraints.first() {
        lines.set_budget(constraint.budget);
    }
    let options = crate::settings::trained_options(&config.env)?;
    let player = Player {
        run: &args.run,
        which: if args.best { Which::Best } else { Which::Latest },
        choice: if args.greedy { Choice::Greedy } else { Choice::Sampled },
    };
    player.play(&config.env.id, &options, args.episodes, args.seed, &mut lines)?;
    lines.summary(true)
}

/// Which agent acts, and how.
pub struct Player<'a> {
    /// Its run directory.
    pub run: &'a Path,
    /// Which of its checkpoints.
    pub which: Which,
    /// How it chooses.
    pub choice: Choice,
}

impl Player<'_> {
    /// The agent, for one world like this one.
    pub fn agent(&self, env: &Env) -> Result<Agent, Failure> {
        let space = env.action_space();
        let action = ActionShape { sizes: space.sizes(), deltas: space.deltas.len() };
        let mut warn = |text: String| eprintln!("hasard: {text}");
        Agent::load(self.run, self.which, self.choice, 1, env.observation_shape(), action, &mut warn).map_err(Failure::bad)
    }

    /// Plays episodes seeded `seed`, `seed + 1`, ... and prints them.
    pub fn play(&self, id: &str, options: &EnvOptions, episodes: u32, seed: u64, lines: &mut EpisodeLines) -> Outcome {
        let mut env = Env::new(id, options).map_err(Failure::bad)?;
        let mut agent = self.agent(&env)?;
        let mut observation = vec![0; env.observation_shape().iter().product()];
        for i in 0..u64::from(episodes) {
            let seed = seed.wrapping_add(i);
            env.reset(seed);
            agent.reset(0, seed);
            loop {
                env.observe(&mut observation);
                let action = agent.act(&observation).swap_remove(0);
                let step = env.step(&action.actions, &action.deltas).map_err(Failure::bad)?;
                agent.observe_cost(0, step.cost);
                if step.ended() {
                    break;
                }
            }
            lines.episode(id, i, &env.episode())?;
        }
        Ok(())
    }
}
