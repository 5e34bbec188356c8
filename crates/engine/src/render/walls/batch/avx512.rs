//! Columns in batches with vectors of 64 bytes: eight are listed at once, and each is drawn as one
//! vector.

use crate::render::blocks::ROW_BLOCK;
use crate::render::buffers::frame::Columns;
use crate::render::buffers::written::DepthBuffer;
use crate::render::textures::wall::MOST_TEXELS;
use crate::render::textures::wall::WallTexture;
use crate::render::view::depth::DepthEncoding;
use crate::render::walls::batch::data::WallBatch;
use crate::render::walls::column::avx512::highest_bytes;
use crate::render::walls::shade::avx512::{self, WallVectors};
use crate::render::walls::shader::{WALL_BLOCK, WallShader, WallSlope};
use crate::simd::lookup::avx512::{load, load_table, look_up_block};
use crate::simd::lookup::first_of_eight;
use std::arch::x86_64::*;

/// Adds the `count` frame columns from `first` on of a wall that shows a picture with texels from
/// `start` on, where `tops` are above `bottoms`; these lists are padded.
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi")]
pub(crate) fn add<D: DepthBuffer>(
    batch: &mut WallBatch,
    shader: &WallShader,
    start: u32,
    first: usize,
    count: usize,
    tops: &[i16],
    bottoms: &[i16],
) {
    let slope = shader.slope();
    batch.make_room(batch.count + count + WALL_BLOCK);
    for from in (0..count).step_by(WALL_BLOCK) {
        let (tops, bottoms) = (rows(&tops[from..]), rows(&bottoms[from..]));
        let shown = _mm512_mask_cmplt_epi64_mask(first_of_eight(count - from), tops, bottoms);
        add_block::<D>(batch, shader, &slope, start, first + from, shown, [tops, bottoms]);
    }
}

#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi")]
fn add_block<D: DepthBuffer>(
    batch: &mut WallBatch,
    shader: &WallShader,
    slope: &WallSlope,
    start: u32,
    first: usize,
    shown: __mmask8,
    [tops, bottoms]: [__m512i; 2],
) {
    let columns = shader.view.columns[first..].first_chunk().expect("the list is padded");
    let WallVectors { distance, u, table, at, step } = avx512::vectors(shader, slope, columns);
    let WallTexture { width, height, .. } = *shader.picture;
    let column =
        _mm256_and_si256(_mm512_cvtepi64_epi32(_mm512_srai_epi64(u, 16)), splat(width - 1));
    let texels = _mm256_add_epi32(splat(start), _mm256_mullo_epi32(column, splat(height)));
    let x = _mm256_add_epi32(splat(first as u32), _mm256_set_epi32(7, 6, 5, 4, 3, 2, 1, 0));
    put(&mut batch.texels[batch.count..], shown, texels);
    put(&mut batch.last_texels[batch.count..], shown, splat(height - 1));
    put(&mut batch.positions[batch.count..], shown, _mm512_cvtepi64_epi32(at));
    put(&mut batch.steps[batch.count..], shown, _mm512_cvtepi64_epi32(step));
    put(&mut batch.tables[batch.count..], shown, _mm512_cvtepi64_epi32(table));
    put(&mut batch.columns[batch.count..], shown, x);
    // From the first row on, and before the last one's end: of 64 rows, counts are those of bits.
    let all = _mm512_set1_epi64(-1);
    let below =
        _mm512_srlv_epi64(all, _mm512_sub_epi64(_mm512_set1_epi64(ROW_BLOCK as i64), bottoms));
    put_wide(
        &mut batch.rows[batch.count..],
        shown,
        _mm512_and_si512(_mm512_sllv_epi64(all, tops), below),
    );
    if D::WRITTEN {
        put_wide(&mut batch.distances[batch.count..], shown, distance);
    }
    batch.count += shown.count_ones() as usize;
}

