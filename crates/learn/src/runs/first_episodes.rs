//! What the first episodes of a run cost: where an annealed budget starts.

use serde::{Deserialize, Serialize};

/// The first episodes of a run under each constraint, one a world that has it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FirstEpisodes {
    /// How many there were so far.
    episodes: Vec<usize>,
    /// Sum of their costs.
    costs: Vec<f64>,
}

impl FirstEpisodes {
    /// Notes an episode's cost under each constraint that it has, until there are `enough` of each.
    pub fn add(&mut self, constrained: &[Option<f64>], enough: &[usize]) {
        self.episodes.resize(constrained.len(), 0);
        self.costs.resize(constrained.len(), 0.0);
        for (index, cost) in constrained.iter().enumerate() {
            if let Some(cost) = cost
                && self.episodes[index] < enough[index]
            {
                self.episodes[index] += 1;
                self.costs[index] += cost;
            }
        }
    }

    /// Their mean cost under a constraint, once there are any.
    #[must_use]
    pub fn mean(&self, constraint: usize) -> Option<f64> {
        let episodes = self.episodes.get(constraint).copied().filter(|count| *count > 0)?;
        Some(self.costs[constraint] / episodes as f64)
    }
}
