//! Running means and variances: of every pixel, and of returns.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::networks::PixelScale;
use hasard_engine::simd::Simd;

use crate::networks::cpu::vectorised::vectorised;
use crate::threads::{in_parallel, pieces};

/// Added to variances before their root is taken.
const EPSILON: f64 = 1e-5;
/// Normalised values are cut off here.
pub const CLIP: f32 = 5.0;

/// Running mean and variance of one number, merged batch by batch by Chan's rule; it starts as one
/// draw of mean 0 and variance 1, and never forgets.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
pub struct Moments {
    /// Number of draws so far, the made-up first one included.
    pub count: f64,
    /// Mean.
    pub mean: f64,
    /// Variance.
    pub variance: f64,
}

impl Default for Moments {
    fn default() -> Moments {
        Moments { count: 1.0, mean: 0.0, variance: 1.0 }
    }
}

impl Moments {
    /// Merges a batch of `count` draws with this mean and unbiased variance.
    pub fn merge(&mut self, count: f64, mean: f64, variance: f64) {
        let total = self.count + count;
        let distance = mean - self.mean;
        let squares = self.variance * self.count
            + variance * count
            + distance * distance * self.count * count / total;
        *self = Moments {
            count: total,
            mean: self.mean + distance * count / total,
            variance: squares / total,
        };
    }

    /// Merges draws.
    pub fn update(&mut self, values: &[f32]) {
        if values.is_empty() {
            return;
        }
        let count = values.len() as f64;
        let mean = values.iter().map(|&v| f64::from(v)).sum::<f64>() / count;
        let squares: f64 = values.iter().map(|&v| (f64::from(v) - mean).powi(2)).sum();
        self.merge(count, mean, squares / (count - 1.0).max(1.0));
    }

    /// Merges draws, and forgets: earlier ones count as `horizon` draws at most, the made-up first
    /// one among them.
    pub fn update_forgetting(&mut self, values: &[f32], horizon: f64) {
        self.count = self.count.min(horizon);
        self.update(values);
    }

    /// Whether some draws have these moments: finite, and spread by no less than nothing.
    #[must_use]
    pub fn are_sound(&self) -> bool {
        let Moments { count, mean, variance } = *self;
        count.is_finite()
            && count >= 1.0
            && mean.is_finite()
            && variance.is_finite()
            && variance >= 0.0
    }

    /// The running deviation.
    #[must_use]
    pub fn deviation(&self) -> f64 {
        (self.variance + EPSILON).sqrt()
    }

    /// A value in units of the running deviation, however large.
    #[must_use]
    pub fn scale_down(&self, value: f32) -> f32 {
        ((f64::from(value) - self.mean) / self.deviation()) as f32
    }

    /// The inverse of [`Moments::scale_down`].
    #[must_use]
    pub fn scale_up(&self, value: f32) -> f32 {
        (f64::from(value) * self.deviation() + self.mean) as f32
    }

    /// A value in units of the running deviation, cut off at five.
    #[must_use]
    pub fn normalise(&self, value: f32) -> f32 {
        self.scale_down(value).clamp(-CLIP, CLIP)
    }

    /// The inverse of [`Moments::normalise`] within its bounds.
    #[must_use]
    pub fn denormalise(&self, value: f32) -> f32 {
        self.scale_up(value.clamp(-CLIP, CLIP))
    }
}

/// Running mean and variance of every pixel (over 255) of an observation.
#[derive(Clone, PartialEq, Debug)]
pub struct PixelNormaliser {
    /// Number of frames so far, the made-up first one included.
    pub count: f64,
    /// Mean of each pixel.
    pub mean: Vec<f64>,
    /// Variance of each pixel.
    pub variance: Vec<f64>,
}

impl PixelNormaliser {
    /// Statistics before the first frame.
    #[must_use]
    pub fn new(pixels: usize) -> PixelNormaliser {
        PixelNormaliser { count: 1.0, mean: vec![0.0; pixels], variance: vec![1.0; pixels] }
    }

    /// Merges a batch of frames, working on `threads` threads. Sums are whole numbers, so neither
    /// the order of frames nor the number of threads changes a bit.
    pub fn update(&mut self, kernels: Simd, frames: &[&[u8]], threads: usize) {
        self.merge(&PixelSums::of(kernels, frames, self.mean.len(), threads));
    }

