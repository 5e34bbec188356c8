//! Which checkpoint a run selected, and the evaluation that closed the run.

use super::Warning;
use crate::statistics::Estimate;
use serde_json::Value;
use std::path::Path;

/// Names of the file, the present one first.
const FILES: [&str; 2] = ["selected.json", "hand_out.json"];

/// The checkpoint that a run selected.
#[derive(Clone, PartialEq, Debug)]
pub struct Selected {
    /// Frames after which it was taken.
    pub frames: f64,
    /// Episodes played when the run was over.
    pub closing: Option<Evaluation>,
    /// The same of the run's last policy.
    pub last: Option<Evaluation>,
    /// Frames after which the run was closed, if the file says.
    pub closed_at: Option<f64>,
}

/// What some episodes of one policy came to.
#[derive(Clone, PartialEq, Debug)]
pub struct Evaluation {
    /// Number of episodes.
    pub episodes: usize,
    /// Return, cost and length by the names that reports have for them, and cost terms as
    /// `cost/TERM`.
    pub values: Vec<(String, Estimate)>,
    /// The same of each of several tasks, by its id.
    pub tasks: Vec<(String, Evaluation)>,
}

impl Evaluation {
    /// A number by the name that reports have for it.
    #[must_use]
    pub fn get(&self, metric: &str) -> Option<Estimate> {
        self.values.iter().find(|(name, _)| name == metric).map(|(_, estimate)| *estimate)
    }

    /// That of one of several tasks.
    pub(super) fn of_task(&self, task: &str) -> Option<Evaluation> {
        self.tasks.iter().find(|(name, _)| name == task).map(|(_, own)| own.clone())
    }
}

/// Whether the run says which checkpoint it selected, rightly or not.
pub(super) fn has_selected(run: &Path) -> bool {
    FILES.iter().any(|name| run.join(name).is_file())
}

/// Reads the file of a run directory, if there is one; of a damaged one `warnings` says so, and of
/// one that was written before the run went on to `frames`: it is of another policy.
pub fn read_selected(run: &Path, frames: f64, warnings: &mut Vec<Warning>) -> Option<Selected> {
    let path = FILES.iter().map(|name| run.join(name)).find(|path| path.is_file())?;
    let problem = match super::read_text(&path) {
        Ok(text) => match understand(&text) {
            Some(selected) => match selected.closed_at.filter(|&closed| closed < frames) {
                None => return Some(selected),
                Some(closed) => format!(
                    "is of {closed} frames, and the run went on to {frames}; passed over until the run is over \
                     (`hasard train ... --resume`)"
                ),
            },
            None => "does not say which checkpoint was selected; passed over".to_owned(),
        },
        Err(warning) => warning.problem,
    };
    warnings.push(Warning { path, line: 0, problem });
    None
}

fn understand(text: &str) -> Option<Selected> {
    let value: Value = serde_json::from_str(text).ok()?;
    if has_negative_width(&value) {
        return None;
    }
    let evaluation = |keys: &[&str]| keys.iter().find_map(|key| evaluation(value.get(key)?));
    Some(Selected {
        frames: value.get("frames")?.as_f64()?,
        closing: evaluation(&["closing"]),
        last: evaluation(&["last"]),
        closed_at: value.get("last").and_then(|last| last.get("frames")?.as_f64()),
    })
}

/// Whether an interval somewhere in it ends before its mean.
fn has_negative_width(value: &Value) -> bool {
    let negative = |width: &Value| width.as_f64().is_some_and(|width| width < 0.0);
    match value {
        Value::Object(fields) => fields
            .iter()
            .any(|(name, one)| name == "half_width" && negative(one) || has_negative_width(one)),
        Value::Array(items) => items.iter().any(has_negative_width),
        _ => false,
    }
}

/// What the last line of `hasard eval --json` says of the episodes before it, by the same intervals
/// as a run's own closing evaluation.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Summary {
    pub evaluation: Evaluation,
    /// Frames that the run had made by then, if it says.
    pub run_frames: Option<f64>,
}

/// Finds it in the text of a file of episodes.
pub(super) fn read_summary(text: &str) -> Option<Summary> {
    let line = text.lines().rev().find(|line| line.contains("\"summary\""))?;
    let value: Value = serde_json::from_str(line).ok()?;
    let all = value.get("summary")?;
    let evaluation = summary_of(all)?;
    // Of a damaged line nothing counts.
    let negative = |one: &Estimate| one.half_width.is_some_and(|width| width < 0.0);
    if evaluation.values.iter().any(|(_, one)| negative(one)) {
        return None;
    }
    Some(Summary { evaluation, run_frames: all.get("run_frames").and_then(Value::as_f64) })
}

