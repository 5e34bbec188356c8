//! The list of actors in view.

use crate::render::buffers::frame::class;
use crate::world::{ActorId, ActorKind};

/// An actor of which at least one pixel was drawn, though what came later may have covered it again.
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
