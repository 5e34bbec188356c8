//! What eight columns of a wall show, side by side, with vectors of 32 bytes. These have no 64-bit
//! products and quotients: doubles, where they are exact, and products of halves stand in.

use crate::render::buffers::frame::Columns;
use crate::render::buffers::written::DepthBuffer;
use crate::render::view::light::{Light, ONE_TABLE_DISTANCE};
use crate::render::view::line::{
    INVERSE_BITS, LEAST_INVERSE, ProjectedLine, TextureLine, fits_doubles,
};
use crate::render::walls::column::{avx2, data::IndexedColumn};
use crate::render::walls::shader::{WALL_BLOCK, WallShader, WallSlope};
use std::arch::x86_64::*;

/// For each of eight columns what [`WallShader::column`] gives.
pub(crate) struct WallColumns {
    pub distance: [i64; WALL_BLOCK],
    /// Horizontal texture position, whole texels.
    pub u: [u32; WALL_BLOCK],
    pub table: [u32; WALL_BLOCK],
    pub at: [u32; WALL_BLOCK],
    pub step: [u32; WALL_BLOCK],
}

/// The same of four, a column in each 64 bits, of which only the lower 32 count but for distances.
#[derive(Clone, Copy)]
struct FourColumns {
    distance: __m256i,
    u: __m256i,
    table: __m128i,
    at: __m256i,
    step: __m256i,
}

/// Whether a wall can be drawn so: its numbers fit the vectors, as those of all walls do but of the
/// ones that the eye nearly lies in, and its texture is 64 or 128 texels high.
#[inline]
pub(crate) fn fits(shader: &WallShader) -> bool {
    let doubles =
        [shader.line, shader.ends].iter().all(|line| fits_doubles(line.inverse, line.inverse_step));
    // A distance has 33 bits; by both factors and without two times 24 bits it must stay positive.
    let factors = [shader.view.inverse_focal_y, shader.picture.inverse_height];
    doubles
        && factors[0] < 1 << 32
        && factors[0] < (1 << 54) / factors[1]
        && matches!(shader.picture.height, 64 | 128)
}

/// [`WallShader::draw`] of a wall that [fits].
#[target_feature(enable = "avx2,fma")]
pub(crate) fn draw<D: DepthBuffer>(
    shader: &WallShader,
    frame: &mut Columns,
    first: usize,
    tops: &[i16],
    bottoms: &[i16],
) {
    let slope = shader.slope();
    let blocks = tops.chunks(WALL_BLOCK).zip(bottoms.chunks(WALL_BLOCK));
    for (first, (tops, bottoms)) in (first..).step_by(WALL_BLOCK).zip(blocks) {
        let columns = columns(
            shader,
            &slope,
            shader.view.columns[first..].first_chunk().expect("the list is padded"),
        );
        match (shader.picture.height, shader.own.room) {
            (64, 16) => draw_block::<64, 16>(shader, &columns, frame, first, tops, bottoms),
            (64, 64) => draw_block::<64, 64>(shader, &columns, frame, first, tops, bottoms),
            (64, _) => draw_block::<64, 256>(shader, &columns, frame, first, tops, bottoms),
            (_, 16) => draw_block::<128, 16>(shader, &columns, frame, first, tops, bottoms),
            (_, 64) => draw_block::<128, 64>(shader, &columns, frame, first, tops, bottoms),
            _ => draw_block::<128, 256>(shader, &columns, frame, first, tops, bottoms),
        }
        if D::WRITTEN {
            for (x, ((&top, &bottom), distance)) in
                (first..).zip(tops.iter().zip(bottoms).zip(columns.distance))
            {
                let depth = shader.depths.wall(distance, shader.picture.height);
                frame.depth_of(x)[top as usize..bottom.max(top) as usize].fill(depth);
            }
        }
    }
}

