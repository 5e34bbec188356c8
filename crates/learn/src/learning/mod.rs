//! How networks learn from a rollout: advantages, normalisers, losses and their gradients, the
//! optimiser, and the learner that algorithms steer.

pub mod advantage;
mod auxiliary;
pub mod dual_number;
pub mod epochs;
mod gather;
pub mod learner;
pub mod loss;
pub mod metrics;
pub mod minibatch;
mod muon;
pub mod normaliser;
pub mod optimiser;
pub mod policy;
pub mod popart;
pub mod targets;
