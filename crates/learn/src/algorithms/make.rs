//! The algorithm that a run's settings name, and what it is rewarded with.

use std::sync::Arc;

use crate::algorithms::algorithm::Algorithm;
use crate::algorithms::{
    cpo, cup, focops, ipo, p3o, ppo, ppo_cost, ppo_lag, ppo_pid, ppo_saute, trpo, trpo_lag,
    trpo_pid,
};
use crate::config::{AlgorithmKind, TrainConfig};
use crate::sampling::shaping::{Plain, Shaping};

/// The algorithm of a run.
#[must_use]
pub fn make(config: &TrainConfig) -> Box<dyn Algorithm> {
    use AlgorithmKind as Kind;
    match config.algorithm {
        Kind::Ppo | Kind::PpoCost | Kind::PpoSaute => Box::new(ppo::Ppo::new(config)),
        Kind::PpoLag => Box::new(ppo_lag::PpoLag::new(config)),
        Kind::PpoPid => Box::new(ppo_pid::new(config)),
        Kind::P3o => Box::new(p3o::P3o::new(config)),
        Kind::Focops => Box::new(focops::Focops::new(config)),
        Kind::Cup => Box::new(cup::Cup::new(config)),
        Kind::Ipo => Box::new(ipo::Ipo::new(config)),
        Kind::Trpo => Box::new(trpo::Trpo::new(config)),
        Kind::TrpoLag => Box::new(trpo_lag::TrpoLag::new(config)),
        Kind::TrpoPid => Box::new(trpo_pid::new(config)),
        Kind::Cpo => Box::new(cpo::Cpo::new(config)),
    }
}

/// How the rewards of a run are shaped.
#[must_use]
pub fn shaping(config: &TrainConfig) -> Arc<dyn Shaping> {
    match config.algorithm {
        AlgorithmKind::PpoCost => Arc::new(ppo_cost::Penalty::new(config)),
        AlgorithmKind::PpoSaute => Arc::new(ppo_saute::Saute::new(config)),
        _ => Arc::new(Plain),
    }
}
