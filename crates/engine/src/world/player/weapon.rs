//! The weapon in a player's hands: raising, firing, lowering, its pictures and its choice.
//!
//! The timing is the original's: a press in a tic in which the weapon is ready starts the fire
//! sequence in that tic, so that the pistol's bullet leaves 4 tics later and the rocket 8 tics
//! later, and holding the button repeats the sequence without a tic between.

use crate::math::{Angle, Fixed};
use crate::world::parts::command::Buttons;
use crate::world::parts::event::Event;
use crate::world::parts::hands::Hands;
use crate::world::parts::hands::PUT_AWAY;
use crate::world::parts::hands::WeaponState;
use crate::world::parts::player::PlayerSprite;
use crate::world::state::world::World;
use crate::world::tables::kinds::{ActorKind, Weapon};
use crate::world::tables::weapons::{Shot, Spread};

/// Height at rest: 32.375.
const AT_REST: Fixed = Fixed((32 << 16) + 0x6000);
/// Raised or lowered per tic.
const RAISE_PER_TIC: Fixed = Fixed::from_int(6);

impl World {
    /// Whether a player owns a weapon and the ammunition for a shot.
    #[must_use]
    pub fn can_fire(&self, player: usize, weapon: Weapon) -> bool {
        let player = &self.players[player];
        player.weapons & weapon.bit() != 0
            && player.ammo[weapon.info().ammo] >= weapon.info().ammo_per_shot
    }

    /// Has a player change to a weapon that he owns and can fire; false where he cannot. Scripts'
    /// `SetWeapon`.
    pub fn select_weapon(&mut self, player: usize, weapon: Weapon) -> bool {
        if self.players[player].weapons & weapon.bit() == 0 {
            return false;
        }
        if self.players[player].weapon == Some(weapon) {
            self.players[player].weapon_state.pending = None;
            return true;
        }
        let usable = self.can_fire(player, weapon);
        if usable {
            self.players[player].weapon_state.pending = Some(weapon);
        }
        usable
    }

    /// Takes every weapon out of a player's hands, at once.
    pub(in crate::world) fn drop_hands(&mut self, player: usize) {
        let player = &mut self.players[player];
        player.weapon = None;
        player.sprites = [None; 2];
        player.extra_light = 0;
        let attack_down = player.weapon_state.attack_down;
        player.weapon_state = WeaponState { attack_down, ..WeaponState::default() };
    }

    /// One tic of a player's weapon: selection, then the weapon layer, then the flash, then the
    /// trigger.
    pub(in crate::world) fn tick_weapon(&mut self, player: usize) {
        self.choose_weapon(player);
        if self.players[player].weapon.is_none() {
            self.players[player].weapon_state.flash = None;
            if self.players[player].weapon_state.pending.is_some() {
                self.bring_up(player);
            }
        } else {
            match self.players[player].weapon_state.hands {
                Hands::Empty => {}
                Hands::Raising => self.raise(player),
                Hands::Lowering => self.lower(player),
                Hands::Ready => {}
                Hands::Firing => {
                    let state = &mut self.players[player].weapon_state;
                    state.tics -= 1;
                    if state.tics <= 0 {
                        let next = state.step + 1;
                        self.enter_fire_frame(player, next);
                    }
                }
            }
            self.tick_flash(player);
            let changes =
                self.players[player].weapon_state.pending.is_some() || self.players[player].dead;
            if self.players[player].weapon_state.hands == Hands::Ready && changes {
                self.start_lowering(player);
            }
            if self.players[player].weapon_state.hands == Hands::Ready {
                self.check_trigger(player);
            }
        }
        self.show_weapon(player);
    }

    /// Follows presses of the buttons that select the next or previous weapon.
    fn choose_weapon(&mut self, index: usize) {
        let player = &self.players[index];
        let pressed = |button| player.buttons.any(button) && !player.old_buttons.any(button);
        let (next, previous) =
            (pressed(Buttons::SELECT_NEXT_WEAPON), pressed(Buttons::SELECT_PREV_WEAPON));
        if next == previous || player.dead {
            return;
        }
        let current = player
            .weapon_state
            .pending
            .or(player.weapon)
            .map_or(Weapon::COUNT - 1, |weapon| weapon as usize);
        let stride = if next { 1 } else { Weapon::COUNT - 1 };
        let order =
            (1..=Weapon::COUNT).map(|i| Weapon::ALL[(current + i * stride) % Weapon::COUNT]);
        let Some(weapon) = order.into_iter().find(|&weapon| self.can_fire(index, weapon)) else {
            return;
        };
        if self.players[index].weapon != Some(weapon) {
            self.players[index].weapon_state.pending = Some(weapon);
        }
    }

