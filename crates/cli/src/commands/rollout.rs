//! `hasard rollout`: episodes of a policy.

use crate::args::{RolloutArgs, Size};
use crate::failure::{Failure, Outcome};
use crate::{episode_lines, settings};
use hasard_envs::{Env, Policy, rollout};

/// Runs the command.
pub fn run(args: &RolloutArgs) -> Outcome {
    // A fixed policy looks at nothing, so nothing is drawn and the size does not matter.
    let options = settings::env_options(&args.env_args, Size::LEARNER)?;
    let mut lines = episode_lines::EpisodeLines::new(args.json);
    let policy: Policy = args.policy.parse().map_err(Failure::bad)?;
    let mut env = Env::new(&args.env, &options).map_err(Failure::bad)?;
    for i in 0..args.episodes {
        let episode = rollout(&mut env, &policy, args.seed.wrapping_add(u64::from(i)));
        lines.episode(&env.id().to_string(), u64::from(i), &episode)?;
    }
    lines.summary(false)
}