/// The colours of eight columns, or of as many as there are rows for.
#[target_feature(enable = "avx2,fma")]
fn draw_block<const TEXELS: usize, const COLOURS: usize>(
    shader: &WallShader,
    columns: &WallColumns,
    frame: &mut Columns,
    first: usize,
    tops: &[i16],
    bottoms: &[i16],
) {
    for (i, (&top, &bottom)) in tops.iter().zip(bottoms).enumerate().take(WALL_BLOCK) {
        if top < bottom {
            let start = shader.picture.column_start(columns.u[i] as i32);
            let texels = shader.own.texels[start..].first_chunk().expect("a whole column");
            let lit = shader
                .own
                .lit(columns.table[i] as usize)
                .first_chunk()
                .expect("as many as there is room for");
            let column = IndexedColumn::<TEXELS, COLOURS> {
                texels,
                lit,
                at: columns.at[i],
                step: columns.step[i],
            };
            avx2::draw(
                &column,
                frame.colour_of(first + i),
                &shader.view.rows,
                top as usize,
                bottom as usize,
            );
        }
    }
}

/// The eight base columns `columns` of a wall that [fits].
#[inline]
#[target_feature(enable = "avx2,fma")]
pub(crate) fn columns(
    shader: &WallShader,
    slope: &WallSlope,
    columns: &[u32; WALL_BLOCK],
) -> WallColumns {
    let (fours, _) = columns.as_chunks();
    let (low, high) =
        (four_columns(shader, slope, &fours[0]), four_columns(shader, slope, &fours[1]));
    let mut columns = WallColumns {
        distance: [0; WALL_BLOCK],
        u: listed(low_halves(low.u, high.u)),
        table: listed(_mm256_inserti128_si256(_mm256_castsi128_si256(low.table), high.table, 1)),
        at: listed(low_halves(low.at, high.at)),
        step: listed(low_halves(low.step, high.step)),
    };
    for (to, four) in columns.distance.as_chunks_mut::<4>().0.iter_mut().zip([low, high]) {
        // SAFETY: 32 bytes are writable behind the reference.
        unsafe { _mm256_storeu_si256(to.as_mut_ptr().cast(), four.distance) }
    }
    columns
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn four_columns(shader: &WallShader, slope: &WallSlope, columns: &[u32; 4]) -> FourColumns {
    // SAFETY: 16 bytes are readable behind the reference.
    let column = unsafe { _mm_loadu_si128(columns.as_ptr().cast()) };
    let (column, double) = (_mm256_cvtepu32_epi64(column), _mm256_cvtepi32_pd(column));
    let distance = distance_at(inverse_at(shader.line, double));
    let step = _mm256_srli_epi64(product(distance, shader.view.inverse_focal_y), 24);
    let step = _mm256_srli_epi64(product(step, shader.picture.inverse_height), 24);
    let whole = _mm256_mul_epu32(step, _mm256_set1_epi64x(slope.rows));
    let part = _mm256_srli_epi64(product(step, slope.fraction), 16);
    FourColumns {
        distance,
        u: _mm256_srli_epi64(texture_at(&shader.texture, column, distance), 16),
        table: tables(shader.light, inverse_at(shader.ends, double)),
        at: _mm256_sub_epi64(_mm256_add_epi64(_mm256_set1_epi64x(slope.start), whole), part),
        step,
    }
}

/// [`ProjectedLine::inverse_at`].
#[inline]
#[target_feature(enable = "avx2")]
fn inverse_at(line: &ProjectedLine, column: __m256d) -> __m256d {
    let change = _mm256_mul_pd(_mm256_set1_pd(line.inverse_step as f64), column);
    _mm256_max_pd(
        _mm256_add_pd(_mm256_set1_pd(line.inverse as f64), change),
        _mm256_set1_pd(LEAST_INVERSE as f64),
    )
}

/// [`ProjectedLine::distance_at`]: a quotient just below a whole number may have been rounded up to it, which the rest shows; products
/// that are not rounded before they are added (`fma`) have an exact one.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn distance_at(inverse: __m256d) -> __m256i {
    let dividend = _mm256_set1_pd((1u64 << (INVERSE_BITS + 16)) as f64);
    let quotient = _mm256_round_pd::<{ _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC }>(_mm256_div_pd(
        dividend, inverse,
    ));
    let rest = _mm256_fnmadd_pd(quotient, inverse, dividend);
    // Of a sum with the first double that has no fraction left, a whole number is the last bits.
    let no_fraction = _mm256_set1_pd((1u64 << (f64::MANTISSA_DIGITS - 1)) as f64);
    let whole =
        _mm256_castpd_si256(_mm256_xor_pd(_mm256_add_pd(quotient, no_fraction), no_fraction));
    let too_large = _mm256_castpd_si256(_mm256_cmp_pd::<_CMP_LT_OQ>(rest, _mm256_setzero_pd()));
    _mm256_add_epi64(whole, too_large)
}

