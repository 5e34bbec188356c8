//! Which drawsegs a sprite has to do with.

crate::simd::kernel_files!(avx2, avx512);
pub mod reaches;
mod scalar;

use crate::simd::{Simd, dispatch};
use reaches::DrawSegBounds;

/// Writes the indices of those that share a column with the columns `first..end` and have `near` at
/// `inverse` or above it to `met`, which is padded; gives how many there are. Which ones do is
/// unpredictable: it is found without a branch.
pub(crate) fn list(
    reaches: &DrawSegBounds,
    simd: Simd,
    columns: [u32; 2],
    inverse: i64,
    met: &mut [u32],
) -> usize {
    dispatch!(simd;
        avx512 => avx512::list(reaches, columns, inverse, met),
        avx2 => avx2::list(reaches, columns, inverse, met),
        scalar => scalar::list(reaches, columns, inverse, met),
    )
}

#[cfg(test)]
mod tests {
    use super::reaches::MEET_BLOCK;
    use super::*;
    use crate::math::Rng;

    #[test]
    fn all_ways_meet_the_same() {
        let mut rng = Rng::new(31);
        for count in 0..60 {
            let mut reaches = DrawSegBounds::default();
            for _ in 0..count {
                let first = rng.below(120) as usize;
                reaches.push(
                    first,
                    first + 1 + rng.below(40) as usize,
                    rng.next_u64() as i64 >> 20,
                );
            }
            let (first, inverse) = (rng.below(120), rng.next_u64() as i64 >> 20);
            let listed = |simd: Simd| {
                let mut met = vec![0; count + 2 * MEET_BLOCK];
                let found = list(&reaches, simd, [first, first + 8], inverse, &mut met);
                met.truncate(found);
                met
            };
            let plain = listed(Simd::PLAIN);
            Simd::available()
                .into_iter()
                .for_each(|simd| assert_eq!(listed(simd), plain, "{simd:?}"));
        }
    }
}
