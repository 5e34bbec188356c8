//! Bullets: where a weapon aims by itself, what a bullet hits, and the puff or blood that it
//! raises.

use crate::map::{Blocks, SectorId};
use crate::math::{Angle, Fixed};
use crate::world::motion::sight::Path;
use crate::world::parts::actor::ActorId;
use crate::world::parts::crossing::{Crossed, WHOLE_PATH};
use crate::world::state::world::World;
use crate::world::tables::info::ActorFlags;
use crate::world::tables::kinds::{ActorKind, DamageKind};
use crate::world::tables::weapons::Spread;

/// Within this distance weapons look for something to aim at, map units.
const AIM_RANGE: i32 = 1024;
/// How far bullets fly, map units.
const BULLET_RANGE: i32 = 8192;
/// Height of the muzzle above half the body's height.
const MUZZLE_OFFSET: Fixed = Fixed::from_int(8);
/// Aiming searches so far up and down, 35 degrees.
const AIM_WINDOW: i64 = (1 << 32) * 35 / 360;
/// The same without autoaim: half a degree.
const NARROW_AIM_WINDOW: i64 = (1 << 32) / 720;
/// Second and third direction in which weapons look for a target: 5.6 degrees to the left and to
/// the right.
const SIDE_LOOKS: [Angle; 2] = [Angle(1 << 26), Angle((1u32 << 26).wrapping_neg())];
/// Puffs appear this much nearer than the wall that was hit.
const PUFF_DISTANCE: Fixed = Fixed::from_int(4);

/// What a weapon points at.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::world) struct Aim {
    /// Direction in which a target was found, or the shooter's own.
    pub angle: Angle,
    /// Pitch as a signed binary angle, down positive.
    pub pitch: i32,
}

/// Where a bullet ends.
enum Impact {
    Actor { slot: usize, at: i64 },
    Surface { at: i64 },
    Nothing,
}

impl World {
    /// Where a player's weapon points: at the first shootable actor straight ahead within the
    /// vertical window, else at one a little to the left, else to the right; else straight ahead
    /// with the player's pitch.
    pub(in crate::world) fn aim(&mut self, player: usize) -> Aim {
        let slot = usize::from(self.players[player].actor.slot);
        let ahead = self.actors[slot].angle;
        let sideways: &[Angle] = if self.no_autoaim { &[] } else { &SIDE_LOOKS };
        let own_pitch = self.players[player].pitch;
        for offset in std::iter::once(Angle::EAST).chain(sideways.iter().copied()) {
            let angle = ahead + offset;
            if let Some(pitch) = self.aim_along(slot, angle, own_pitch) {
                return Aim { angle, pitch };
            }
        }
        Aim { angle: ahead, pitch: own_pitch }
    }

    /// The pitch at which the first actor along `angle` can be hit through every opening on the
    /// way.
    fn aim_along(&mut self, slot: usize, angle: Angle, own_pitch: i32) -> Option<i32> {
        let window = if self.no_autoaim { NARROW_AIM_WINDOW } else { AIM_WINDOW };
        let (mut top, mut bottom) = (i64::from(own_pitch) - window, i64::from(own_pitch) + window);
        let muzzle = self.muzzle(slot);
        let path = self.path_from(slot, angle, AIM_RANGE);
        let range = Fixed::from_int(AIM_RANGE);
        let mut crossings = std::mem::take(&mut self.scratch_crossings);
        self.everything_on(&path, slot, &mut crossings);
        let mut found = None;
        for crossing in &crossings {
            let distance = part_of(range, crossing.at);
            let pitch_to =
                |height: Fixed| -i64::from(Angle::of_vector(distance, height - muzzle).0 as i32);
            match crossing.what {
                Crossed::Line(index) => {
                    let line = &self.map.lines[index as usize];
                    let Some(back) = line.back_sector else { break };
                    let opening = self.opening(line.front_sector, back);
                    if opening.bottom >= opening.top || line.flags.blocks.any(Blocks::EVERYTHING) {
                        break;
                    }
                    let (front, back) = (self.sector(line.front_sector), self.sector(back));
                    if front.floor != back.floor {
                        bottom = bottom.min(pitch_to(opening.bottom));
                    }
                    if front.ceiling != back.ceiling {
                        top = top.max(pitch_to(opening.top));
                    }
                    if top >= bottom {
                        break;
                    }
                }
                Crossed::Actor(target) => {
                    let target = &self.actors[usize::from(target)];
                    let (target_top, target_bottom) = (pitch_to(target.top()), pitch_to(target.z));
                    if target_top > bottom || target_bottom < top {
                        continue;
                    }
                    found = Some(((target_top.max(top) + target_bottom.min(bottom)) / 2) as i32);
                    break;
                }
            }
        }
        self.scratch_crossings = crossings;
        found
    }

