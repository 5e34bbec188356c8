//! `heatmaps.jsonl`: where the agent has been, at moments of training.

use super::Warning;
use serde::Deserialize;
use std::path::Path;

/// Largest side of the grid of a heatmap; a bound on hostile files.
const MAX_CELLS_A_SIDE: usize = 1024;

/// Steps spent in each cell of a grid over the map during the last episodes before a moment of
/// training.
#[derive(Clone, PartialEq, Debug, Deserialize)]
pub struct HeatmapData {
    /// The moment.
    pub frames: f64,
    /// Number of episodes that were counted.
    pub episodes: u64,
    /// Map units that the grid spans: x from, y from, x to, y to.
    pub extent: [f64; 4],
    /// Cells along x.
    pub columns: usize,
    /// Cells along y.
    pub rows: usize,
    /// Name of the picture in the run's directory that shows the same extent from above;
    /// `automap.png` if the line names none.
    #[serde(default)]
    pub automap: Option<String>,
    /// Steps in each cell, `[rows, columns]`, the row of the smallest y first.
    pub steps: Vec<f64>,
}

/// Understands the lines; a damaged one is passed over with a warning.
pub fn parse_heatmaps(text: &str, path: &Path, warnings: &mut Vec<Warning>) -> Vec<HeatmapData> {
    let mut heatmaps: Vec<HeatmapData> = Vec::new();
    for (index, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let parsed = serde_json::from_str::<HeatmapData>(line).ok().filter(|map| {
            (1..=MAX_CELLS_A_SIDE).contains(&map.columns)
                && (1..=MAX_CELLS_A_SIDE).contains(&map.rows)
                && map.steps.len() == map.columns * map.rows
                && map.steps.iter().all(|steps| steps.is_finite() && *steps >= 0.0)
                && map.extent.iter().all(|side| side.is_finite())
                && map.extent[0] < map.extent[2]
                && map.extent[1] < map.extent[3]
        });
        match parsed {
            Some(map) => {
                heatmaps.retain(|earlier| earlier.frames < map.frames);
                heatmaps.push(map);
            }
            None => warnings.push(Warning {
                path: path.to_owned(),
                line: index + 1,
                problem: "is no heatmap (frames, episodes, extent, columns, rows, steps); line passed over".into(),
            }),
        }
    }
    heatmaps
}
