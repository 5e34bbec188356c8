//! How networks learn from a rollout: advantages, normalisers, the optimiser, and the learner that algorithms steer.

pub mod advantage;
pub mod learner;
pub mod metrics;
pub mod normaliser;
pub mod optimiser;
