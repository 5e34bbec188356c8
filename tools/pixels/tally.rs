//! Counts of equal pixels.

use std::collections::BTreeMap;

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
    /// Whatever there is, of the pixels that a learner's frame of 128x72 keeps.
    Learner,
}

const NAMES: [&str; 11] = [
    "wall",
    "floor",
    "ceiling",
    "sky",
    "world",
    "status bar",
    "weapon",
    "sprites",
    "depth",
    "labels",
    "learner's frame",
];

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

impl Tally {
    fn add(&mut self, theirs: &[u8], ours: &[u8]) {
        let differences = || theirs.iter().zip(ours).map(|(a, b)| a.abs_diff(*b));
        self.pixels += 1;
        self.equal += u64::from(differences().all(|difference| difference == 0));
        self.near += u64::from(differences().all(|difference| difference <= 8));
        self.sum += differences().map(u64::from).sum::<u64>();
        self.channels += theirs.len() as u64;
    }

    fn join(&mut self, other: &Tally) {
        self.pixels += other.pixels;
        self.equal += other.equal;
        self.near += other.near;
        self.sum += other.sum;
        self.channels += other.channels;
    }

    fn print(&self, level: &str, name: &str) {
        let part = |of: u64| 100.0 * of as f64 / self.pixels as f64;
        let mean = self.sum as f64 / self.channels as f64;
        println!(
            "| {level} | {name} | {} | {:.2} | {:.2} | {mean:.2} |",
            self.pixels,
            part(self.equal),
            part(self.near)
        );
    }
}

/// Counts of every kind, and of things by their names.
#[derive(Clone, Default)]
pub struct Tallies {
    kinds: [Tally; NAMES.len()],
    things: BTreeMap<String, Tally>,
}

impl Tallies {
    /// Adds a pixel, theirs and ours.
    pub fn add(&mut self, kind: Kind, theirs: &[u8], ours: &[u8]) {
        self.kinds[kind as usize].add(theirs, ours);
    }

    /// Adds a pixel of a thing.
    pub fn add_thing(&mut self, name: &str, theirs: &[u8], ours: &[u8]) {
        self.add(Kind::Sprites, theirs, ours);
        self.things.entry(name.to_owned()).or_default().add(theirs, ours);
    }

    pub fn join(&mut self, other: &Tallies) {
        self.kinds.iter_mut().zip(&other.kinds).for_each(|(to, from)| to.join(from));
        for (name, from) in &other.things {
            self.things.entry(name.clone()).or_default().join(from);
        }
    }

    /// Prints a row of the table for every kind that has pixels.
    pub fn print(&self, level: &str) {
        for (tally, name) in self.kinds.iter().zip(NAMES).filter(|(tally, _)| tally.pixels > 0) {
            tally.print(level, name);
        }
        for (name, tally) in &self.things {
            tally.print(level, name);
        }
    }

    /// The equal parts of every kind in a line.
    pub fn summary(&self) -> String {
        let counted = self.kinds.iter().zip(NAMES).filter(|(tally, _)| tally.pixels > 0);
        let parts = counted.map(|(tally, name)| {
            format!("{name} {:.2}", 100.0 * tally.equal as f64 / tally.pixels as f64)
        });
        parts.collect::<Vec<_>>().join(", ")
    }
}