    /// Takes the pending weapon into the hands and begins to raise it.
    fn bring_up(&mut self, player: usize) {
        let state = &mut self.players[player].weapon_state;
        match state.pending.take() {
            Some(weapon) => {
                state.height = PUT_AWAY;
                state.hands = Hands::Raising;
                self.players[player].weapon = Some(weapon);
                self.raise(player);
            }
            None => {
                state.height = AT_REST;
                state.hands = Hands::Ready;
            }
        }
    }

    fn raise(&mut self, player: usize) {
        if self.players[player].weapon_state.pending.is_some() {
            return self.start_lowering(player);
        }
        let state = &mut self.players[player].weapon_state;
        state.height -= RAISE_PER_TIC;
        if state.height <= AT_REST {
            state.height = AT_REST;
            state.hands = Hands::Ready;
        }
    }

    /// Begins to put the weapon away.
    pub(in crate::world) fn start_lowering(&mut self, player: usize) {
        if self.players[player].weapon.is_some() {
            self.players[player].weapon_state.hands = Hands::Lowering;
            self.lower(player);
        }
    }

    fn lower(&mut self, player: usize) {
        let dead = self.players[player].dead;
        let state = &mut self.players[player].weapon_state;
        state.height += RAISE_PER_TIC;
        if state.height < PUT_AWAY {
            return;
        }
        if dead {
            state.height = PUT_AWAY;
            state.hands = Hands::Empty;
            return;
        }
        state.flash = None;
        self.players[player].extra_light = 0;
        self.bring_up(player);
    }

    /// Fires if the button is down, by the rule of a fresh press for the weapons that have it.
    fn check_trigger(&mut self, player: usize) {
        let Some(weapon) = self.players[player].weapon else { return };
        let held = self.players[player].buttons.any(Buttons::ATTACK);
        let state = &mut self.players[player].weapon_state;
        if !held {
            state.attack_down = false;
        } else if !state.attack_down || !weapon.info().fresh_press {
            state.attack_down = true;
            self.fire(player);
        }
    }

    /// Starts the fire sequence, or reaches for another weapon where the ammunition is spent.
    fn fire(&mut self, player: usize) {
        let Some(weapon) = self.players[player].weapon else { return };
        if self.can_fire(player, weapon) {
            self.players[player].weapon_state.hands = Hands::Firing;
            self.enter_fire_frame(player, 0);
        } else {
            self.reach_for_another(player);
        }
    }

    /// Changes to the best weapon that can fire, if there is one.
    fn reach_for_another(&mut self, player: usize) {
        let best = Weapon::ALL.into_iter().filter(|&weapon| self.can_fire(player, weapon));
        if let Some(best) = best.min_by_key(|weapon| weapon.info().rank) {
            self.players[player].weapon_state.pending = Some(best);
            self.start_lowering(player);
        }
    }

    /// Enters a frame of the fire sequence and every frame without duration after it; past the end
    /// the weapon is ready.
    fn enter_fire_frame(&mut self, player: usize, step: u8) {
        let Some(weapon) = self.players[player].weapon else { return };
        let mut step = step;
        loop {
            let state = &mut self.players[player].weapon_state;
            let Some(frame) = weapon.info().fire.get(usize::from(step)) else {
                state.hands = Hands::Ready;
                return;
            };
            (state.step, state.tics) = (step, frame.tics);
            match frame.shot {
                Shot::None => {}
                Shot::Flash => self.start_flash(player, 0),
                Shot::Fire => self.shoot(player, weapon, step),
                Shot::Again => {
                    if self.fire_again(player) {
                        return;
                    }
                }
            }
            if frame.tics > 0 || self.players[player].weapon_state.hands != Hands::Firing {
                return;
            }
            step += 1;
        }
    }

    /// Repeats the sequence while the button is held; true if the hands were given something else
    /// to do.
    fn fire_again(&mut self, player: usize) -> bool {
        let (held, dead) =
            (self.players[player].buttons.any(Buttons::ATTACK), self.players[player].dead);
        let state = &mut self.players[player].weapon_state;
        if held && state.pending.is_none() && !dead {
            state.repeats += 1;
            self.fire(player);
            return self.players[player].weapon_state.step == 0
                || self.players[player].weapon_state.hands != Hands::Firing;
        }
        state.repeats = 0;
        if let Some(weapon) = self.players[player].weapon
            && !self.can_fire(player, weapon)
        {
            self.reach_for_another(player);
        }
        self.players[player].weapon_state.hands != Hands::Firing
    }

