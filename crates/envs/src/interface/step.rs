//! What a step brought, and the named parts of its cost.

/// What a step brought.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Step {
    /// Reward, over all tics of the step.
    pub reward: f64,
    /// Cost, over all tics of the step: the sum of the counted cost terms.
    pub cost: f64,
    /// The episode ended by death, the hard constraint or its goal.
    pub terminated: bool,
    /// The episode ended by time-out.
    pub truncated: bool,
}

impl Step {
    /// Whether the episode is over.
    #[must_use]
    pub const fn ended(&self) -> bool {
        self.terminated || self.truncated
    }
}

/// A named part of the cost.
///
/// The scalar cost is the sum of the counted terms. The others are constraints that the scenario
/// measures beside it, so that each may be given its own budget, without changing the published
/// scalar cost.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct CostTerm {
    /// The name in tables and settings.
    pub name: &'static str,
    /// Part of the scalar cost.
    pub counted: bool,
}
