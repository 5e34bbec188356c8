//! The eye: its height above the feet, its recovery from steps and landings, and its bob.

use crate::math::{Angle, Fixed};
use crate::world::parts::player::Player;
use crate::world::parts::player::VIEW_HEIGHT;
use crate::world::state::world::World;

/// Most that the bob swings from top to bottom.
const LARGEST_BOB: Fixed = Fixed::from_int(16);

/// The eye's smallest distance to floor and ceiling.
const EYE_CLEARANCE: Fixed = Fixed::from_int(4);

/// Height of a dead player's eye.
const FALLEN_VIEW_HEIGHT: Fixed = Fixed::from_int(6);

/// Tics of one swing of the bob.
const BOB_PERIOD: u32 = 20;

impl Player {
    /// The speed with which the eye starts to return to its rest height: an eighth of what is
    /// missing.
    pub(crate) fn view_recovery(&self) -> Fixed {
        (VIEW_HEIGHT + self.crouch_view_offset - self.view_height) >> 3
    }
}

impl World {
    /// Computes a player's eye height. Runs before the body moves, so that the eye lags one tic in
    /// height.
    pub(crate) fn calculate_view(&mut self, index: usize) {
        let player = &mut self.players[index];
        let [vx, vy] = player.bob_velocity;
        let effort =
            ((i64::from(vx.0) * i64::from(vx.0) + i64::from(vy.0) * i64::from(vy.0)) >> 16) as i32;
        player.bob = (Fixed(effort) >> 2).min(LARGEST_BOB);
        let phase = ((u64::from(self.tic) << 13) / u64::from(BOB_PERIOD)) as u32 & 8191;
        let swing = if effort == 0 {
            Fixed::ZERO
        } else {
            (player.bob >> 1) * Angle::from_fine(phase as i32).sin()
        };
        if player.dead {
            player.view_height = (player.view_height - Fixed::ONE).max(FALLEN_VIEW_HEIGHT);
            player.delta_view_height = Fixed::ZERO;
        } else {
            player.recover_view();
        }
        let height = player.view_height + swing;
        let body = &self.actors[usize::from(player.actor.slot)];
        let eye =
            (body.z + height).min(body.ceiling_z - EYE_CLEARANCE).max(body.floor_z + EYE_CLEARANCE);
        self.players[index].view_z = eye;
    }
}

impl Player {
    /// One tic of the eye's return to its rest height.
    fn recover_view(&mut self) {
        let rest = VIEW_HEIGHT + self.crouch_view_offset;
        self.view_height += self.delta_view_height;
        if self.view_height > rest {
            self.view_height = rest;
            self.delta_view_height = Fixed::ZERO;
        } else if self.view_height < rest >> 1 {
            self.view_height = rest >> 1;
            self.delta_view_height = self.delta_view_height.max(Fixed(1));
        }
        if self.delta_view_height != Fixed::ZERO {
            self.delta_view_height += Fixed::ONE / 4;
            if self.delta_view_height == Fixed::ZERO {
                self.delta_view_height = Fixed(1);
            }
        }
    }
}
