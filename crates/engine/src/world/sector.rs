//! What changes of a sector.

use crate::map::TextureId;
use crate::math::Fixed;

/// Damage to players who stand on a floor.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct SectorDamage {
    /// Health points a hit; 0 for none.
    pub amount: i32,
    /// Tics between hits: a hit where the world's tic is a multiple of it.
    pub interval: u32,
    /// Chance in 256 that a radiation suit leaks.
    pub leak: i32,
}

/// The changing part of a sector.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
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
    /// Damage to players who stand on its floor.
    pub damage: SectorDamage,
    /// A floor mover or waggle is at work: new ones are ignored.
    pub floor_busy: bool,
    /// A ceiling mover is at work.
    pub ceiling_busy: bool,
}
