//! A sector as it is now, and what its floor does to players.

use crate::map::{SectorId, TextureId};
use crate::world::parts::sector::{SectorDamage, SectorState};
use crate::world::state::world::World;
use crate::world::tables::kinds::DamageKind;
use std::sync::Arc;

impl World {
    /// How many sectors the map has.
    #[must_use]
    pub fn sector_count(&self) -> usize {
        self.sectors.len()
    }

    /// A sector as it is now: floors that swing and lights that change are computed when they are
    /// looked at.
    #[must_use]
    #[inline(always)]
    pub fn sector(&self, sector: SectorId) -> SectorState {
        SectorState {
            floor: self.floor_of(sector),
            light: self.light_of(sector),
            ..self.sectors[sector.0 as usize]
        }
    }

    /// Every sector as it is now, in map order.
    pub fn sectors(&self) -> impl Iterator<Item = SectorState> + '_ {
        (0..self.sectors.len() as u32).map(|sector| self.sector(SectorId(sector)))
    }

    /// A sector, to change it by hand; effects at work in it go on.
    pub fn sector_mut(&mut self, sector: SectorId) -> &mut SectorState {
        self.settle_floor(sector);
        self.settle_light(sector);
        &mut self.sectors[sector.0 as usize]
    }

    /// What a sector's floor does to players who stand on it, to change it by hand.
    pub fn sector_damage_mut(&mut self, sector: SectorId) -> &mut SectorDamage {
        &mut self.sector_damages[sector.0 as usize]
    }

    /// The sectors with a tag get new damage. An interval of 0 or less takes the default of its
    /// amount: below 20 points every 32 tics, below 50 every 32 tics leaking through suits, from 50
    /// every tic whatever the suit.
    pub fn set_sector_damage(&mut self, tag: i32, amount: i32, interval: i32, leak: i32) {
        let damage = match amount {
            _ if interval > 0 => SectorDamage { amount, interval: interval as u32, leak },
            ..20 => SectorDamage { amount, interval: 32, leak: 0 },
            20..50 => SectorDamage { amount, interval: 32, leak: 5 },
            50.. => SectorDamage { amount, interval: 1, leak: 256 },
        };
        let map = Arc::clone(&self.map);
        for sector in map.tagged(tag) {
            self.sector_damages[sector.0 as usize] = damage;
        }
    }

    /// The floors of the sectors with a tag get another texture (see
    /// [`Map::texture`](crate::map::Map::texture)).
    pub fn change_floor_texture(&mut self, tag: i32, texture: TextureId) {
        let map = Arc::clone(&self.map);
        for sector in map.tagged(tag) {
            self.sectors[sector.0 as usize].floor_texture = texture;
        }
    }

    /// Hurts a player who stands on a harmful floor. A neighbouring floor's edge is safe, and so is
    /// the air: the feet must be at the height of the floor under the centre.
    pub(crate) fn damage_by_sector(&mut self, index: usize, slot: usize) {
        let body = &self.actors[slot];
        let damage = self.sector_damages[body.sector.0 as usize];
        if damage.amount <= 0
            || body.z != self.floor_of(body.sector)
            || !self.tic.is_multiple_of(damage.interval.max(1))
        {
            return;
        }
        let suited = self.players[index].rad_suit_tics > 0;
        if suited && self.rng.byte() >= damage.leak {
            return;
        }
        let victim = self.players[index].actor;
        self.damage(victim, None, None, damage.amount, DamageKind::Sector);
    }
}
