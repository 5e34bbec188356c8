//! Sums and products of vectors as long as a network, by which conjugate gradients go. Neither the
//! kernels nor the number of threads change a bit.

use hasard_engine::simd::Simd;

use crate::networks::cpu::vectorised::vectorised;
use crate::threads::in_parallel;

/// Numbers that are added up side by side.
const SIDE: usize = 16;
/// Numbers that a thread takes at once, and whose products are added up apart.
const STRETCH: usize = 1 << 17;

/// What computes with vectors. All of one call are of one length.
#[derive(Clone, Copy, Debug)]
pub struct Vectors {
    /// Kernels.
    pub kernels: Simd,
    /// Threads.
    pub threads: usize,
}

impl Vectors {
    /// Product of two vectors, summed in 64 bits.
    #[must_use]
    pub fn dot(self, a: &[f32], b: &[f32]) -> f64 {
        let mut sums = vec![0.0; a.len().div_ceil(STRETCH)];
        let work = a.chunks(STRETCH).zip(b.chunks(STRETCH)).zip(&mut sums);
        self.each(work.map(|((a, b), sum)| move |_: &mut ()| dot_stretch(self.kernels, a, b, sum)));
        sums.iter().sum()
    }

    /// `to += scale * b`.
    pub fn add_scaled(self, to: &mut [f32], scale: f64, b: &[f32]) {
        let work = to.chunks_mut(STRETCH).zip(b.chunks(STRETCH));
        self.each(
            work.map(|(to, b)| move |_: &mut ()| add_scaled(self.kernels, to, scale as f32, b)),
        );
    }

    /// `to = a + scale * to`.
    pub fn scale_and_add(self, to: &mut [f32], scale: f64, a: &[f32]) {
        let work = to.chunks_mut(STRETCH).zip(a.chunks(STRETCH));
        self.each(
            work.map(|(to, a)| move |_: &mut ()| scale_and_add(self.kernels, to, scale as f32, a)),
        );
    }

    /// `to = a + scale * b`.
    pub fn set_sum(self, to: &mut [f32], a: &[f32], scale: f64, b: &[f32]) {
        let work = to.chunks_mut(STRETCH).zip(a.chunks(STRETCH)).zip(b.chunks(STRETCH));
        self.each(
            work.map(|((to, a), b)| {
                move |_: &mut ()| set_sum(self.kernels, to, a, scale as f32, b)
            }),
        );
    }

    fn each<W: FnOnce(&mut ()) + Send>(self, work: impl Iterator<Item = W> + Send) {
        in_parallel(&mut vec![(); self.threads.max(1)], work);
    }
}

vectorised! {
    fn dot_stretch(a: &[f32], b: &[f32], sum: &mut f64) {
        let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<SIDE>(), b.as_chunks::<SIDE>());
        let mut sums = [0.0; SIDE];
        for (a, b) in a.iter().zip(b) {
            for lane in 0..SIDE {
                sums[lane] += f64::from(a[lane]) * f64::from(b[lane]);
            }
        }
        for ((sum, a), b) in sums.iter_mut().zip(a_rest).zip(b_rest) {
            *sum += f64::from(*a) * f64::from(*b);
        }
        *sum = sums.iter().sum();
    }
}

vectorised! {
    fn add_scaled(to: &mut [f32], scale: f32, b: &[f32]) {
        for (to, b) in to.iter_mut().zip(b) {
            *to += scale * *b;
        }
    }
}

vectorised! {
    fn scale_and_add(to: &mut [f32], scale: f32, a: &[f32]) {
        for (to, a) in to.iter_mut().zip(a) {
            *to = *a + scale * *to;
        }
    }
}

vectorised! {
    fn set_sum(to: &mut [f32], a: &[f32], scale: f32, b: &[f32]) {
        for ((to, a), b) in to.iter_mut().zip(a).zip(b) {
            *to = *a + scale * *b;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::product::tests::noise;
    use super::*;

    #[test]
    fn kernels_and_threads_agree_to_the_bit_and_with_plain_loops() {
        let plain = Vectors { kernels: Simd::PLAIN, threads: 1 };
        for length in [0, 1, 15, 16, 1003, 2 * STRETCH + 5] {
            let (a, b) = (noise(length, 1), noise(length, 2));
            let expected: f64 = a.iter().zip(&b).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum();
            for (kernels, threads) in
                Simd::available().into_iter().flat_map(|kernels| [(kernels, 1), (kernels, 3)])
            {
                let vectors = Vectors { kernels, threads };
                let found = vectors.dot(&a, &b);
                assert!(
                    (found - expected).abs() < 1e-9,
                    "{vectors:?}, {length}: {found} against {expected}"
                );
                assert_eq!(found.to_bits(), plain.dot(&a, &b).to_bits(), "{vectors:?}, {length}");
                let (mut added, mut scaled, mut set) = (a.clone(), a.clone(), vec![0.0; length]);
                vectors.add_scaled(&mut added, 0.3, &b);
                vectors.scale_and_add(&mut scaled, 0.3, &b);
                vectors.set_sum(&mut set, &a, 0.3, &b);
                for index in 0..length {
                    assert_eq!(added[index], a[index] + 0.3 * b[index]);
                    assert_eq!(scaled[index], b[index] + 0.3 * a[index]);
                    assert_eq!(set[index], added[index]);
                }
            }
        }
    }
}
