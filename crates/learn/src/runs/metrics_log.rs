//! The log of a run: its reports as lines of JSON and as TensorBoard's events.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::error::LearnError;
use crate::runs::run_directory::{HEATMAPS, METRICS};
use crate::runs::tensorboard::EventFile;

/// Where reports go: a line of JSON each, and TensorBoard's event file.
pub struct MetricsLog {
    path: PathBuf,
    lines: File,
    events: EventFile,
}

impl MetricsLog {
    /// Opens a run's log; rows after these frames are added at its end.
    pub fn open(run: &Path, frames: u64) -> Result<MetricsLog, LearnError> {
        let path = run.join(METRICS);
        let lines = File::options()
            .create(true)
            .append(true)
            .open(&path)
            .map_err(LearnError::file(&path, "open"))?;
        Ok(MetricsLog { lines, events: EventFile::create(run, frames)?, path })
    }

    /// Adds a line to the run's `heatmaps.jsonl`.
    pub fn write_heatmap(&mut self, line: &Value) -> Result<(), LearnError> {
        let path = self.path.with_file_name(HEATMAPS);
        let mut file = File::options()
            .create(true)
            .append(true)
            .open(&path)
            .map_err(LearnError::file(&path, "open"))?;
        file.write_all(format!("{line}\n").as_bytes()).map_err(LearnError::file(&path, "write"))
    }

    /// Writes a row.
    pub fn write(&mut self, frames: u64, row: &Value) -> Result<(), LearnError> {
        let mut line = row.to_string();
        line.push('\n');
        self.lines.write_all(line.as_bytes()).map_err(LearnError::file(&self.path, "write"))?;
        let mut scalars = Vec::new();
        collect_scalars("", row, &mut scalars);
        self.events.scalars(frames, &scalars)
    }
}

/// Every number of a row, nested ones under joined names.
fn collect_scalars(prefix: &str, value: &Value, out: &mut Vec<(String, f64)>) {
    match value {
        Value::Number(number) => {
            out.extend(number.as_f64().map(|number| (prefix.to_string(), number)))
        }
        Value::Object(fields) => {
            for (name, value) in fields {
                let name =
                    if prefix.is_empty() { name.clone() } else { format!("{prefix}/{name}") };
                collect_scalars(&name, value, out);
            }
        }
        Value::Array(items) => {
            for (index, value) in items.iter().enumerate() {
                collect_scalars(&format!("{prefix}/{index}"), value, out);
            }
        }
        _ => {}
    }
}
