//! What a run's selected checkpoint is worth, for the lists and the page of a run.

use super::files::Stamp;
use hasard_report::run::{Config, Constraint, Evaluation, Kept, SHOWN, Selected, read_selected};
use serde_json::{Value, json};
use std::path::Path;

/// Names of the file, the present one first.
const FILES: [&str; 2] = ["selected.json", "hand_out.json"];

/// A run's selection and the file that it was read from, as it was then.
pub(super) struct Stamped {
    stamp: Stamp,
    pub found: Option<Selected>,
}

impl Default for Stamped {
    fn default() -> Stamped {
        Stamped { stamp: Stamp::NONE, found: None }
    }
}

impl Stamped {
    /// Reads it again if the file is another; whether it was.
    pub fn look(&mut self, run: &Path) -> bool {
        let stamp = FILES.iter().find_map(|name| Stamp::of(&run.join(name))).unwrap_or(Stamp::NONE);
        if stamp == self.stamp {
            return false;
        }
        self.stamp = stamp;
        // Of a run that goes on, what it selected before is what there is.
        self.found = read_selected(run, 0.0, &mut Vec::new());
        true
    }
}

/// The selected checkpoint by its closing evaluation; without one, only its frames.
pub(super) fn as_json(selected: &Selected, config: &Config) -> Value {
    let mut row =
        selected.closing.as_ref().map_or_else(|| json!({}), |closing| evaluation(closing, config));
    row["frames"] = json!(selected.frames);
    row["last"] = selected.last.as_ref().map_or(Value::Null, |last| evaluation(last, config));
    row
}

/// Return, the cost of each constraint, and how they stand to the budgets.
fn evaluation(found: &Evaluation, config: &Config) -> Value {
    let of = |metric: &str| {
        found.get(metric).map(|one| json!({ "mean": one.mean, "half": one.half_width }))
    };
    let costs: Vec<Value> = config
        .constraints
        .iter()
        .map(|one| {
            let kept = kept(one.kept_by(found.get(&one.metric())));
            json!({ "name": one.name(), "budget": one.budget, "cost": of(&one.metric()), "kept": kept })
        })
        .collect();
    let all = config
        .constraints
        .iter()
        .map(|one| one.kept_by(found.get(&one.metric())))
        .min()
        .unwrap_or_default();
    json!({ "episodes": found.episodes, "return": of("return_mean"), "costs": costs, "kept": kept(all) })
}

/// The closing evaluation as people are judged who play the task: the whole cost against the task's
/// own budget, whatever the run was trained under; and what that was, in words.
pub(super) fn by_the_task(selected: Option<&Selected>, config: &Config) -> Value {
    let closing = selected.and_then(|one| one.closing.as_ref());
    let cost = closing.and_then(|closing| closing.get("cost_mean"));
    let whole = Constraint { term: None, budget: config.usual_budget(&config.scenario) };
    let within = matches!(whole.kept_by(cost), Kept::ByMean | Kept::Surely);
    json!({
        "cost": cost.map(|one| one.mean), "budget": whole.budget, "within": within,
        "under": under(config),
    })
}

/// The preset and the options that are not the usual ones, in words.
fn under(config: &Config) -> String {
    let named = SHOWN.iter().filter_map(|name| Some((*name, config.options.get(*name)?)));
    let words = named.filter_map(|(name, value)| match (name, value.as_str()) {
        ("rules", "paper") => None,
        ("preset", preset) => Some(preset.to_owned()),
        (name, "true") => Some(name.replace('_', " ")),
        (name, value) => Some(format!("{} {value}", name.replace('_', " "))),
    });
    words.collect::<Vec<_>>().join(", ")
}

/// How costs stand to their budgets, in a word.
fn kept(kept: Kept) -> &'static str {
    match kept {
        Kept::Surely => "surely",
        Kept::ByMean => "mean",
        Kept::Over => "over",
        Kept::Unknown => "unknown",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hasard_report::statistics::Estimate;

    #[test]
    fn a_run_with_a_budget_of_its_own_is_judged_by_the_tasks() {
        let estimate = |mean: f64| Estimate { mean, half_width: Some(1.0), n: 20 };
        let closing = |cost: f64| Evaluation {
            episodes: 20,
            values: vec![("cost_mean".into(), estimate(cost)), ("cost/lava".into(), estimate(1.0))],
            tasks: Vec::new(),
        };
        let judged = |options: &str, cost: f64| {
            let config = format!(
                "{{\"env\":\"VolcanicVentureLevel1-v0\",\"algo\":\"PPOLag\",\"seed\":1,\"preset\":\"quick\",\"rules\":\"paper\"{options}}}"
            );
            let selected =
                Selected { frames: 9.0, closing: Some(closing(cost)), last: None, closed_at: None };
            by_the_task(Some(&selected), &Config::parse(&config).unwrap())
        };
        let said = |within: bool, cost: f64, under: &str| json!({ "cost": cost, "budget": 50.0, "within": within, "under": under });
        assert_eq!(judged("", 40.0), said(true, 40.0, "quick"));
        let wide = judged(",\"safety_budget\":200", 150.0);
        assert_eq!(wide, said(false, 150.0, "quick, safety budget 200"));
        // The whole cost counts, though the run was held to a part of it.
        let term = ",\"constraints\":[{\"term\":\"lava\",\"budget\":2}],\"full_actions\":true";
        assert_eq!(
            judged(term, 60.0),
            said(false, 60.0, "quick, full actions, constraints lava:2")
        );
        assert_eq!(judged(",\"hard\":true", 1.0)["within"], false);
    }
}
