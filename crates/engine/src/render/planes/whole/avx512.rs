//! Whole floors and ceilings with vectors of 64 bytes, in frames as small as learners': which
//! columns of a row belong to the plane is one mask or two, and what is the same all along a row is
//! worked out for eight rows side by side.

use crate::render::buffers::frame::Frame;
use crate::render::buffers::visplane::{SPAN_BLOCK, VisPlane};
use crate::render::buffers::written::{ClassBuffer, DepthBuffer};
use crate::render::planes::row::avx512::{self, ROW_VECTOR};
use crate::render::planes::row::data::RowWalk;
use crate::render::planes::shader::PlaneShader;
use crate::render::planes::spans::avx2::rows;
use crate::render::planes::spans::avx512::load_avx512;
use crate::render::planes::spans::rows::next_run;
use crate::render::textures::flat::FlatTexture;
use crate::render::view::light_avx512::tables;
use crate::simd::lookup::avx512::{load, load_table, look_up_block};
use crate::simd::lookup::first_of_eight;
use std::arch::x86_64::*;

/// The last row that fits a byte.
const LAST_BYTE: i16 = 255;
/// Rows that are worked out side by side.
const EIGHT: usize = 8;

/// What eight rows show.
struct EightRows {
    walks: [[u32; EIGHT]; 4],
    distances: [i64; EIGHT],
    tables: [i64; EIGHT],
}

/// Draws a plane, if it is small enough; returns whether it was.
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi")]
pub(crate) fn draw<D: DepthBuffer, C: ClassBuffer>(
    shader: &PlaneShader,
    frame: &mut Frame,
    flat: &FlatTexture,
    plane: &VisPlane,
) -> bool {
    let (first, end) = rows(plane);
    let blocks = (plane.end - plane.first).div_ceil(SPAN_BLOCK);
    if end > LAST_BYTE || blocks > 2 {
        return false;
    }
    match (flat, blocks) {
        (FlatTexture::Small(texels), 1) => {
            draw_rows::<D, C, 6, { 64 * 64 }, 1>(shader, frame, texels, plane, first, end)
        }
        (FlatTexture::Small(texels), _) => {
            draw_rows::<D, C, 6, { 64 * 64 }, 2>(shader, frame, texels, plane, first, end)
        }
        (FlatTexture::Large(texels), 1) => {
            draw_rows::<D, C, 7, { 128 * 128 }, 1>(shader, frame, texels, plane, first, end)
        }
        (FlatTexture::Large(texels), _) => {
            draw_rows::<D, C, 7, { 128 * 128 }, 2>(shader, frame, texels, plane, first, end)
        }
    }
    true
}

#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi")]
fn draw_rows<
    D: DepthBuffer,
    C: ClassBuffer,
    const BITS: u32,
    const TEXELS: usize,
    const BLOCKS: usize,
>(
    shader: &PlaneShader,
    frame: &mut Frame,
    texels: &[u8; TEXELS],
    plane: &VisPlane,
    first: i16,
    end: i16,
) {
    let mut ends = [[_mm512_setzero_si512(); 2]; BLOCKS];
    for (i, ends) in ends.iter_mut().enumerate() {
        let block = |list: &[i16]| {
            bytes_of(list[plane.first + i * SPAN_BLOCK..].first_chunk().expect("lists are padded"))
        };
        *ends = [block(&plane.top), block(&plane.bottom)];
    }
    let (first, end) = (first.max(0) as usize, end.max(0) as usize);
    let from_left = &shader.view.columns[plane.first..];
    // Texels are fetched one by one, and lit as vectors some hundred instructions later: bytes that
    // were just written one by one cannot be loaded together at once.
    let mut unlit = [[[0; SPAN_BLOCK + ROW_VECTOR]; BLOCKS]; EIGHT];
    let mut masks = [[0; BLOCKS]; EIGHT];
    for from in (first..end).step_by(EIGHT) {
        let (eight, count) = (eight_rows::<BITS>(shader, from), EIGHT.min(end - from));
        for (i, (unlit, masks)) in unlit.iter_mut().zip(&mut masks).enumerate().take(count) {
            let here = _mm512_set1_epi8((from + i) as i8);
            let [u, v, u_step, v_step] = eight.walks.map(|list| list[i]);
            let walk = RowWalk { u, v, u_step, v_step };
            for (block, ((unlit, whole), [top, bottom])) in
                unlit.iter_mut().zip(masks).zip(&ends).enumerate()
            {
                let mut mask =
                    _mm512_mask_cmpgt_epu8_mask(_mm512_cmple_epu8_mask(*top, here), *bottom, here);
                *whole = mask;
                while mask != 0 {
                    // Whole vectors, runs or not: how many runs there are and how long they are is
                    // unpredictable.
                    let first = mask.trailing_zeros() as usize;
                    let columns = from_left[block * SPAN_BLOCK + first..]
                        .first_chunk()
                        .expect("the list is padded");
                    let unlit = unlit[first..].first_chunk_mut().expect("a block and a vector");
                    avx512::fetch::<BITS, TEXELS>(&walk, unlit, columns, texels);
                    mask &= !(((1 << ROW_VECTOR) - 1) << first);
                }
                if D::WRITTEN || C::WRITTEN {
                    let (mut mask, left) =
                        (*whole, (from + i) * frame.width + plane.first + block * SPAN_BLOCK);
                    while mask != 0 {
                        let run = next_run(&mut mask);
                        shader.write::<D, C>(
                            frame,
                            eight.distances[i],
                            left + run.start..left + run.end,
                        );
                    }
                }
            }
        }
        for (i, (unlit, masks)) in unlit.iter().zip(&masks).enumerate().take(count) {
            let table = load_table(&shader.tables[eight.tables[i] as usize & 31]);
            for (block, (unlit, &mask)) in unlit.iter().zip(masks).enumerate() {
                let pixels = &mut frame.colour
                    [(from + i) * frame.width + plane.first + block * SPAN_BLOCK..];
                let lit = look_up_block(table, load(unlit.first_chunk().expect("a block")));
                // SAFETY: only columns of the mask are written, which the frame has.
                unsafe { _mm512_mask_storeu_epi8(pixels.as_mut_ptr().cast(), mask, lit) }
            }
        }
    }
}

