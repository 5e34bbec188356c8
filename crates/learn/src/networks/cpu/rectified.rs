//! Element-wise passes of the residual encoder: rectifiers between layouts, pooling, and their
//! gradients.
//!
//! Images lie pixel by pixel, all channels of one together; `places`, `sources` and `targets` say
//! where each pixel starts in another layout.

use crate::networks::ImageShape;
use crate::networks::cpu::vectorised::vectorised;

vectorised! {
    /// Writes what is above zero of an image to `places`, and zero for the rest.
    pub fn rectified_scatter(image: &[f32], channels: usize, places: &[usize], out: &mut [f32]) {
        for (from, &place) in image.chunks_exact(channels).zip(places) {
            for (to, from) in out[place..place + channels].iter_mut().zip(from) {
                *to = from.max(0.0);
            }
        }
    }
}

vectorised! {
    /// Adds biases to `raw` pixels and writes what is above zero to `places`.
    pub fn bias_rectified_scatter(raw: &[f32], sources: &[usize], bias: &[f32], places: &[usize], out: &mut [f32]) {
        let channels = bias.len();
        for (&source, &place) in sources.iter().zip(places) {
            let (from, to) = (&raw[source..source + channels], &mut out[place..place + channels]);
            for channel in 0..channels {
                to[channel] = (from[channel] + bias[channel]).max(0.0);
            }
        }
    }
}

vectorised! {
    /// Adds `raw` pixels and biases to an image.
    pub fn add_biased(raw: &[f32], sources: &[usize], bias: &[f32], image: &mut [f32]) {
        let channels = bias.len();
        for (&source, to) in sources.iter().zip(image.chunks_exact_mut(channels)) {
            let from = &raw[source..source + channels];
            for channel in 0..channels {
                to[channel] += from[channel] + bias[channel];
            }
        }
    }
}

/// Copies the pixels of an image to `targets`.
pub fn scatter(image: &[f32], channels: usize, targets: &[usize], out: &mut [f32]) {
    for (from, &target) in image.chunks_exact(channels).zip(targets) {
        out[target..target + channels].copy_from_slice(from);
    }
}

/// Copies the pixels at `sources` to an image.
pub fn gather(from: &[f32], sources: &[usize], channels: usize, image: &mut [f32]) {
    for (&source, to) in sources.iter().zip(image.chunks_exact_mut(channels)) {
        to.copy_from_slice(&from[source..source + channels]);
    }
}

vectorised! {
    /// Gradient before a rectifier whose output is `output`, both laid out by `places`, gathered to
    /// `targets`.
    pub fn rectified_backward_gather(
        gradient: &[f32], output: &[f32], places: &[usize], channels: usize, targets: &[usize], raw: &mut [f32],
    ) {
        for (&place, &target) in places.iter().zip(targets) {
            let (from, output) = (&gradient[place..place + channels], &output[place..place + channels]);
            let to = &mut raw[target..target + channels];
            for channel in 0..channels {
                to[channel] = if output[channel] > 0.0 { from[channel] } else { 0.0 };
            }
        }
    }
}

vectorised! {
    /// Adds the gradient before a rectifier whose output is `output`, both laid out by `places`, to
    /// an image.
    pub fn rectified_backward_add(gradient: &[f32], output: &[f32], places: &[usize], channels: usize, image: &mut [f32]) {
        for (&place, to) in places.iter().zip(image.chunks_exact_mut(channels)) {
            let (from, output) = (&gradient[place..place + channels], &output[place..place + channels]);
            for channel in 0..channels {
                to[channel] += if output[channel] > 0.0 { from[channel] } else { 0.0 };
            }
        }
    }
}

/// Pixels of `image` that a pooled one is the largest of, by their numbers in the 3x3 around every
/// second pixel.
#[inline(always)]
fn window(image: ImageShape, pooled: usize) -> impl Iterator<Item = (u8, usize)> {
    let width = image.width.div_ceil(2);
    let (y, x) = (2 * (pooled / width), 2 * (pooled % width));
    (0..9u8).filter_map(move |number| {
        let (row, column) = (y + usize::from(number / 3), x + usize::from(number % 3));
        let inside = (1..=image.height).contains(&row) && (1..=image.width).contains(&column);
        inside.then(|| (number, (row - 1) * image.width + column - 1))
    })
}

vectorised! {
    /// The largest of the `raw` pixels in each window of an image, biases added, and which of the
    /// nine it was; the first of equal ones.
    pub fn pool(raw: &[f32], image: ImageShape, sources: &[usize], bias: &[f32], out: &mut [f32], largest: &mut [u8]) {
        let channels = bias.len();
        let pooled = out.chunks_exact_mut(channels).zip(largest.chunks_exact_mut(channels));
        for (index, (to, largest)) in pooled.enumerate() {
            to.fill(f32::NEG_INFINITY);
            for (number, pixel) in window(image, index) {
                let from = &raw[sources[pixel]..sources[pixel] + channels];
                for channel in 0..channels {
                    let larger = from[channel] > to[channel];
                    to[channel] = if larger { from[channel] } else { to[channel] };
                    largest[channel] = if larger { number } else { largest[channel] };
                }
            }
            for channel in 0..channels {
                to[channel] += bias[channel];
            }
        }
    }
}

vectorised! {
    /// Adds the gradient of each pooled value to the pixel at `targets` that it was taken from.
    pub fn pool_backward(gradient: &[f32], image: ImageShape, largest: &[u8], channels: usize, targets: &[usize], raw: &mut [f32]) {
        let pooled = gradient.chunks_exact(channels).zip(largest.chunks_exact(channels));
        for (index, (from, largest)) in pooled.enumerate() {
            for (number, pixel) in window(image, index) {
                let to = &mut raw[targets[pixel]..targets[pixel] + channels];
                for channel in 0..channels {
                    to[channel] += if largest[channel] == number { from[channel] } else { 0.0 };
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hasard_engine::simd::Simd;

    /// Pools of an image of 3x4 and of one of 2x2 pixels, by hand; equal values count once, for the
    /// first.
    #[test]
    fn pools_take_the_largest_of_nine_and_give_back_to_it() {
        for kernels in Simd::available() {
            let image = ImageShape { height: 3, width: 4, channels: 1 };
            let raw = [1.0, 5.0, 2.0, 0.0, -1.0, 3.0, 9.0, 4.0, 7.0, 6.0, 9.0, -2.0];
            let places: Vec<usize> = (0..12).collect();
            let (mut out, mut largest) = ([0.0; 4], [9; 4]);
            pool(kernels, &raw, image, &places, &[0.5], &mut out, &mut largest);
            // Around (0, 0), (0, 2), (2, 0) and (2, 2): of the window's numbers 4 is the middle.
            assert_eq!(out, [5.5, 9.5, 7.5, 9.5]);
            assert_eq!(largest, [5, 7, 4, 1]);
            let mut back = [0.0; 12];
            pool_backward(kernels, &[1.0, 2.0, 3.0, 4.0], image, &largest, 1, &places, &mut back);
            assert_eq!(back, [0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 6.0, 0.0, 3.0, 0.0, 0.0, 0.0]);
        }
        assert_eq!(
            ImageShape { height: 3, width: 4, channels: 1 }.pooled(),
            ImageShape { height: 2, width: 2, channels: 1 }
        );
    }
}
