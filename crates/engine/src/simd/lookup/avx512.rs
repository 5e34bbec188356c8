//! Tables of 256 bytes in four registers, looked up 64 bytes at once (AVX-512 VBMI: Ice Lake and
//! Zen 4 onward).

use std::arch::x86_64::{
    __m512i, _mm512_loadu_si512, _mm512_mask_blend_epi8, _mm512_movepi8_mask,
    _mm512_permutex2var_epi8, _mm512_storeu_si512,
};

#[inline]
#[target_feature(enable = "avx512f")]
pub(crate) fn load(bytes: &[u8; LANES]) -> __m512i {
    // SAFETY: 64 bytes are readable behind a reference to 64 bytes; the load needs no alignment.
    unsafe { _mm512_loadu_si512(bytes.as_ptr().cast()) }
}

#[inline]
#[target_feature(enable = "avx512f")]
pub(crate) fn store(bytes: &mut [u8; LANES], vector: __m512i) {
    // SAFETY: 64 bytes are writable behind a reference to 64 bytes; the store needs no alignment.
    unsafe { _mm512_storeu_si512(bytes.as_mut_ptr().cast(), vector) }
}

/// A table of 256 bytes in registers.
#[inline]
#[target_feature(enable = "avx512f")]
pub(crate) fn load_table(table: &[u8; 256]) -> [__m512i; 4] {
    let (blocks, _) = table.as_chunks::<LANES>();
    [load(&blocks[0]), load(&blocks[1]), load(&blocks[2]), load(&blocks[3])]
}

#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512vbmi")]
pub(crate) fn look_up_block(table: [__m512i; 4], indices: __m512i) -> __m512i {
    // Each permutation looks at the lower 7 bits and covers one half of the table; the highest bit
    // chooses between them.
    let low = _mm512_permutex2var_epi8(table[0], indices, table[1]);
    let high = _mm512_permutex2var_epi8(table[2], indices, table[3]);
    _mm512_mask_blend_epi8(_mm512_movepi8_mask(indices), low, high)
}

/// Bytes that are looked up at once.
pub(crate) const LANES: usize = 64;
