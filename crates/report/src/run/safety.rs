//! How safe a run was while it learned.

use super::{Kept, Row, Run};
use crate::statistics::Estimate;

impl Run {
    /// Costs of all training episodes together, or what of them was above the budgets, from the
    /// last report that has the sum: `cost_total`, `violation_total`.
    #[must_use]
    pub fn total(&self, name: &str) -> Option<f64> {
        self.rows.iter().rev().find_map(|row| row.get(name))
    }

    /// Frames of the first report whose mean costs are within all budgets, and the share of the
    /// frames after it that reports within the budgets closed; the share is `None` if nothing
    /// followed.
    #[must_use]
    pub fn time_within(&self) -> Option<(f64, Option<f64>)> {
        let within = |row: &Row| {
            let kept =
                |cost: Option<f64>| cost.map(|mean| Estimate { mean, half_width: None, n: 1 });
            let all =
                self.config.constraints.iter().map(|one| one.kept_by(kept(row.get(&one.metric()))));
            all.min().unwrap_or_default()
        };
        let judged: Vec<(f64, Kept)> =
            self.rows.iter().map(|row| (row.frames, within(row))).collect();
        let judged: Vec<(f64, Kept)> =
            judged.into_iter().filter(|(_, kept)| *kept != Kept::Unknown).collect();
        let first = judged.iter().position(|(_, kept)| *kept >= Kept::ByMean)?;
        let (from, to) = (judged[first].0, judged[judged.len() - 1].0);
        let good: f64 = judged[first..]
            .windows(2)
            .filter(|pair| pair[1].1 >= Kept::ByMean)
            .map(|pair| pair[1].0 - pair[0].0)
            .sum();
        Some((from, (to > from).then(|| good / (to - from))))
    }
}

#[cfg(test)]
mod tests {
    use super::super::Config;
    use super::*;

    #[test]
    fn time_within_the_budget_is_counted_from_the_first_report_within() {
        let run = |costs: &[(f64, f64)]| {
            let config =
                Config::parse("{\"env\":\"RemedyRushLevel1-v0\",\"algo\":\"PPOLag\",\"seed\":1}")
                    .unwrap();
            let rows = costs
                .iter()
                .map(|&(frames, cost)| Row::new(frames, vec![("cost_mean".into(), cost)]))
                .collect();
            Run {
                path: "x".into(),
                config,
                rows,
                evaluation: vec![],
                summary: None,
                selected: None,
                calibration: vec![],
                heatmaps: vec![],
            }
        };
        // Over until 200, within to 400, over to 500: two thirds of the 300 frames after.
        let learner = run(&[(100.0, 9.0), (200.0, 5.0), (300.0, 4.0), (400.0, 4.9), (500.0, 5.1)]);
        let (from, share) = learner.time_within().unwrap();
        assert!(from == 200.0 && (share.unwrap() - 2.0 / 3.0).abs() < 1e-12, "{from} {share:?}");
        assert_eq!(run(&[(100.0, 9.0)]).time_within(), None);
        assert_eq!(run(&[(100.0, 2.0)]).time_within(), Some((100.0, None)));
        assert_eq!(learner.total("cost_total"), None);
    }
}
