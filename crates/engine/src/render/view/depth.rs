//! From a distance to a value of the depth buffer.

use crate::render::published_depth::DepthFormulas;

/// How depth is written: evenly, or as ViZDoom writes it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct DepthEncoding {
    published: Option<DepthFormulas>,
}

impl DepthEncoding {
    /// By formulas, or evenly without them.
    pub fn new(published: Option<DepthFormulas>) -> DepthEncoding {
        DepthEncoding { published }
    }

    /// Depth of a wall at a distance in 16.16 map units that shows a texture of `height` texels.
    #[inline]
    pub fn wall(self, distance: i64, height: u32) -> u8 {
        let Some(published) = self.published else { return even(distance) };
        published.wall(distance, height)
    }

    /// Depth of a sprite.
    #[inline]
    pub fn sprite(self, distance: i64, focal_y: i64) -> u8 {
        let Some(published) = self.published else { return even(distance) };
        published.sprite(distance, focal_y)
    }

    /// Depth of soot where it is written by itself.
    #[inline]
    pub fn stain(self, distance: i64) -> u8 {
        if self.published.is_some() { DepthFormulas::DECAL } else { even(distance) }
    }

    /// Depth of a floor or ceiling, in every size the same.
    #[inline]
    pub fn plane(self, distance: i64) -> u8 {
        let Some(published) = self.published else { return even(distance) };
        published.plane(distance)
    }

    /// Depth of the sky and of nothing.
    pub fn farthest(self) -> u8 {
        self.published.map_or(255, DepthFormulas::farthest)
    }
}

/// 7.3 map units a level.
#[inline]
fn even(distance: i64) -> u8 {
    (distance * 10 / (73 << 16)).min(255) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    fn units(distance: i64) -> i64 {
        distance << 16
    }

    #[test]
    fn even_depth_is_the_same_for_everything() {
        let depths = DepthEncoding::default();
        for distance in [0, 72, 73, 730, 1860, 30_000].map(units) {
            let level = ((distance >> 16) * 10 / 73).min(255) as u8;
            let written = [
                depths.wall(distance, 128),
                depths.plane(distance),
                depths.sprite(distance, 96 << 16),
                depths.stain(distance),
            ];
            assert_eq!(written, [level; 4]);
        }
        assert_eq!(depths.farthest(), 255);
    }
}
