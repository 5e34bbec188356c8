//! Episodes played by a fixed policy.

use crate::{Env, Episode, Move, Policy, PolicyRun};

/// Plays the episode of `seed` to its end.
pub fn rollout(env: &mut Env, policy: &Policy, seed: u64) -> Episode {
    env.reset(seed);
    let mut run = PolicyRun::new(*policy, env.action_space(), seed);
    loop {
        let step = match run.next_move() {
            Move::Action(actions, deltas) => env.step(actions, deltas),
            Move::Buttons(command) => env.step_buttons(command),
        };
        if step.ended() {
            return env.episode();
        }
    }
}
