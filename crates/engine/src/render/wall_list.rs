//! Columns of walls on their way to the screen, for processors with 64-byte vectors: listed while the world is walked, and
//! drawn together. How many columns a wall has, and which of them are covered, cannot be foretold; in one list of all walls
//! one column is like the next.
//!
//! The plain twin is `column`, by which walls are drawn that do not fit here; a test in `wall` compares them.

use super::column::ROW_BLOCK;
use super::column_wide::highest_bytes;
use super::convert_wide::{load, load_table, look_up_block};
use super::depth::Depths;
use super::frame::Columns;
use super::picture::WallPicture;
use super::wall::{WALL_BLOCK, WallShader, WallSlope};
use super::wall_wide::{self, WallVectors};
use std::arch::x86_64::*;

/// What is listed; a column is one entry in each list.
#[derive(Debug, Default)]
pub(super) struct WallList {
    count: usize,
    /// Index of the first texel; position in the texture at base row 0, from bit 32 on.
    texels: Vec<i64>,
    /// Change of that position a base row; light table, from bit 32 on.
    steps: Vec<i64>,
    /// Frame column, first row, one past the last, and index of the picture: 16 bits each.
    places: Vec<i64>,
    distances: Vec<i64>,
}

impl WallList {
    /// Whether walls with a picture can be listed: its columns fill one or two vectors, and wrap as numbers do.
    pub fn takes(picture: &WallPicture) -> bool {
        matches!(picture.height, 64 | 128) && picture.width.is_power_of_two()
    }

    /// Forgets what was drawn.
    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// Adds the `count` frame columns from `first` on of a wall that shows picture number `picture`, where `tops` are
    /// above `bottoms`; these lists are padded.
    #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi")]
    pub fn add(&mut self, shader: &WallShader, picture: usize, first: usize, count: usize, tops: &[i16], bottoms: &[i16]) {
        let slope = shader.slope();
        for from in (0..count).step_by(WALL_BLOCK) {
            self.add_block(shader, &slope, picture, [first + from, count - from], &tops[from..], &bottoms[from..]);
        }
    }

    #[inline]
    #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi")]
    fn add_block(
        &mut self,
        shader: &WallShader,
        slope: &WallSlope,
        picture: usize,
        [first, count]: [usize; 2],
        tops: &[i16],
        bottoms: &[i16],
    ) {
        let columns = shader.view.columns[first..].first_chunk().expect("the list is padded");
        let WallVectors { distance, u, table, at, step } = wall_wide::vectors(shader, slope, columns);
        let width = _mm512_set1_epi64(i64::from(shader.picture.width) - 1);
        let column = _mm512_and_si512(_mm512_srai_epi64(u, 16), width);
        let start = _mm512_mullo_epi64(column, _mm512_set1_epi64(i64::from(shader.picture.height)));
        let (top, bottom) = (rows(tops), rows(bottoms));
        let inside = if count < WALL_BLOCK { (1 << count) - 1 } else { u8::MAX };
        let shown = _mm512_mask_cmplt_epi64_mask(inside, top, bottom);
        let x = _mm512_add_epi64(_mm512_set1_epi64((first | picture << 48) as i64), _mm512_set_epi64(7, 6, 5, 4, 3, 2, 1, 0));
        let place = _mm512_or_si512(x, _mm512_or_si512(_mm512_slli_epi64(top, 16), _mm512_slli_epi64(bottom, 32)));
        let low = |vector| _mm512_maskz_mov_epi32(0b0101_0101_0101_0101, vector);
        let (end, words) = (self.count + WALL_BLOCK, [
            (&mut self.texels, _mm512_or_si512(start, _mm512_slli_epi64(at, 32))),
            (&mut self.steps, _mm512_or_si512(low(step), _mm512_slli_epi64(table, 32))),
            (&mut self.places, place),
            (&mut self.distances, distance),
        ]);
        for (list, word) in words {
            if list.len() < end {
                list.resize(2 * end, 0);
            }
            let to: &mut [i64; WALL_BLOCK] = list[self.count..].first_chunk_mut().expect("there is room");
            // SAFETY: 64 bytes are writable behind the reference.
            unsafe { _mm512_storeu_si512(to.as_mut_ptr().cast(), _mm512_maskz_compress_epi64(shown, word)) }
        }
        self.count += shown.count_ones() as usize;
    }

