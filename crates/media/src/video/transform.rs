//! The 4 x 4 integer transform and its quantisation (clauses 8.5.6 to 8.5.12).

/// Coefficients or residuals of a 4 x 4 block, row after row.
pub(super) type Block = [i32; 16];

/// Multipliers of the forward quantiser by quantiser modulo 6, for coefficients at even-even, odd-odd and other places:
/// 2^15 over the step size and the transform's gain.
const FORWARD: [[i32; 3]; 6] =
    [[13107, 5243, 8066], [11916, 4660, 7490], [10082, 4194, 6554], [9362, 3647, 5825], [8192, 3355, 5243], [7282, 2893, 4559]];
/// Multipliers of the inverse quantiser (clause 8.5.9).
const INVERSE: [[i32; 3]; 6] = [[10, 16, 13], [11, 18, 14], [13, 20, 16], [14, 23, 18], [16, 25, 20], [18, 29, 23]];
/// Levels are kept in what an ordinary escape code holds.
const MAX_LEVEL: i32 = 2000;

fn class(at: usize) -> usize {
    match (at / 4 % 2, at % 2) {
        (0, 0) => 0,
        (1, 1) => 1,
        _ => 2,
    }
}

/// A quantiser: step size doubles every six.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quantiser {
    value: u8,
    /// How much of a step rounds up: a third for intra, a sixth for inter blocks, whose residuals are mostly noise.
    rounding_divisor: i32,
}

impl Quantiser {
    pub fn new(value: u8, intra: bool) -> Quantiser {
        Quantiser { value, rounding_divisor: if intra { 3 } else { 6 } }
    }

    fn shift(self) -> u32 {
        u32::from(self.value / 6)
    }

    fn row(self) -> usize {
        usize::from(self.value % 6)
    }

    fn level(self, coefficient: i32, multiplier: i32, extra_shift: u32) -> i32 {
        let shift = 15 + self.shift() + extra_shift;
        let rounding = (1i64 << shift) / i64::from(self.rounding_divisor);
        let level = ((i64::from(coefficient.abs()) * i64::from(multiplier) + rounding) >> shift) as i32;
        level.min(MAX_LEVEL) * coefficient.signum()
    }

    /// Levels of transformed coefficients.
    pub fn quantise(self, block: &Block) -> Block {
        std::array::from_fn(|at| self.level(block[at], FORWARD[self.row()][class(at)], 0))
    }

    /// Coefficients of levels, scaled as [`inverse`] wants them.
    pub fn scale(self, levels: &Block) -> Block {
        std::array::from_fn(|at| (levels[at] * INVERSE[self.row()][class(at)]) << self.shift())
    }

    /// Levels of the 4 x 4 first coefficients of a macroblock's blocks.
    pub fn quantise_luma_dc(self, dc: &Block) -> Block {
        hadamard4(dc).map(|sum| self.level((sum + sum.signum()) / 2, FORWARD[self.row()][0], 1))
    }

    /// First coefficients from their levels (clause 8.5.10).
    pub fn scale_luma_dc(self, levels: &Block) -> Block {
        let scale = 16 * INVERSE[self.row()][0];
        hadamard4(levels).map(|sum| match self.shift() {
            shift if shift >= 6 => (sum * scale) << (shift - 6),
            shift => (sum * scale + (1 << (5 - shift))) >> (6 - shift),
        })
    }

    /// Levels of the four first coefficients of a colour-difference block of 8 x 8.
    pub fn quantise_chroma_dc(self, dc: &[i32; 4]) -> [i32; 4] {
        hadamard2(dc).map(|sum| self.level(sum, FORWARD[self.row()][0], 1))
    }

    /// First coefficients from their levels (clause 8.5.11.2).
    pub fn scale_chroma_dc(self, levels: &[i32; 4]) -> [i32; 4] {
        hadamard2(levels).map(|sum| ((sum * 16 * INVERSE[self.row()][0]) << self.shift()) >> 5)
    }
}

/// The quantiser of colour differences that goes with one of luminance (table 8-15).
pub(super) fn chroma_quantiser(luma: u8) -> u8 {
    const FROM_30: [u8; 22] = [29, 30, 31, 32, 32, 33, 34, 34, 35, 35, 36, 36, 37, 37, 37, 38, 38, 38, 39, 39, 39, 39];
    if luma < 30 { luma } else { FROM_30[usize::from(luma.min(51)) - 30] }
}

