//! Small run directories with curves of known shape, made in a moment.

#![allow(dead_code, reason = "each test file uses some of it")]

use hasard_media::episode::{EpisodeFile, Header, Outcome};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// A folder that is gone after the test, unless `HASARD_KEEP_REPORT` names a place to keep it at,
/// for a look at the page.
pub struct Folder(pub PathBuf, bool);

impl Folder {
    pub fn new(name: &str) -> Folder {
        let kept =
            std::env::var_os("HASARD_KEEP_REPORT").map(|place| PathBuf::from(place).join(name));
        let keep = kept.is_some();
        let path = kept.unwrap_or_else(|| {
            std::env::temp_dir().join(format!("hasard-report-test-{}-{name}", std::process::id()))
        });
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        Folder(path, keep)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        if !self.1 {
            let _ = std::fs::remove_dir_all(&self.0);
        }
    }
}

/// What a synthetic run is.
pub struct Synthetic<'a> {
    pub env: &'a str,
    pub algo: &'a str,
    pub seed: u64,
    pub frames: f64,
    pub reports: usize,
    /// Further keys of the configuration, as JSON, beginning with a comma.
    pub options: &'a str,
    /// Return and cost at the end, and the height of the cost's overshoot.
    pub end: (f64, f64, f64),
}

impl Synthetic<'_> {
    pub fn write(&self, folder: &Path) {
        std::fs::create_dir_all(folder).unwrap();
        let config = format!(
            "{{\"env\":\"{}\",\"algo\":\"{}\",\"seed\":{},\"frames\":{},\"rules\":\"tables\",\"preset\":\"paper\",\"out\":\"{}\"{}}}",
            self.env,
            self.algo,
            self.seed,
            self.frames,
            folder.display(),
            self.options
        );
        std::fs::write(folder.join("config.json"), config).unwrap();
        std::fs::write(folder.join("metrics.jsonl"), self.metrics()).unwrap();
    }

    fn metrics(&self) -> String {
        let mut text = String::new();
        let (end_return, end_cost, overshoot) = self.end;
        for k in 1..=self.reports {
            let share = k as f64 / self.reports as f64;
            let wave = ((k as u64 * 7919 + self.seed * 104_729) % 1000) as f64 / 1000.0 - 0.5;
            let rise = 1.0 - (-5.0 * share).exp();
            let episode_return =
                end_return * rise * (1.0 + 0.06 * wave + 0.03 * (self.seed as f64 - 2.0));
            let cost = (end_cost * rise + overshoot * share * 8.0 * (-8.0 * share).exp())
                * (1.0 + 0.15 * wave);
            let frames = self.frames * share;
            let multiplier = if self.algo.ends_with("Lag") {
                format!(",\"multipliers\":[{}]", 0.4 * rise)
            } else {
                String::new()
            };
            let _ = writeln!(
                text,
                "{{\"frames\":{frames},\"updates\":{k},\"wall_s\":{},\"fps\":4000,\"return_mean\":{episode_return},\"cost_mean\":{cost},\"length_mean\":{},\"cost_total\":{},\"violation_total\":{}{multiplier}}}",
                frames / 4000.0,
                500.0 + wave,
                frames / 100.0,
                frames / 400.0
            );
        }
        text
    }
}

/// Heatmaps of a walk that spreads during training, and a small automap.
pub fn write_heatmaps(folder: &Path) {
    let (columns, rows) = (24usize, 30usize);
    let mut text = String::new();
    for moment in 1..=12 {
        let steps: Vec<f64> = (0..columns * rows)
            .map(|cell| {
                let (x, y) = ((cell % columns) as f64 - 6.0, (cell / columns) as f64 - 5.0);
                let spread = f64::from(moment) * 12.0;
                (1000.0 * (-(x * x + y * y) / spread).exp()).floor()
            })
            .collect();
        let _ = writeln!(
            text,
            "{{\"frames\":{},\"episodes\":1000,\"extent\":[-608,-736,1040,1296],\"columns\":{columns},\"rows\":{rows},\"steps\":{steps:?}}}",
            moment * 1_000_000
        );
    }
    std::fs::write(folder.join("heatmaps.jsonl"), text).unwrap();
    let mut map = hasard_media::Picture::filled(206, 254, [70, 66, 60]);
    for k in 0..5 {
        map.fill(20 + k * 36, 30 + k * 40, 14, 22, [120, 110, 90]);
    }
    hasard_media::png::write(&map, &folder.join("automap.png")).unwrap();
}

/// An episode of Remedy Rush 1 in a file: so many steps of one action, and what came of them.
pub fn write_episode(
    path: &Path,
    player: &str,
    seed: u64,
    options: &[(&str, &str)],
    steps: usize,
    outcome: Outcome,
) {
    let header = Header {
        env: "RemedyRushLevel1-v0".into(),
        options: options.iter().map(|&(name, value)| (name.into(), value.into())).collect(),
        seed,
        program: "0.1.0".into(),
        player: player.into(),
        steps: 0,
        groups: 1,
        deltas: 0,
        outcome: None,
    };
    let mut file = EpisodeFile::new(header).unwrap();
    for _ in 0..steps {
        file.push(&[1], &[]).unwrap();
    }
    file.set_outcome(outcome);
    file.write(path).unwrap();
}
