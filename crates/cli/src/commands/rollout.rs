//! `hasard rollout`: episodes of a policy.

use super::eval::Player;
use crate::actor::agent_options;
use crate::args::{RolloutArgs, Size};
use crate::failure::{Failure, Outcome};
use crate::{episode_lines, settings};
use hasard_envs::{Env, EnvOptions, rollout};
use hasard_learn::runs::agent::{Choice, Which};

/// Runs the command.
pub fn run(args: &RolloutArgs) -> Outcome {
    settings::last_seed(args.seed, args.episodes)?;
    // A fixed policy looks at nothing, so nothing is drawn and the size does not matter.
    let options = settings::observed(
        settings::env_options(&args.env_args, Size::LEARNER)?,
        &args.observation,
    );
    // The task that was named, whatever file of that name an agent was trained on.
    let scenario = settings::env_id(&args.env)?.scenario;
    settings::warn_of_task(scenario);
    let options = EnvOptions { scenario: Some(scenario), test_seeds: args.test_seeds, ..options };
    let mut lines = episode_lines::EpisodeLines::new(args.json);
    if let Some(run) = crate::actor::agent_of(&args.policy)? {
        let options = agent_options(&args.env, &run, &options, args.env_args.elsewhere())?;
        lines.played_under(&options);
        let player = Player { run: &run, which: Which::Selected, choice: Choice::Sampled };
        player.play(&args.env, &options, args.episodes, args.seed, &mut lines)?;
        return lines.summary(false);
    }
    lines.played_under(&options);
    let policy = settings::policy(&args.policy)?;
    let mut env = Env::new(&args.env, &options).map_err(Failure::bad)?;
    for i in 0..args.episodes {
        let episode = rollout(&mut env, &policy, args.seed + u64::from(i)).map_err(Failure::bad)?;
        lines.episode(&env.id().to_string(), u64::from(i), episode)?;
    }
    lines.summary(false)
}
