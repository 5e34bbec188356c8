//! From an 8-bit image to what the first layer reads.

use hasard_engine::simd::Simd;

use crate::networks::cpu::bfloat16::round_pixels;
use crate::networks::cpu::buffers::sized;
use crate::networks::cpu::convolution::{ConvolutionPlan, Stored};
use crate::networks::cpu::elementwise::scale_pixels;
use crate::networks::{ImageShape, PixelScale};

/// The stored input of a first convolution.
#[derive(Default)]
pub(super) struct StoredImage {
    bytes: Vec<u8>,
    numbers: Vec<f32>,
    rounded: Vec<u16>,
}

impl StoredImage {
    /// Stores an 8-bit image, normalised.
    pub fn store(
        &mut self,
        kernels: Simd,
        shape: ImageShape,
        convolution: &ConvolutionPlan,
        observation: &[u8],
        pixels: &PixelScale,
    ) -> Stored<'_> {
        assert_eq!(observation.len(), shape.size(), "observation of the wrong size");
        let as_it_is = convolution.runs == [(0, 0)] && convolution.stored == observation.len();
        if !as_it_is {
            self.arrange(convolution, observation);
        }
        let bytes = if as_it_is { observation } else { &self.bytes };
        if kernels.family().rounds() {
            self.rounded.resize(convolution.rounded(), 0);
            round_pixels(
                kernels,
                bytes,
                &pixels.scale,
                &pixels.shift,
                &mut self.rounded[..convolution.stored],
            );
        } else {
            let numbers = sized(&mut self.numbers, convolution.stored);
            scale_pixels(kernels, bytes, &pixels.scale, &pixels.shift, numbers);
        }
        self.latest(kernels)
    }

    /// The image that was stored last.
    pub fn latest(&self, kernels: Simd) -> Stored<'_> {
        if kernels.family().rounds() {
            Stored::Rounded(&self.rounded)
        } else {
            Stored::Numbers(&self.numbers)
        }
    }

    /// Brings the bytes into the order of the stored input.
    fn arrange(&mut self, convolution: &ConvolutionPlan, observation: &[u8]) {
        self.bytes.resize(convolution.stored, 0);
        match convolution.run_length {
            12 => copy_runs::<12>(observation, &convolution.runs, &mut self.bytes),
            16 => copy_runs::<16>(observation, &convolution.runs, &mut self.bytes),
            length => {
                for &(from, to) in &convolution.runs {
                    let (from, to) = (from as usize, to as usize);
                    self.bytes[to..to + length].copy_from_slice(&observation[from..from + length]);
                }
            }
        }
    }
}

/// Copies runs of a known length, so that each is a move or two rather than a call.
fn copy_runs<const LENGTH: usize>(observation: &[u8], runs: &[(u32, u32)], bytes: &mut [u8]) {
    for &(from, to) in runs {
        let (from, to) = (from as usize, to as usize);
        bytes[to..to + LENGTH].copy_from_slice(&observation[from..from + LENGTH]);
    }
}