/// The forward transform of residuals.
pub(super) fn forward(residuals: &Block) -> Block {
    let pass = |[a, b, c, d]: [i32; 4]| {
        let (s0, s1, d0, d1) = (a + d, b + c, a - d, b - c);
        [s0 + s1, 2 * d0 + d1, s0 - s1, d0 - 2 * d1]
    };
    both_ways(residuals, pass)
}

/// Residuals from scaled coefficients (clause 8.5.12.2), rounded.
pub(super) fn inverse(coefficients: &Block) -> Block {
    let pass = |[a, b, c, d]: [i32; 4]| {
        let (e0, e1, e2, e3) = (a + c, a - c, (b >> 1) - d, b + (d >> 1));
        [e0 + e3, e1 + e2, e1 - e2, e0 - e3]
    };
    both_ways(coefficients, pass).map(|value| (value + 32) >> 6)
}

fn hadamard4(block: &Block) -> Block {
    let pass = |[a, b, c, d]: [i32; 4]| [a + b + c + d, a + b - c - d, a - b - c + d, a - b + c - d];
    both_ways(block, pass)
}

fn hadamard2([a, b, c, d]: &[i32; 4]) -> [i32; 4] {
    [a + b + c + d, a - b + c - d, a + b - c - d, a - b - c + d]
}

/// Applies a transform of four values to every row, then to every column.
fn both_ways(block: &Block, pass: impl Fn([i32; 4]) -> [i32; 4]) -> Block {
    let mut result = *block;
    for row in 0..4 {
        let values = pass(std::array::from_fn(|k| result[4 * row + k]));
        result[4 * row..4 * row + 4].copy_from_slice(&values);
    }
    for column in 0..4 {
        let values = pass(std::array::from_fn(|k| result[4 * k + column]));
        for (k, value) in values.into_iter().enumerate() {
            result[4 * k + column] = value;
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Residuals of all sizes, from a small fixed stream.
    fn blocks() -> impl Iterator<Item = Block> {
        let mut state = 1u64;
        (0..200).map(move |k| {
            std::array::from_fn(|_| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                ((state >> 40) % 511) as i32 * (1 + k % 4) / 4 - 255 * (1 + k % 4) / 4
            })
        })
    }

    #[test]
    fn what_is_quantised_comes_back_within_a_step() {
        for value in [0u8, 4, 12, 22, 28, 35] {
            let quantiser = Quantiser::new(value, true);
            let step = 0.625 * 2f64.powf(f64::from(value) / 6.0);
            for block in blocks() {
                let back = inverse(&quantiser.scale(&quantiser.quantise(&forward(&block))));
                for (a, b) in block.iter().zip(back) {
                    assert!(f64::from((a - b).abs()) <= 2.0 + 2.5 * step, "quantiser {value}: {a} {b}");
                }
            }
        }
    }

    #[test]
    fn first_coefficients_come_back_within_a_step() {
        for value in [10u8, 22, 37] {
            let quantiser = Quantiser::new(value, true);
            for block in blocks() {
                // First coefficients of 16 flat blocks of the given residuals, through their own transform.
                let dc = block.map(|residual| residual * 16);
                let scaled = quantiser.scale_luma_dc(&quantiser.quantise_luma_dc(&dc));
                let step = 0.625 * 2f64.powf(f64::from(value) / 6.0);
                for (a, b) in block.iter().zip(scaled) {
                    assert!((f64::from(*a) - f64::from(b) / 64.0).abs() <= 1.0 + step * 1.5, "quantiser {value}: {a} {}", b / 64);
                }
                let four = [dc[0], dc[1], dc[2], dc[3]];
                let scaled = quantiser.scale_chroma_dc(&quantiser.quantise_chroma_dc(&four));
                for (a, b) in block.iter().zip(scaled) {
                    assert!((f64::from(*a) - f64::from(b) / 64.0).abs() <= 1.0 + step * 1.5, "quantiser {value}: {a} {}", b / 64);
                }
            }
        }
    }
}
