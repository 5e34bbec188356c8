//! From an 8-bit image to what the first layer reads.

use super::convolution::ConvolutionPlan;
use super::elementwise::scale_pixels;
use super::simd::Kernels;
use crate::networks::{ImageShape, PixelScale};

/// An 8-bit image to the first convolution's stored input, normalised. `bytes` is scratch.
pub(super) fn store_pixels(
    kernels: Kernels,
    shape: ImageShape,
    convolution: &ConvolutionPlan,
    observation: &[u8],
    pixels: &PixelScale,
    bytes: &mut Vec<u8>,
    image: &mut [f32],
) {
    assert_eq!(observation.len(), shape.size(), "observation of the wrong size");
    bytes.resize(convolution.stored, 0);
    match convolution.run_length {
        12 => copy_runs::<12>(observation, &convolution.runs, bytes),
        16 => copy_runs::<16>(observation, &convolution.runs, bytes),
        length => {
            for &(from, to) in &convolution.runs {
                let (from, to) = (from as usize, to as usize);
                bytes[to..to + length].copy_from_slice(&observation[from..from + length]);
            }
        }
    }
    scale_pixels(kernels, bytes, &pixels.scale, &pixels.shift, image);
}

/// Copies runs of a known length, so that each is a move or two rather than a call.
fn copy_runs<const LENGTH: usize>(observation: &[u8], runs: &[(u32, u32)], bytes: &mut [u8]) {
    for &(from, to) in runs {
        let (from, to) = (from as usize, to as usize);
        bytes[to..to + LENGTH].copy_from_slice(&observation[from..from + LENGTH]);
    }
}
