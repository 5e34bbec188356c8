//! Counts of equal pixels.

/// What pixels are counted by.
#[derive(Clone, Copy)]
pub enum Kind {
    Wall,
    Floor,
    Ceiling,
    Sky,
    World,
    StatusBar,
    Weapon,
    Sprites,
    Depth,
    Labels,
}

const NAMES: [&str; 10] = ["wall", "floor", "ceiling", "sky", "world", "status bar", "weapon", "sprites", "depth", "labels"];

/// Counts of one kind.
#[derive(Clone, Copy, Default)]
struct Tally {
    pixels: u64,
    equal: u64,
    near: u64,
    /// Sum of the differences of the channels.
    sum: u64,
    channels: u64,
}

/// Counts of every kind.
#[derive(Clone, Default)]
pub struct Tallies([Tally; NAMES.len()]);

impl Tallies {
    /// Adds a pixel, theirs and ours.
    pub fn add(&mut self, kind: Kind, theirs: &[u8], ours: &[u8]) {
        let differences = || theirs.iter().zip(ours).map(|(a, b)| a.abs_diff(*b));
        let tally = &mut self.0[kind as usize];
        tally.pixels += 1;
        tally.equal += u64::from(differences().all(|difference| difference == 0));
        tally.near += u64::from(differences().all(|difference| difference <= 8));
        tally.sum += differences().map(u64::from).sum::<u64>();
        tally.channels += theirs.len() as u64;
    }

    pub fn join(&mut self, other: &Tallies) {
        for (to, from) in self.0.iter_mut().zip(&other.0) {
            to.pixels += from.pixels;
            to.equal += from.equal;
            to.near += from.near;
            to.sum += from.sum;
            to.channels += from.channels;
        }
    }

    /// Prints a row of the table for every kind that has pixels.
    pub fn print(&self, level: &str) {
        for (tally, name) in self.0.iter().zip(NAMES).filter(|(tally, _)| tally.pixels > 0) {
            let part = |of: u64| 100.0 * of as f64 / tally.pixels as f64;
            let mean = tally.sum as f64 / tally.channels as f64;
            println!("| {level} | {name} | {} | {:.2} | {:.2} | {mean:.2} |", tally.pixels, part(tally.equal), part(tally.near));
        }
    }

    /// The equal parts of every kind in a line.
    pub fn summary(&self) -> String {
        let counted = self.0.iter().zip(NAMES).filter(|(tally, _)| tally.pixels > 0);
        let parts = counted.map(|(tally, name)| format!("{name} {:.2}", 100.0 * tally.equal as f64 / tally.pixels as f64));
        parts.collect::<Vec<_>>().join(", ")
    }
}
