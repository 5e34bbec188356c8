//! Where a seg lies on the screen, and the drawing of its wall.

use crate::render::buffers::frame::Columns;
use crate::render::textures::local_palette::OwnColours;
use crate::render::textures::picture::WallPicture;
use crate::render::view::camera::Camera;
use crate::render::view::depth::Depths;
use crate::render::view::light::{Light, ONE_TABLE_DISTANCE};
use crate::render::view::line::{INVERSE_BITS, SeenLine, TextureLine};
use crate::render::view::tables::View;
use crate::render::walls::column::Column;
#[cfg(target_arch = "x86_64")]
use crate::render::walls::shade::{avx2, avx512};
#[cfg(target_arch = "x86_64")]
use crate::simd::Level;
use crate::simd::Simd;

/// A part of a wall that one texture covers.
pub(crate) struct WallShader<'a> {
    pub camera: &'a Camera,
    pub view: &'a View,
    pub depths: Depths,
    pub tables: &'a [[u8; 256]; 32],
    /// For texture positions.
    pub line: &'a SeenLine,
    /// For the light.
    pub ends: &'a SeenLine,
    pub texture: TextureLine,
    pub picture: &'a WallPicture,
    #[cfg_attr(not(target_arch = "x86_64"), allow(dead_code, reason = "wide code alone picks colours so"))]
    pub own: &'a OwnColours,
    pub light: Light,
    /// Height of the texture's top row, relative to the eye, 16.16.
    pub hung_from: i64,
}

/// Columns of a wall that are worked out side by side at most.
pub(crate) const WALL_BLOCK: usize = 8;

/// Where the texture lies in the rows, the same in all columns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WallSlope {
    /// Texture position at the height of the eye, as a fraction of the texture's height with 32 bits.
    pub start: i64,
    /// From the horizon to the lower edge of base row 0: whole base rows, and 65536ths of one to take away.
    pub rows: i64,
    pub fraction: i64,
}

/// What one column of a wall shows.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct WallColumn {
    distance: i64,
    /// Horizontal texture position, 16.16.
    u: i64,
    /// Light table.
    table: usize,
    /// Position in the texture at base row 0 and its change a base row, as fractions of its height with 32 bits: what
    /// overflows is whole heights.
    at: u32,
    step: u32,
}

impl WallShader<'_> {
    /// Draws rows `tops[i]..bottoms[i]` of the frame columns from `first` on, into the frame's columns.
    pub fn draw<const DEPTH: bool>(&self, simd: Simd, frame: &mut Columns, first: usize, tops: &[i16], bottoms: &[i16]) {
        // What is done for a column is short: calls into functions for other instructions would be much of it.
        #[cfg(target_arch = "x86_64")]
        match simd.level() {
            // SAFETY: whoever has this `Simd` has the instructions.
            Level::Avx512 => return unsafe { self.draw_avx512::<DEPTH>(simd, frame, first, tops, bottoms) },
            // SAFETY: as above.
            Level::Avx2 if avx2::fits(self) => {
                return unsafe { avx2::draw::<DEPTH>(self, frame, first, tops, bottoms) };
            }
            _ => {}
        }
        self.draw_columns::<DEPTH>(simd, frame, first, tops, bottoms);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi")]
    fn draw_avx512<const DEPTH: bool>(&self, simd: Simd, frame: &mut Columns, first: usize, tops: &[i16], bottoms: &[i16]) {
        self.draw_columns::<DEPTH>(simd, frame, first, tops, bottoms);
    }

    #[inline(always)]
    fn draw_columns<const DEPTH: bool>(&self, simd: Simd, frame: &mut Columns, first: usize, tops: &[i16], bottoms: &[i16]) {
        let slope = self.slope();
        for from in (0..tops.len()).step_by(WALL_BLOCK) {
            #[cfg(target_arch = "x86_64")]
            let block = (simd.level() == Level::Avx512).then(|| {
                let columns = self.view.columns[first + from..].first_chunk().expect("the list is padded");
                // SAFETY: whoever has this `Simd` has the instructions.
                unsafe { avx512::columns(self, &slope, columns) }
            });
            for i in from..(from + WALL_BLOCK).min(tops.len()) {
                let (x, top, bottom) = (first + i, tops[i], bottoms[i]);
                if top >= bottom {
                    continue;
                }
                #[cfg(target_arch = "x86_64")]
                let column = match &block {
                    Some(block) => WallColumn::of_block(block, i - from),
                    None => self.column(&slope, i64::from(self.view.columns[x])),
                };
                #[cfg(not(target_arch = "x86_64"))]
                let column = self.column(&slope, i64::from(self.view.columns[x]));
                self.draw_column::<DEPTH>(simd, frame, x, [top as usize, bottom as usize], column);
            }
        }
    }

    pub fn slope(&self) -> WallSlope {
        // Texels are those of the rows' lower edges.
        let start = (self.hung_from * self.picture.inverse_height) >> 16;
        WallSlope { start, rows: 1 - (self.camera.horizon >> 16), fraction: self.camera.horizon & 0xFFFF }
    }

    /// What a base column shows.
    #[inline(always)]
    fn column(&self, slope: &WallSlope, column: i64) -> WallColumn {
        let distance = self.line.distance_at(column);
        let nearness = (self.ends.inverse_at(column) * ONE_TABLE_DISTANCE) >> (INVERSE_BITS - 16);
        let step = (((distance * self.view.inverse_focal_y) >> 24).wrapping_mul(self.picture.inverse_height)) >> 24;
        let at = slope.start.wrapping_add(step.wrapping_mul(slope.rows)).wrapping_sub((step * slope.fraction) >> 16);
        WallColumn {
            distance,
            u: self.texture.at(column, distance),
            table: self.light.table(nearness),
            at: at as u32,
            step: step as u32,
        }
    }

    #[inline(always)]
    fn draw_column<const DEPTH: bool>(
        &self,
        simd: Simd,
        frame: &mut Columns,
        x: usize,
        [top, bottom]: [usize; 2],
        WallColumn { distance, u, table, at, step }: WallColumn,
    ) {
        let column = Column { texels: self.picture.column(u), table: &self.tables[table], at, step };
        column.draw(simd, frame.colour_of(x), &self.view.rows, top, bottom);
        if DEPTH {
            let depth = self.depths.wall(distance, self.picture.height);
            frame.depth_of(x)[top..bottom].fill(depth);
        }
        // The class of a wall is what the frame was cleared to.
    }
}