/// What the rows from `first` on have in common all along: [`PlaneShader::row`] and
/// [`PlaneShader::walk`].
#[inline]
#[target_feature(enable = "avx512f,avx512dq")]
fn eight_rows<const BITS: u32>(shader: &PlaneShader, first: usize) -> EightRows {
    let (camera, splat) = (shader.camera, |number: i64| _mm512_set1_epi64(number));
    let slopes = load_rows(&shader.slopes.distances[first..]);
    let distance = _mm512_srai_epi64(_mm512_mullo_epi64(splat(shader.height), slopes), 16);
    let rows = load_rows(&shader.slopes.rows[first..]);
    let nearness = _mm512_srai_epi64(_mm512_mullo_epi64(splat(shader.nearness), rows), 32);
    let part = |position: __m512i| match BITS {
        6 => _mm512_cvtepi64_epi32(_mm512_srli_epi64(position, 22)),
        _ => _mm512_cvtepi64_epi32(_mm512_srli_epi64(position, 23)),
    };
    let along = |ray: i64| _mm512_mullo_epi64(distance, splat(ray));
    let u = _mm512_add_epi64(splat(camera.x << 32), along(camera.plane_ray[0]));
    let v = _mm512_add_epi64(splat(camera.y << 32), along(camera.plane_ray[1]));
    let minus = |vector: __m512i| _mm512_sub_epi64(_mm512_setzero_si512(), vector);
    let walks = [
        part(u),
        part(minus(v)),
        part(along(camera.plane_step[0])),
        part(minus(along(camera.plane_step[1]))),
    ];
    let mut eight = EightRows { walks: [[0; EIGHT]; 4], distances: [0; EIGHT], tables: [0; EIGHT] };
    for (to, from) in eight.walks.iter_mut().zip(walks) {
        // SAFETY: 32 bytes are writable behind the reference.
        unsafe { _mm256_storeu_si256(to.as_mut_ptr().cast(), from) }
    }
    for (to, from) in
        [(&mut eight.distances, distance), (&mut eight.tables, tables(shader.light, nearness))]
    {
        // SAFETY: 64 bytes are writable behind the reference.
        unsafe { _mm512_storeu_si512(to.as_mut_ptr().cast(), from) }
    }
    eight
}
/// Rows as bytes; those of columns without rows, which may be negative, as 0.
#[inline]
#[target_feature(enable = "avx512f,avx512bw")]
fn bytes_of(list: &[i16; SPAN_BLOCK]) -> __m512i {
    let [low, high] = load_avx512(list);
    let bytes =
        |half: __m512i| _mm512_cvtepi16_epi8(_mm512_max_epi16(half, _mm512_setzero_si512()));
    _mm512_inserti64x4(_mm512_castsi256_si512(bytes(low)), bytes(high), 1)
}

/// Eight numbers, or as many as there are.
#[inline]
#[target_feature(enable = "avx512f")]
fn load_rows(list: &[i64]) -> __m512i {
    // SAFETY: only the numbers that are there are read.
    unsafe { _mm512_maskz_loadu_epi64(first_of_eight(list.len()), list.as_ptr()) }
}
