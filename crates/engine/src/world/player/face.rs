//! The player's face on the status bar: it glances about, winces, grins and rages.

use crate::world::state::command::Buttons;
use crate::world::state::world::World;

/// Tics between glances.
const GLANCE_TICS: u32 = 17;
/// Tics that a wince lasts.
const PAIN_TICS: u32 = 35;
/// Tics that a grin lasts.
const GRIN_TICS: u32 = 70;
/// Tics of firing after which the face rages.
const RAGE_AFTER_TICS: u32 = 70;
/// A loss of more health than this in a tic is felt as an outcry.
const MUCH_PAIN: i32 = 20;

/// What the face shows, within the band of the player's health.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Face {
    /// Looks right (0), ahead (1) or left (2): pictures `STFST` + band + this.
    Glance(u8),
    /// Cries out: `STFOUCH` + band.
    Ouch,
    /// Grins at a new weapon: `STFEVL` + band.
    Grin,
    /// Clenches its teeth in pain or rage: `STFKILL` + band.
    Rage,
    /// Dead: `STFDEAD0`.
    Dead,
}

/// What the face remembers from tic to tic.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct FaceState {
    /// What is shown.
    pub shown: Face,
    /// Tics left of it.
    tics: u32,
    /// Health at the last tic.
    health: i32,
    /// Tics of firing without a break.
    firing_tics: u32,
    /// A weapon was taken that the player did not have.
    pub(in crate::world) grin: bool,
}

impl Default for FaceState {
    fn default() -> FaceState {
        FaceState { shown: Face::Glance(1), tics: 0, health: 0, firing_tics: 0, grin: false }
    }
}

impl World {
    /// Band of a player's health for the face: 0 at 80 and more, 4 below 20.
    #[must_use]
    pub fn face_band(&self, player: usize) -> u8 {
        let health =
            self.get(self.players[player].actor).map_or(0, |body| body.health.clamp(0, 100));
        ((100 - health) * 5 / 101) as u8
    }

    /// One tic of the face.
    pub(in crate::world) fn tick_face(&mut self, index: usize) {
        let health = self.get(self.players[index].actor).map_or(0, |body| body.health);
        let player = &mut self.players[index];
        let face = &mut player.face_state;
        let lost = face.health - health;
        face.health = health;
        face.tics = face.tics.saturating_sub(1);
        let firing = player.buttons.any(Buttons::ATTACK) && player.weapon.is_some();
        face.firing_tics = if firing { (face.firing_tics + 1).min(RAGE_AFTER_TICS) } else { 0 };
        if player.dead {
            face.shown = Face::Dead;
        } else if std::mem::take(&mut face.grin) {
            (face.shown, face.tics) = (Face::Grin, GRIN_TICS);
        } else if lost > 0 && face.shown != Face::Grin {
            let shown = if lost > MUCH_PAIN { Face::Ouch } else { Face::Rage };
            // A scratch does not end an outcry.
            if face.shown != Face::Ouch || shown == Face::Ouch || face.tics == 0 {
                (face.shown, face.tics) = (shown, PAIN_TICS);
            }
        } else if face.tics == 0 {
            if face.firing_tics == RAGE_AFTER_TICS {
                (face.shown, face.tics) = (Face::Rage, 1);
            } else {
                (face.shown, face.tics) = (Face::Glance(self.rng.below(3) as u8), GLANCE_TICS);
            }
        }
    }
}