impl WallColumn {
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn of_block(block: &avx512::WallColumns, i: usize) -> WallColumn {
        WallColumn {
            distance: block.distance[i],
            u: block.u[i],
            table: block.table[i] as usize,
            at: block.at[i] as u32,
            step: block.step[i] as u32,
        }
    }
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::*;
    use crate::assets::Image;
    use crate::math::Rng;
    use crate::render::view::size::FrameSize;

    #[test]
    fn columns_side_by_side_are_those_one_by_one() {
        let has = |level: Level| Simd::available().iter().any(|simd| simd.level() == level);
        let mut rng = Rng::new(12);
        let pictures = [64, 96, 128].map(|height| {
            let pixels = vec![0; 64 * usize::from(height)].into();
            WallPicture::new(&Image { width: 64, height, offset_x: 0, offset_y: 0, pixels, mask: None })
        });
        let own = OwnColours::new(&[], &[]);
        let view = View::new(FrameSize::LEARNER).unwrap();
        let mut fitting = 0;
        for round in 0..20_000 {
            let mut signed = |bits: u32| rng.next_u64() as i64 >> (63 - bits);
            // Inverses from those beyond all maps to those of a wall at the eye.
            let mut line = || {
                let bits = 24 + signed(5).unsigned_abs() as u32 % 29;
                SeenLine { inverse: signed(bits), inverse_step: signed(bits - 8) }
            };
            let (line, ends) = (line(), line());
            let camera = Camera { horizon: signed(24), extra_light: (signed(1) & 1) as i32, ..Camera::default() };
            let shader = WallShader {
                camera: &camera,
                view: &view,
                depths: Depths::default(),
                tables: &[[0; 256]; 32],
                line: &line,
                ends: &ends,
                texture: TextureLine {
                    along: signed(30),
                    gain: signed(58),
                    gain_step: signed(50),
                    least: [0, i64::MIN][(signed(1) & 1) as usize],
                    last: signed(24).abs(),
                    offset: signed(24),
                },
                picture: &pictures[round % 3],
                own: &own,
                light: Light::new(&camera, signed(8) as i32),
                hung_from: signed(28),
            };
            let slope = shader.slope();
            let columns: [u32; WALL_BLOCK] = *view.columns[rng.below(128) as usize..].first_chunk().unwrap();
            let plain = columns.map(|column| shader.column(&slope, i64::from(column)));
            if has(Level::Avx512) {
                // SAFETY: the processor has the instructions.
                let block = unsafe { avx512::columns(&shader, &slope, &columns) };
                for (i, plain) in plain.iter().enumerate() {
                    assert_eq!(WallColumn::of_block(&block, i), *plain, "{line:?} at {}", columns[i]);
                }
            }
            if has(Level::Avx2) && avx2::fits(&shader) {
                // SAFETY: the processor has the instructions.
                let block = unsafe { avx2::columns(&shader, &slope, &columns) };
                for (i, plain) in plain.iter().enumerate() {
                    let (distance, table) = (block.distance[i], block.table[i] as usize);
                    assert_eq!((distance, table), (plain.distance, plain.table), "{line:?} at {}", columns[i]);
                    let expected = ((plain.u >> 16) as u32, plain.at, plain.step);
                    assert_eq!((block.u[i], block.at[i], block.step[i]), expected, "{line:?} at {}", columns[i]);
                }
                fitting += 1;
            }
        }
        assert!(fitting > 10_000 || !has(Level::Avx2), "{fitting}");
    }
}