    /// Draws the columns, in base rows `rows`, which are padded to whole blocks.
    #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi")]
    pub fn draw<const DEPTH: bool>(
        &self,
        frame: &mut Columns,
        rows: &[u32],
        pictures: &[WallPicture],
        tables: &[[u8; 256]; 32],
        depths: Depths,
    ) {
        let (rows, _) = rows.as_chunks::<ROW_BLOCK>();
        let lists = self.texels[..self.count].iter().zip(&self.steps).zip(&self.places).zip(&self.distances);
        for (((&texels, &step), &place), &distance) in lists {
            let [x, top, bottom, picture] = [0, 16, 32, 48].map(|from| (place >> from) as usize & 0xFFFF);
            let column = ListedColumn::new(&pictures[picture], tables, texels, step);
            let (pixels, _) = frame.colour_of(x).as_chunks_mut::<ROW_BLOCK>();
            if let ([pixels], [rows]) = (&mut *pixels, rows) {
                column.draw(pixels, rows, (u64::MAX << top) & (u64::MAX >> (ROW_BLOCK - bottom)));
            } else {
                for block in top / ROW_BLOCK..bottom.div_ceil(ROW_BLOCK) {
                    let above = top.saturating_sub(block * ROW_BLOCK);
                    let below = ((block + 1) * ROW_BLOCK).saturating_sub(bottom);
                    column.draw(&mut pixels[block], &rows[block], (u64::MAX << above) & (u64::MAX >> below));
                }
            }
            if DEPTH {
                let depth = depths.wall(distance);
                frame.depth_of(x)[top..bottom].fill(depth);
            }
        }
    }
}

/// A column as it is drawn.
struct ListedColumn {
    /// Its texels: of 64 both halves are the same.
    halves: [__m512i; 2],
    /// From the highest byte of a position to the index of a texel.
    shift: __m128i,
    table: [__m512i; 4],
    at: u32,
    step: u32,
}

impl ListedColumn {
    #[inline]
    #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi")]
    fn new(picture: &WallPicture, tables: &[[u8; 256]; 32], texels: i64, step: i64) -> ListedColumn {
        let height = picture.height as usize;
        let column = &picture.pixels[texels as u32 as usize..][..height];
        let half = |from: usize| load(column[from..].first_chunk().expect("64 texels at least"));
        ListedColumn {
            halves: [half(0), half(height - ROW_BLOCK)],
            shift: _mm_cvtsi32_si128(if height == 2 * ROW_BLOCK { 1 } else { 2 }),
            table: load_table(&tables[(step >> 32) as usize & 31]),
            at: (texels >> 32) as u32,
            step: step as u32,
        }
    }

    /// Draws the rows of a mask.
    #[inline]
    #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi")]
    fn draw(&self, pixels: &mut [u8; ROW_BLOCK], rows: &[u32; ROW_BLOCK], mask: u64) {
        let index = _mm512_srl_epi16(highest_bytes(self.at, self.step, rows), self.shift);
        let lit = look_up_block(self.table, _mm512_permutex2var_epi8(self.halves[0], index, self.halves[1]));
        // SAFETY: 64 bytes are writable behind the reference.
        unsafe { _mm512_mask_storeu_epi8(pixels.as_mut_ptr().cast(), mask, lit) }
    }
}

/// Eight rows as they are listed.
#[inline]
#[target_feature(enable = "avx512f")]
fn rows(list: &[i16]) -> __m512i {
    let rows: &[i16; WALL_BLOCK] = list.first_chunk().expect("lists are padded");
    // SAFETY: 16 bytes are readable behind the reference.
    _mm512_cvtepi16_epi64(unsafe { _mm_loadu_si128(rows.as_ptr().cast()) })
}
