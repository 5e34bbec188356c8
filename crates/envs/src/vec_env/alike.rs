//! Whether the environments of a batch have the same shapes.

use crate::{EnvError, Environment};

/// Whether a lane's environment fits into a batch with the first one's.
pub(super) fn alike(
    first: &dyn Environment,
    env: &dyn Environment,
    lane: usize,
) -> Result<(), EnvError> {
    let unlike = |what| Err(EnvError::Unlike { lane, what });
    if env.action_space().groups.is_empty() && env.action_space().deltas.is_empty() {
        unlike("action space (which may not be empty)")
    } else if env.action_space() != first.action_space() {
        unlike("action space")
    } else if env.observation_shape() != first.observation_shape() {
        unlike("observation shape")
    } else if env.cost_terms() != first.cost_terms() {
        unlike("cost terms")
    } else if env.stat_names() != first.stat_names() {
        unlike("statistics")
    } else {
        Ok(())
    }
}
