//! A player's own work of one tic: what the command means for view, thrust and jump, before the
//! body moves.

use crate::math::{Angle, Fixed};
use crate::world::parts::actor::Actor;
use crate::world::parts::command::{Buttons, Command};
use crate::world::parts::player::{Player, VIEW_HEIGHT};
use crate::world::state::world::World;
use crate::world::tables::info::ActorFlags;
use crate::world::tables::kinds::ActorKind;

/// Forward or backward command, walking and running, in command units.
const FORWARD: [i32; 2] = [25, 50];
/// Sideways command, walking and running.
const SIDE: [i32; 2] = [24, 40];
/// Largest command in either direction.
const LARGEST_COMMAND: i32 = 50;
/// Turn of the first tics of a hold, 65536ths of a turn per tic.
const SLOW_TURN: i32 = 320;
/// Turn from the sixth tic of a hold, walking and running.
const TURN: [i32; 2] = [640, 1280];
/// The tic of a hold from which turning is fast.
const FAST_TURN_FROM: u32 = 6;
/// Look button, walking and running, 65536ths of a turn per tic.
const LOOK: [i32; 2] = [450, 512];
/// Tics of a half turn.
const TURN180_TICS: u8 = 9;
/// Highest look: 32 degrees up.
const PITCH_UP: i64 = -((1 << 32) * 32 / 360);
/// Lowest look: 56 degrees down.
pub const PITCH_DOWN: i64 = (1 << 32) * 56 / 360;
/// Thrust of one command unit: 256ths of this many 65536ths of a map unit per tic.
const MOVE_FACTOR: i64 = 2048;
/// The same in the air.
const AIR_MOVE_FACTOR: i64 = MOVE_FACTOR / 256;
/// Upward speed of a jump, map units per tic.
const JUMP_SPEED: Fixed = Fixed::from_int(8);
/// Change of the crouch factor per tic.
const CROUCH_SPEED: Fixed = Fixed((1 << 16) / 12);

impl World {
    /// A player's think: crouch, look, turn, thrust, jump, eye, sector damage, weapon, counters.
    pub(crate) fn think_player(&mut self, index: usize, command: &Command) {
        let slot = usize::from(self.players[index].actor.slot);
        let player = &mut self.players[index];
        player.just_spent = [0; 4];
        player.old_buttons = std::mem::replace(&mut player.buttons, command.buttons);
        let turning = command.buttons.any(Buttons::TURN_LEFT | Buttons::TURN_RIGHT);
        player.turn_held_tics = if turning { player.turn_held_tics.saturating_add(1) } else { 0 };
        player.thrust = thrust_of(command.buttons);
        if player.dead {
            self.calculate_view(index);
            self.tick_weapon(index);
            self.tick_face(index);
            self.count_down(index);
            return;
        }
        self.crouch(index, slot, command.buttons);
        let player = &mut self.players[index];
        player.look(command);
        if player.jump_tics != 0 {
            player.jump_tics -= 1;
            if player.on_ground && player.jump_tics < -18 {
                player.jump_tics = 0;
            }
        }
        if command.buttons.any(Buttons::TURN180) && !player.old_buttons.any(Buttons::TURN180) {
            player.turn180_tics = TURN180_TICS;
        }
        if player.freeze_tics > 0 {
            player.freeze_tics -= 1;
        } else {
            self.turn(index, slot, command);
            self.push(index, slot);
            self.jump(index, slot, command.buttons);
        }
        self.calculate_view(index);
        self.damage_by_sector(index, slot);
        self.tick_weapon(index);
        self.tick_face(index);
        self.count_down(index);
    }

    fn count_down(&mut self, index: usize) {
        let player = &mut self.players[index];
        player.damage_count = player.damage_count.saturating_sub(1);
        player.bonus_count = player.bonus_count.saturating_sub(1);
    }

    /// Gets down or up by one twelfth, if the room allows.
    fn crouch(&mut self, index: usize, slot: usize, buttons: Buttons) {
        let player = &mut self.players[index];
        let wants_down = buttons.any(Buttons::CROUCH) && !buttons.any(Buttons::JUMP);
        let down = wants_down && !player.forced_rise;
        if wants_down && player.forced_rise {
            player.forced_rise = false;
        }
        let body = &self.actors[slot];
        if !down && player.crouch < Fixed::ONE && body.top() < body.ceiling_z {
            self.change_crouch(index, slot, CROUCH_SPEED);
        } else if down && player.crouch > Fixed::ONE / 2 {
            self.change_crouch(index, slot, -CROUCH_SPEED);
        }
    }

    fn change_crouch(&mut self, index: usize, slot: usize, change: Fixed) {
        let crouch = self.players[index].crouch + change;
        let full_height = ActorKind::Player.height();
        let body = &mut self.actors[slot];
        let height = std::mem::replace(&mut body.height, full_height * crouch);
        let (x, y) = (body.x, body.y);
        let fits = self.try_move(slot, x, y, false).moved;
        self.actors[slot].height = height;
        if !fits && change > Fixed::ZERO {
            return;
        }
        let player = &mut self.players[index];
        player.crouch = crouch.clamp(Fixed::ONE / 2, Fixed::ONE);
        player.view_height = VIEW_HEIGHT * player.crouch;
        player.crouch_view_offset = player.view_height - VIEW_HEIGHT;
    }

