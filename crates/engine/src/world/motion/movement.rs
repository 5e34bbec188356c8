//! The move of an actor in one tic: in the plane, then in height.

use crate::math::Fixed;
use crate::world::motion::collision::{PASSES, approximate_distance};
use crate::world::parts::actor::Actor;
use crate::world::parts::event::Event;
use crate::world::state::world::World;
use crate::world::tables::info::ActorFlags;

/// Speed kept on the ground from one tic to the next: 0.90625.
pub(crate) const FRICTION: Fixed = Fixed(0xE800);

/// Below this in both directions (1/16 map unit per tic) an actor without effort stops.
const STOP_SPEED: Fixed = Fixed(0x1000);

/// Fall of speed per tic, map units per tic.
const GRAVITY: Fixed = Fixed::ONE;

/// Fastest plane speed of crouching players, map units per tic and axis.
const CROUCHED_SPEED_LIMIT: Fixed = Fixed::from_int(30);

/// Landings faster than a jump's (8 map units per tic) make the knees bend.
const HARD_LANDING: Fixed = Fixed::from_int(-8);

/// Height change of floaters towards their target, map units per tic.
pub(crate) const FLOAT_SPEED: Fixed = Fixed::from_int(4);

/// What a plane move leaves for the vertical one.
#[derive(Clone, Copy)]
struct PlaneMove {
    /// The floor before the move.
    old_floor: Fixed,
    /// The last attempt met an actor.
    met_actor: bool,
}

impl World {
    /// Moves an actor by its velocity, lets it fall, rise and land. Missiles that hit something
    /// burst.
    pub(crate) fn move_actor(&mut self, slot: usize) {
        let generation = self.actors[slot].generation;
        let plane = self.move_in_plane(slot);
        let actor = &self.actors[slot];
        if actor.generation != generation {
            return;
        }
        if actor.vz == Fixed::ZERO && !plane.met_actor && actor.z == actor.floor_z {
            return;
        }
        if actor.flags.any(PASSES) {
            let z = self.next_height(slot);
            if let Some(other) = self.actor_at(slot, z) {
                self.stand_on(slot, other);
                return;
            }
            self.move_in_height(slot, plane.old_floor);
            self.actors[slot].flags.set(ActorFlags::ON_ACTOR, false);
        } else {
            self.move_in_height(slot, plane.old_floor);
        }
    }

    /// The plane move: in steps short enough not to skip a line, with sliding, then friction.
    fn move_in_plane(&mut self, slot: usize) -> PlaneMove {
        let mut outcome = PlaneMove { old_floor: self.actors[slot].floor_z, met_actor: false };
        self.limit_crouched_speed(slot);
        let actor = &self.actors[slot];
        let (mut vx, mut vy) = (actor.vx, actor.vy);
        if vx.0 | vy.0 == 0 {
            return outcome;
        }
        let longest = actor.radius - Fixed::ONE;
        let longest = if longest.0 <= 0 { CROUCHED_SPEED_LIMIT } else { longest };
        let fastest = vx.abs().max(vy.abs());
        let steps = if fastest > longest { 1 + fastest.0 / longest.0 } else { 1 };
        let (step_x, step_y) = (vx / steps, vy / steps);
        let (mut start_x, mut start_y) = (actor.x, actor.y);
        for step in 1..=steps {
            let (x, y) = (start_x + part(vx, step, steps), start_y + part(vy, step, steps));
            let attempt = self.try_move(slot, x, y, true);
            outcome.met_actor = attempt.position.blocking_actor.is_some();
            if attempt.moved {
                continue;
            }
            let flags = self.actors[slot].flags;
            if flags.any(ActorFlags::MISSILE) {
                self.missile_blocked(slot, &attempt);
                return outcome;
            }
            if !flags.any(ActorFlags::PLAYER) {
                self.stop(slot);
                break;
            }
            if outcome.met_actor {
                self.slide_along_actor(slot, step_x, step_y);
                break;
            }
            self.slide(slot, step_x, step_y, steps);
            let actor = &self.actors[slot];
            (vx, vy) = (actor.vx, actor.vy);
            if vx.0 | vy.0 == 0 {
                break;
            }
            (start_x, start_y) = (actor.x - part(vx, step, steps), actor.y - part(vy, step, steps));
        }
        self.apply_friction(slot);
        outcome
    }

