//! Weights as codes of four or eight bits.
//!
//! Weights are cut into blocks of `BLOCK` that share a scale; a block's codes are whole numbers
//! from `-m` to `m`, and a weight is its code times `scale / m`. Of four bits, a byte has two.

/// Weights that share a scale.
const BLOCK: usize = 64;

fn largest_code(bits: u32) -> f32 {
    (1i32 << (bits - 1)).wrapping_sub(1) as f32
}

/// Codes and scales of some weights.
pub(super) fn round(weights: &[f32], bits: u32) -> (Vec<u8>, Vec<f32>) {
    let most = largest_code(bits);
    let mut scales = Vec::with_capacity(weights.len().div_ceil(BLOCK));
    let mut codes: Vec<i8> = Vec::with_capacity(weights.len());
    for block in weights.chunks(BLOCK) {
        let scale = block.iter().fold(0.0f32, |largest, weight| largest.max(weight.abs()));
        let unit = if scale > 0.0 { most / scale } else { 0.0 };
        codes.extend(block.iter().map(|weight| (weight * unit).round().clamp(-most, most) as i8));
        scales.push(scale);
    }
    let bytes = match bits {
        8 => codes.iter().map(|code| code.cast_unsigned()).collect(),
        _ => codes
            .chunks(2)
            .map(|two| nibble(two[0]) | nibble(two.get(1).copied().unwrap_or(0)) << 4)
            .collect(),
    };
    (bytes, scales)
}

fn nibble(code: i8) -> u8 {
    (code + 8).cast_unsigned() & 15
}

/// Bits of the codes of so many weights; `None` if codes and scales are not those of so many.
pub(super) fn bits_of(bytes: &[u8], scales: &[f32], count: usize) -> Option<u32> {
    let bits = [(8, count), (4, count.div_ceil(2))]
        .into_iter()
        .find(|&(_, length)| bytes.len() == length)?
        .0;
    (scales.len() == count.div_ceil(BLOCK)).then_some(bits)
}

/// The weights that codes and scales stand for; `None` if they do not belong together.
pub(super) fn unround(bytes: &[u8], scales: &[f32], count: usize) -> Option<Vec<f32>> {
    let bits = bits_of(bytes, scales, count)?;
    let codes: Vec<i8> = match bits {
        8 => bytes.iter().map(|byte| byte.cast_signed()).collect(),
        _ => {
            let two = |byte: &u8| [(byte & 15).cast_signed() - 8, (byte >> 4).cast_signed() - 8];
            bytes.iter().flat_map(two).take(count).collect()
        }
    };
    let blocks = codes.chunks(BLOCK).zip(scales);
    Some(
        blocks
            .flat_map(|(block, scale)| {
                block.iter().map(move |&code| f32::from(code) * scale / largest_code(bits))
            })
            .collect(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_come_back_to_within_half_a_code() {
        let weights: Vec<f32> = (0..1001)
            .map(|k| ((k * 7919 % 1000) as f32 / 500.0 - 1.0) * (1 + k / 64) as f32)
            .collect();
        for bits in [8, 4] {
            let (codes, scales) = round(&weights, bits);
            assert_eq!(codes.len(), if bits == 8 { 1001 } else { 501 });
            let back = unround(&codes, &scales, weights.len()).unwrap();
            for (index, (weight, other)) in weights.iter().zip(&back).enumerate() {
                let step = scales[index / BLOCK] / largest_code(bits);
                assert!(
                    (weight - other).abs() <= step * 0.5001,
                    "{bits} bits: {weight} became {other}"
                );
            }
            assert!(unround(&codes[1..], &scales, weights.len()).is_none());
            assert!(unround(&codes, &scales[1..], weights.len()).is_none());
        }
        let (codes, scales) = round(&[0.0; 10], 4);
        assert_eq!(unround(&codes, &scales, 10), Some(vec![0.0; 10]));
    }
}
