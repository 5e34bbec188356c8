//! What the learner is rewarded with, where that is not the plain reward. Reported returns and
//! costs are always the plain ones.

/// How rewards are shaped before learning; each algorithm that shapes them has its own.
pub trait Shaping: Send + Sync {
    /// Numbers that join the network's input.
    fn extra_inputs(&self) -> usize {
        0
    }

    /// The shaped reward of a step, and the safety state after it from that before it (1 at an
    /// episode's start).
    fn step(&self, safety: f64, reward: f32, _cost: f32) -> (f32, f64) {
        (reward, safety)
    }
}

/// No shaping at all.
pub struct Plain;

impl Shaping for Plain {}

/// What the network sees of a safety state, in the bounds of all its inputs.
#[must_use]
pub fn seen(safety: f64) -> f32 {
    safety.clamp(-5.0, 5.0) as f32
}
