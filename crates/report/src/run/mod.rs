//! Run directories: what a training left behind.

mod calibration;
mod config;
mod constraint;
mod discover;
mod episodes;
mod evaluated;
mod heatmap;
mod metrics;
mod own;
mod safety;
mod selected;
mod task;

pub use calibration::{Calibration, read_calibration};
pub use config::{Config, FRAME_SKIP, SHOWN, scenario_and_level};
pub use constraint::{Constraint, Kept};
pub use discover::{Found, Origin, PlayerKey, TRASH, discover};
use episodes::own_episodes;
pub use episodes::{EpisodeResult, read_episode_lines};
pub use heatmap::{HeatmapData, parse_heatmaps};
pub use metrics::{Row, parse_metrics};
pub use own::{OwnTasks, default_budget};
use selected::has_selected;
use selected::read_summary;
pub use selected::{Evaluation, Selected, read_selected};

use crate::curve::interpolate;
use crate::escape::one_line;
use std::path::{Path, PathBuf};

/// Largest text file that is read, in bytes: far above the metrics of any run.
pub(crate) const TEXT_LIMIT: u64 = 512 << 20;

/// Points that a run's reports are thinned to in the published tables, and how many of the last are
/// averaged.
const POINTS: usize = 500;
/// See `POINTS`.
pub const LAST_POINTS: usize = 10;

/// Something that was passed over while reading: the reader must know, but the report goes on.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct Warning {
    /// The file.
    pub path: PathBuf,
    /// Line in it, from 1; 0 for the file as a whole.
    pub line: usize,
    /// What is wrong, and what was done about it.
    pub problem: String,
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let problem = one_line(&self.problem);
        match self.line {
            0 => write!(f, "{}: {problem}", self.path.display()),
            line => write!(f, "{}:{line}: {problem}", self.path.display()),
        }
    }
}

/// One training run, read.
#[derive(Clone, Debug)]
pub struct Run {
    /// Its directory.
    pub path: PathBuf,
    /// What was trained and how.
    pub config: Config,
    /// Its reports, in the order of frames.
    pub rows: Vec<Row>,
    /// Episodes of the selected checkpoint: those of the closing evaluation, or of `hasard eval` if
    /// that kept any here.
    pub evaluation: Vec<EpisodeResult>,
    /// What `hasard eval` said of them all, where these are its episodes.
    pub summary: Option<Evaluation>,
    /// The checkpoint that it selected, if it says.
    pub selected: Option<Selected>,
    /// How its critics of costs were calibrated, if it says.
    pub calibration: Vec<Calibration>,
    /// Visited positions at moments of training, if any were kept.
    pub heatmaps: Vec<HeatmapData>,
}

impl Run {
    /// Reads a run directory. Damaged lines are passed over, and `warnings` lists them.
    ///
    /// # Errors
    /// When `config.json` is missing or unusable: then it is no run.
    pub fn read(path: &Path, warnings: &mut Vec<Warning>) -> Result<Run, Warning> {
        let config = Config::read(&path.join("config.json"))?;
        let metrics_path = path.join("metrics.jsonl");
        let rows = match read_text(&metrics_path) {
            Ok(text) => parse_metrics(&text, &metrics_path, warnings),
            Err(warning) => {
                warnings.push(warning);
                Vec::new()
            }
        };
        let frames = rows.last().map_or(0.0, |row: &Row| row.frames);
        let selected = read_selected(path, frames, warnings);
        // Those of a selection that does not count are of another policy too.
        let refused = selected.is_none() && has_selected(path);
        let (mut evaluation, mut summary) = (Vec::new(), None);
        // Episodes of the closing evaluation are the run's own; those of a later `hasard eval`
        // count where it kept none.
        for beginning in ["closing", "eval"] {
            for file in sorted_files(path) {
                let name = file.file_name().and_then(|name| name.to_str()).unwrap_or_default();
                let counts = beginning == "eval" || !refused;
                if counts
                    && evaluation.is_empty()
                    && name.starts_with(beginning)
                    && name.ends_with(".jsonl")
                {
                    match read_text(&file) {
                        Ok(text) => {
                            let said = if beginning == "eval" { read_summary(&text) } else { None };
                            let before = said.as_ref().and_then(|said| said.run_frames);
                            if let Some(before) = before.filter(|before| *before < frames * 0.999) {
                                let problem = format!(
                                    "is of a run of {before} frames, which went on to {frames}; passed over \
                                     (evaluate it anew: hasard eval)"
                                );
                                warnings.push(Warning { path: file, line: 0, problem });
                                continue;
                            }
                            let read = read_episode_lines(&text, &file, warnings);
                            evaluation.extend(own_episodes(read, &config, &file, warnings));
                            // It is of all lines, and no word of some of them.
                            summary = said
                                .map(|said| said.evaluation)
                                .filter(|said| said.episodes == evaluation.len());
                        }
                        Err(warning) => warnings.push(warning),
                    }
                }
            }
        }
        let heatmap_path = path.join("heatmaps.jsonl");
        let heatmaps = if heatmap_path.is_file() {
            match read_text(&heatmap_path) {
                Ok(text) => heatmap::parse_heatmaps(&text, &heatmap_path, warnings),
                Err(warning) => {
                    warnings.push(warning);
                    Vec::new()
                }
            }
        } else {
            Vec::new()
        };
        Ok(Run {
            path: path.to_owned(),
            config,
            rows,
            evaluation,
            summary,
            selected,
            calibration: read_calibration(path, warnings),
            heatmaps,
        })
    }

