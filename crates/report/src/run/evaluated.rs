//! What a run's agent is worth in episodes that training has not seen.

use super::{Constraint, EpisodeResult, Run};
use crate::statistics::Estimate;

impl Run {
    /// A metric (named as in reports) over the episodes of the selected checkpoint: of the closing
    /// evaluation, or of `hasard eval` where its episodes lie in the directory. `None` for a run
    /// that was not evaluated.
    #[must_use]
    pub fn evaluated(&self, metric: &str) -> Option<Estimate> {
        let of = |episode: &EpisodeResult| match metric {
            "return_mean" => Some(episode.episode_return),
            "cost_mean" => Some(episode.cost),
            "length_mean" => episode.length,
            _ => {
                let term = metric.strip_prefix("cost/")?;
                episode.costs.iter().find(|(name, _)| name == term).map(|(_, cost)| *cost)
            }
        };
        // The run's own word comes first: its intervals are made for skewed costs.
        let closing =
            self.selected.as_ref().and_then(|selected| selected.closing.as_ref()?.get(metric));
        let said = || self.summary.as_ref()?.get(metric);
        closing.or_else(said).or_else(|| {
            Estimate::of(&self.evaluation.iter().map(of).collect::<Option<Vec<f64>>>()?)
        })
    }

    /// Number of episodes behind [`Run::evaluated`].
    #[must_use]
    pub fn evaluated_episodes(&self) -> usize {
        let closing =
            self.selected.as_ref().and_then(|selected| Some(selected.closing.as_ref()?.episodes));
        closing.unwrap_or(self.evaluation.len())
    }

    /// The costs of the evaluated episodes under a constraint; empty where single episodes were not
    /// kept.
    #[must_use]
    pub fn episode_costs(&self, constraint: &Constraint) -> Vec<f64> {
        self.evaluation.iter().filter_map(|episode| episode.cost_of(constraint)).collect()
    }
}
