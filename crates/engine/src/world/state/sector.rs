//! What changes of a sector.

use crate::map::{Sector, SectorId, TextureId, special};
use crate::math::Fixed;
use crate::world::state::event::DamageKind;
use crate::world::state::world::World;
use std::sync::Arc;

/// Damage to players who stand on a floor.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub struct SectorDamage {
    /// Health points a hit; 0 for none.
    pub amount: i32,
    /// Tics between hits: a hit where the world's tic is a multiple of it.
    pub interval: u32,
    /// Chance in 256 that a radiation suit leaks.
    pub leak: i32,
}

/// Which effects are at work in a sector: new ones of the same kind are ignored.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Busy(u8);

impl Busy {
    /// A floor mover or waggle.
    pub const FLOOR: Busy = Busy(1);
    /// A ceiling mover.
    pub const CEILING: Busy = Busy(2);
    /// Either of them.
    pub const PLANES: Busy = Busy(Busy::FLOOR.0 | Busy::CEILING.0);
    /// A light effect.
    pub const LIGHT: Busy = Busy(4);

    /// That which moves a floor, or a ceiling.
    pub(crate) const fn of_plane(ceiling: bool) -> Busy {
        if ceiling { Busy::CEILING } else { Busy::FLOOR }
    }

    /// Whether one of these is at work.
    #[must_use]
    pub const fn any(self, of: Busy) -> bool {
        self.0 & of.0 != 0
    }

    /// One of these begins; whether one was at work already.
    pub(crate) fn begin(&mut self, one: Busy) -> bool {
        let was = self.any(one);
        self.0 |= one.0;
        was
    }

    /// One of these ends; whether one was at work.
    pub(crate) fn end(&mut self, one: Busy) -> bool {
        let was = self.any(one);
        self.0 &= !one.0;
        was
    }
}

/// The changing part of a sector, but for the damage that its floor does. Four to a line of the
/// cache: a frame looks at a hundred.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(align(16))]
pub struct SectorState {
    /// Floor height.
    pub floor: Fixed,
    /// Ceiling height.
    pub ceiling: Fixed,
    /// Floor texture.
    pub floor_texture: TextureId,
    /// Ceiling texture.
    pub ceiling_texture: TextureId,
    /// Light; the renderer clamps.
    pub light: i16,
    /// What is at work in it.
    pub busy: Busy,
}

const _: () = assert!(size_of::<SectorState>() == 16);

impl SectorDamage {
    /// What a sector's floor does as the map starts it. Lava hurts before any script: 8 points
    /// every 32 tics, through any suit.
    pub(crate) fn new(sector: &Sector) -> SectorDamage {
        match sector.special & 0xFF {
            special::LAVA => SectorDamage { amount: 8, interval: 32, leak: 256 },
            _ => SectorDamage::default(),
        }
    }
}

impl SectorState {
    /// A sector as the map starts it.
    pub(crate) fn new(sector: &Sector) -> SectorState {
        SectorState {
            floor: sector.floor,
            ceiling: sector.ceiling,
            floor_texture: sector.floor_texture,
            ceiling_texture: sector.ceiling_texture,
            light: sector.light,
            busy: Busy::default(),
        }
    }
}

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