    /// Merges frames of which the sums are known.
    pub fn merge(&mut self, sums: &PixelSums) {
        let Some((&frames, numbers)) = sums.0.split_last().filter(|(frames, _)| **frames > 0)
        else {
            return;
        };
        let (count, old_count) = (frames as f64, self.count);
        let (sums, squares) = numbers.split_at(numbers.len() / 2);
        for (((&sum, &square), own_mean), own_variance) in
            sums.iter().zip(squares).zip(&mut self.mean).zip(&mut self.variance)
        {
            let mean = sum as f64 / count;
            let deviations = square as f64 - mean * sum as f64;
            let variance = (deviations / (count - 1.0).max(1.0)).max(0.0) / (255.0 * 255.0);
            let mut moments =
                Moments { count: old_count, mean: *own_mean, variance: *own_variance };
            moments.merge(count, mean / 255.0, variance);
            (*own_mean, *own_variance) = (moments.mean, moments.variance);
        }
        self.count += count;
    }

    /// How pixels enter the network under these statistics.
    #[must_use]
    pub fn scale(&self) -> PixelScale {
        let factor = |variance: f64| 1.0 / (variance + EPSILON).sqrt();
        PixelScale {
            scale: self
                .variance
                .iter()
                .map(|&variance| (factor(variance) / 255.0) as f32)
                .collect(),
            shift: self
                .variance
                .iter()
                .zip(&self.mean)
                .map(|(&variance, mean)| (-mean * factor(variance)) as f32)
                .collect(),
        }
    }
}

/// Sums of frames: of every pixel, of every pixel's square, and their number, one after the other.
#[derive(Clone, PartialEq, Debug)]
pub struct PixelSums(pub Vec<u64>);

impl PixelSums {
    /// The sums of some frames of so many pixels, worked out on `threads` threads.
    #[must_use]
    pub fn of(kernels: Simd, frames: &[&[u8]], pixels: usize, threads: usize) -> PixelSums {
        const BLOCK: usize = 2048;
        let mut all = vec![0; 2 * pixels + 1];
        all[2 * pixels] = frames.len() as u64;
        let (sums, squares) = all[..2 * pixels].split_at_mut(pixels);
        let share = pixels.div_ceil(pieces(threads)).next_multiple_of(BLOCK);
        let parts = sums.chunks_mut(share).zip(squares.chunks_mut(share)).enumerate();
        let work = parts.map(|(part, (sums, squares))| {
            move |_: &mut ()| {
                let (mut some_sums, mut some_squares) = ([0u32; BLOCK], [0u32; BLOCK]);
                for (block, (sums, squares)) in
                    sums.chunks_mut(BLOCK).zip(squares.chunks_mut(BLOCK)).enumerate()
                {
                    let first = part * share + block * BLOCK;
                    // 32 bits hold the squares of 66,000 pixels.
                    for some in frames.chunks(65_536) {
                        some_sums.fill(0);
                        some_squares.fill(0);
                        add_pixels(
                            kernels,
                            some,
                            first..first + sums.len(),
                            &mut some_sums,
                            &mut some_squares,
                        );
                        let wide = |narrow: &u32| u64::from(*narrow);
                        sums.iter_mut()
                            .zip(some_sums.iter().map(wide))
                            .for_each(|(sum, some)| *sum += some);
                        squares
                            .iter_mut()
                            .zip(some_squares.iter().map(wide))
                            .for_each(|(sum, some)| *sum += some);
                    }
                }
            }
        });
        in_parallel(&mut vec![(); threads.max(1)], work);
        PixelSums(all)
    }
}

