//! Blasts: what a bursting rocket or barrel does to everything around it.

use crate::math::{Angle, Fixed};
use crate::world::parts::actor::ActorId;
use crate::world::state::world::World;
use crate::world::tables::info::ActorFlags;
use crate::world::tables::kinds::DamageKind;

/// Damage at the centre of a blast, and the distance at which none is left.
pub const BLAST: i32 = 128;

impl World {
    /// The blast of the actor in `slot`, blamed on `source`. Every shootable actor within reach and
    /// in its sight is hurt, the one to blame too.
    ///
    /// Two rules: barrels (bursting or hurt) count whole map units in the plane alone; all others
    /// count the distance to the victim's box in space, and are thrown up or down as well.
    pub(in crate::world) fn blast(&mut self, slot: usize, source: Option<ActorId>, by: DamageKind) {
        let bomb = self.actors[slot];
        let mut victims = std::mem::take(&mut self.scratch_slots);
        victims.clear();
        let reach = Fixed::from_int(BLAST);
        victims.extend(self.near(bomb.x, bomb.y, reach).map(|victim| victim as u16));
        for &victim in &victims {
            let victim = usize::from(victim);
            let flags = self.actors[victim].flags;
            if victim == slot || self.actors[victim].removed || !flags.any(ActorFlags::SHOOTABLE) {
                continue;
            }
            if bomb.flags.any(ActorFlags::OLD_BLAST) || flags.any(ActorFlags::OLD_BLAST) {
                self.blast_flat(slot, victim, source, by);
            } else {
                self.blast_box(slot, victim, source, by);
            }
        }
        self.scratch_slots = victims;
    }

    /// The barrels' rule.
    fn blast_flat(&mut self, slot: usize, victim: usize, source: Option<ActorId>, by: DamageKind) {
        let (bomb, target) = (&self.actors[slot], &self.actors[victim]);
        let across = (target.x - bomb.x).abs().max((target.y - bomb.y).abs());
        let distance = (across - target.radius).floor().max(0);
        if distance < BLAST && self.sees(victim, slot) {
            self.damage(self.id_of(victim), Some(self.id_of(slot)), source, BLAST - distance, by);
        }
    }

    /// The rule of all others.
    fn blast_box(&mut self, slot: usize, victim: usize, source: Option<ActorId>, by: DamageKind) {
        let (bomb, target) = (&self.actors[slot], &self.actors[victim]);
        let across = (target.x - bomb.x).abs().max((target.y - bomb.y).abs());
        let beside = across - target.radius;
        let gap = if bomb.z < target.z {
            target.z - bomb.z
        } else if bomb.z >= target.top() {
            bomb.z - target.top()
        } else {
            Fixed(-1)
        };
        let distance = match gap {
            Fixed(-1) => beside.max(Fixed::ZERO),
            _ if beside <= Fixed::ZERO => gap,
            _ => Fixed::length_of(beside, gap),
        };
        let points = Fixed::from_int(BLAST) - distance;
        if points <= Fixed::ZERO || !self.sees(victim, slot) {
            return;
        }
        let (target, own) = (&self.actors[victim], source == Some(self.id_of(victim)));
        let rise = target.z + (target.height >> 1) - self.actors[slot].z;
        self.damage(self.id_of(victim), Some(self.id_of(slot)), source, points.floor(), by);
        let bomb = self.actors[slot];
        let target = &mut self.actors[victim];
        let thrust = points / (2 * target.mass.max(1));
        let direction = Angle::of_vector(target.x - bomb.x, target.y - bomb.y);
        target.vx += thrust * direction.cos();
        target.vy += thrust * direction.sin();
        // Thrown up or down by half of that per map unit between the centres; no matter who is to
        // blame, by four fifths.
        let lift = rise * thrust;
        target.vz += if own { lift.scale(4, 5) } else { lift.scale(1, 2) };
        self.wake_slot(victim);
    }
}
