//! PPOPID: PPO with multipliers moved by PID controllers (Stooke et al. 2020, arXiv 2007.03964).
//!
//! As PPOLag, but the multiplier also reacts to the excess itself and to its rise.

use crate::algorithms::multiplier::Pid;
use crate::algorithms::ppo_lag::PpoLag;
use crate::config::TrainConfig;

/// PPOPID with a run's settings.
#[must_use]
pub fn new(config: &TrainConfig) -> PpoLag {
    PpoLag::moved_by(Pid::all(&config.algorithm_settings, config.constraints.len()), config)
}