vectorised! {
    /// Adds the pixels `range` of some frames, and their squares.
    fn add_pixels(frames: &[&[u8]], range: Range<usize>, sums: &mut [u32], squares: &mut [u32]) {
        // Eight frames at a time, so that sums are fetched and stored once for all eight.
        let (eights, rest) = frames.as_chunks::<8>();
        for eight in eights {
            let count = range.len();
            let parts = eight.map(|frame| &frame[range.clone()][..count]);
            let (sums, squares) = (&mut sums[..count], &mut squares[..count]);
            for pixel in 0..count {
                let values = parts.map(|part| u32::from(part[pixel]));
                sums[pixel] += values.iter().sum::<u32>();
                squares[pixel] += values.iter().map(|value| value * value).sum::<u32>();
            }
        }
        for frame in rest {
            for ((pixel, sum), square) in frame[range.clone()].iter().zip(&mut *sums).zip(&mut *squares) {
                let value = u32::from(*pixel);
                *sum += value;
                *square += value * value;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The released code's normaliser begins with a count of 1, mean 0 and variance 0; worked out
    /// apart by Chan's merge.
    #[test]
    fn first_batch_gives_the_recorded_numbers() {
        let mut moments = Moments::default();
        moments.update(&[1.0, 2.0, 3.0, 4.0]);
        assert!((moments.mean - 2.0).abs() < 1e-9);
        assert!((moments.variance - 2.533_333_3).abs() < 1e-7);
        assert_eq!(moments.count, 5.0);
        let value = moments.normalise(3.0);
        assert!((moments.denormalise(value) - 3.0).abs() < 1e-6);
        assert_eq!(moments.normalise(1e6), 5.0);
    }

    #[test]
    fn moments_that_no_draws_have_are_known() {
        let moments = Moments { count: 3.0, mean: -1.0, variance: 0.0 };
        assert!(Moments::default().are_sound() && moments.are_sound());
        for wrong in [
            Moments { variance: -1.0, ..moments },
            Moments { variance: f64::NAN, ..moments },
            Moments { mean: f64::INFINITY, ..moments },
            Moments { count: 0.0, ..moments },
        ] {
            assert!(!wrong.are_sound(), "{wrong:?}");
        }
    }

    /// A12: the moments follow returns that change (equation 7 of van Hasselt et al. 2016, an
    /// average that gives what was before a weight of horizon / (horizon + batch)), where those
    /// that never forget lag behind for as long as they have run.
    #[test]
    fn moments_that_forget_follow_returns_that_change() {
        let batch = |mean: f32| -> Vec<f32> {
            (0..1000).map(|index| mean + if index % 2 == 0 { 1.0 } else { -1.0 }).collect()
        };
        let (mut forgetting, mut running) = (Moments::default(), Moments::default());
        for rollout in 0..100 {
            let values = batch(if rollout < 80 { 0.0 } else { 30.0 });
            forgetting.update_forgetting(&values, 3000.0);
            running.update(&values);
        }
        // Twenty batches of a weight of a quarter each.
        let expected = 30.0 * (1.0 - 0.75f64.powi(20));
        assert!((forgetting.mean - expected).abs() < 1e-6, "{}", forgetting.mean);
        assert!(forgetting.deviation() < 2.5 && running.mean < 7.0 && running.deviation() > 10.0);
    }

    #[test]
    fn pixels_are_normalised_as_single_numbers_are() {
        let pixels = 5000;
        let frames: Vec<Vec<u8>> = (0..9u32)
            .map(|f| (0..pixels as u32).map(|p| ((p * 31 + f * f * 17) % 256) as u8).collect())
            .collect();
        let (early, late) = frames.split_at(4);
        let run = |threads| {
            let mut normaliser = PixelNormaliser::new(pixels);
            for part in [early, late] {
                normaliser.update(
                    Simd::PLAIN,
                    &part.iter().map(Vec::as_slice).collect::<Vec<_>>(),
                    threads,
                );
            }
            normaliser
        };
        let normaliser = run(1);
        assert_eq!(normaliser, run(3));
        let scale = normaliser.scale();
        for pixel in [0, 1, 2047, 2048, 4999] {
            let mut moments = Moments::default();
            for part in [early, late] {
                moments
                    .update(&part.iter().map(|f| f32::from(f[pixel]) / 255.0).collect::<Vec<_>>());
            }
            assert!((moments.mean - normaliser.mean[pixel]).abs() < 1e-6);
            assert!((moments.variance - normaliser.variance[pixel]).abs() < 1e-6);
            let value = f32::from(frames[0][pixel]);
            let expected = moments.normalise(value / 255.0);
            assert!((value * scale.scale[pixel] + scale.shift[pixel] - expected).abs() < 1e-4);
        }
    }
}
