//! A run on several tasks, task by task: a table of one environment has what the agent came to there.

use super::config::scenario_and_level;
use super::{Constraint, Evaluation, Row, Run};

/// The option that says which tasks a run was trained on together.
const TOGETHER: &str = "tasks";

impl Run {
    /// The run as it is, or once for each of its several tasks: what is measured over all of them
    /// gives way to what is measured in the task. Frames are those of the whole run.
    #[must_use]
    pub fn by_task(self) -> Vec<Run> {
        if !self.config.env.contains(',') {
            return vec![self];
        }
        let mut tasks: Vec<&str> = Vec::new();
        for task in self.config.env.split(',').map(str::trim) {
            if !tasks.contains(&task) {
                tasks.push(task);
            }
        }
        tasks.into_iter().map(|task| self.of_task(task)).collect()
    }

    fn of_task(&self, task: &str) -> Run {
        let mut config = self.config.clone();
        (config.scenario, config.level) = scenario_and_level(task);
        config.env = task.to_owned();
        config.file = config.own.file(&config.scenario).map(String::from);
        let names: Vec<&str> =
            self.config.env.split(',').map(|id| id.trim().trim_end_matches("-v0")).collect();
        config.options.insert(TOGETHER.into(), names.join(" + "));
        config.options.remove("constraints");
        let usual = config.usual_budget(&config.scenario);
        let own = self.config.constraints.iter().find(|one| one.term.as_deref() == Some(task));
        let for_all = self.config.constraints.iter().find(|one| one.term.is_none());
        config.safety_budget = own.or(for_all).map_or(usual, |one| one.budget);
        config.constraints = vec![Constraint { term: None, budget: config.safety_budget }];
        if config.safety_budget == usual {
            config.options.remove("safety_budget");
        } else {
            config.options.insert("safety_budget".into(), config.safety_budget.to_string());
        }
        let place =
            self.config.constraints.iter().position(|one| one.term.as_deref() == Some(task));
        let rows = self.rows.iter().map(|row| row_of(row, task, place)).collect();
        let evaluation = self.evaluation.iter().filter(|one| one.env == task).cloned().collect();
        let mut selected = self.selected.clone();
        if let Some(selected) = &mut selected {
            for part in [&mut selected.closing, &mut selected.last] {
                *part = part.as_ref().and_then(|whole| Evaluation::of_task(whole, task));
            }
        }
        Run {
            path: self.path.clone(),
            config,
            rows,
            evaluation,
            summary: self.summary.as_ref().and_then(|whole| whole.of_task(task)),
            selected,
            calibration: Vec::new(),
            heatmaps: Vec::new(),
        }
    }
}

/// A row with a task's numbers in place of those over all tasks; `constraint` is the place of the
/// task's own among the constraints.
fn row_of(row: &Row, task: &str, constraint: Option<usize>) -> Row {
    const OVER_ALL: [&str; 11] = [
        "return_mean",
        "cost_mean",
        "length_mean",
        "return_min",
        "return_max",
        "cost_min",
        "cost_max",
        "cost_total",
        "violation_total",
        "budget",
        "multiplier",
    ];
    let of_all = |name: &str| OVER_ALL.contains(&name) || name.starts_with("eval/");
    let mut values: Vec<(String, f64)> = row
        .values()
        .iter()
        .filter(|(name, _)| !of_all(name) && !name.starts_with("task/"))
        .cloned()
        .collect();
    for measured in ["return", "cost", "length"] {
        for (from, to) in [("task/", ""), ("eval/task/", "eval/")] {
            if let Some(value) = row.get(&format!("{from}{task}/{measured}")) {
                values.push((format!("{to}{measured}_mean"), value));
            }
        }
    }
    for (from, to) in [
        ("budgets", "budget"),
        ("multipliers", "multiplier"),
        ("violation_totals", "violation_total"),
    ] {
        if let Some(value) = constraint.and_then(|at| row.get(&format!("{from}.{at}"))) {
            values.push((to.to_owned(), value));
        }
    }
    Row::new(row.frames, values)
}

