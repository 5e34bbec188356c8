//! Action spaces: groups of exclusive buttons, and delta buttons.

use hasard_engine::world::Buttons;

/// A sub-action: 0 presses nothing, `i` presses `buttons[i - 1]`.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct ActionGroup {
    /// The exclusive buttons, with their names.
    pub buttons: Vec<(&'static str, Buttons)>,
}

/// A continuous sub-action in [-1, 1], times 7.5 degrees per tic.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum DeltaButton {
    /// `LOOK_UP_DOWN_DELTA`: positive looks up.
    Look,
    /// `TURN_LEFT_RIGHT_DELTA`: positive turns right.
    Turn,
}

/// A tuple of categorical sub-actions followed by a tuple of continuous ones.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct ActionSpace {
    /// The categorical sub-actions.
    pub groups: Vec<ActionGroup>,
    /// The continuous sub-actions; empty for simplified spaces.
    pub deltas: Vec<DeltaButton>,
}

impl ActionSpace {
    /// Number of choices of each categorical sub-action.
    #[must_use]
    pub fn sizes(&self) -> Vec<usize> {
        self.groups.iter().map(|group| group.buttons.len() + 1).collect()
    }
}
