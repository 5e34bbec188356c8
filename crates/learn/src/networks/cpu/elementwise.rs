//! Element-wise passes: activations and their gradients, pixel scaling, sums of columns, Adam.
//!
//! Exponentials are a polynomial of relative error below 2e-7, because the system's are neither
//! vectorised nor equal on all machines.

use hasard_engine::simd::Simd;

use crate::networks::cpu::vectorised::vectorised;

/// e^x for x in about -87..88, clamped outside.
#[inline(always)]
pub fn exponential(x: f32) -> f32 {
    // 1.5 * 2^23: adding it rounds to the nearest whole number, which then stands in the low bits.
    const ROUND: f32 = 12_582_912.0;
    let x = x.clamp(-87.0, 88.0);
    let shifted = x * std::f32::consts::LOG2_E + ROUND;
    let whole = shifted - ROUND;
    // ln 2 in two parts, the first exact in few bits, so that the remainder loses nothing.
    let rest = (x - whole * 0.693_359_4) + whole * 2.121_944_4e-4;
    let mut sum = 1.987_569_2e-4;
    sum = sum * rest + 1.398_199_9e-3;
    sum = sum * rest + 8.333_452e-3;
    sum = sum * rest + 4.166_579_6e-2;
    sum = sum * rest + 1.666_666_6e-1;
    sum = sum * rest + 5e-1;
    let value = sum * rest * rest + rest + 1.0;
    let exponent = shifted.to_bits().wrapping_sub(ROUND.to_bits());
    f32::from_bits(value.to_bits().wrapping_add(exponent << 23))
}

#[inline(always)]
pub(super) fn sigmoid(x: f32) -> f32 {
    1.0 / (1.0 + exponential(-x))
}

#[inline(always)]
pub(super) fn tanh(x: f32) -> f32 {
    2.0 / (1.0 + exponential(-2.0 * x)) - 1.0
}

#[inline(always)]
fn elu(x: f32) -> f32 {
    if x > 0.0 { x } else { exponential(x) - 1.0 }
}

/// The derivative of an ELU from its output.
#[inline(always)]
fn elu_slope(y: f32) -> f32 {
    if y > 0.0 { 1.0 } else { y + 1.0 }
}

/// Place of a pixel that the next layer does not read.
pub const NOWHERE: usize = usize::MAX;

vectorised! {
    /// Adds biases to `raw` pixels (`sources[p]` says where pixel `p` is) and writes their ELU to
    /// `places[p]`.
    pub fn bias_elu_scatter(raw: &[f32], sources: &[usize], bias: &[f32], places: &[usize], out: &mut [f32]) {
        let channels = bias.len();
        for (&source, &place) in sources.iter().zip(places) {
            if place == NOWHERE {
                continue;
            }
            let from = &raw[source..source + channels];
            let to = &mut out[place..place + channels];
            for channel in 0..channels {
                to[channel] = elu(from[channel] + bias[channel]);
            }
        }
    }
}

vectorised! {
    /// Gradient before the ELU: `gradient` times the slope at `output`, both laid out by `places`,
    /// gathered to `targets`.
    pub fn elu_backward_gather(
        gradient: &[f32], output: &[f32], places: &[usize], channels: usize, targets: &[usize], raw: &mut [f32],
    ) {
        for (&place, &target) in places.iter().zip(targets) {
            let to = &mut raw[target..target + channels];
            if place == NOWHERE {
                to.fill(0.0);
                continue;
            }
            let (slope, from) = (&output[place..place + channels], &gradient[place..place + channels]);
            for channel in 0..channels {
                to[channel] = from[channel] * elu_slope(slope[channel]);
            }
        }
    }
}

vectorised! {
    /// Adds biases to rows and applies the ELU in place; rows are `stride` apart.
    pub fn bias_elu_rows(rows: &mut [f32], stride: usize, bias: &[f32]) {
        for row in rows.chunks_mut(stride) {
            for (value, bias) in row.iter_mut().zip(bias) {
                *value = elu(*value + *bias);
            }
        }
    }
}

vectorised! {
    /// Adds biases to rows that are `stride` apart.
    pub fn bias_rows(rows: &mut [f32], stride: usize, bias: &[f32]) {
        for row in rows.chunks_mut(stride) {
            for (value, bias) in row.iter_mut().zip(bias) {
                *value += *bias;
            }
        }
    }
}

vectorised! {
    /// Multiplies gradients by the slope of the ELU at its outputs; the outputs' rows are `stride`
    /// apart.
    pub fn elu_backward_rows(gradient: &mut [f32], width: usize, output: &[f32], stride: usize) {
        for (gradient, output) in gradient.chunks_exact_mut(width).zip(output.chunks(stride)) {
            for (gradient, output) in gradient.iter_mut().zip(output) {
                *gradient *= elu_slope(*output);
            }
        }
    }
}

vectorised! {
    /// Adds the sum of rows to `sums`.
    pub fn add_column_sums(rows: &[f32], sums: &mut [f32]) {
        let width = sums.len();
        for row in rows.chunks_exact(width) {
            for (sum, value) in sums.iter_mut().zip(row) {
                *sum += *value;
            }
        }
    }
}

