//! The action space that several environments have together.

use crate::spaces::action::{ActionGroup, ActionSpace, BUTTONS, DeltaButton};
use hasard_engine::world::Buttons;

/// The continuous sub-actions.
const DELTAS: [DeltaButton; 2] = [DeltaButton::Look, DeltaButton::Turn];

impl ActionSpace {
    /// The space with the buttons of all: groups that share a button become one, so that buttons
    /// that exclude each other in one of them do so in all.
    pub(crate) fn joined(all: impl IntoIterator<Item = ActionSpace>) -> ActionSpace {
        let none = ActionSpace { groups: Vec::new(), deltas: Vec::new() };
        all.into_iter().fold(none, |space, other| joined(space, &other))
    }

    /// A space in which a button that this one does not have does nothing; this one where none is
    /// given.
    pub(crate) fn within(self, space: Option<ActionSpace>) -> ActionSpace {
        let Some(mut space) = space else { return self };
        let lacking = self.lacking(&space);
        for (name, button) in space.groups.iter_mut().flat_map(|group| &mut group.buttons) {
            if lacking.contains(name) {
                *button = Buttons::default();
            }
        }
        space
    }

    /// The names of the buttons and continuous parts of another space that this one does not have.
    #[must_use]
    pub fn lacking(&self, other: &ActionSpace) -> Vec<&'static str> {
        fn buttons(space: &ActionSpace) -> impl Iterator<Item = &'static str> {
            space.groups.iter().flat_map(|group| &group.buttons).map(|(name, _)| *name)
        }
        let buttons = buttons(other).filter(|name| buttons(self).all(|own| own != *name));
        let deltas = other.deltas.iter().filter(|delta| !self.deltas.contains(delta));
        buttons.chain(deltas.map(|delta| delta.name())).collect()
    }

    /// The names of its parts: exclusive buttons with strokes between them, groups and continuous
    /// parts with spaces. [`ActionSpace::named`] reads it.
    #[must_use]
    pub fn names(&self) -> String {
        let group = |group: &ActionGroup| {
            group.buttons.iter().map(|(name, _)| *name).collect::<Vec<_>>().join("|")
        };
        let deltas = self.deltas.iter().map(|delta| delta.name().to_string());
        self.groups.iter().map(group).chain(deltas).collect::<Vec<_>>().join(" ")
    }

    /// The space of these names; `None` if one is no button.
    #[must_use]
    pub fn named(names: &str) -> Option<ActionSpace> {
        let mut space = ActionSpace { groups: Vec::new(), deltas: Vec::new() };
        for part in names.split(' ') {
            if let Some(delta) = DELTAS.into_iter().find(|delta| delta.name() == part) {
                space.deltas.push(delta);
                continue;
            }
            let button = |name: &str| BUTTONS.into_iter().find(|(known, _)| *known == name);
            let buttons = part.split('|').map(button).collect::<Option<_>>()?;
            space.groups.push(ActionGroup { buttons });
        }
        Some(space)
    }
}

/// A space with the buttons of both: groups that share a button become one, so that buttons that
/// exclude each other in one of the tasks do so in all.
fn joined(mut space: ActionSpace, other: &ActionSpace) -> ActionSpace {
    for group in &other.groups {
        let shares = |known: &ActionGroup| {
            known.buttons.iter().any(|(name, _)| group.buttons.iter().any(|(own, _)| own == name))
        };
        let place = space.groups.iter().position(&shares).unwrap_or(space.groups.len());
        let (sharing, apart): (Vec<_>, Vec<_>) = space.groups.into_iter().partition(shares);
        let mut buttons: Vec<_> = sharing.into_iter().flat_map(|group| group.buttons).collect();
        for button in &group.buttons {
            if !buttons.iter().any(|(name, _)| *name == button.0) {
                buttons.push(*button);
            }
        }
        space.groups = apart;
        space.groups.insert(place, ActionGroup { buttons });
    }
    for delta in &other.deltas {
        if !space.deltas.contains(delta) {
            space.deltas.push(*delta);
        }
    }
    space
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_space_is_read_as_it_is_written() {
        let spaces = [
            ActionSpace::new(&[&["TURN_LEFT", "TURN_RIGHT"], &["JUMP"]], &[DeltaButton::Turn]),
            ActionSpace::new(&[&["ATTACK"]], &[]),
        ];
        for count in [1, 2] {
            let space = ActionSpace::joined(spaces[..count].iter().cloned());
            assert_eq!(ActionSpace::named(&space.names()), Some(space));
        }
        for wrong in ["", "JUMP|FLY", "JUMP  USE", "jump"] {
            assert_eq!(ActionSpace::named(wrong), None, "{wrong}");
        }
    }
}