#[cfg(test)]
mod tests {
    use super::super::{Config, EpisodeResult, Selected};
    use super::*;
    use crate::statistics::Estimate;

    const BOTH: &str = "RemedyRushLevel1-v0,VolcanicVentureLevel1-v0";

    fn both() -> Run {
        let text = format!(
            r#"{{"env":{{"id":"{BOTH}"}},"algorithm":"PPOPID","seed":3,"frames":100,"constraints":[
            {{"term":"RemedyRushLevel1-v0","budget":5.0}},{{"term":"VolcanicVentureLevel1-v0","budget":50.0}}]}}"#
        );
        let row = [
            ("return_mean", 20.0),
            ("cost_mean", 30.0),
            ("task/RemedyRushLevel1-v0/return", 12.0),
            ("task/RemedyRushLevel1-v0/cost", 4.0),
            ("task/VolcanicVentureLevel1-v0/return", 28.0),
            ("task/VolcanicVentureLevel1-v0/cost", 56.0),
            ("violation_totals.0", 7.0),
            ("violation_totals.1", 900.0),
            ("fps", 1000.0),
        ];
        let episode = |env: &str, cost: f64| EpisodeResult {
            env: env.into(),
            episode_return: 1.0,
            cost,
            costs: vec![],
            stats: vec![],
            rules: None,
            hard: None,
            full_actions: false,
            frame_skip: crate::run::FRAME_SKIP,
            maps: false,
            early_creatures: false,
            length: Some(525.0),
            seed: None,
        };
        let mean = |mean: f64| Estimate { mean, half_width: Some(1.0), n: 2 };
        let part = |cost: f64| Evaluation {
            episodes: 2,
            values: vec![("cost_mean".into(), mean(cost))],
            tasks: vec![],
        };
        let closing = Evaluation {
            tasks: vec![
                ("RemedyRushLevel1-v0".into(), part(4.5)),
                ("VolcanicVentureLevel1-v0".into(), part(55.0)),
            ],
            ..part(30.0)
        };
        Run {
            path: "runs/both".into(),
            config: Config::parse(&text).unwrap(),
            rows: vec![Row::new(100.0, row.map(|(name, value)| (name.to_owned(), value)).into())],
            evaluation: vec![
                episode("RemedyRushLevel1-v0", 4.0),
                episode("VolcanicVentureLevel1-v0", 60.0),
            ],
            summary: None,
            selected: Some(Selected {
                frames: 100.0,
                closing: Some(closing),
                last: None,
                closed_at: None,
            }),
            calibration: vec![],
            heatmaps: vec![],
        }
    }

    #[test]
    fn each_task_has_its_own_numbers_and_its_own_budget() {
        let runs = both().by_task();
        let ids: Vec<&str> = runs.iter().map(|run| run.config.env.as_str()).collect();
        assert_eq!(ids, BOTH.split(',').collect::<Vec<_>>());
        for (run, budget, cost, violation, closing) in
            [(&runs[0], 5.0, 4.0, 7.0, 4.5), (&runs[1], 50.0, 56.0, 900.0, 55.0)]
        {
            assert_eq!((run.config.budget(), run.config.level), (Some(budget), 1));
            assert_eq!(run.final_mean("cost_mean"), Some(cost));
            assert_eq!(run.total("violation_total"), Some(violation));
            assert_eq!(run.rows[0].get("fps"), Some(1000.0));
            assert_eq!(run.evaluation.len(), 1);
            assert_eq!(run.evaluated("cost_mean").unwrap().mean, closing);
            let tasks = &run.config.options["tasks"];
            assert_eq!(tasks, "RemedyRushLevel1 + VolcanicVentureLevel1");
            assert!(!run.config.options.contains_key("constraints"));
        }
    }

    #[test]
    fn a_run_of_one_task_is_what_it_was() {
        let mut run = both();
        run.config.env = "RemedyRushLevel1-v0".into();
        let same = run.clone().by_task();
        assert_eq!(same.len(), 1);
        assert_eq!((&same[0].rows, &same[0].config), (&run.rows, &run.config));
    }
}
