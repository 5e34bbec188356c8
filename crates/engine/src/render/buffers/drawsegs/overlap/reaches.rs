//! What decides whether a drawseg and a sprite overlap.

/// What decides in most cases that a drawseg and a sprite have nothing to do with each other, on
/// its own: a frame has dozens of drawsegs, and each sprite asks all of them. Lists of `count`,
/// padded to whole blocks.
#[derive(Debug, Default)]
pub(crate) struct DrawSegBounds {
    pub count: usize,
    /// First columns.
    pub firsts: Vec<u32>,
    /// One past the last columns.
    pub ends: Vec<u32>,
    /// Inverse distances of the nearer ends; the greatest number where there is a masked texture.
    pub nears: Vec<i64>,
}

/// DrawSegs that are asked at once at most.
pub(crate) const MEET_BLOCK: usize = 8;

impl DrawSegBounds {
    pub fn push(&mut self, first: usize, end: usize, near: i64) {
        if self.count + MEET_BLOCK > self.nears.len() {
            let length = 2 * (self.count + MEET_BLOCK);
            self.firsts.resize(length, 0);
            self.ends.resize(length, 0);
            self.nears.resize(length, 0);
        }
        (self.firsts[self.count], self.ends[self.count], self.nears[self.count]) =
            (first as u32, end as u32, near);
        self.count += 1;
    }
}
