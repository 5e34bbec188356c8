//! `hasard metrics`: every key of `metrics.jsonl`, its unit and meaning.

use crate::args::MetricsArgs;
use crate::failure::Outcome;
use hasard_learn::runs::metrics_explained::METRICS;
use serde_json::json;

/// Runs the command.
pub fn run(args: &MetricsArgs) -> Outcome {
    for one in METRICS {
        if args.json {
            say!(
                "{}",
                json!({ "name": one.name, "unit": one.unit, "when": one.when, "meaning": one.meaning })
            );
            continue;
        }
        let unit = if one.unit.is_empty() { String::new() } else { format!(" [{}]", one.unit) };
        let when = if one.when.is_empty() { String::new() } else { format!(" ({})", one.when) };
        say!("{}{unit}{when}\n    {}", one.name, one.meaning);
    }
    Ok(())
}
