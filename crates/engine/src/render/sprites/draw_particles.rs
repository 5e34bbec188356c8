//! The squares of trails, drawn between the sprites: the farthest first.

use crate::render::buffers::written::{ClassBuffer, DepthBuffer};
use crate::render::sprites::particles::{Particle, inverse};
use crate::render::sprites::pass::SpritePass;

impl SpritePass<'_> {
    /// Finds the trails of which drawsegs may hide something: nothing is before most.
    pub fn find_hidden_trails(&mut self) {
        for seen in self.trails.trails.iter_mut().filter(|seen| seen.distance > 0) {
            let [first, end] = seen.columns.map(usize::from);
            seen.hidden = self.drawsegs.meet(self.simd, first, end, inverse(seen.distance)) > 0;
        }
    }

    /// Draws the squares that are farther away than a distance, 16.16, and were not drawn yet.
    /// Depth and labels say nothing of them.
    pub fn squares_beyond<D: DepthBuffer, C: ClassBuffer>(&mut self, distance: i64) {
        while let Some(spot) = self.trails.spots.pop_if(|spot| spot.distance > distance) {
            self.square::<D, C>(&spot);
        }
    }

    /// Mixes the colour of a spot into what is seen of each of its columns.
    fn square<D: DepthBuffer, C: ClassBuffer>(&mut self, spot: &Particle) {
        let (width, hidden) =
            (self.frame.width, self.trails.trails[usize::from(spot.trail)].hidden);
        let first = usize::from(spot.columns[0]);
        if hidden {
            let extent = spot.extent();
            self.columns.open(0..self.view.view_rows as i16, (first..extent.end).map(|_| 0));
            self.occlude::<D, C>(&extent);
        }
        for column in first..usize::from(spot.columns[1]) {
            let [mut top, mut bottom] = spot.rows;
            if hidden {
                (top, bottom) = (
                    top.max(self.columns.tops[column - first]),
                    bottom.min(self.columns.bottoms[column - first]),
                );
            }
            for row in top..bottom {
                let pixel = &mut self.frame.colour[row as usize * width + column];
                *pixel = self.scene.blend.over(spot.colour, *pixel, spot.opacity);
            }
        }
    }
}
