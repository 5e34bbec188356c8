//! The feasible score: what a seed's return is worth if it keeps its budgets.

/// A return on the scale where a random policy scores 0 and PPO, which ignores costs, scores 1;
/// `None` where the two are equal, so that there is no scale.
#[must_use]
pub fn normalised(episode_return: f64, random: f64, ppo: f64) -> Option<f64> {
    (ppo != random).then(|| (episode_return - random) / (ppo - random))
}

/// The largest of several costs, each divided by its budget: 1 at the budget. Each pair is an upper
/// end of a cost's interval and its budget; with a budget of 0 any cost at all is infinitely far
/// above.
#[must_use]
pub fn cost_ratio(costs: &[(f64, f64)]) -> f64 {
    let factor = |&(cost, budget): &(f64, f64)| {
        if cost <= budget { (cost / budget).min(1.0) } else { cost / budget }
    };
    costs.iter().map(factor).filter(|factor| !factor.is_nan()).fold(0.0, f64::max)
}

/// Feasible score of a normalised return, hard and soft: hard, 0 if a cost's upper end is above its
/// budget; soft, divided by that ratio where it is above 1. Within the budget a return below random
/// play's scores below 0. Such a return is not divided, lest a breach improve it.
#[must_use]
pub fn feasible_scores(normalised: f64, costs: &[(f64, f64)]) -> (f64, f64) {
    let ratio = cost_ratio(costs);
    let soft = if normalised > 0.0 { normalised / ratio.max(1.0) } else { normalised };
    (if ratio <= 1.0 { normalised } else { 0.0 }, soft)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_breach_costs_the_score_or_its_share() {
        // Random 4, PPO 24: a return of 19 is three quarters of the way.
        let score = normalised(19.0, 4.0, 24.0).unwrap();
        assert_eq!((score, normalised(1.0, 2.0, 2.0)), (0.75, None));
        assert_eq!(feasible_scores(score, &[(50.0, 50.0)]), (0.75, 0.75));
        assert_eq!(feasible_scores(score, &[(75.0, 50.0), (1.0, 5.0)]), (0.0, 0.5));
        assert_eq!(feasible_scores(score, &[(0.0, 0.0)]), (0.75, 0.75));
        assert_eq!(feasible_scores(score, &[(0.1, 0.0)]), (0.0, 0.0));
        assert_eq!(feasible_scores(-0.5, &[(1.0, 5.0)]), (-0.5, -0.5));
        assert_eq!(feasible_scores(-0.5, &[(10.0, 5.0)]), (0.0, -0.5));
    }
}
