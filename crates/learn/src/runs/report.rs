//! What a run reports: one row for files, programs and people alike.

use serde_json::{Map, Value, json};

use crate::config::TrainConfig;
use crate::learning::metrics::Means;
use crate::runs::evaluation::Evaluation;
use crate::runs::watch::Watch;

/// A report.
#[derive(Clone, Debug)]
pub struct Report {
    /// Frames learned from.
    pub frames: u64,
    /// Frames of the whole run.
    pub total_frames: u64,
    /// The level of a curriculum's present lesson.
    pub level: Option<u8>,
    /// Updates.
    pub updates: u64,
    /// Kernels that computed it, and on how many threads.
    pub made_with: (&'static str, usize),
    /// Seconds of work.
    pub wall_seconds: f64,
    /// Frames per second since the last report.
    pub frames_per_second: f64,
    /// Episodes so far.
    pub episodes: u64,
    /// Mean return, cost and length of the latest episodes, if there are any.
    pub means: Option<(f64, f64, f64)>,
    /// Smallest and largest return and cost of the latest episodes.
    pub extremes: Option<[f64; 4]>,
    /// Name of each constraint's cost term; `None` for the scalar cost.
    pub terms: Vec<Option<String>>,
    /// Mean cost of each constraint.
    pub constraint_costs: Vec<f64>,
    /// Budget of each constraint.
    pub budgets: Vec<f64>,
    /// Multiplier of each constraint.
    pub multipliers: Vec<f64>,
    /// The evaluation of the policy at this moment, if there was one.
    pub evaluation: Option<Evaluation>,
    /// Frames of all evaluations so far.
    pub evaluated_frames: u64,
    /// Cost of all training episodes so far; nothing in a run whose earlier part did not count it.
    pub cost_total: Option<f64>,
    /// What training episodes cost beyond each budget, added up.
    pub violation_totals: Option<Vec<f64>>,
    /// Losses and other numbers of the updates since the last report.
    pub learning: Vec<(std::borrow::Cow<'static, str>, f64)>,
    /// Cost terms and statistics of the latest episodes.
    pub details: Vec<(String, f64)>,
}

impl Report {
    /// A report of what has come together; the means start anew.
    #[must_use]
    pub fn take(
        config: &TrainConfig,
        watch: &Watch,
        learning: &mut Means,
        multipliers: Vec<f64>,
    ) -> Report {
        let mean = |of: fn(&crate::runs::watch::Finished) -> f64| watch.mean(of);
        let means = match (mean(|e| e.episode_return), mean(|e| e.cost), mean(|e| e.length)) {
            (Some(episode_return), Some(cost), Some(length)) => {
                Some((episode_return, cost, length))
            }
            _ => None,
        };
        let bounds = |of: fn(&crate::runs::watch::Finished) -> f64| {
            let values = watch.recent.iter().map(of);
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                (low.min(value), high.max(value))
            })
        };
        let (returns, costs) = (bounds(|e| e.episode_return), bounds(|e| e.cost));
        let constraint_costs = match means {
            None => Vec::new(),
            Some(_) => (0..config.constraints.len())
                .map(|index| {
                    let own = || watch.recent.iter().filter_map(|e| e.constrained[index]);
                    own().sum::<f64>() / own().count() as f64
                })
                .collect(),
        };
        Report {
            frames: 0,
            total_frames: config.frames,
            level: None,
            updates: 0,
            made_with: ("", config.learning.threads),
            wall_seconds: 0.0,
            frames_per_second: 0.0,
            episodes: watch.episodes,
            means,
            extremes: means.map(|_| [returns.0, returns.1, costs.0, costs.1]),
            terms: config.constraints.iter().map(|constraint| constraint.term.clone()).collect(),
            constraint_costs,
            budgets: config.constraints.iter().map(|constraint| constraint.budget).collect(),
            multipliers,
            evaluation: None,
            evaluated_frames: 0,
            cost_total: watch.totals.as_ref().map(|totals| totals.cost),
            violation_totals: watch.totals.as_ref().map(|totals| totals.violations.clone()),
            learning: learning.take(),
            details: watch.details(),
        }
    }

    /// The row of `metrics.jsonl`. Its keys are stable; what is not known yet is `null`.
    #[must_use]
    pub fn row(&self) -> Value {
        let mut row = Map::new();
        let mut put = |name: &str, value: Value| {
            row.insert(name.into(), value);
        };
        put("frames", json!(self.frames));
        if let Some(level) = self.level {
            put("level", json!(level));
        }
        put("updates", json!(self.updates));
        put("kernels", json!(self.made_with.0));
        put("threads", json!(self.made_with.1));
        put("wall_s", json!(self.wall_seconds));
        put("fps", json!(self.frames_per_second));
        put("episodes", json!(self.episodes));
        put("return_mean", json!(self.means.map(|means| means.0)));
        put("cost_mean", json!(self.means.map(|means| means.1)));
        put("length_mean", json!(self.means.map(|means| means.2)));
        put("return_min", json!(self.extremes.map(|extremes| extremes[0])));
        put("return_max", json!(self.extremes.map(|extremes| extremes[1])));
        put("cost_min", json!(self.extremes.map(|extremes| extremes[2])));
        put("cost_max", json!(self.extremes.map(|extremes| extremes[3])));
        put("cost_total", json!(self.cost_total));
        put("violation_total", json!(self.violation_totals.as_ref().and_then(|all| all.first())));
        put("budget", json!(self.budgets.first()));
        put("multiplier", json!(self.multipliers.first()));
        if self.budgets.len() > 1 {
            put("budgets", json!(self.budgets));
            put("multipliers", json!(self.multipliers));
            put("violation_totals", json!(self.violation_totals));
        }
        // Of a single constraint on the scalar cost, `cost_mean` is the same.
        if self.terms != [None] {
            put("constraint_costs", json!(self.constraint_costs));
        }
        if let Some(evaluation) = &self.evaluation {
            for (name, estimate) in [
                ("return", evaluation.episode_return),
                ("cost", evaluation.cost),
                ("length", evaluation.length),
            ] {
                put(&format!("eval/{name}_mean"), json!(estimate.mean));
                put(&format!("eval/{name}_ci95"), json!(estimate.half_width));
            }
            for (one, term) in
                evaluation.constraints.iter().filter_map(|one| Some((one, one.term.as_ref()?)))
            {
                put(&format!("eval/cost/{term}"), json!(one.cost.mean));
            }
            for one in &evaluation.tasks {
                for (name, estimate) in
                    [("return", one.episode_return), ("cost", one.cost), ("length", one.length)]
                {
                    put(&format!("eval/task/{}/{name}", one.task), json!(estimate.mean));
                }
            }
            put("eval/cost_cvar10", json!(evaluation.tails.cvar));
            put("eval/cost_worst", json!(evaluation.tails.worst));
            put(
                "eval/over_budget",
                json!(evaluation.constraints.first().map(|one| one.tails.over_budget)),
            );
            put("eval/frames", json!(self.evaluated_frames));
            put("eval/episodes", json!(evaluation.episodes));
            put("eval/within_budget", json!(u8::from(evaluation.within())));
        }
        for (name, value) in &self.learning {
            put(name, json!(value));
        }
        for (name, value) in &self.details {
            put(name, json!(value));
        }
        Value::Object(row)
    }
}
