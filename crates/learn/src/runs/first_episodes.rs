//! What the first episodes of a run cost: where an annealed budget starts.

use serde::{Deserialize, Serialize};

/// The first episodes of a run, one a world.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FirstEpisodes {
    /// How many there were so far.
    episodes: usize,
    /// Sum of their costs under each constraint.
    costs: Vec<f64>,
}

impl FirstEpisodes {
    /// Notes an episode's cost under each constraint, until there are `enough`.
    pub fn add(&mut self, constrained: &[f64], enough: usize) {
        if self.episodes < enough {
            self.episodes += 1;
            self.costs.resize(constrained.len(), 0.0);
            self.costs.iter_mut().zip(constrained).for_each(|(sum, cost)| *sum += cost);
        }
    }

    /// Their mean cost under a constraint, once there are any.
    #[must_use]
    pub fn mean(&self, constraint: usize) -> Option<f64> {
        self.costs.get(constraint).map(|sum| sum / self.episodes as f64)
    }
}
