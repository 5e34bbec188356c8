//! Episodes played by a fixed policy.

use crate::error::EnvError;
use crate::interface::batch::Episode;
use crate::policies::policy::{Policy, PolicyRun};
use crate::single::env::Env;

/// Plays the episode of `seed` to its end.
///
/// # Errors
/// When the policy is for another scenario.
pub fn rollout(env: &mut Env, policy: &Policy, seed: u64) -> Result<Episode, EnvError> {
    env.reset(seed);
    let mut run = PolicyRun::new(*policy, env, seed)?;
    loop {
        if env.make_move(run.next_move(env))?.ended() {
            return Ok(env.episode());
        }
    }
}