    /// Turns the body, and notes whether it stands.
    fn turn(&mut self, index: usize, slot: usize, command: &Command) {
        let player = &mut self.players[index];
        let body = &mut self.actors[slot];
        if player.turn180_tics > 0 {
            player.turn180_tics -= 1;
            body.angle += Angle(Angle::DEG_180.0 / u32::from(TURN180_TICS));
        } else {
            body.angle += Angle::from_turn_65536(yaw_of(command, player.turn_held_tics));
        }
        player.on_ground = body.z <= body.floor_z || body.flags.any(ActorFlags::ON_ACTOR);
    }

    /// Adds the thrust of the command to the velocity and to the bob.
    fn push(&mut self, index: usize, slot: usize) {
        let player = &mut self.players[index];
        let [forward, right] = player.thrust;
        if forward | right == 0 {
            return;
        }
        let body = &mut self.actors[slot];
        let factor = if player.on_ground { MOVE_FACTOR } else { AIR_MOVE_FACTOR };
        let bob_factor = if player.crouch == Fixed::ONE {
            Fixed(factor as i32)
        } else {
            Fixed(factor as i32) * player.crouch
        };
        let thrust = |command: i32| {
            let scaled = Fixed(command) * player.speed;
            let scaled = if player.crouch == Fixed::ONE { scaled } else { scaled * player.crouch };
            Fixed((i64::from(scaled.0) * factor / 256) as i32)
        };
        let right_angle = body.angle - Angle::DEG_90;
        let pushes = [(thrust(forward), forward, body.angle), (thrust(right), right, right_angle)];
        for (thrust, command, direction) in pushes {
            if thrust != Fixed::ZERO {
                let effort = Fixed((command * bob_factor.0) >> 8);
                player.bob_velocity[0] += effort * direction.cos();
                player.bob_velocity[1] += effort * direction.sin();
                body.vx += thrust * direction.cos();
                body.vy += thrust * direction.sin();
            }
        }
    }

    fn jump(&mut self, index: usize, slot: usize, buttons: Buttons) {
        if !buttons.any(Buttons::JUMP) {
            return;
        }
        let player = &mut self.players[index];
        if player.crouch_view_offset != Fixed::ZERO {
            player.forced_rise = true;
        } else if player.on_ground && player.jump_tics == 0 {
            let body = &mut self.actors[slot];
            body.vz += JUMP_SPEED;
            body.flags.set(ActorFlags::ON_ACTOR, false);
            player.jump_tics = -1;
        }
    }

    /// After a slide: the bob is no faster than the body.
    pub(crate) fn limit_bob(&mut self, slot: usize) {
        let Actor { vx, vy, .. } = self.actors[slot];
        if let Some(player) = self.actors[slot].player_index() {
            let bob = &mut self.players[player].bob_velocity;
            for (bob, v) in bob.iter_mut().zip([vx, vy]) {
                if bob.abs() > v.abs() {
                    *bob = v;
                }
            }
        }
    }
}

impl Player {
    /// Looks up or down by the buttons and the delta button.
    fn look(&mut self, command: &Command) {
        let look = LOOK[running(command.buttons)];
        let mut up = command.look_delta;
        if command.buttons.any(Buttons::LOOK_UP) {
            up += look;
        }
        if command.buttons.any(Buttons::LOOK_DOWN) {
            up -= look;
        }
        // The command has 16 bits.
        let up = i64::from(up as i16) << 16;
        self.pitch = (i64::from(self.pitch) - up).clamp(PITCH_UP, PITCH_DOWN) as i32;
    }
}

fn running(buttons: Buttons) -> usize {
    usize::from(buttons.any(Buttons::SPEED))
}

/// The forward and right command of the buttons, 256ths of command units.
fn thrust_of(buttons: Buttons) -> [i32; 2] {
    let run = running(buttons);
    let axis = |plus: Buttons, minus: Buttons, amount: i32| {
        let sum = amount * (i32::from(buttons.any(plus)) - i32::from(buttons.any(minus)));
        sum.clamp(-LARGEST_COMMAND, LARGEST_COMMAND) * 256
    };
    [
        axis(Buttons::MOVE_FORWARD, Buttons::MOVE_BACKWARD, FORWARD[run]),
        axis(Buttons::MOVE_RIGHT, Buttons::MOVE_LEFT, SIDE[run]),
    ]
}

/// The turn of the command, counter-clockwise, 65536ths of a turn.
fn yaw_of(command: &Command, held_tics: u32) -> i32 {
    let step = if held_tics < FAST_TURN_FROM { SLOW_TURN } else { TURN[running(command.buttons)] };
    let mut yaw = -command.turn_delta;
    if command.buttons.any(Buttons::TURN_LEFT) {
        yaw += step;
    }
    if command.buttons.any(Buttons::TURN_RIGHT) {
        yaw -= step;
    }
    yaw
}