/// The lower 64 bits of products with a number of 32 bits, all positive.
#[inline]
#[target_feature(enable = "avx2")]
fn product(numbers: __m256i, factor: i64) -> __m256i {
    let factor = _mm256_set1_epi64x(factor);
    let high = _mm256_mul_epu32(_mm256_srli_epi64(numbers, 32), factor);
    _mm256_add_epi64(_mm256_mul_epu32(numbers, factor), _mm256_slli_epi64(high, 32))
}

/// [`TextureLine::at`].
#[inline]
#[target_feature(enable = "avx2")]
fn texture_at(line: &TextureLine, column: __m256i, distance: __m256i) -> __m256i {
    let splat = |number: i64| _mm256_set1_epi64x(number);
    let high = _mm256_mul_epu32(splat(line.gain_step >> 32), column);
    let change = _mm256_add_epi64(
        _mm256_mul_epu32(splat(line.gain_step), column),
        _mm256_slli_epi64(high, 32),
    );
    // Factors with a sign have 32 bits: a gain has no more, a distance is taken in two parts.
    let gain = _mm256_srli_epi64(_mm256_add_epi64(splat(line.gain), change), 32);
    let high = _mm256_mul_epi32(_mm256_srli_epi64(distance, 16), gain);
    let low = _mm256_mul_epi32(_mm256_and_si256(distance, splat(0xFFFF)), gain);
    let along =
        _mm256_add_epi64(splat(line.along), _mm256_add_epi64(_mm256_slli_epi64(high, 16), low));
    // A shift to the right with the sign kept: of the number from the least one up, then back down.
    let along = _mm256_srli_epi64(_mm256_xor_si256(along, splat(i64::MIN)), 28);
    let along = _mm256_sub_epi64(along, splat(1 << (63 - 28)));
    let along =
        _mm256_blendv_epi8(along, splat(line.last), _mm256_cmpgt_epi64(along, splat(line.last)));
    let along =
        _mm256_blendv_epi8(along, splat(line.least), _mm256_cmpgt_epi64(splat(line.least), along));
    _mm256_add_epi64(along, splat(line.offset))
}

/// [`Light::table`] where distances have these inverses.
#[inline]
#[target_feature(enable = "avx2")]
fn tables(light: Light, inverse: __m256d) -> __m128i {
    // Nearness brightens no further long before, and the product is exact.
    let inverse = _mm256_min_pd(inverse, _mm256_set1_pd((1u64 << 42) as f64));
    let one_table = const { ONE_TABLE_DISTANCE as f64 / (1u64 << (INVERSE_BITS - 16)) as f64 };
    let nearness = _mm256_cvttpd_epi32(_mm256_mul_pd(inverse, _mm256_set1_pd(one_table)));
    let nearness = _mm_min_epi32(nearness, _mm_set1_epi32(light.most as i32));
    let table = _mm_srai_epi32(_mm_sub_epi32(_mm_set1_epi32(light.base as i32), nearness), 16);
    _mm_max_epi32(_mm_min_epi32(table, _mm_set1_epi32(31)), _mm_setzero_si128())
}

/// The lower halves of eight numbers, in order.
#[inline]
#[target_feature(enable = "avx2")]
fn low_halves(low: __m256i, high: __m256i) -> __m256i {
    let halves =
        _mm256_shuffle_ps(_mm256_castsi256_ps(low), _mm256_castsi256_ps(high), 0b10_00_10_00);
    _mm256_permute4x64_epi64(_mm256_castps_si256(halves), 0b11_01_10_00)
}

#[inline]
#[target_feature(enable = "avx2")]
fn listed(vector: __m256i) -> [u32; WALL_BLOCK] {
    let mut list = [0; WALL_BLOCK];
    // SAFETY: 32 bytes are writable behind the reference.
    unsafe { _mm256_storeu_si256(list.as_mut_ptr().cast(), vector) }
    list
}
