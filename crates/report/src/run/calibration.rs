//! `calibration.json`: what a run's critics of the costs expected, and what came.

use super::Warning;
use serde::Deserialize;
use std::path::Path;

/// How one critic's predictions and what came agree.
#[derive(Clone, PartialEq, Debug, Deserialize)]
pub struct Calibration {
    /// Name of the constraint's cost term; `None` for the whole cost.
    pub term: Option<String>,
    /// Discount of the cost to come.
    pub gamma: f64,
    /// Steps that were compared.
    pub steps: f64,
    /// Mean of prediction minus what came.
    pub bias: f64,
    /// Root of their mean squared difference.
    pub error: f64,
    /// Means of steps with alike predictions, by rising prediction.
    pub bins: Vec<Bin>,
}

/// Steps with alike predictions.
#[derive(Clone, PartialEq, Debug, Deserialize)]
pub struct Bin {
    /// Mean prediction.
    pub predicted: f64,
    /// Mean cost that came.
    pub observed: f64,
}

#[derive(Deserialize)]
struct File {
    constraints: Vec<Calibration>,
}

/// Reads the file of a run directory, if there is one; of a damaged one `warnings` says so.
pub fn read_calibration(run: &Path, warnings: &mut Vec<Warning>) -> Vec<Calibration> {
    let path = run.join("calibration.json");
    if !path.is_file() {
        return Vec::new();
    }
    let problem = match super::read_text(&path) {
        Ok(text) => match serde_json::from_str::<File>(&text) {
            Ok(file) => return file.constraints,
            Err(_) => {
                "is no calibration (constraints with gamma, steps, bias, error, bins); passed over"
                    .to_owned()
            }
        },
        Err(warning) => warning.problem,
    };
    warnings.push(Warning { path, line: 0, problem });
    Vec::new()
}
