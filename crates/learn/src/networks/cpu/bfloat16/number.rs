//! Numbers of 16 bits, and pairs of them.

/// Two numbers of 16 bits, the first one in the lower half.
pub type Pair = u32;

/// The bits of a number rounded to its upper 16; those below are to be cut off.
#[inline(always)]
pub fn rounded(value: f32) -> u32 {
    let bits = value.to_bits();
    // What is no number stays none, though its upper bits alone might say otherwise.
    if value.is_nan() { bits | 0x0040_0000 } else { bits.wrapping_add(0x7FFF + ((bits >> 16) & 1)) }
}

#[inline(always)]
pub fn pair(first: f32, second: f32) -> Pair {
    (rounded(first) >> 16) | (rounded(second) & 0xFFFF_0000)
}

#[inline(always)]
pub fn normalised(pixel: u8, scale: f32, shift: f32) -> f32 {
    (f32::from(pixel) * scale + shift).clamp(-5.0, 5.0)
}
