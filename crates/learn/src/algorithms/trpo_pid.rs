//! TRPOPID: TRPO with multipliers moved by PID controllers (Stooke et al. 2020, arXiv 2007.03964).

use crate::algorithms::multiplier::Pid;
use crate::algorithms::trpo_lag::TrpoLag;
use crate::config::TrainConfig;

/// TRPOPID with a run's settings.
#[must_use]
pub fn new(config: &TrainConfig) -> TrpoLag {
    TrpoLag::moved_by(Pid::all(&config.algorithm_settings, config.constraints.len()), config)
}
