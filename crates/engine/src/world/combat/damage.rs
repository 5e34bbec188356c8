//! Losing health: what reduces it, the thrust of a hit, pain, and death.

use crate::math::{Angle, Fixed};
use crate::world::parts::actor::{Actor, ActorId};
use crate::world::parts::event::Event;
use crate::world::state::world::World;
use crate::world::tables::info::ActorFlags;
use crate::world::tables::kinds::{ActorKind, DamageKind};
use crate::world::tables::states::{Phase, animation};

/// Fastest thrust of one hit, map units per tic.
const LARGEST_THRUST: Fixed = Fixed::from_int(32);

/// Thrust below a hundredth of a map unit per tic is dropped.
const SMALLEST_THRUST: Fixed = Fixed(65536 / 100);

/// Armour takes this part of the damage: 33.335 percent.
const ARMOR_SHARE: Fixed = Fixed(21846);

/// Largest value of the red flash counter.
const LARGEST_DAMAGE_COUNT: i32 = 100;

impl World {
    /// Hurts `victim` by `amount` health points before armour, in the original's order: damage
    /// factor, thrust, invulnerability, armour, health, then death or pain. Gives the health points
    /// lost.
    ///
    /// `inflictor` is what touched the victim (a rocket, a barrel; for bullets the shooter), which
    /// is pushed away from there; `source` is who is to blame. Floors, falls and scripts have
    /// neither.
    pub fn damage(
        &mut self,
        victim: ActorId,
        inflictor: Option<ActorId>,
        source: Option<ActorId>,
        amount: i32,
        by: DamageKind,
    ) -> i32 {
        let Some(actor) = self.get(victim) else { return 0 };
        if !actor.flags.any(ActorFlags::SHOOTABLE) || actor.health <= 0 || amount < 0 {
            return 0;
        }
        let slot = usize::from(victim.slot);
        let player = actor.player_index();
        let mut amount = amount;
        if let Some(player) = player {
            let factor = self.players[player].damage_factor;
            amount = ((i64::from(amount) * i64::from(factor.0)) >> 16) as i32;
            if factor == Fixed::ZERO {
                return 0;
            }
        } else if actor.flags.any(ActorFlags::INVULNERABLE) {
            return 0;
        }
        if let Some(inflictor) = inflictor.filter(|&inflictor| inflictor != victim) {
            self.thrust_from(slot, inflictor, amount);
        }
        if let Some(player) = player {
            if self.players[player].invulnerable {
                return 0;
            }
            amount -= self.absorb(player, amount);
            let owner = &mut self.players[player];
            let count = i32::from(owner.damage_count) + amount;
            owner.damage_count = count.min(LARGEST_DAMAGE_COUNT) as u8;
        }
        let actor = &mut self.actors[slot];
        let lost = amount.min(actor.health);
        // What goes below zero is kept: costs that count health points count it too, as measured.
        actor.health -= amount;
        if lost > 0 {
            self.events.push(Event::Hurt { victim, amount: lost, source, by });
        }
        if self.actors[slot].health <= 0 {
            self.die(victim, source);
        } else {
            self.feel(slot);
        }
        lost
    }

    /// Pushes an actor away from whatever hurt it, in proportion to the damage and against its
    /// mass.
    fn thrust_from(&mut self, slot: usize, inflictor: ActorId, amount: i32) {
        let Some(origin) = self.get(inflictor) else { return };
        let (dx, dy) = (self.actors[slot].x - origin.x, self.actors[slot].y - origin.y);
        let mass = i64::from(self.actors[slot].mass.max(1));
        // An eighth of the damage, for a mass of 100.
        let thrust = i64::from(amount) * (100 << 16) / (8 * mass);
        let thrust = Fixed(thrust.min(i64::from(LARGEST_THRUST.0)) as i32);
        if thrust < SMALLEST_THRUST {
            return;
        }
        let direction = if dx.0 | dy.0 == 0 {
            Angle(self.rng.next_u64() as u32)
        } else {
            Angle::of_vector(dx, dy)
        };
        let actor = &mut self.actors[slot];
        actor.vx += thrust * direction.cos();
        actor.vy += thrust * direction.sin();
        self.wake_slot(slot);
    }

    /// What a player's armour takes of some damage.
    fn absorb(&mut self, player: usize, amount: i32) -> i32 {
        let armor = &mut self.players[player].armor;
        let taken = (((i64::from(amount) * i64::from(ARMOR_SHARE.0)) >> 16) as i32).min(*armor);
        *armor -= taken;
        taken
    }

    /// A hit that does not kill may be felt, by the chance of the victim's kind.
    fn feel(&mut self, slot: usize) {
        let kind = self.actors[slot].kind;
        let chance = kind.info().pain_chance;
        if chance > 0
            && self.rng.byte() < chance
            && self.actors[slot].flags.any(ActorFlags::MONSTER)
        {
            self.set_phase(slot, Phase::Pain);
        }
    }

    /// Kills an actor: it falls, shrinks to a quarter of its height and starts to die.
    /// [`Event::Died`] is raised now, before any animation or blast.
    fn die(&mut self, victim: ActorId, source: Option<ActorId>) {
        let slot = usize::from(victim.slot);
        let actor = &mut self.actors[slot];
        let (kind, tid) = (actor.kind, actor.tid);
        let monster = actor.flags.any(ActorFlags::MONSTER);
        actor
            .flags
            .set(ActorFlags::SHOOTABLE.with(ActorFlags::FLOAT).with(ActorFlags::NO_GRAVITY), false);
        actor.flags.set(ActorFlags::DROP_OFF, true);
        actor.height = actor.height >> 2;
        actor.origin = source;
        (actor.goal, actor.pursuing) = (None, false);
        if let Some(player) = actor.player_index() {
            self.players[player].dead = true;
            self.actors[slot].flags.set(ActorFlags::SOLID, false);
            self.start_lowering(player);
        }
        let killer = source.and_then(|source| self.get(source)).and_then(Actor::player_index);
        if let Some(killer) = killer.filter(|_| monster) {
            self.players[killer].kills += 1;
        }
        self.set_phase(slot, Phase::Death);
        if animation(kind, Phase::Death).frames[0].tics > 1 {
            self.shorten_frame(slot);
        }
        self.events.push(Event::Died { victim, kind, tid, source });
        if monster && self.monsters_drop_items {
            self.drop_item(slot);
        }
    }

    /// A killed soldier lets go of what it carried: tossed up, with half the ammunition.
    fn drop_item(&mut self, slot: usize) {
        let dropper = self.actors[slot];
        let kind = match dropper.kind {
            ActorKind::ZombieMan => ActorKind::Clip,
            ActorKind::ShotgunGuy => ActorKind::Shotgun,
            ActorKind::ChaingunGuy => ActorKind::Chaingun,
            _ => return,
        };
        let id = self.spawn(kind, dropper.x, dropper.y, dropper.z + (dropper.height >> 1));
        let (vx, vy) =
            (Fixed(self.rng.signed_difference() << 8), Fixed(self.rng.signed_difference() << 8));
        let vz = Fixed::from_int(5) + Fixed(self.rng.byte() << 10);
        let item = &mut self.actors[usize::from(id.slot)];
        (item.vx, item.vy, item.vz) = (vx, vy, vz);
        (item.floor_z, item.ceiling_z, item.dropoff_z) =
            (dropper.floor_z, dropper.ceiling_z, dropper.dropoff_z);
        item.flags.set(ActorFlags::DROPPED, true);
    }
}
