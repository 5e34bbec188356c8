//! Which lanes something is done with, and how a lane is reset.

use std::ops::Range;
use std::sync::Arc;

/// How a lane is reset.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Restart {
    /// Not at all: its episode goes on, and its present is shown.
    Stay,
    /// Its next episode starts.
    #[default]
    Next,
    /// Its stream of episode seeds starts anew from this seed, and its first episode starts. The
    /// stream is that of lane 0 of a batch made with this seed, wherever the lane stands.
    Seed(u64),
}

/// Lanes of the whole, in the order of a batch.
#[derive(Clone)]
pub(super) enum Chosen {
    /// Neighbours, as the lanes of a group are.
    Range(Range<usize>),
    /// Any, each once.
    List(Arc<[usize]>),
}

impl Chosen {
    pub fn count(&self) -> usize {
        match self {
            Chosen::Range(range) => range.len(),
            Chosen::List(list) => list.len(),
        }
    }

    /// The lane at a place of the batch.
    pub fn lane(&self, index: usize) -> usize {
        match self {
            Chosen::Range(range) => range.start + index,
            Chosen::List(list) => list[index],
        }
    }
}
