//! `hasard eval`, and `rollout --policy run:DIR`: a trained agent at work.

use crate::args::EvalArgs;
use crate::episode_lines::EpisodeLines;
use crate::failure::{Failure, Outcome};
use crate::zoo;
use hasard_envs::{Env, EnvOptions, VecEnv};
use hasard_learn::networks::distribution::ActionShape;
use hasard_learn::runs::agent::{Agent, Choice, TrainedPolicy, Which, run_config};
use hasard_learn::runs::evaluate::play;
use std::path::Path;

/// Episodes that are played before they are printed.
const AT_ONCE: u32 = 256;

/// Runs the command.
pub fn run(args: &EvalArgs) -> Outcome {
    let run = zoo::find(&args.run)?;
    let config = run_config(&run).map_err(Failure::bad)?;
    let mut lines = EpisodeLines::new(args.json);
    lines.hold_against(&config.constraints);
    let options = crate::settings::trained_options(&config.env, args.places.elsewhere())?;
    let player = Player {
        run: &run,
        which: if args.latest { Which::Latest } else { Which::HandedOut },
        choice: if args.greedy { Choice::Greedy } else { Choice::Sampled },
    };
    player.play(&config.env.id, &options, args.episodes, args.seed, &mut lines)?;
    lines.summary(true)
}

/// Which agent acts, and how.
pub struct Player<'a> {
    /// Its run directory, or its file.
    pub run: &'a Path,
    /// Which of its checkpoints.
    pub which: Which,
    /// How it chooses.
    pub choice: Choice,
}

impl Player<'_> {
    /// Its policy, for worlds like this one.
    fn policy(&self, env: &Env) -> Result<TrainedPolicy, Failure> {
        let space = env.action_space();
        let action = ActionShape { sizes: space.sizes(), deltas: space.deltas.len() };
        let mut warn = |text: String| note!("hasard: {text}");
        TrainedPolicy::load(self.run, self.which, env.observation_shape(), action, &mut warn).map_err(Failure::bad)
    }

    /// The agent, for one world like this one.
    pub fn agent(&self, env: &Env) -> Result<Agent, Failure> {
        Ok(self.policy(env)?.agent(self.choice, 1))
    }

    /// Plays episodes seeded `seed`, `seed + 1`, ... on all cores and prints them in order.
    pub fn play(&self, id: &str, options: &EnvOptions, episodes: u32, seed: u64, lines: &mut EpisodeLines) -> Outcome {
        let env = Env::new(id, options).map_err(Failure::bad)?;
        let policy = self.policy(&env)?;
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let numbers: Vec<u32> = (0..episodes).collect();
        for some in numbers.chunks(AT_ONCE as usize) {
            let seeds: Vec<u64> = some.iter().map(|&number| seed.wrapping_add(number.into())).collect();
            let make = |_: &_, worlds| VecEnv::new(id, options, worlds);
            let played = play(&policy, self.choice, &make, &seeds, threads).map_err(Failure::bad)?;
            for (&number, episode) in some.iter().zip(played) {
                lines.episode(id, number.into(), episode)?;
            }
        }
        Ok(())
    }
}
