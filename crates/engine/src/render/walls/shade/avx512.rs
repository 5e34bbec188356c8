//! What eight columns of a wall show, side by side, with vectors of 64 bytes.

use crate::render::buffers::frame::Columns;
use crate::render::buffers::written::DepthBuffer;
use crate::render::view::light::ONE_TABLE_DISTANCE;
use crate::render::view::light_avx512::tables;
use crate::render::view::line::{INVERSE_BITS, LEAST_INVERSE, ProjectedLine, TextureLine};
use crate::render::walls::shade::scalar;
use crate::render::walls::shader::{WALL_BLOCK, WallColumn, WallShader, WallSlope};
use crate::simd::Simd;
use std::arch::x86_64::*;

/// For each of eight columns what [`WallShader::column`] gives.
#[derive(Clone, Copy)]
pub(crate) struct WallVectors {
    pub distance: __m512i,
    /// Horizontal texture position.
    pub u: __m512i,
    pub table: __m512i,
    pub at: __m512i,
    pub step: __m512i,
}

/// The eight base columns `columns`.
#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi")]
pub(crate) fn vectors(
    shader: &WallShader,
    slope: &WallSlope,
    columns: &[u32; WALL_BLOCK],
) -> WallVectors {
    // SAFETY: 32 bytes are readable behind the reference.
    let column = _mm512_cvtepu32_epi64(unsafe { _mm256_loadu_si256(columns.as_ptr().cast()) });
    let distance = quotients(inverse_at(shader.line, column));
    let nearness =
        _mm512_mullo_epi64(inverse_at(shader.ends, column), _mm512_set1_epi64(ONE_TABLE_DISTANCE));
    let nearness = _mm512_srai_epi64(nearness, INVERSE_BITS - 16);
    let step = _mm512_srai_epi64(
        _mm512_mullo_epi64(distance, _mm512_set1_epi64(shader.view.inverse_focal_y)),
        24,
    );
    let step = _mm512_srai_epi64(
        _mm512_mullo_epi64(step, _mm512_set1_epi64(shader.picture.inverse_height)),
        24,
    );
    let whole = _mm512_mullo_epi64(step, _mm512_set1_epi64(slope.rows));
    let part = _mm512_srai_epi64(_mm512_mullo_epi64(step, _mm512_set1_epi64(slope.fraction)), 16);
    WallVectors {
        distance,
        u: texture_at(&shader.texture, column, distance),
        table: tables(shader.light, nearness),
        at: _mm512_sub_epi64(_mm512_add_epi64(_mm512_set1_epi64(slope.start), whole), part),
        step,
    }
}

/// The same as lists.
pub(crate) struct WallColumns {
    pub distance: [i64; WALL_BLOCK],
    pub u: [i64; WALL_BLOCK],
    pub table: [i64; WALL_BLOCK],
    pub at: [i64; WALL_BLOCK],
    pub step: [i64; WALL_BLOCK],
}

/// The same as lists.
#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi")]
pub(crate) fn columns(
    shader: &WallShader,
    slope: &WallSlope,
    columns: &[u32; WALL_BLOCK],
) -> WallColumns {
    let WallVectors { distance, u, table, at, step } = vectors(shader, slope, columns);
    WallColumns {
        distance: listed(distance),
        u: listed(u),
        table: listed(table),
        at: listed(at),
        step: listed(step),
    }
}

/// [`ProjectedLine::inverse_at`].
#[inline]
#[target_feature(enable = "avx512f,avx512dq")]
fn inverse_at(line: &ProjectedLine, column: __m512i) -> __m512i {
    let change = _mm512_mullo_epi64(_mm512_set1_epi64(line.inverse_step), column);
    let inverse = _mm512_add_epi64(_mm512_set1_epi64(line.inverse), change);
    _mm512_max_epi64(inverse, _mm512_set1_epi64(LEAST_INVERSE))
}

/// [`ProjectedLine::distance_at`]: `2^60` divided by each divisor, rounded down. The quotient of floating-point numbers is at
/// most one off, as divisors are at least `2^27`; the rest shows.
#[inline]
#[target_feature(enable = "avx512f,avx512dq")]
fn quotients(divisor: __m512i) -> __m512i {
    const DIVIDEND: i64 = 1 << (INVERSE_BITS + 16);
    let (dividend, one) = (_mm512_set1_epi64(DIVIDEND), _mm512_set1_epi64(1));
    let estimate = _mm512_div_pd(_mm512_cvtepi64_pd(dividend), _mm512_cvtepi64_pd(divisor));
    let quotient = _mm512_cvttpd_epi64(estimate);
    let rest = _mm512_sub_epi64(dividend, _mm512_mullo_epi64(quotient, divisor));
    let too_large = _mm512_movepi64_mask(rest);
    let too_small = _mm512_cmpge_epi64_mask(rest, divisor);
    let quotient = _mm512_mask_sub_epi64(quotient, too_large, quotient, one);
    _mm512_mask_add_epi64(quotient, too_small, quotient, one)
}

/// [`TextureLine::at`].
#[inline]
#[target_feature(enable = "avx512f,avx512dq")]
fn texture_at(line: &TextureLine, column: __m512i, distance: __m512i) -> __m512i {
    let change = _mm512_mullo_epi64(_mm512_set1_epi64(line.gain_step), column);
    let gain = _mm512_srai_epi64(_mm512_add_epi64(_mm512_set1_epi64(line.gain), change), 32);
    let gained = _mm512_mullo_epi64(distance, gain);
    let along = _mm512_srai_epi64(_mm512_add_epi64(_mm512_set1_epi64(line.along), gained), 28);
    let along = _mm512_max_epi64(
        _mm512_min_epi64(along, _mm512_set1_epi64(line.last)),
        _mm512_set1_epi64(line.least),
    );
    _mm512_add_epi64(along, _mm512_set1_epi64(line.offset))
}

#[inline]
#[target_feature(enable = "avx512f")]
fn listed(vector: __m512i) -> [i64; WALL_BLOCK] {
    let mut list = [0; WALL_BLOCK];
    // SAFETY: 64 bytes are writable behind the reference.
    unsafe { _mm512_storeu_si512(list.as_mut_ptr().cast(), vector) }
    list
}

impl WallColumns {
    /// What one of them shows.
    #[inline(always)]
    pub fn column(&self, i: usize) -> WallColumn {
        WallColumn {
            distance: self.distance[i],
            u: self.u[i],
            table: self.table[i] as usize,
            at: self.at[i] as u32,
            step: self.step[i] as u32,
        }
    }
}

/// Draws rows `tops[i]..bottoms[i]` of the frame columns from `first` on: what eight columns show
/// is worked out at once. The whole loop is compiled for these instructions, as what is done for a
/// column is short: calls into functions for others would be much of it.
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi")]
pub(crate) fn draw<D: DepthBuffer>(
    shader: &WallShader,
    simd: Simd,
    frame: &mut Columns,
    first: usize,
    tops: &[i16],
    bottoms: &[i16],
) {
    let slope = shader.slope();
    for from in (0..tops.len()).step_by(WALL_BLOCK) {
        let block = columns(
            shader,
            &slope,
            shader.view.columns[first + from..].first_chunk().expect("the list is padded"),
        );
        for i in from..(from + WALL_BLOCK).min(tops.len()) {
            if tops[i] < bottoms[i] {
                let rows = [tops[i] as usize, bottoms[i] as usize];
                scalar::draw_column::<D>(
                    shader,
                    simd,
                    frame,
                    first + i,
                    rows,
                    block.column(i - from),
                );
            }
        }
    }
}
