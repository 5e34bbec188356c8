//! Patches up to 256 texels wide, 64 columns at a time: a row of texels is one to four vectors,
//! from which the columns pick.

use crate::render::buffers::frame::Frame;
use crate::render::buffers::written::{ClassBuffer, DepthBuffer};
use crate::render::colour::blend::Mixture;
use crate::render::patch::data::{DrawnBounds, PATCH_BLOCK, Patch};
use crate::render::textures::sprite::TEXEL_BLOCK;
use crate::simd::lookup::avx512::{load, load_table, look_up_block, store};
use std::arch::x86_64::*;
use std::ops::Range;

/// Widest padded row of texels: as many as a byte distinguishes.
pub(crate) const MOST_TEXELS: usize = 256;

/// Draws some rows of a stamp; `base_rows` are the base rows of the frame's.
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi")]
pub(crate) fn draw<D: DepthBuffer, C: ClassBuffer>(
    stamp: &Patch,
    frame: &mut Frame,
    base_rows: &[u32],
    rows: Range<usize>,
) -> DrawnBounds {
    let (count, table, mut covered) =
        (stamp.columns.count(), load_table(stamp.table), DrawnBounds::NOTHING);
    for from in (0..count).step_by(PATCH_BLOCK) {
        let picked = packed(&stamp.columns.texels[from..]);
        let [tops, bottoms] =
            [two_vectors(&stamp.columns.tops[from..]), two_vectors(&stamp.columns.bottoms[from..])];
        let inside = u64::MAX >> PATCH_BLOCK.saturating_sub(count - from);
        for row in rows.clone() {
            let (texels, opaque) = stamp.picture.row(stamp.texel_row(base_rows[row]));
            let (texels, _) = texels.as_chunks::<TEXEL_BLOCK>();
            let here = _mm512_set1_epi16(row as i16);
            let low = _mm512_mask_cmpgt_epi16_mask(
                _mm512_cmple_epi16_mask(tops[0], here),
                bottoms[0],
                here,
            );
            let high = _mm512_mask_cmpgt_epi16_mask(
                _mm512_cmple_epi16_mask(tops[1], here),
                bottoms[1],
                here,
            );
            let open = u64::from(low) | u64::from(high) << 32;
            let mask = pick_bits(opaque, picked) & open & inside;
            let lit = look_up_block(table, pick(texels, picked));
            let first = stamp.first + from;
            let at = row * frame.width + first;
            let end = at + (64 - mask.leading_zeros() as usize);
            let pixels = &mut frame.colour[at..end];
            match stamp.mixture {
                None => {
                    // SAFETY: what the mask selects lies before `end`.
                    unsafe { _mm512_mask_storeu_epi8(pixels.as_mut_ptr().cast(), mask, lit) }
                }
                Some(mixture) => shine_through(mixture, pixels, mask, lit),
            }
            if D::WRITTEN {
                let depth = _mm512_set1_epi8(stamp.depth as i8);
                // SAFETY: as above.
                unsafe {
                    _mm512_mask_storeu_epi8(frame.depth[at..end].as_mut_ptr().cast(), mask, depth)
                }
            }
            if C::WRITTEN && mask != 0 {
                let class = _mm512_set1_epi16(stamp.class as i16);
                let pixels: *mut i16 = frame.class[at..end].as_mut_ptr().cast();
                // SAFETY: as above; the second half lies in the buffer where it has a pixel at all.
                unsafe {
                    _mm512_mask_storeu_epi16(pixels, mask as u32, class);
                    _mm512_mask_storeu_epi16(pixels.wrapping_add(32), (mask >> 32) as u32, class);
                }
                covered
                    .add(first + mask.trailing_zeros() as usize..first + (end - at), row..row + 1);
            }
        }
    }
    covered
}