    /// Spends ammunition and sends off what the weapon sends.
    fn shoot(&mut self, player: usize, weapon: Weapon, step: u8) {
        let info = weapon.info();
        if self.players[player].ammo[info.ammo] < info.ammo_per_shot {
            return;
        }
        self.players[player].ammo[info.ammo] -= info.ammo_per_shot;
        self.players[player].just_spent[info.ammo] += info.ammo_per_shot;
        self.events.push(Event::Fired { player });
        let accurate = self.players[player].weapon_state.repeats == 0;
        match weapon {
            Weapon::Pistol => {
                self.start_flash(player, 0);
                self.fire_bullets(player, 1, if accurate { Spread::NONE } else { Spread::NARROW });
            }
            Weapon::Chaingun => {
                self.start_flash(player, step);
                self.fire_bullets(player, 1, if accurate { Spread::NONE } else { Spread::NARROW });
            }
            Weapon::Shotgun => {
                self.start_flash(player, 0);
                self.fire_bullets(player, 7, Spread::NARROW);
            }
            Weapon::SuperShotgun => {
                self.start_flash(player, 0);
                self.fire_bullets(player, 20, Spread::WIDE);
            }
            Weapon::RocketLauncher => self.throw_missile(player, ActorKind::Rocket),
            Weapon::PlasmaRifle => {
                let sequence = (self.rng.byte() & 1) as u8;
                self.start_flash(player, sequence);
                self.throw_missile(player, ActorKind::PlasmaBall);
            }
            Weapon::Bfg9000 => self.throw_missile(player, ActorKind::BfgBall),
        }
    }

    fn start_flash(&mut self, player: usize, sequence: u8) {
        let Some(weapon) = self.players[player].weapon else { return };
        let frame = &weapon.info().flashes[usize::from(sequence)][0];
        let owner = &mut self.players[player];
        owner.weapon_state.flash = Some((sequence, 0));
        owner.weapon_state.flash_tics = frame.tics;
        owner.extra_light = frame.light;
    }

    fn tick_flash(&mut self, player: usize) {
        let owner = &mut self.players[player];
        let (Some((sequence, step)), Some(weapon)) = (owner.weapon_state.flash, owner.weapon)
        else {
            return;
        };
        owner.weapon_state.flash_tics -= 1;
        if owner.weapon_state.flash_tics > 0 {
            return;
        }
        match weapon.info().flashes[usize::from(sequence)].get(usize::from(step) + 1) {
            Some(frame) => {
                owner.weapon_state.flash = Some((sequence, step + 1));
                owner.weapon_state.flash_tics = frame.tics;
                owner.extra_light = frame.light;
            }
            None => {
                owner.weapon_state.flash = None;
                owner.extra_light = 0;
            }
        }
    }

    /// Lays out the pictures of the weapon and its flash as they are after this tic.
    fn show_weapon(&mut self, player: usize) {
        let tic = self.tic.wrapping_add(1);
        let owner = &mut self.players[player];
        let state = &mut owner.weapon_state;
        let Some(weapon) = owner.weapon.filter(|_| state.hands != Hands::Empty) else {
            owner.sprites = [None; 2];
            return;
        };
        let info = weapon.info();
        let target = if state.hands == Hands::Ready { owner.bob } else { Fixed::ZERO };
        state.swing =
            Fixed(target.0.clamp(state.swing.0 - Fixed::ONE.0, state.swing.0 + Fixed::ONE.0));
        // A swing takes 64 tics.
        let turn = Angle::from_fine((tic.wrapping_mul(128) & 8191) as i32);
        let half_turn = Angle::from_fine((tic.wrapping_mul(128) & 4095) as i32);
        let x = state.swing * turn.cos();
        let y = state.height + state.swing * half_turn.sin();
        let frame =
            if state.hands == Hands::Firing { info.fire[usize::from(state.step)].frame } else { 0 };
        let flash = state.flash.map(|(sequence, step)| PlayerSprite {
            sprite: info.flash_sprite,
            frame: info.flashes[usize::from(sequence)][usize::from(step)].frame,
            bright: true,
            x,
            y,
        });
        owner.sprites =
            [Some(PlayerSprite { sprite: info.sprite, frame, bright: false, x, y }), flash];
    }
}