    /// Fires `count` bullets from a player's weapon.
    pub(in crate::world) fn fire_bullets(&mut self, player: usize, count: u32, spread: Spread) {
        let slot = usize::from(self.players[player].actor.slot);
        let aimed = self.aim(player);
        for _ in 0..count {
            let damage = 5 * (1 + self.rng.below(3) as i32);
            let mut angle = self.actors[slot].angle;
            let mut pitch = aimed.pitch;
            if spread != Spread::NONE {
                angle += Angle((self.rng.signed_difference() << spread.yaw_shift) as u32);
            }
            if spread.vertical {
                // 332063 in 2^-32 turns a step: 7.1 degrees at most.
                pitch += self.rng.signed_difference() * 332_063;
            }
            self.fire_bullet(slot, angle, pitch, damage);
        }
    }

    /// Sends a bullet off: it hurts the first shootable actor whose box it enters, or marks the
    /// first surface.
    pub(in crate::world) fn fire_bullet(
        &mut self,
        slot: usize,
        angle: Angle,
        pitch: i32,
        damage: i32,
    ) {
        let pitch = Angle(pitch as u32);
        let level = pitch.cos();
        let (x, y) = (level * angle.cos(), level * angle.sin());
        let rise = -pitch.sin();
        let path = Path {
            x: self.actors[slot].x,
            y: self.actors[slot].y,
            dx: x * BULLET_RANGE,
            dy: y * BULLET_RANGE,
        };
        let muzzle = self.muzzle(slot);
        let impact = self.trace(slot, &path, muzzle, rise);
        let range = Fixed::from_int(BULLET_RANGE);
        let place = |distance: Fixed| {
            (path.x + distance * x, path.y + distance * y, muzzle + distance * rise)
        };
        match impact {
            Impact::Nothing => {}
            Impact::Surface { at } => {
                let (x, y, z) = place(part_of(range, at) - PUFF_DISTANCE);
                self.spawn_mark(ActorKind::BulletPuff, x, y, z);
            }
            Impact::Actor { slot: victim, at } => {
                let (x, y, z) = place(part_of(range, at));
                let bleeds = !self.actors[victim].flags.any(ActorFlags::NO_BLOOD);
                let shooter = self.id_of(slot);
                self.damage(
                    self.id_of(victim),
                    Some(shooter),
                    Some(shooter),
                    damage,
                    DamageKind::Bullet,
                );
                if bleeds {
                    let id = self.spawn_mark(ActorKind::Blood, x, y, z);
                    self.weaken_blood(id, damage);
                } else {
                    self.spawn_mark(ActorKind::BulletPuff, x, y, z);
                }
            }
        }
    }

    /// Follows a bullet through sectors and boxes. `rise` is its climb per unit of path.
    fn trace(&mut self, shooter: usize, path: &Path, muzzle: Fixed, rise: Fixed) -> Impact {
        let mut crossings = std::mem::take(&mut self.scratch_crossings);
        self.everything_on(path, shooter, &mut crossings);
        let range = Fixed::from_int(BULLET_RANGE);
        let height_at = |at: i64| muzzle + part_of(range, at) * rise;
        let mut sector = self.actors[shooter].sector;
        let mut impact = None;
        for crossing in &crossings {
            let at = crossing.at;
            let z = height_at(at);
            if let Some(hit) = self.plane_hit(sector, muzzle, rise, z) {
                impact = Some(hit);
                break;
            }
            match crossing.what {
                Crossed::Line(index) => {
                    let line = &self.map.lines[index as usize];
                    let stops = line.flags.blocks.any(Blocks::EVERYTHING.with(Blocks::HITSCAN));
                    let Some(back) = line.back_sector.filter(|_| !stops) else {
                        impact = Some(Impact::Surface { at });
                        break;
                    };
                    let next = if sector == line.front_sector { back } else { line.front_sector };
                    let beyond = self.sector(next);
                    if z <= beyond.floor || z >= beyond.ceiling {
                        impact = Some(if z > beyond.floor && self.both_sky(sector, next) {
                            Impact::Nothing
                        } else {
                            Impact::Surface { at }
                        });
                        break;
                    }
                    sector = next;
                }
                Crossed::Actor(slot) => {
                    if let Some(at) = self.enters_box(usize::from(slot), path, muzzle, rise, at) {
                        impact = Some(Impact::Actor { slot: usize::from(slot), at });
                        break;
                    }
                }
            }
        }
        let end = height_at(WHOLE_PATH);
        let impact =
            impact.or_else(|| self.plane_hit(sector, muzzle, rise, end)).unwrap_or(Impact::Nothing);
        self.scratch_crossings = crossings;
        impact
    }

