//! What actions are in a mirror.

use hasard_envs::{ActionSpace, DeltaButton};
use serde::{Deserialize, Serialize};

use crate::error::LearnError;

/// Which output of the mirror image an output stands beside.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct Reflected {
    /// Its column.
    pub column: usize,
    /// It counts with the opposite sign: how far to turn to the right is how far not to turn to the
    /// left.
    pub opposite: bool,
}

impl Reflected {
    /// The factor that it counts with.
    #[must_use]
    pub fn sign(self) -> f32 {
        if self.opposite { -1.0 } else { 1.0 }
    }
}

/// The button on the other side; the same for one that has none.
fn other_side(name: &str) -> &str {
    match name {
        "MOVE_LEFT" => "MOVE_RIGHT",
        "MOVE_RIGHT" => "MOVE_LEFT",
        "TURN_LEFT" => "TURN_RIGHT",
        "TURN_RIGHT" => "TURN_LEFT",
        other => other,
    }
}

/// What a policy's outputs are in a mirror: logits of left stand beside those of right.
///
/// # Errors
/// When the actions have a side without the other.
pub fn reflections(space: &ActionSpace) -> Result<Vec<Reflected>, LearnError> {
    let mut all = Vec::new();
    for group in &space.groups {
        let first = all.len();
        all.push(Reflected { column: first, opposite: false });
        for (name, _) in &group.buttons {
            let other = other_side(name);
            let at = group.buttons.iter().position(|(name, _)| *name == other);
            let Some(at) = at else {
                return Err(LearnError::Config(format!(
                    "network.mirror is on, but {name} has no {other} in its group of buttons: give the task both in one group of \
                     its actions, or use false"
                )));
            };
            all.push(Reflected { column: first + 1 + at, opposite: false });
        }
    }
    for delta in &space.deltas {
        let mean = all.len();
        all.push(Reflected { column: mean, opposite: *delta == DeltaButton::Turn });
        all.push(Reflected { column: mean + 1, opposite: false });
    }
    Ok(all)
}