    /// Around an actor: north or south only, else east or west only, else not at all.
    fn slide_along_actor(&mut self, slot: usize, step_x: Fixed, step_y: Fixed) {
        let (x, y) = (self.actors[slot].x, self.actors[slot].y);
        if self.try_move(slot, x, y + step_y, true).moved {
            self.actors[slot].vx = Fixed::ZERO;
        } else if self.try_move(slot, x + step_x, y, true).moved {
            self.actors[slot].vy = Fixed::ZERO;
        } else {
            self.stop(slot);
        }
        if let Some(player) = self.actors[slot].player_index() {
            let bob = &mut self.players[player].bob_velocity;
            if self.actors[slot].vx == Fixed::ZERO {
                bob[0] = Fixed::ZERO;
            }
            if self.actors[slot].vy == Fixed::ZERO {
                bob[1] = Fixed::ZERO;
            }
        }
    }

    fn stop(&mut self, slot: usize) {
        let actor = &mut self.actors[slot];
        (actor.vx, actor.vy) = (Fixed::ZERO, Fixed::ZERO);
    }

    /// Friction on the ground; none in the air.
    fn apply_friction(&mut self, slot: usize) {
        let actor = &mut self.actors[slot];
        if actor.flags.any(ActorFlags::MISSILE)
            || (actor.z > actor.floor_z && !actor.flags.any(ActorFlags::ON_ACTOR))
        {
            return;
        }
        let player = actor.player_index();
        let pushes = player.is_some_and(|player| self.players[player].thrust != [0, 0]);
        let slow = |v: Fixed| v.abs() < STOP_SPEED;
        if slow(actor.vx) && slow(actor.vy) && !pushes {
            (actor.vx, actor.vy) = (Fixed::ZERO, Fixed::ZERO);
            if let Some(player) = player {
                self.players[player].bob_velocity = [Fixed::ZERO; 2];
            }
        } else {
            (actor.vx, actor.vy) = (actor.vx * FRICTION, actor.vy * FRICTION);
            if let Some(player) = player {
                let [x, y] = self.players[player].bob_velocity;
                self.players[player].bob_velocity = [x * FRICTION, y * FRICTION];
            }
        }
    }

    /// Crouching players are held to 30 map units per tic, the direction kept.
    fn limit_crouched_speed(&mut self, slot: usize) {
        let actor = &mut self.actors[slot];
        let Some(player) = actor.player_index() else { return };
        let limit = CROUCHED_SPEED_LIMIT;
        if self.players[player].crouch < Fixed::ONE * 3 / 4
            && (actor.vx.abs() > limit || actor.vy.abs() > limit)
        {
            let factor = limit / actor.vx.abs().max(actor.vy.abs());
            (actor.vx, actor.vy) = (actor.vx * factor, actor.vy * factor);
        }
    }

    /// The height that the vertical move would give, for the test of what is below.
    fn next_height(&self, slot: usize) -> Fixed {
        let actor = &self.actors[slot];
        let z = (actor.z + actor.vz + self.float_step(slot)).max(actor.floor_z);
        if z + actor.height > actor.ceiling_z { actor.ceiling_z - actor.height } else { z }
    }

    /// A floater's step of height towards its target, zero unless the target is close and well
    /// above or below.
    fn float_step(&self, slot: usize) -> Fixed {
        let actor = &self.actors[slot];
        if !actor.flags.any(ActorFlags::FLOAT) || actor.in_float || !actor.pursuing {
            return Fixed::ZERO;
        }
        let Some(target) = actor.goal.and_then(|id| self.get(id)) else { return Fixed::ZERO };
        let distance = approximate_distance(target.x - actor.x, target.y - actor.y);
        let rise = target.z + (actor.height >> 1) - actor.z;
        match rise.0.signum() {
            1 if distance < rise * 3 => FLOAT_SPEED,
            -1 if distance < -(rise * 3) => -FLOAT_SPEED,
            _ => Fixed::ZERO,
        }
    }