/// The first 64 numbers of a list.
#[inline]
#[target_feature(enable = "avx512f")]
fn two_vectors<T>(list: &[T]) -> [__m512i; 2] {
    const { assert!(size_of::<T>() == 2) }
    let list: &[T; PATCH_BLOCK] = list.first_chunk().expect("lists are padded");
    // SAFETY: 128 bytes are readable behind the reference.
    unsafe {
        [_mm512_loadu_si512(list.as_ptr().cast()), _mm512_loadu_si512(list.as_ptr().add(32).cast())]
    }
}

/// The lower bytes of the first 64 numbers of a list.
#[inline]
#[target_feature(enable = "avx512f,avx512bw")]
fn packed(list: &[u16]) -> __m512i {
    let [low, high] = two_vectors(list);
    _mm512_inserti64x4(
        _mm512_castsi256_si512(_mm512_cvtepi16_epi8(low)),
        _mm512_cvtepi16_epi8(high),
        1,
    )
}

/// The texels of 64 columns of a row of up to four blocks.
#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512vbmi")]
fn pick(row: &[[u8; TEXEL_BLOCK]], columns: __m512i) -> __m512i {
    match row {
        [one] => _mm512_permutexvar_epi8(columns, load(one)),
        [one, two] => _mm512_permutex2var_epi8(load(one), columns, load(two)),
        [one, two, three, rest @ ..] => {
            let low = _mm512_permutex2var_epi8(load(one), columns, load(two));
            let high =
                _mm512_permutex2var_epi8(load(three), columns, load(rest.first().unwrap_or(three)));
            _mm512_mask_blend_epi8(_mm512_movepi8_mask(columns), low, high)
        }
        [] => columns,
    }
}

/// The same of bits.
#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512vbmi")]
fn pick_bits(row: &[u64], columns: __m512i) -> u64 {
    let picked = match row {
        [one] => _mm512_permutexvar_epi8(columns, _mm512_movm_epi8(*one)),
        [one, two] => {
            _mm512_permutex2var_epi8(_mm512_movm_epi8(*one), columns, _mm512_movm_epi8(*two))
        }
        [one, two, three, rest @ ..] => {
            let low =
                _mm512_permutex2var_epi8(_mm512_movm_epi8(*one), columns, _mm512_movm_epi8(*two));
            let last = _mm512_movm_epi8(*rest.first().unwrap_or(three));
            let high = _mm512_permutex2var_epi8(_mm512_movm_epi8(*three), columns, last);
            _mm512_mask_blend_epi8(_mm512_movepi8_mask(columns), low, high)
        }
        [] => columns,
    };
    _mm512_movepi8_mask(picked)
}

/// Mixes the pixels of a mask with what is there, sixteen at a time as [`Mixture::over`] one.
#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512vl")]
fn shine_through(mixture: &Mixture, pixels: &mut [u8], mask: u64, lit: __m512i) {
    const LANES: usize = 16;
    let mut colours = [0; PATCH_BLOCK];
    store(&mut colours, lit);
    let colours = colours.as_chunks::<LANES>().0;
    for (part, colours) in colours.iter().enumerate() {
        let mask = (mask >> (part * LANES)) as __mmask16;
        if mask == 0 {
            continue;
        }
        let at = pixels[part * LANES..].as_mut_ptr();
        // SAFETY: what the mask selects lies in the slice; pairs of bytes have entries in a list
        // that is padded.
        unsafe {
            let lower = _mm512_cvtepu8_epi32(_mm_maskz_loadu_epi8(mask, at.cast()));
            let upper = _mm512_cvtepu8_epi32(_mm_loadu_si128(colours.as_ptr().cast()));
            let pair = _mm512_or_si512(_mm512_slli_epi32::<8>(upper), lower);
            let zero = _mm512_setzero_si512();
            let mixed = _mm512_mask_i32gather_epi32::<1>(
                zero,
                mask,
                pair,
                mixture.entries().as_ptr().cast(),
            );
            _mm_mask_storeu_epi8(at.cast(), mask, _mm512_cvtepi32_epi8(mixed));
        }
    }
}
