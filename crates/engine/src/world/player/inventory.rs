//! What players carry: what each item gives, and when it is refused.

use crate::world::state::world::World;
use crate::world::tables::kinds::{ActorKind, Weapon};
use crate::world::tables::weapons::ammo;

/// Tics of light amplification: 120 seconds.
const INFRARED_TICS: u32 = 120 * 35;
/// Tics of a radiation suit, and of partial invisibility: 60 seconds.
const SUIT_TICS: u32 = 60 * 35;

/// The yellow key card's bit in [`Player::keys`](crate::world::Player::keys).
pub const YELLOW_CARD: u8 = 1;
/// The blue skull's bit in [`Player::keys`](crate::world::Player::keys).
pub const BLUE_SKULL: u8 = 2;

impl World {
    /// Gives a player what an item of a kind gives. False where it is refused and would stay on the
    /// ground: health packs at full health, ammunition when full, keys that are owned. `dropped`
    /// items hold half the ammunition.
    pub fn give(&mut self, player: usize, kind: ActorKind, dropped: bool) -> bool {
        match kind {
            ActorKind::HealthBonus => {
                self.heal(player, 1, 200);
                true
            }
            ActorKind::Stimpack => self.heal(player, 10, 100),
            ActorKind::Medikit => self.heal(player, 25, 100),
            ActorKind::ArmorBonus => {
                let armor = &mut self.players[player].armor;
                *armor = (*armor).max((*armor + 1).min(200));
                true
            }
            ActorKind::RocketAmmo => self.give_ammo(player, ammo::ROCKET, 1),
            ActorKind::Shell => self.give_ammo(player, ammo::SHELL, 4),
            ActorKind::Cell => self.give_ammo(player, ammo::CELL, 20),
            ActorKind::Clip => self.give_ammo(player, ammo::CLIP, if dropped { 5 } else { 10 }),
            ActorKind::Infrared => {
                self.players[player].infrared_tics = INFRARED_TICS;
                true
            }
            ActorKind::BlurSphere => {
                self.players[player].blur_tics = SUIT_TICS;
                true
            }
            ActorKind::RadSuit => {
                self.players[player].rad_suit_tics = SUIT_TICS;
                true
            }
            // There is no automap to reveal.
            ActorKind::Allmap => true,
            ActorKind::Backpack => {
                self.players[player].max_ammo = ammo::MOST.map(|most| 2 * most);
                for (which, amount) in
                    [(ammo::CLIP, 10), (ammo::SHELL, 4), (ammo::ROCKET, 1), (ammo::CELL, 20)]
                {
                    self.give_ammo(player, which, amount);
                }
                true
            }
            ActorKind::YellowCard => self.give_key(player, YELLOW_CARD),
            ActorKind::BlueSkull => self.give_key(player, BLUE_SKULL),
            _ => match kind.weapon() {
                Some(weapon) => self.give_weapon(player, weapon, dropped),
                None => false,
            },
        }
    }

    /// Adds ammunition of a type (see [`ammo`]); false where the player has as much as he can
    /// carry.
    pub fn give_ammo(&mut self, player: usize, which: usize, amount: i32) -> bool {
        let player = &mut self.players[player];
        if player.ammo[which] >= player.max_ammo[which] {
            return false;
        }
        player.ammo[which] = (player.ammo[which] + amount).min(player.max_ammo[which]);
        true
    }

    /// Gives a weapon with its ammunition; the player changes to it if it is new to him. A second
    /// one is taken for its ammunition only.
    pub fn give_weapon(&mut self, player: usize, weapon: Weapon, dropped: bool) -> bool {
        let given = weapon.info().ammo_given;
        let took_ammo =
            self.give_ammo(player, weapon.info().ammo, if dropped { given / 2 } else { given });
        let owner = &mut self.players[player];
        if owner.weapons & weapon.bit() != 0 {
            return took_ammo;
        }
        owner.weapons |= weapon.bit();
        owner.weapon_state.pending = Some(weapon);
        owner.face_state.grin = true;
        true
    }

    /// Takes everything from a player: weapons, ammunition, armour, powers, keys, the backpack.
    pub fn clear_inventory(&mut self, player: usize) {
        self.drop_hands(player);
        let player = &mut self.players[player];
        player.weapons = 0;
        player.ammo = [0; 4];
        player.max_ammo = ammo::MOST;
        player.armor = 0;
        player.keys = 0;
        (player.infrared_tics, player.rad_suit_tics, player.blur_tics) = (0, 0, 0);
    }

    /// Adds health up to `most`; false if the player has that much.
    pub fn heal(&mut self, player: usize, amount: i32, most: i32) -> bool {
        let body = self.players[player].actor;
        let Some(actor) = self.get_mut(body) else { return false };
        if actor.health >= most || actor.health <= 0 {
            return false;
        }
        actor.health = (actor.health + amount).min(most);
        true
    }

    fn give_key(&mut self, player: usize, key: u8) -> bool {
        let player = &mut self.players[player];
        let new = player.keys & key == 0;
        player.keys |= key;
        new
    }

    /// Counts the powers and the screen flashes down by one tic.
    pub(in crate::world) fn tick_powers(&mut self, player: usize) {
        let player = &mut self.players[player];
        for tics in [&mut player.infrared_tics, &mut player.rad_suit_tics, &mut player.blur_tics] {
            *tics = tics.saturating_sub(1);
        }
    }
}
