//! How experience is gathered: worlds, the policy that acts in them, and what is handed to the
//! learner.

pub mod auxiliary;
pub mod gather;
pub mod privileged;
pub mod rollout;
pub mod rollout_memory;
pub mod sampler;
pub mod shaping;
pub mod shared_rollout;
