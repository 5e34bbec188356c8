//! Missiles: how players throw them, what stops them, and how they burst.

use crate::math::{Angle, Fixed};
use crate::world::motion::collision::Move;
use crate::world::parts::actor::Actor;
use crate::world::state::world::World;
use crate::world::tables::info::ActorFlags;
use crate::world::tables::kinds::{ActorKind, DamageKind};
use crate::world::tables::states::Phase;

/// Height of the muzzle for missiles above half the body's height: 4 lower than for bullets.
const MISSILE_OFFSET: Fixed = Fixed::from_int(4);

impl World {
    /// Throws a missile from a player's weapon along its aim.
    pub(in crate::world) fn throw_missile(&mut self, player: usize, kind: ActorKind) {
        let aim = self.aim(player);
        let id = self.players[player].actor;
        let body = self.actors[usize::from(id.slot)];
        let z = body.z + (body.height >> 1) + MISSILE_OFFSET * self.players[player].crouch;
        let missile = self.spawn(kind, body.x, body.y, z.max(body.floor_z));
        let slot = usize::from(missile.slot);
        let pitch = Angle(aim.pitch as u32);
        let actor = &mut self.actors[slot];
        actor.angle = aim.angle;
        actor.origin = Some(id);
        actor.vx = pitch.cos() * aim.angle.cos() * actor.speed;
        actor.vy = pitch.cos() * aim.angle.sin() * actor.speed;
        actor.vz = -pitch.sin() * actor.speed;
        self.advance_from_thrower(slot, body.radius);
        if kind == ActorKind::Rocket && self.get(missile).is_some() {
            self.begin_trail(slot);
        }
    }

    /// Puts a new missile some way along its flight, still within its thrower; it may burst at
    /// once.
    fn advance_from_thrower(&mut self, slot: usize, thrower_radius: Fixed) {
        let missile = &self.actors[slot];
        let (mut x, mut y, mut z) = (missile.vx, missile.vy, missile.vz);
        let square = |f: Fixed| i64::from(f.0) * i64::from(f.0);
        loop {
            (x, y, z) = (x >> 1, y >> 1, z >> 1);
            if square(x) + square(y) < square(thrower_radius) {
                break;
            }
        }
        let (x, y) = (missile.x + x, missile.y + y);
        self.actors[slot].z += z;
        let attempt = self.try_move(slot, x, y, false);
        if !attempt.moved {
            self.missile_blocked(slot, &attempt);
        }
    }

    /// A missile's move was refused: it hurts the actor in its way and bursts, or vanishes into the
    /// sky.
    pub(in crate::world) fn missile_blocked(&mut self, slot: usize, attempt: &Move) {
        if self.actors[slot].phase == Phase::Death {
            return;
        }
        match attempt.position.blocking_actor {
            Some(victim) => self.missile_hits(slot, victim),
            None if self.is_lost_in_sky(slot, attempt) => {
                self.remove(self.id_of(slot));
                return;
            }
            None => {
                if let Some(line) = attempt.position.blocking_line {
                    let Actor { kind, x, y, z, .. } = self.actors[slot];
                    if kind == ActorKind::Rocket {
                        self.leave_soot(line, x, y, z);
                    }
                }
            }
        }
        self.burst(slot);
    }

    /// Whether what stopped a missile is the upper part of a wall with sky behind it.
    fn is_lost_in_sky(&self, slot: usize, attempt: &Move) -> bool {
        let Some(line) = attempt.position.ceiling_line.map(|index| &self.map.lines[index as usize])
        else {
            return false;
        };
        let Some(back) = line.back_sector.map(|back| self.sectors[back.0 as usize]) else {
            return false;
        };
        self.is_sky(back.ceiling_texture) && self.actors[slot].z >= back.ceiling
    }

    /// A missile met the floor (or else the ceiling): it bursts, or vanishes into the sky.
    pub(in crate::world) fn missile_hit_plane(&mut self, slot: usize, floor: bool) {
        if self.actors[slot].phase == Phase::Death {
            return;
        }
        let state = &self.sectors[self.actors[slot].sector.0 as usize];
        if !floor && self.is_sky(state.ceiling_texture) {
            self.remove(self.id_of(slot));
        } else {
            self.burst(slot);
        }
    }

    /// A direct hit: 1 to 8 times the missile's damage.
    fn missile_hits(&mut self, slot: usize, victim: usize) {
        let missile = &self.actors[slot];
        let (kind, source) = (missile.kind, missile.origin);
        if !self.actors[victim].flags.any(ActorFlags::SHOOTABLE) {
            return;
        }
        let damage = (1 + self.rng.below(8) as i32) * kind.info().damage;
        self.damage(self.id_of(victim), Some(self.id_of(slot)), source, damage, DamageKind::Rocket);
    }

    /// Stops a missile and starts its explosion, whose first frame is up to 3 tics shorter.
    fn burst(&mut self, slot: usize) {
        self.end_trail(slot);
        let actor = &mut self.actors[slot];
        (actor.vx, actor.vy, actor.vz) = (Fixed::ZERO, Fixed::ZERO, Fixed::ZERO);
        self.set_phase(slot, Phase::Death);
        self.shorten_frame(slot);
    }

    /// Leaves a puff of smoke where a rocket came from.
    pub(in crate::world) fn leave_smoke(&mut self, slot: usize) {
        let rocket = self.actors[slot];
        let direction = Angle::of_vector(rocket.vx, rocket.vy);
        let behind = rocket.radius * 2;
        let x = rocket.x - rocket.vx - behind * direction.cos() + Fixed(self.rng.byte() << 10);
        let y = rocket.y - rocket.vy - behind * direction.sin() + Fixed(self.rng.byte() << 10);
        let z = rocket.z - rocket.vz + rocket.height.scale(2, 3);
        let smoke = self.spawn(ActorKind::RocketSmokeTrail, x, y, z);
        let slot = usize::from(smoke.slot);
        self.actors[slot].vz = Fixed::ONE;
        self.shorten_frame(slot);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::stone_room;
    use crate::world::parts::actor::ActorId;

    #[test]
    fn puffs_of_smoke_live_as_long_as_in_the_original() {
        let mut world = World::new(stone_room(200, [0, 0, 4000, 256], &[]), 5);
        let id = world.spawn(
            ActorKind::Rocket,
            Fixed::from_int(64),
            Fixed::from_int(128),
            Fixed::from_int(50),
        );
        world.get_mut(id).unwrap().vx = Fixed::from_int(20);
        let mut seen: Vec<(ActorId, i32)> = Vec::new();
        // The rocket bursts after 197 tics, and its last puff has gone after as many more as it
        // lives.
        for _ in 0..230 {
            world.run_thinkers(&[]);
            world.finish_tic();
            for slot in 0..world.actors.len() {
                let actor = &world.actors[slot];
                if actor.kind == ActorKind::RocketSmokeTrail && !actor.removed {
                    let id = world.id_of(slot);
                    match seen.iter_mut().find(|(known, _)| *known == id) {
                        Some((_, tics)) => *tics += 1,
                        None => seen.push((id, 1)),
                    }
                }
            }
        }
        // Measured: of 208 puffs, 48 lived 21 tics, 46, 45 and 63 one, two and three more.
        let mut lives: Vec<i32> = seen.into_iter().map(|(_, tics)| tics).collect();
        assert!(lives.len() > 40, "{}", lives.len());
        lives.sort_unstable();
        lives.dedup();
        assert_eq!(lives, [21, 22, 23, 24]);
    }
}
