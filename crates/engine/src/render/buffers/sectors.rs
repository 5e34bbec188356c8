//! What is drawn of a sector, looked at when a frame first needs it: floors and lights may have to
//! be computed.

use crate::map::{SectorId, TextureId};
use crate::math::Fixed;
use crate::world::World;

/// All that is drawn of a sector.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub(crate) struct SectorSurfaces {
    pub floor: Fixed,
    pub ceiling: Fixed,
    pub floor_texture: TextureId,
    pub ceiling_texture: TextureId,
    pub light: i16,
    /// The frame that it is of.
    frame: u16,
}

impl SectorSurfaces {
    /// No frame's.
    const NONE: SectorSurfaces = SectorSurfaces {
        floor: Fixed::ZERO,
        ceiling: Fixed::ZERO,
        floor_texture: TextureId(0),
        ceiling_texture: TextureId(0),
        light: 0,
        frame: 0,
    };

    /// Not zero if two surfaces of one frame differ.
    #[inline(always)]
    pub fn difference(&self, other: &SectorSurfaces) -> u64 {
        let words = |look: &SectorSurfaces| {
            let heights = u64::from(look.floor.0 as u32) | u64::from(look.ceiling.0 as u32) << 32;
            let textures =
                u64::from(look.floor_texture.0) | u64::from(look.ceiling_texture.0) << 16;
            [heights, textures | u64::from(look.light as u16) << 32 | u64::from(look.frame) << 48]
        };
        let (one, other) = (words(self), words(other));
        (one[0] ^ other[0]) | (one[1] ^ other[1])
    }
}

/// The surfaces of a frame's sectors.
#[derive(Debug, Default)]
pub(crate) struct SurfaceCache {
    list: Vec<SectorSurfaces>,
    /// The frame at hand, from 1.
    frame: u16,
}

impl SurfaceCache {
    /// Forgets the last frame; the next one has this many sectors.
    pub fn reset(&mut self, sectors: usize) {
        self.list.resize(sectors, SectorSurfaces::NONE);
        if self.frame == u16::MAX {
            self.list.fill(SectorSurfaces::NONE);
            self.frame = 0;
        }
        self.frame += 1;
    }

    /// What is drawn of a sector in this frame.
    #[inline(always)]
    pub fn of(&mut self, world: &World, sector: u32) -> SectorSurfaces {
        if self.list[sector as usize].frame != self.frame {
            self.fetch(world, sector);
        }
        self.list[sector as usize]
    }

    #[inline(never)]
    fn fetch(&mut self, world: &World, sector: u32) {
        let state = world.sector(SectorId(sector));
        self.list[sector as usize] = SectorSurfaces {
            floor: state.floor,
            ceiling: state.ceiling,
            floor_texture: state.floor_texture,
            ceiling_texture: state.ceiling_texture,
            light: state.light,
            frame: self.frame,
        };
    }
}
