//! What a monster does each time its state calls for it: looks for a goal, walks one step towards
//! it, turns.
//!
//! Monsters here are harmless: they walk from goal to goal and never attack. What makes them
//! interesting is that they block each other: two who meet head-on slide aside together for
//! hundreds of map units, because a direction once chosen is kept for up to 16 steps.

use crate::math::{Angle, Fixed};
use crate::world::motion::collision::approximate_distance;
use crate::world::motion::movement::FLOAT_SPEED;
use crate::world::parts::lines::for_each_line_across;
use crate::world::state::world::World;
use crate::world::tables::heading::Heading;
use crate::world::tables::info::ActorFlags;
use crate::world::tables::states::Phase;

/// A goal counts as reached within this distance and its radius.
const GOAL_REACH: Fixed = Fixed::from_int(44);

/// Closer than this in one axis, that axis is no reason to move.
const ALIGNED: Fixed = Fixed::from_int(10);

/// How far a monster backs off from a ledge.
const BACK_OFF: i32 = 32;

/// Height change of a floater that something blocks, map units a step.
const FLOAT_STEP: Fixed = FLOAT_SPEED;

impl World {
    /// A standing monster looks for its goal and sets out for it.
    pub(in crate::world) fn look(&mut self, slot: usize) {
        if self.adopt_goal(slot) {
            self.set_phase(slot, Phase::Walk);
        }
    }

    /// Sets out for the goal; false where there is none (any more).
    fn adopt_goal(&mut self, slot: usize) -> bool {
        let goal = self.actors[slot].goal.filter(|&goal| self.get(goal).is_some());
        self.actors[slot].pursuing = goal.is_some();
        goal.is_some()
    }

    /// A step of a monster on its way.
    pub(in crate::world) fn chase(&mut self, slot: usize) {
        self.turn_to_heading(slot);
        if !self.adopt_goal(slot) {
            self.set_phase(slot, Phase::Idle);
            return;
        }
        if std::mem::take(&mut self.actors[slot].arrived) {
            self.choose_heading(slot);
            return;
        }
        if self.reach_goal(slot) {
            return;
        }
        let actor = &mut self.actors[slot];
        actor.steps_left -= 1;
        if actor.steps_left < 0 || !self.step(slot) {
            self.choose_heading(slot);
        }
    }

    /// Turns by an eighth towards the heading.
    fn turn_to_heading(&mut self, slot: usize) {
        let actor = &mut self.actors[slot];
        let Some(heading) = actor.heading.angle() else { return };
        let snapped = Angle(actor.angle.0 & (7 << 29));
        actor.angle = match ((snapped - heading).0 as i32).signum() {
            1 => snapped - Angle::DEG_45,
            -1 => snapped + Angle::DEG_45,
            _ => snapped,
        };
    }

    /// At the goal: on to the patrol point that follows it, if any. The next call only chooses a
    /// direction.
    fn reach_goal(&mut self, slot: usize) -> bool {
        let actor = &self.actors[slot];
        let Some(goal) = actor.goal.and_then(|id| self.get(id)) else { return false };
        let distance = approximate_distance(goal.x - actor.x, goal.y - actor.y);
        if distance >= GOAL_REACH + goal.radius {
            return false;
        }
        let (next, facing) = (goal.next_goal, goal.angle);
        let next = self.patrol_point(next);
        let actor = &mut self.actors[slot];
        if next.is_none() {
            actor.angle = facing;
        }
        actor.goal = next;
        actor.pursuing = false;
        actor.arrived = true;
        true
    }

    /// Walks one step in the heading; false if it is blocked.
    fn step(&mut self, slot: usize) -> bool {
        let actor = &self.actors[slot];
        if actor.heading == Heading::None {
            return false;
        }
        let flags = actor.flags;
        let walks = !flags.any(ActorFlags::NO_GRAVITY);
        // Walkers in the air cannot walk.
        if walks && actor.z > actor.floor_z && !flags.any(ActorFlags::ON_ACTOR) {
            return false;
        }
        let (unit_x, unit_y) = actor.heading.unit();
        let (dx, dy) = (actor.speed * unit_x, actor.speed * unit_y);
        let (x, y) = (actor.x, actor.y);
        // Steps longer than the body would jump over lines.
        let longest = actor.radius - Fixed::ONE;
        let fastest = dx.abs().max(dy.abs());
        let parts =
            if longest > Fixed::ZERO && fastest > longest { 1 + fastest.0 / longest.0 } else { 1 };
        let mut attempt = None;
        for part in 1..=parts {
            let made =
                self.try_move(slot, x + dx.scale(part, parts), y + dy.scale(part, parts), false);
            let moved = made.moved;
            attempt = Some(made);
            if !moved {
                break;
            }
        }
        let Some(attempt) = attempt else { return false };
        if !attempt.moved {
            return flags.any(ActorFlags::FLOAT)
                && attempt.fits_higher
                && self.float_past(slot, attempt.position.floor_z);
        }
        self.actors[slot].in_float = false;
        if walks {
            self.step_down(slot);
        }
        true
    }

    /// A walker that stepped off something not higher than a step is put down at once.
    fn step_down(&mut self, slot: usize) {
        let actor = &self.actors[slot];
        let (floor, above) =
            (actor.floor_z, actor.z > actor.floor_z && !actor.flags.any(ActorFlags::ON_ACTOR));
        if above && actor.z <= floor + actor.max_step && self.actor_at(slot, floor).is_none() {
            self.actors[slot].z = floor;
        }
    }

