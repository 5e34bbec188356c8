//! Episodes played by a fixed policy.

use crate::{Env, Episode, Policy, PolicyRun};

/// Plays the episode of `seed` to its end.
pub fn rollout(env: &mut Env, policy: &Policy, seed: u64) -> Episode {
    env.reset(seed);
    let mut run = PolicyRun::new(*policy, env.action_space(), seed);
    loop {
        let step = env.make_move(run.next_move()).expect("the policy draws from the environment's own action space");
        if step.ended() {
            return env.episode();
        }
    }
}