/// Draws the columns; `rows` are the frame's base rows, `texels` those of all pictures.
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi")]
pub(crate) fn draw<D: DepthBuffer>(
    batch: &WallBatch,
    frame: &mut Columns,
    rows: &[u32; ROW_BLOCK],
    texels: &[u8],
    tables: &[[u8; 256]; 32],
    depths: DepthEncoding,
) {
    let count = batch.count;
    let (starts, lasts) = (&batch.texels[..count], &batch.last_texels[..count]);
    let (positions, steps) = (&batch.positions[..count], &batch.steps[..count]);
    let (table_numbers, columns, masks) =
        (&batch.tables[..count], &batch.columns[..count], &batch.rows[..count]);
    for i in 0..count {
        let halves: &[u8; MOST_TEXELS] =
            texels[starts[i] as usize..].first_chunk().expect("the list is padded");
        let (halves, _) = halves.as_chunks::<ROW_BLOCK>();
        // The highest 6 or 7 bits of a position; those that come from its neighbour are cut.
        let shift = _mm_cvtsi32_si128(if lasts[i] == 63 { 2 } else { 1 });
        let index = _mm512_srl_epi16(highest_bytes(positions[i], steps[i], rows), shift);
        let index = _mm512_and_si512(index, _mm512_set1_epi8(lasts[i] as i8));
        let colours = _mm512_permutex2var_epi8(load(&halves[0]), index, load(&halves[1]));
        let lit = look_up_block(load_table(&tables[table_numbers[i] as usize & 31]), colours);
        let x = columns[i] as usize;
        store(&mut frame.colour_blocks()[x], masks[i], lit);
        if D::WRITTEN {
            let depth = depths.wall(batch.distances[i] as i64, lasts[i] + 1);
            store(&mut frame.depth_blocks()[x], masks[i], _mm512_set1_epi8(depth as i8));
        }
    }
}

#[inline]
#[target_feature(enable = "avx2")]
fn splat(number: u32) -> __m256i {
    _mm256_set1_epi32(number as i32)
}

/// Eight rows as they are listed.
#[inline]
#[target_feature(enable = "avx512f")]
fn rows(list: &[i16]) -> __m512i {
    let rows: &[i16; WALL_BLOCK] = list.first_chunk().expect("lists are padded");
    // SAFETY: 16 bytes are readable behind the reference.
    _mm512_cvtepi16_epi64(unsafe { _mm_loadu_si128(rows.as_ptr().cast()) })
}

/// Writes those of eight numbers that a mask has to the front of a list.
#[inline]
#[target_feature(enable = "avx512f,avx512vl")]
fn put(list: &mut [u32], mask: __mmask8, numbers: __m256i) {
    let to: &mut [u32; WALL_BLOCK] = list.first_chunk_mut().expect("there is room");
    // SAFETY: 32 bytes are writable behind the reference.
    unsafe {
        _mm256_storeu_si256(to.as_mut_ptr().cast(), _mm256_maskz_compress_epi32(mask, numbers))
    }
}

/// The same with wider numbers.
#[inline]
#[target_feature(enable = "avx512f")]
fn put_wide(list: &mut [u64], mask: __mmask8, numbers: __m512i) {
    let to: &mut [u64; WALL_BLOCK] = list.first_chunk_mut().expect("there is room");
    // SAFETY: 64 bytes are writable behind the reference.
    unsafe {
        _mm512_storeu_si512(to.as_mut_ptr().cast(), _mm512_maskz_compress_epi64(mask, numbers))
    }
}

/// Writes the bytes of a mask.
#[inline]
#[target_feature(enable = "avx512f,avx512bw")]
fn store(bytes: &mut [u8; ROW_BLOCK], mask: u64, vector: __m512i) {
    // SAFETY: 64 bytes are writable behind the reference.
    unsafe { _mm512_mask_storeu_epi8(bytes.as_mut_ptr().cast(), mask, vector) }
}