    /// Lands an actor on another, or lifts it there from within a step's height.
    fn stand_on(&mut self, slot: usize, other: usize) {
        let top = self.actors[other].top();
        let actor = &self.actors[slot];
        let rise = top - actor.z;
        if let Some(player) = actor.player_index() {
            if actor.vz < HARD_LANDING {
                self.players[player].delta_view_height = actor.vz >> 3;
            }
            if rise <= actor.max_step {
                let player = &mut self.players[player];
                player.view_height -= rise;
                player.delta_view_height = player.delta_view_height.max(player.view_recovery());
            }
        }
        let actor = &mut self.actors[slot];
        if rise <= actor.max_step {
            actor.z = top;
        }
        actor.flags.set(ActorFlags::ON_ACTOR, true);
        actor.vz = Fixed::ZERO;
    }

    /// The vertical move: velocity, gravity, floor, ceiling. `old_floor` is the floor before the
    /// plane move: walking off a ledge starts the fall with double gravity.
    fn move_in_height(&mut self, slot: usize, old_floor: Fixed) {
        let float_step = self.float_step(slot);
        let actor = &mut self.actors[slot];
        let player = actor.player_index();
        if let Some(player) = player
            && actor.z < actor.floor_z
        {
            let player = &mut self.players[player];
            player.view_height -= actor.floor_z - actor.z;
            player.delta_view_height = player.view_recovery();
        }
        actor.z += actor.vz;
        if actor.z > actor.floor_z && !actor.flags.any(ActorFlags::NO_GRAVITY) {
            let off_a_ledge =
                actor.vz == Fixed::ZERO && old_floor > actor.floor_z && actor.z == old_floor;
            actor.vz -= if off_a_ledge { GRAVITY * 2 } else { GRAVITY };
        }
        actor.z += float_step;
        if actor.z <= actor.floor_z {
            if actor.flags.any(ActorFlags::MISSILE) {
                actor.z = actor.floor_z;
                self.missile_hit_plane(slot, true);
                return;
            }
            actor.z = actor.floor_z;
            if actor.vz < Fixed::ZERO {
                let speed = std::mem::replace(&mut actor.vz, Fixed::ZERO);
                if let Some(player) = player {
                    self.land(player, speed);
                }
            }
        }
        let actor = &mut self.actors[slot];
        if actor.top() > actor.ceiling_z {
            actor.z = actor.ceiling_z - actor.height;
            actor.vz = actor.vz.min(Fixed::ZERO);
            if actor.flags.any(ActorFlags::MISSILE) {
                self.missile_hit_plane(slot, false);
            }
        }
    }

    /// A player's feet touch the floor.
    fn land(&mut self, player: usize, speed: Fixed) {
        let state = &mut self.players[player];
        if state.jump_tics < 0 || speed < HARD_LANDING {
            state.jump_tics = 7;
        }
        if speed < HARD_LANDING {
            state.delta_view_height = speed >> 3;
        }
        self.events.push(Event::Landed { player, speed });
    }
}

impl Actor {
    /// Nothing moves it and nothing will: it can be skipped while its animation is timed.
    pub(crate) fn at_rest(&self) -> bool {
        self.vx.0 | self.vy.0 | self.vz.0 == 0
            && !self.flags.any(ActorFlags::FLOAT)
            && (self.z == self.floor_z
                || (self.z > self.floor_z && self.flags.any(ActorFlags::NO_GRAVITY)))
    }
}

/// `step / steps` of a move, rounded towards zero.
fn part(v: Fixed, step: i32, steps: i32) -> Fixed {
    Fixed((i64::from(v.0) * i64::from(step) / i64::from(steps)) as i32)
}
