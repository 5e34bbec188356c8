//! Squares that rockets shed, theirs and ours: not where they are, but how many pixels they change, and how.

use crate::Any;
use crate::dump::{Level, Pictures};
use crate::pose::{Stage, leave_trails};
use crate::{name, sheet, untold};
use hasard_engine::render::Buffers;
use hasard_engine::world::World;
use std::path::{Path, PathBuf};

/// What a square makes of a pixel.
const CHANGES: [&str; 3] = ["yellow", "lighter", "darker"];

/// Pixels whose colours were changed, and by how much.
#[derive(Clone, Copy, Default)]
struct Changes {
    moments: u64,
    /// Pixels of the view in all moments.
    pixels: u64,
    /// Changed ones by [`CHANGES`].
    changed: [u64; 3],
    /// Sum of the differences of their channels.
    sum: u64,
    /// Changed ones in the row and column of the middle of the view or near it: a quarter of either.
    middle: u64,
    /// Sum of the squares of each moment's number, for the spread.
    spread: f64,
}

/// Prints what theirs and ours change in the moments of every folder.
pub fn run(folders: &[PathBuf], bare: &Path, out: Option<&Path>) -> Any<()> {
    println!(
        "| level | whose | pixels changed % | of a moment's | {} | in the middle % | by |",
        CHANGES.map(|name| format!("{name} %")).join(" | ")
    );
    println!("|---|---|--:|--:|--:|--:|--:|--:|--:|");
    let mut whole = [Changes::default(); 2];
    for folder in folders {
        let level = Level::read(folder)?;
        let mut stage = Stage::new(&level)?;
        let mut counts = [Changes::default(); 2];
        for moment in &level.scenes {
            let theirs = Pictures::read(folder, moment.number)?;
            let plain = Pictures::read(&bare.join(name(folder)), moment.number)?;
            let mut posed = stage.pose(&level, moment);
            untold::find(&mut stage, &mut posed, &plain, &level.scenario, moment);
            let mut draw = |world: &World| {
                stage.renderer.render(world, 0, Buffers::default());
                stage.renderer.write_rgb_hwc(&mut stage.rgb);
                stage.rgb.clone()
            };
            let without = draw(&posed.world);
            leave_trails(&mut posed.world, moment);
            let with = draw(&posed.world);
            let view = [stage.size[0], stage.renderer.view().view_rows()];
            counts[0].add(&plain.rgb, &theirs.rgb, view);
            counts[1].add(&without, &with, view);
            if let Some(out) = out {
                let path = out.join(format!("{}_{:02}_squares.png", name(folder), moment.number));
                sheet::write(&path, stage.size, [&theirs.rgb, &with])?;
            }
        }
        for (counts, (whole, whose)) in counts.iter().zip(whole.iter_mut().zip(["theirs", "ours"])) {
            counts.print(&name(folder), whose);
            whole.join(counts);
        }
    }
    if folders.len() > 1 {
        whole.iter().zip(["theirs", "ours"]).for_each(|(counts, whose)| counts.print("all", whose));
    }
    Ok(())
}

impl Changes {
    /// Counts what differs between two pictures in the columns and rows of a view.
    fn add(&mut self, before: &[u8], after: &[u8], [width, rows]: [usize; 2]) {
        let mut own = 0u64;
        for (at, (before, after)) in before.chunks_exact(3).zip(after.chunks_exact(3)).take(width * rows).enumerate() {
            if before == after {
                continue;
            }
            let sum = |pixel: &[u8]| pixel.iter().map(|&channel| u32::from(channel)).sum::<u32>();
            // Of yellow, blue is what it lacks, and what it takes from what is behind.
            let yellow = after[0].saturating_sub(after[2]) > before[0].saturating_sub(before[2]).saturating_add(16);
            let change = if yellow { 0 } else { 1 + usize::from(sum(after) <= sum(before)) };
            self.changed[change] += 1;
            self.sum += before.iter().zip(after).map(|(a, b)| u64::from(a.abs_diff(*b))).sum::<u64>();
            let near = |at: usize, of: usize| (at * 8).abs_diff(of * 4) <= of;
            self.middle += u64::from(near(at % width, width) && near(at / width, rows));
            own += 1;
        }
        self.moments += 1;
        self.pixels += (width * rows) as u64;
        self.spread += (own as f64).powi(2);
    }

    fn join(&mut self, other: &Changes) {
        self.moments += other.moments;
        self.pixels += other.pixels;
        self.changed.iter_mut().zip(other.changed).for_each(|(to, from)| *to += from);
        self.sum += other.sum;
        self.middle += other.middle;
        self.spread += other.spread;
    }

    fn print(&self, level: &str, whose: &str) {
        let changed: u64 = self.changed.iter().sum();
        let (moments, all) = (self.moments as f64, changed as f64);
        let mean = all / moments;
        let deviation = (self.spread / moments - mean * mean).max(0.0).sqrt();
        let parts = self.changed.map(|count| format!("{:.1}", 100.0 * count as f64 / all));
        println!(
            "| {level} | {whose} | {:.2} | {mean:.0} ± {:.0} | {} | {:.1} | {:.1} |",
            100.0 * all / self.pixels as f64,
            1.96 * deviation / moments.sqrt(),
            parts.join(" | "),
            100.0 * self.middle as f64 / all,
            self.sum as f64 / (3.0 * all),
        );
    }
}
