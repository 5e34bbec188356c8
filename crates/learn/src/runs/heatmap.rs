//! Where the agents have been lately: counts of steps on a grid over the map, written at moments of
//! training.

use std::collections::VecDeque;

use serde_json::{Value, json};

use crate::sampling::rollout::Rollout;

/// Episodes that are counted.
const EPISODES: usize = 1000;
/// Cells along the longer side of the map.
const LONGER_SIDE: u64 = 60;
/// Moments of a run at which the counts are written.
const MOMENTS: u64 = 20;

/// Steps spent in each cell during the last `EPISODES` episodes.
///
/// It is no part of a checkpoint: a resumed run begins to count anew, and each line says how many
/// episodes it counts.
pub struct Heatmap {
    /// Map units: x from, y from, x to, y to.
    extent: [i32; 4],
    columns: usize,
    rows: usize,
    /// Cells of the running episode of each lane, a cell a step.
    running: Vec<Vec<u32>>,
    /// Cells of the last episodes, the oldest first.
    episodes: VecDeque<Vec<u32>>,
    /// Sum over those episodes.
    steps: Vec<u64>,
    /// Frames between moments, and the next one.
    interval: u64,
    next: u64,
    /// Name of the picture of the map that the counts lie on.
    automap: String,
}

impl Heatmap {
    /// An empty grid over a map of some extent, for a run of `frames` frames that has made `done`
    /// of them.
    #[must_use]
    pub fn new(extent: [i32; 4], lanes: usize, frames: u64, done: u64, automap: String) -> Heatmap {
        let sides = [extent[2] - extent[0], extent[3] - extent[1]]
            .map(|side| u64::from(side.max(1).unsigned_abs()));
        let longer = sides[0].max(sides[1]);
        let [columns, rows] = sides.map(|side| (side * LONGER_SIDE).div_ceil(longer) as usize);
        let interval = (frames / MOMENTS).max(1);
        Heatmap {
            extent,
            columns,
            rows,
            running: vec![Vec::new(); lanes],
            episodes: VecDeque::new(),
            steps: vec![0; columns * rows],
            interval,
            next: done + interval,
            automap,
        }
    }

    /// Counts a rollout's steps.
    pub fn add(&mut self, rollout: &Rollout) {
        let mut first_lane = 0;
        for part in &rollout.parts {
            for (row, (&position, &done)) in part.positions.iter().zip(&part.done).enumerate() {
                self.add_step(first_lane + row % part.lanes, position, done);
            }
            first_lane += part.lanes;
        }
    }

    fn add_step(&mut self, lane: usize, [x, y]: [i32; 2], done: bool) {
        let along = |at: i32, from: i32, to: i32, cells: usize| {
            let share = i64::from(at - from) * cells as i64 / i64::from((to - from).max(1));
            share.clamp(0, cells as i64 - 1) as usize
        };
        let column = along(x, self.extent[0], self.extent[2], self.columns);
        let row = along(y, self.extent[1], self.extent[3], self.rows);
        self.running[lane].push((row * self.columns + column) as u32);
        if done {
            let episode = std::mem::take(&mut self.running[lane]);
            for &cell in &episode {
                self.steps[cell as usize] += 1;
            }
            self.episodes.push_back(episode);
            if self.episodes.len() > EPISODES
                && let Some(oldest) = self.episodes.pop_front()
            {
                for cell in oldest {
                    self.steps[cell as usize] -= 1;
                }
            }
        }
    }

    /// The line to write if a moment has come, or if the run is `over`; none before an episode has
    /// ended.
    pub fn line(&mut self, frames: u64, over: bool) -> Option<Value> {
        if self.episodes.is_empty() || frames < self.next && !over {
            return None;
        }
        self.next = frames - frames % self.interval + self.interval;
        Some(json!({
            "frames": frames,
            "episodes": self.episodes.len(),
            "extent": self.extent,
            "automap": self.automap,
            "columns": self.columns,
            "rows": self.rows,
            "steps": self.steps,
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_thousand_episodes_are_counted() {
        let mut heatmap = Heatmap::new([-100, 0, 500, 300], 2, 1000, 0, "automap.png".into());
        assert_eq!((heatmap.columns, heatmap.rows), (60, 30));
        assert!(heatmap.line(100, true).is_none());
        // Lane 0 stands in the north-west corner for three steps, then once beyond the south-east
        // one.
        for _ in 0..3 {
            heatmap.add_step(0, [-100, 300], false);
        }
        heatmap.add_step(1, [0, 0], false);
        assert!(heatmap.line(100, false).is_none(), "no episode has ended");
        heatmap.add_step(0, [9999, -9999], true);
        let line = heatmap.line(100, false).unwrap();
        assert_eq!((&line["frames"], &line["episodes"]), (&json!(100), &json!(1)));
        assert_eq!((&line["steps"][29 * 60], &line["steps"][59]), (&json!(3), &json!(1)));
        assert!(heatmap.line(120, false).is_none() && heatmap.line(150, false).is_some());
        for _ in 0..EPISODES {
            heatmap.add_step(1, [200, 150], true);
        }
        let line = heatmap.line(150, true).unwrap();
        let total: u64 =
            line["steps"].as_array().unwrap().iter().map(|steps| steps.as_u64().unwrap()).sum();
        // The oldest episode is gone; lane 1's first one had two steps.
        assert_eq!((line["episodes"].as_u64(), total), (Some(1000), 1001));
    }
}
