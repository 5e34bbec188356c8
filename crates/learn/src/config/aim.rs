//! What an episode may cost, as learning aims at it: a share of the budget, less where costs
//! scatter, to which the aim may come down from what the first episodes cost.

use crate::config::numbers::{Shown, refuse};
use crate::config::{AlgorithmKind, ConstraintStatistic, TrainConfig};
use crate::error::LearnError;

impl TrainConfig {
    /// Most that learning lets an episode cost in the end, for one of the constraints: the same
    /// for every algorithm.
    #[must_use]
    pub fn aim(&self, constraint: usize) -> f64 {
        self.constraints[constraint].budget * self.budget_share
    }

    /// Whether the aim depends on how costs scatter.
    #[must_use]
    pub fn keeps_a_margin(&self) -> bool {
        self.budget_margin > 0.0
            && self.algorithm != AlgorithmKind::PpoSaute
            && self.constraint_statistic == ConstraintStatistic::EpisodeMean
    }

    /// The aim where episodes' costs have a standard deviation.
    fn aim_within(&self, constraint: usize, deviation: f64) -> f64 {
        let (aim, budget) = (self.aim(constraint), self.constraints[constraint].budget);
        if !self.keeps_a_margin() {
            return aim;
        }
        (budget - self.budget_margin * deviation).max(budget / 2.0).min(aim)
    }

    /// The aim when a share of the schedule is over: a straight line from where it starts, which is
    /// never below its end, to its end. `measured` is what the first episodes cost, `deviation` the
    /// standard deviation of what the latest cost.
    #[must_use]
    pub fn aim_after(&self, constraint: usize, done: f64, measured: f64, deviation: f64) -> f64 {
        let last = self.aim_within(constraint, deviation);
        let Some(share) = self.learning.budget_annealing else { return last };
        let start = self.learning.budget_annealing_start.map_or(measured, |factor| factor * last);
        last + (start - last).max(0.0) * (1.0 - done / share).max(0.0)
    }

    /// Refuses an annealing of the budget that no run can have.
    pub(super) fn check_annealing(&self) -> Result<(), LearnError> {
        let refuse = |name: &str, given, allowed: &str| refuse(name, &Shown(given), allowed);
        let learning = &self.learning;
        if let Some(factor) = learning.budget_annealing_start {
            let name = "learning.budget_annealing_start";
            if !(factor.is_finite() && factor >= 1.0) {
                return refuse(name, factor, "a factor of at least 1, or null");
            }
            if learning.budget_annealing.is_none() {
                return refuse(name, factor, "null unless learning.budget_annealing is set");
            }
        }
        let Some(share) = learning.budget_annealing else { return Ok(()) };
        let name = "learning.budget_annealing";
        if !(share > 0.0 && share <= 1.0) {
            return refuse(name, share, "a share above 0 and at most 1, or null");
        }
        if self.algorithm == AlgorithmKind::PpoSaute {
            let allowed = "null for PPOSaute, whose state counts what is left of one fixed budget";
            return refuse(name, share, allowed);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{Constraint, EnvConfig, Preset};

    fn config() -> TrainConfig {
        let mut config =
            TrainConfig::plain(AlgorithmKind::PpoPid, Preset::Quick, EnvConfig::new("test"));
        config.constraints = vec![
            Constraint { term: None, budget: 50.0 },
            Constraint { term: Some("jumps".into()), budget: 10.0 },
        ];
        (config.budget_share, config.budget_margin) = (0.9, 0.0);
        config
    }

    /// By hand: budgets of 50 and 10 with a share of 0.9 are aims of 45 and 9. The first episodes
    /// cost 105 and 4: the first aim falls from 105 to 45 within 0.6 of the schedule, 60 / 0.6 =
    /// 100 a whole schedule; the second, which costs less than its aim, has nothing to come down
    /// from.
    #[test]
    fn aims_fall_in_a_straight_line_to_the_share_of_the_budget() {
        let mut config = config();
        assert_eq!(config.aim_after(0, 0.0, 105.0, 9.0), 45.0, "off by default");
        config.learning.budget_annealing = Some(0.6);
        config.check_annealing().unwrap();
        for (done, expected) in
            [(0.0, 105.0), (0.1, 95.0), (0.3, 75.0), (0.59, 46.0), (0.6, 45.0), (1.0, 45.0)]
        {
            let found = config.aim_after(0, done, 105.0, 9.0);
            assert!((found - expected).abs() < 1e-9, "after {done}: {found}");
            assert_eq!(config.aim_after(1, done, 4.0, 9.0), 9.0);
        }
        // Four times what is aimed at, whatever the first episodes cost.
        config.learning.budget_annealing_start = Some(4.0);
        config.check_annealing().unwrap();
        assert!((config.aim_after(1, 0.3, 999.0, 9.0) - (9.0 + 27.0 / 2.0)).abs() < 1e-9);
    }

    /// By hand, with a share of 0.9, 45 of 50 and 9 of 10: 0.4 deviations of 10 leave 46 of 50, more
    /// than the share; of 20, 42; of 100, less than half. Of 1 they leave 9.6 of 10, of 5, 8.
    #[test]
    fn aims_leave_room_for_how_costs_scatter() {
        let mut config = config();
        assert_eq!(config.aim_after(0, 1.0, 0.0, 100.0), 45.0, "off by default");
        config.budget_margin = 0.4;
        for (constraint, deviation, expected) in [
            (0, 0.0, 45.0),
            (0, 10.0, 45.0),
            (0, 20.0, 42.0),
            (0, 100.0, 25.0),
            (1, 1.0, 9.0),
            (1, 5.0, 8.0),
        ] {
            let found = config.aim_after(constraint, 1.0, 0.0, deviation);
            assert!((found - expected).abs() < 1e-12, "{constraint} {deviation}: {found}");
        }
        config.algorithm = AlgorithmKind::PpoSaute;
        assert_eq!(config.aim_after(0, 1.0, 0.0, 20.0), 45.0);
    }

    #[test]
    fn an_annealing_that_cannot_be_is_refused_by_name() {
        let refuse = |change: fn(&mut TrainConfig), word: &str| {
            let mut config = config();
            config.learning.budget_annealing = Some(0.6);
            change(&mut config);
            let message = config.check().unwrap_err().to_string();
            assert!(message.contains(word) && !message.contains('\n'), "{message}");
        };
        refuse(
            |c| c.learning.budget_annealing = Some(0.0),
            "learning.budget_annealing cannot be 0",
        );
        refuse(|c| c.learning.budget_annealing = Some(1.5), "at most 1");
        refuse(|c| c.learning.budget_annealing_start = Some(0.5), "at least 1");
        refuse(
            |c| {
                c.learning.budget_annealing_start = Some(3.0);
                c.learning.budget_annealing = None;
            },
            "null unless learning.budget_annealing is set",
        );
        refuse(
            |c| {
                c.algorithm = AlgorithmKind::PpoSaute;
                c.constraints.truncate(1);
            },
            "PPOSaute",
        );
    }
}
