//! What a mean hides: how episodes spread, and the worst of them.

use serde::{Deserialize, Serialize};

use crate::statistics::bootstrap::quantile;

/// Share of the episodes that the worst are: the costs of a constraint on tails are theirs.
const WORST: f64 = 0.1;

/// How the costs of episodes spread.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize, Deserialize)]
pub struct Tails {
    /// Half of the episodes cost no more.
    pub median: f64,
    /// Nine tenths of the episodes cost no more.
    pub ninety: f64,
    /// The most costly episode.
    pub worst: f64,
    /// Conditional value at risk: mean cost of the worst tenth of the episodes.
    pub cvar: f64,
    /// Share of the episodes that cost more than the budget, if there is one.
    pub over_budget: Option<f64>,
}

/// How costs spread; all 0 for none. The conditional value at risk counts the episode at the
/// tenth's edge in part where a tenth is no whole number (Rockafellar and Uryasev 2002,
/// equation 30), so that it does not jump with the number of episodes.
#[must_use]
pub fn tails(costs: impl IntoIterator<Item = f64>, budget: Option<f64>) -> Tails {
    let mut sorted: Vec<f64> = costs.into_iter().collect();
    sorted.sort_by(f64::total_cmp);
    let Some(&worst) = sorted.last() else {
        return Tails { over_budget: budget.map(|_| 0.0), ..Tails::default() };
    };
    let count = sorted.len() as f64;
    let over = |budget: f64| sorted.iter().filter(|&&cost| cost > budget).count() as f64 / count;
    let mut left = WORST * count;
    let mut sum = 0.0;
    for cost in sorted.iter().rev() {
        let weight = left.min(1.0);
        sum += weight * cost;
        left -= weight;
        if left <= 0.0 {
            break;
        }
    }
    Tails {
        median: quantile(&sorted, 0.5),
        ninety: quantile(&sorted, 0.9),
        worst,
        cvar: sum / (WORST * count),
        over_budget: budget.map(over),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: of the costs 1 to 25, a tenth is two episodes and a half: (25 + 24 + 23 / 2)
    /// / 2.5 = 24.2. `numpy.quantile` gives 13 and 22.6. Six of 25 exceed 19.
    #[test]
    fn tails_are_those_worked_out_by_hand() {
        let costs = (1..=25).rev().map(f64::from);
        let own = tails(costs.clone(), Some(19.0));
        assert_eq!((own.median, own.worst, own.over_budget), (13.0, 25.0, Some(0.24)));
        assert!((own.ninety - 22.6).abs() < 1e-12 && (own.cvar - 24.2).abs() < 1e-12, "{own:?}");
        assert_eq!(tails(costs, None).over_budget, None);
        // Fewer than ten episodes: the worst tenth is a part of the worst.
        assert_eq!(
            tails([3.0, 8.0], Some(8.0)),
            Tails { median: 5.5, ninety: 7.5, worst: 8.0, cvar: 8.0, over_budget: Some(0.0) }
        );
        assert_eq!(tails([], Some(1.0)), Tails { over_budget: Some(0.0), ..Tails::default() });
    }
}