    /// Where a bullet that is at height `z` now went through the floor or ceiling of a sector, if
    /// it did.
    fn plane_hit(&self, sector: SectorId, muzzle: Fixed, rise: Fixed, z: Fixed) -> Option<Impact> {
        let state = self.sector(sector);
        let plane = if z < state.floor {
            state.floor
        } else if z > state.ceiling {
            if self.is_sky(state.ceiling_texture) {
                return Some(Impact::Nothing);
            }
            state.ceiling
        } else {
            return None;
        };
        Some(Impact::Surface { at: path_part((plane - muzzle) / rise) })
    }

    /// Whether the ceilings on both sides of a line are sky, so that nothing is above the opening.
    fn both_sky(&self, one: SectorId, other: SectorId) -> bool {
        let sky = |sector: SectorId| self.is_sky(self.sectors[sector.0 as usize].ceiling_texture);
        sky(one) && sky(other)
    }

    /// Where a bullet enters an actor's box: through a side, or through top or bottom on the way.
    fn enters_box(
        &self,
        slot: usize,
        path: &Path,
        muzzle: Fixed,
        rise: Fixed,
        at: i64,
    ) -> Option<i64> {
        let actor = &self.actors[slot];
        let range = Fixed::from_int(BULLET_RANGE);
        let z = muzzle + part_of(range, at) * rise;
        let plane = if z > actor.top() {
            if rise >= Fixed::ZERO {
                return None;
            }
            actor.top()
        } else if z < actor.z {
            if rise <= Fixed::ZERO {
                return None;
            }
            actor.z
        } else {
            return Some(at);
        };
        let through = path_part((plane - muzzle) / rise);
        let (_, leaves) = path.meets_square(actor.x, actor.y, actor.radius)?;
        (through <= leaves).then_some(through)
    }

    /// Height from which an actor shoots: 36 above its feet when upright.
    fn muzzle(&self, slot: usize) -> Fixed {
        let actor = &self.actors[slot];
        let offset = match actor.player_index() {
            Some(player) => MUZZLE_OFFSET * self.players[player].crouch,
            None => MUZZLE_OFFSET,
        };
        actor.z + (actor.height >> 1) + offset
    }

    fn path_from(&self, slot: usize, angle: Angle, length: i32) -> Path {
        let actor = &self.actors[slot];
        Path { x: actor.x, y: actor.y, dx: angle.cos() * length, dy: angle.sin() * length }
    }

    /// A puff or a drop of blood, a little higher or lower than the hit and up to 3 tics ahead of
    /// its time.
    fn spawn_mark(&mut self, kind: ActorKind, x: Fixed, y: Fixed, z: Fixed) -> ActorId {
        let z = z + Fixed(self.rng.signed_difference() << 10);
        let id = self.spawn(kind, x, y, z);
        let slot = usize::from(id.slot);
        self.actors[slot].vz = Fixed::from_int(if kind == ActorKind::Blood { 2 } else { 1 });
        self.shorten_frame(slot);
        id
    }

    /// Weaker hits bleed less: the drop starts at a later frame.
    fn weaken_blood(&mut self, id: ActorId, damage: i32) {
        let step = match damage {
            ..9 => 2,
            9..=12 => 1,
            _ => 0,
        };
        if step > 0 {
            self.skip_to_frame(usize::from(id.slot), step);
        }
    }
}

/// Part `at` of a length.
fn part_of(length: Fixed, at: i64) -> Fixed {
    Fixed((i64::from(length.0) * at / WHOLE_PATH) as i32)
}

/// The part of a bullet's path that a distance is.
fn path_part(distance: Fixed) -> i64 {
    i64::from(distance.0) * WHOLE_PATH / i64::from(Fixed::from_int(BULLET_RANGE).0)
}