    /// The picture of the map that a heatmap lies on, if the directory has it. A name that leads
    /// elsewhere is no name.
    #[must_use]
    pub fn automap(&self, heatmap: &HeatmapData) -> Option<PathBuf> {
        let name = heatmap.automap.as_deref().unwrap_or("automap.png");
        let plain = Path::new(name).file_name().is_some_and(|file| file == name);
        Some(self.path.join(name)).filter(|file| plain && file.is_file())
    }

    /// Frames that the run has reached.
    #[must_use]
    pub fn frames(&self) -> f64 {
        self.rows.last().map_or(0.0, |row| row.frames)
    }

    /// Whether it has reached the frames that it was asked for; `true` if it does not say.
    #[must_use]
    pub fn finished(&self) -> bool {
        self.config.frames.is_none_or(|asked| self.frames() >= asked * 0.999)
    }

    /// A metric at the end of training; `None` if no report has it.
    ///
    /// The published tables take the mean over the last ten of a run's five hundred points. Reports
    /// are made by the clock, so that a fast machine makes fewer of them: the points are taken here
    /// at equal distances in frames, each on the line between the reports around it.
    #[must_use]
    pub fn final_mean(&self, metric: &str) -> Option<f64> {
        let reports: Vec<(f64, f64)> =
            self.rows.iter().filter_map(|row| Some((row.frames, row.get(metric)?))).collect();
        let (end, _) = *reports.last()?;
        let points = (0..LAST_POINTS).map(|point| end * (1.0 - point as f64 / POINTS as f64));
        let values: Vec<f64> = points.filter_map(|frames| interpolate(&reports, frames)).collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    }

    /// Frames a second over the whole run, if its reports hold the time.
    #[must_use]
    pub fn frames_per_second(&self) -> Option<f64> {
        let last = self.rows.last()?;
        last.get("wall_s").filter(|seconds| *seconds > 0.0).map(|seconds| last.frames / seconds)
    }
}

/// The files of a folder in the order of their names, so that a report does not depend on the file
/// system.
pub(crate) fn sorted_files(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| entry.path())
        .collect();
    files.sort();
    files
}

/// Reads a text file; bytes that are no UTF-8 (a line cut or overwritten) become replacement
/// characters and their line fails to parse like any other damaged one.
pub(crate) fn read_text(path: &Path) -> Result<String, Warning> {
    let bytes = hasard_media::files::read_limited(path, TEXT_LIMIT)
        .map_err(|error| warning_of(path, &error))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// What is wrong with a file, without its name, which a warning has apart.
fn warning_of(path: &Path, error: &hasard_media::MediaError) -> Warning {
    let text = error.to_string();
    let problem = text.strip_prefix(&format!("{}: ", path.display())).unwrap_or(&text).to_owned();
    Warning { path: path.to_owned(), line: 0, problem }
}

#[cfg(test)]
mod tests;
