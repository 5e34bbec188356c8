//! Tables as large as pictures have colours or columns texels, looked up in registers of 32 bytes.
//! The plain twins are where they are used: in `column` and `masked_column`, where tests compare
//! them.

use std::arch::x86_64::*;

/// Rows that are drawn at once.
pub(crate) const GROUP: usize = 32;

/// What a table has for 32 numbers, all of which it has something for.
#[inline]
#[target_feature(enable = "avx2")]
pub(crate) fn look_up<const SIZE: usize>(table: &[u8; SIZE], numbers: __m256i) -> __m256i {
    const { assert!(SIZE == 16 || SIZE == 64 || SIZE == 128 || SIZE == 256) }
    let (parts, _) = table.as_chunks::<16>();
    match SIZE {
        16 => sixteen(&parts[0], numbers),
        64 => sixty_four(&parts[..4], numbers),
        128 => half_table(&parts[..8], numbers),
        _ => {
            // What has the highest bit set would be looked up as nothing.
            let within = _mm256_and_si256(numbers, _mm256_set1_epi8(127));
            _mm256_blendv_epi8(
                half_table(&parts[..8], within),
                half_table(&parts[8..], within),
                numbers,
            )
        }
    }
}

#[inline]
#[target_feature(enable = "avx2")]
fn half_table(parts: &[[u8; 16]], numbers: __m256i) -> __m256i {
    let (low, high) = (sixty_four(&parts[..4], numbers), sixty_four(&parts[4..], numbers));
    // The highest bit of each byte chooses: here the seventh, below the sixth and the fifth.
    _mm256_blendv_epi8(low, high, _mm256_slli_epi16(numbers, 1))
}

#[inline]
#[target_feature(enable = "avx2")]
fn sixty_four(parts: &[[u8; 16]], numbers: __m256i) -> __m256i {
    let fifth = _mm256_slli_epi16(numbers, 3);
    let low = _mm256_blendv_epi8(sixteen(&parts[0], numbers), sixteen(&parts[1], numbers), fifth);
    let high = _mm256_blendv_epi8(sixteen(&parts[2], numbers), sixteen(&parts[3], numbers), fifth);
    _mm256_blendv_epi8(low, high, _mm256_slli_epi16(numbers, 2))
}

#[inline]
#[target_feature(enable = "avx2")]
fn sixteen(part: &[u8; 16], numbers: __m256i) -> __m256i {
    // SAFETY: 16 bytes are readable behind the reference.
    let part = unsafe { _mm_loadu_si128(part.as_ptr().cast()) };
    _mm256_shuffle_epi8(_mm256_broadcastsi128_si256(part), numbers)
}

/// The numbers of 32 rows, eight in each vector, as bytes.
#[inline]
#[target_feature(enable = "avx2")]
pub(crate) fn bytes_of([first, second, third, fourth]: [__m256i; 4]) -> __m256i {
    let (low, high) = (_mm256_packs_epi32(first, second), _mm256_packs_epi32(third, fourth));
    // Fours of rows now lie 0, 2, 4, 6, 1, 3, 5, 7.
    _mm256_permutevar8x32_epi32(
        _mm256_packus_epi16(low, high),
        _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7),
    )
}

/// The first `count` of 32 bytes, of all if there are more.
#[inline]
#[target_feature(enable = "avx2")]
pub(crate) fn first_bytes(count: usize) -> __m256i {
    static BYTES: [u8; 2 * GROUP] = {
        let mut bytes = [0; 2 * GROUP];
        let mut i = 0;
        while i < GROUP {
            bytes[i] = u8::MAX;
            i += 1;
        }
        bytes
    };
    let bytes: &[u8; GROUP] =
        BYTES[GROUP - count.min(GROUP)..].first_chunk().expect("there are as many again");
    // SAFETY: 32 bytes are readable behind the reference.
    unsafe { _mm256_loadu_si256(bytes.as_ptr().cast()) }
}