    /// A floater climbs or sinks to get over or under what blocks it; false if something is in the
    /// way of that too.
    fn float_past(&mut self, slot: usize, floor: Fixed) -> bool {
        let actor = &self.actors[slot];
        let z = if actor.z < floor { actor.z + FLOAT_STEP } else { actor.z - FLOAT_STEP };
        if self.actor_at(slot, z).is_some() {
            return false;
        }
        let actor = &mut self.actors[slot];
        actor.z = z;
        actor.in_float = true;
        true
    }

    /// Chooses a new direction and walks the first step of it.
    fn choose_heading(&mut self, slot: usize) {
        let actor = &self.actors[slot];
        let Some(goal) = actor.goal.and_then(|id| self.get(id)) else { return };
        let (dx, dy) = (goal.x - actor.x, goal.y - actor.y);
        if let Some((dx, dy)) = self.away_from_ledges(slot) {
            self.actors[slot].avoids_ledge = true;
            self.try_headings(slot, dx, dy, true);
            self.actors[slot].avoids_ledge = false;
            // One small step only.
            self.actors[slot].steps_left = 1;
        } else {
            self.try_headings(slot, dx, dy, false);
        }
    }

    /// For a walker that hangs over a deep drop: the direction away from the lines that it hangs
    /// over.
    fn away_from_ledges(&self, slot: usize) -> Option<(Fixed, Fixed)> {
        let actor = &self.actors[slot];
        let exempt = ActorFlags::DROP_OFF.with(ActorFlags::ON_ACTOR).with(ActorFlags::FLOAT);
        if actor.floor_z - actor.dropoff_z <= actor.max_dropoff
            || actor.z > actor.floor_z
            || actor.flags.any(exempt)
        {
            return None;
        }
        let (mut away_x, mut away_y) = (Fixed::ZERO, Fixed::ZERO);
        for_each_line_across(&self.map, actor.x, actor.y, actor.radius, |_, line| {
            let Some(back) = line.back_sector else { return };
            let (front, back) = (self.floor_of(line.front_sector), self.floor_of(back));
            let deep = actor.z - actor.max_dropoff;
            let direction = if back == actor.z && front < deep {
                Angle::of_vector(line.dx, line.dy)
            } else if front == actor.z && back < deep {
                Angle::of_vector(-line.dx, -line.dy)
            } else {
                return;
            };
            away_x -= direction.sin() * BACK_OFF;
            away_y += direction.cos() * BACK_OFF;
        });
        (away_x.0 | away_y.0 != 0).then_some((away_x, away_y))
    }

    /// Tries directions until a step succeeds: the diagonal towards (dx, dy), its two components,
    /// the old direction, all others from a random end, and the way back last.
    fn try_headings(&mut self, slot: usize, dx: Fixed, dy: Fixed, avoids_ledge: bool) {
        let old = self.actors[slot].heading;
        let back = old.opposite();
        let mut tried = 0u16;
        let horizontal = towards(dx, Heading::East, Heading::West);
        let vertical = towards(dy, Heading::North, Heading::South);
        if horizontal != Heading::None && vertical != Heading::None {
            let diagonal = match (dx > Fixed::ZERO, dy < Fixed::ZERO) {
                (true, false) => Heading::NorthEast,
                (false, false) => Heading::NorthWest,
                (false, true) => Heading::SouthWest,
                (true, true) => Heading::SouthEast,
            };
            if diagonal != back && self.try_heading(slot, diagonal, &mut tried) {
                return;
            }
        }
        let (mut first, mut second) = (horizontal, vertical);
        if !avoids_ledge {
            if self.rng.byte() > 200 || dy.abs() > dx.abs() {
                (first, second) = (second, first);
            }
            for candidate in [&mut first, &mut second] {
                if *candidate == back {
                    *candidate = Heading::None;
                }
            }
        }
        if self.try_heading(slot, first, &mut tried) || self.try_heading(slot, second, &mut tried) {
            return;
        }
        if !avoids_ledge && self.try_heading(slot, old, &mut tried) {
            return;
        }
        let forwards = self.rng.byte() & 1 != 0;
        for i in 0..8 {
            let heading = Heading::ALL[if forwards { i } else { 7 - i }];
            if heading != back && self.try_heading(slot, heading, &mut tried) {
                return;
            }
        }
        if !self.try_heading(slot, back, &mut tried) {
            self.actors[slot].heading = Heading::None;
        }
    }

    /// Tries one direction, once: if the step succeeds, the direction is kept for 0 to 15 more.
    fn try_heading(&mut self, slot: usize, heading: Heading, tried: &mut u16) -> bool {
        let bit = 1 << heading as u16;
        if heading == Heading::None || *tried & bit != 0 {
            return false;
        }
        *tried |= bit;
        self.actors[slot].heading = heading;
        if !self.step(slot) {
            return false;
        }
        self.actors[slot].steps_left = self.rng.byte() & 15;
        true
    }
}

/// The direction along an axis, if it is worth it.
fn towards(distance: Fixed, positive: Heading, negative: Heading) -> Heading {
    if distance > ALIGNED {
        positive
    } else if distance < -ALIGNED {
        negative
    } else {
        Heading::None
    }
}
