//! What changes of a sector.

use crate::map::{Sector, TextureId};
use crate::math::Fixed;

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
        if sector.hurts() {
            SectorDamage { amount: 8, interval: 32, leak: 256 }
        } else {
            SectorDamage::default()
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
