//! `metrics.jsonl`: one JSON object a line, a line a report.

use super::Warning;
use serde_json::Value;
use std::path::Path;

/// One report of a run.
#[derive(Clone, PartialEq, Debug)]
pub struct Row {
    /// Frames (tics) seen so far: the horizontal axis of every curve.
    pub frames: f64,
    /// The numbers of the row by name, nested names joined by dots (`multipliers.0`); sorted by
    /// name.
    values: Vec<(String, f64)>,
}

impl Row {
    /// A row of given numbers.
    #[must_use]
    pub fn new(frames: f64, mut values: Vec<(String, f64)>) -> Row {
        values.sort_by(|a, b| a.0.cmp(&b.0));
        Row { frames, values }
    }

    /// A number by its name: `return_mean`, `cost_mean`, `length_mean`, `fps`, ...; `None` where it
    /// is missing or null, as returns are before the first episode ends.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<f64> {
        self.values
            .binary_search_by(|(key, _)| key.as_str().cmp(name))
            .ok()
            .map(|at| self.values[at].1)
    }

    /// All names and numbers.
    #[must_use]
    pub fn values(&self) -> &[(String, f64)] {
        &self.values
    }
}

/// Understands the lines of a metrics file. A damaged line, above all the half-written last one of
/// a killed run, is passed over with a warning. Where frames step back (a run resumed from a
/// checkpoint older than its last report), the later rows stand and the rows that they repeat are
/// dropped.
pub fn parse_metrics(text: &str, path: &Path, warnings: &mut Vec<Warning>) -> Vec<Row> {
    let mut rows: Vec<Row> = Vec::new();
    let mut warn = |line: usize, problem: String| {
        warnings.push(Warning { path: path.to_owned(), line, problem })
    };
    for (index, line) in text.lines().enumerate() {
        let line = line.trim_matches(|c: char| c.is_whitespace() || c == '\0');
        if line.is_empty() {
            continue;
        }
        let object = match serde_json::from_str::<Value>(line) {
            Ok(Value::Object(object)) => object,
            Ok(_) => {
                warn(index + 1, "is no JSON object; line passed over".into());
                continue;
            }
            Err(error) => {
                warn(
                    index + 1,
                    format!("is damaged or half-written ({}); line passed over", short(&error)),
                );
                continue;
            }
        };
        let Some(frames) =
            object.get("frames").and_then(Value::as_f64).filter(|frames| *frames >= 0.0)
        else {
            warn(index + 1, "has no number of frames; line passed over".into());
            continue;
        };
        let mut values = Vec::new();
        for (key, value) in &object {
            numbers(key, value, &mut values);
        }
        let keep = rows.partition_point(|row| row.frames < frames);
        if keep < rows.len() {
            warn(
                index + 1,
                format!(
                    "goes back to frame {frames} (a resumed run); {} earlier rows replaced",
                    rows.len() - keep
                ),
            );
            rows.truncate(keep);
        }
        rows.push(Row::new(frames, values));
    }
    rows
}

/// serde's message without its position: a file of lines has its own line number.
fn short(error: &serde_json::Error) -> String {
    let text = error.to_string();
    text.split(" at line ").next().unwrap_or(&text).to_owned()
}

/// Collects the numbers in a value under their joined names; texts, booleans and nulls are no
/// numbers.
fn numbers(key: &str, value: &Value, into: &mut Vec<(String, f64)>) {
    match value {
        Value::Number(number) => into.extend(
            number.as_f64().filter(|float| float.is_finite()).map(|float| (key.to_owned(), float)),
        ),
        Value::Object(object) => {
            object.iter().for_each(|(inner, value)| numbers(&format!("{key}.{inner}"), value, into))
        }
        Value::Array(items) => items
            .iter()
            .enumerate()
            .for_each(|(at, value)| numbers(&format!("{key}.{at}"), value, into)),
        _ => {}
    }
}