vectorised! {
    /// 8-bit pixels to normalised numbers: `clamp(pixel * scale + shift, -5, 5)`.
    pub fn scale_pixels(pixels: &[u8], scale: &[f32], shift: &[f32], out: &mut [f32]) {
        for (((out, pixel), scale), shift) in out.iter_mut().zip(pixels).zip(scale).zip(shift) {
            *out = (f32::from(*pixel) * *scale + *shift).clamp(-5.0, 5.0);
        }
    }
}

vectorised! {
    /// `target += source`.
    pub fn add(target: &mut [f32], source: &[f32]) {
        for (target, source) in target.iter_mut().zip(source) {
            *target += *source;
        }
    }
}

/// Sum of squares, in blocks so that it neither loses small terms nor depends on anything but its
/// input.
#[must_use]
pub fn sum_of_squares(kernels: Simd, values: &[f32]) -> f64 {
    let mut total = 0.0;
    for block in values.chunks(4096) {
        let mut sum = 0.0;
        block_square_sum(kernels, block, &mut sum);
        total += f64::from(sum);
    }
    total
}

vectorised! {
    fn block_square_sum(values: &[f32], sum: &mut f32) {
        let mut sums = [0.0f32; 32];
        let blocks = values.chunks_exact(32);
        let rest: f32 = blocks.remainder().iter().map(|v| v * v).sum();
        for block in blocks {
            for lane in 0..32 {
                sums[lane] += block[lane] * block[lane];
            }
        }
        *sum = sums.iter().sum::<f32>() + rest;
    }
}

/// Numbers of one Adam step, bias corrections already in them.
#[derive(Clone, Copy, Debug)]
pub struct AdamStep {
    /// What each gradient is multiplied by first (the clipping of its norm).
    pub gradient_scale: f32,
    /// Learning rate over the first bias correction.
    pub rate: f32,
    /// One over the square root of the second bias correction.
    pub second_scale: f32,
    /// Decay of the first moment.
    pub beta1: f32,
    /// Decay of the second moment.
    pub beta2: f32,
    /// Added to the root.
    pub epsilon: f32,
}

vectorised! {
    /// One Adam step over a stretch of parameters.
    pub fn adam(step: AdamStep, gradient: &[f32], first: &mut [f32], second: &mut [f32], parameters: &mut [f32]) {
        for (((gradient, first), second), parameter) in gradient.iter().zip(first).zip(second).zip(parameters) {
            let g = *gradient * step.gradient_scale;
            *first = step.beta1 * *first + (1.0 - step.beta1) * g;
            *second = step.beta2 * *second + (1.0 - step.beta2) * g * g;
            *parameter -= step.rate * *first / (second.sqrt() * step.second_scale + step.epsilon);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponentials_are_accurate() {
        let mut worst = 0.0f64;
        for index in 0..200_000 {
            let x = -86.9 + index as f32 * (174.0 / 200_000.0);
            let exact = f64::from(x).exp();
            worst = worst.max(((f64::from(exponential(x)) - exact) / exact).abs());
        }
        assert!(worst < 2e-7, "{worst}");
        assert_eq!(exponential(0.0), 1.0);
        assert!((exponential(-500.0)) < 1e-37 && exponential(500.0).is_finite());
        for index in 0..4000 {
            let x = index as f32 / 100.0 - 20.0;
            assert!((tanh(x) - x.tanh()).abs() < 3e-7);
            assert!((f64::from(sigmoid(x)) - 1.0 / (1.0 + f64::from(-x).exp())).abs() < 3e-7);
        }
    }

    #[test]
    fn adam_follows_its_formula() {
        let (mut p, mut m, mut v) = ([1.0f32; 3], [0.0f32; 3], [0.0f32; 3]);
        let gradients = [[0.5f32, -2.0, 0.0], [0.25, 1.0, 3.0]];
        let (mut ep, mut em, mut ev) = ([1.0f64; 3], [0.0f64; 3], [0.0f64; 3]);
        for (t, g) in gradients.iter().enumerate() {
            let t = t as i32 + 1;
            let step = AdamStep {
                gradient_scale: 0.5,
                rate: 0.01 / (1.0 - 0.9f32.powi(t)),
                second_scale: 1.0 / (1.0 - 0.999f32.powi(t)).sqrt(),
                beta1: 0.9,
                beta2: 0.999,
                epsilon: 1e-6,
            };
            adam(Simd::PLAIN, step, g, &mut m, &mut v, &mut p);
            for i in 0..3 {
                let g = f64::from(g[i]) * 0.5;
                em[i] = 0.9 * em[i] + 0.1 * g;
                ev[i] = 0.999 * ev[i] + 0.001 * g * g;
                let (mh, vh) = (em[i] / (1.0 - 0.9f64.powi(t)), ev[i] / (1.0 - 0.999f64.powi(t)));
                ep[i] -= 0.01 * mh / (vh.sqrt() + 1e-6);
            }
        }
        for i in 0..3 {
            assert!((f64::from(p[i]) - ep[i]).abs() < 1e-5, "{p:?} {ep:?}");
        }
    }
}
