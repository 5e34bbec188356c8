//! The list of actors in view.

use crate::render::buffers::frame::class;
use crate::world::{ActorId, ActorKind};

/// An actor of which at least one pixel was drawn, though what came later may have covered it
/// again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Label {
    /// What it is.
    pub kind: ActorKind,
    /// Who it is.
    pub actor: ActorId,
    /// Its value in the class buffer.
    pub class: u16,
    /// First column of the drawn pixels.
    pub x: u16,
    /// First row.
    pub y: u16,
    /// Number of columns.
    pub width: u16,
    /// Number of rows.
    pub height: u16,
}

/// An actor that shows in the finished frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InView {
    /// The actor; its box holds the pixels that still show.
    pub label: Label,
    /// Its value in the picture of labels.
    pub value: u8,
    /// How many pixels of it show.
    pub pixels: usize,
}

/// The value in the picture of labels of the actor that was drawn as number `index` of `count`.
pub(crate) fn value(index: usize, count: usize) -> u8 {
    ((index + 1) * 255 / (count + 1)) as u8
}

/// Those of the drawn actors of which the finished frame has pixels.
pub(crate) fn in_view(labels: &[Label], classes: &[u16], width: usize) -> Vec<InView> {
    // Count, columns and rows of each; an empty box to begin with.
    let mut seen = vec![(0_usize, [usize::MAX, 0], [usize::MAX, 0]); labels.len()];
    for (y, row) in classes.chunks_exact(width).enumerate() {
        for (x, &class) in row.iter().enumerate() {
            let index = usize::from(class).wrapping_sub(usize::from(class::FIRST_ACTOR));
            if let Some((pixels, columns, rows)) = seen.get_mut(index) {
                *pixels += 1;
                *columns = [columns[0].min(x), columns[1].max(x)];
                *rows = [rows[0].min(y), rows[1].max(y)];
            }
        }
    }
    type Range = [usize; 2];
    let shows = |(index, (&label, &(pixels, [left, right], [top, bottom]))): (
        usize,
        (&Label, &(usize, Range, Range)),
    )| {
        let side = |from: usize, to: usize| (to - from + 1) as u16;
        (pixels > 0).then(|| InView {
            label: Label {
                x: left as u16,
                y: top as u16,
                width: side(left, right),
                height: side(top, bottom),
                ..label
            },
            value: value(index, labels.len()),
            pixels,
        })
    };
    labels.iter().zip(&seen).enumerate().filter_map(shows).collect()
}

/// The labels of a frame in the order of drawing, far to near.
#[derive(Clone, Debug, Default)]
pub(crate) struct Labels {
    pub list: Vec<Label>,
}

impl Labels {
    /// The class of the next actor.
    pub fn next_class(&self) -> u16 {
        class::FIRST_ACTOR + self.list.len() as u16
    }
}
