//! The player's face on the status bar: it glances about, winces, grins and rages.

use crate::world::parts::command::Buttons;
use crate::world::parts::face::Face;
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