fn summary_of(all: &Value) -> Option<Evaluation> {
    let episodes = all.get("episodes")?.as_u64()? as usize;
    let estimate = |of: &Value, name: &str| -> Option<Estimate> {
        let number = |what: &str| of.get(format!("{name}_{what}")).and_then(Value::as_f64);
        let mean = number("mean")?;
        let upper =
            of.get(format!("{name}_interval")).and_then(|ends| Some(ends.get(1)?.as_f64()? - mean));
        Some(Estimate { mean, half_width: upper.or_else(|| number("ci95")), n: episodes })
    };
    let mut values = Vec::new();
    for (metric, name) in
        [("return_mean", "return"), ("cost_mean", "cost"), ("length_mean", "length")]
    {
        values.extend(estimate(all, name).map(|one| (metric.to_owned(), one)));
    }
    for constraint in all.get("constraints").and_then(Value::as_array).into_iter().flatten() {
        let term = constraint.get("term").and_then(Value::as_str);
        values.extend(
            term.and_then(|term| Some((format!("cost/{term}"), estimate(constraint, "cost")?))),
        );
    }
    let tasks = all.get("tasks").and_then(Value::as_array).into_iter().flatten();
    let task = |one: &Value| Some((one.get("task")?.as_str()?.to_owned(), summary_of(one)?));
    Some(Evaluation { episodes, values, tasks: tasks.filter_map(task).collect() })
}

fn evaluation(value: &Value) -> Option<Evaluation> {
    let episodes = value.get("episodes")?.as_u64()? as usize;
    let estimate = |is_cost: bool, value: &Value| {
        let mean = value.get("mean")?.as_f64()?;
        // Where values are skewed the run gives a bootstrap's ends. Budgets are held against the
        // upper one of costs; of other values the farther one counts, so that neither is passed over.
        let end = |index| value.get("bootstrap").and_then(|ends: &Value| ends.get(index)?.as_f64());
        let arms = end(0).zip(end(1)).map(|(low, high)| (mean - low, high - mean));
        let half_width = match arms {
            Some((_, upper)) if is_cost => Some(upper),
            Some((lower, upper)) => Some(lower.max(upper)),
            None => value.get("half_width").and_then(Value::as_f64),
        };
        let half_width = half_width.filter(|_| episodes > 1);
        Some(Estimate { mean, half_width, n: episodes })
    };
    let named =
        [("return_mean", "episode_return"), ("cost_mean", "cost"), ("length_mean", "length")];
    let mut values: Vec<(String, Estimate)> = named
        .iter()
        .filter_map(|(name, key)| {
            Some(((*name).to_owned(), estimate(*key == "cost", value.get(key)?)?))
        })
        .collect();
    for constraint in value.get("constraints").and_then(Value::as_array).into_iter().flatten() {
        if let (Some(term), Some(cost)) = (
            constraint.get("term").and_then(Value::as_str),
            constraint.get("cost").and_then(|cost| estimate(true, cost)),
        ) {
            values.push((format!("cost/{term}"), cost));
        }
    }
    let tasks = value.get("tasks").and_then(Value::as_array).into_iter().flatten();
    let task = |one: &Value| Some((one.get("task")?.as_str()?.to_owned(), evaluation(one)?));
    let tasks = tasks.filter_map(task).collect();
    Some(Evaluation { episodes, values, tasks })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_closing_evaluation_is_read_whole() {
        let text = r#"{"frames":500,"chosen_by":{},"confirmed":true,"closing":{"episodes":100,"episode_return":{"mean":28.5,
            "half_width":1.5,"bootstrap":[26,29]},"cost":{"mean":42,"half_width":3,"bootstrap":[40,47.5]},"length":{"mean":525,"half_width":0},
            "constraints":[{"term":"lava","budget":30,"cost":{"mean":29,"half_width":2}}]},
            "last":{"frames":600,"episodes":50,"episode_return":{"mean":30,"half_width":1},"cost":{"mean":49,"half_width":1}}}"#;
        let selected = understand(text).unwrap();
        let closing = selected.closing.unwrap();
        let last = selected.last.unwrap();
        assert_eq!((selected.frames, closing.episodes, last.episodes), (500.0, 100, 50));
        assert_eq!(selected.closed_at, Some(600.0));
        assert_eq!(
            (closing.get("cost_mean").unwrap().high(), last.get("cost_mean").unwrap().high()),
            (47.5, 50.0)
        );
        let lava = closing.get("cost/lava").unwrap();
        assert_eq!(
            (lava.mean, lava.high(), closing.get("return_mean").unwrap().mean),
            (29.0, 31.0, 28.5)
        );
        // Its ± was the shorter arm.
        assert_eq!(closing.get("return_mean").unwrap().low(), 26.0);
        assert_eq!(understand("{\"frames\":3,\"closing\":null}").unwrap().closing, None);
        assert_eq!(understand("{\"closing\":null}"), None);
    }
}
