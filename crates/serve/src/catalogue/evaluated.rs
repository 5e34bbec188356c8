//! What a run's selected checkpoint is worth, for the lists and the page of a run.

use super::files::Stamp;
use hasard_report::run::{Config, Evaluation, Kept, Selected, read_selected};
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

/// How costs stand to their budgets, in a word.
fn kept(kept: Kept) -> &'static str {
    match kept {
        Kept::Surely => "surely",
        Kept::ByMean => "mean",
        Kept::Over => "over",
        Kept::Unknown => "unknown",
    }
}
