//! Weights as the products of a family read them: packed panel after panel, as numbers of 32 bits
//! or as pairs of 16.

use hasard_engine::simd::Simd;

use crate::networks::cpu::bfloat16::{Pair, pair_of, pair_rows, pair_with_zeros};
use crate::networks::cpu::pack::{pack, pack_transposed};
use crate::networks::cpu::tile::PANEL;

/// A right factor.
#[derive(Clone, Debug)]
pub enum Panels {
    /// For a family that multiplies numbers of 32 bits.
    Numbers(Vec<f32>),
    /// For products in bfloat16: two rows of the inner dimension together.
    Pairs(Vec<Pair>),
}

impl Default for Panels {
    fn default() -> Panels {
        Panels::Numbers(Vec::new())
    }
}

impl Panels {
    /// Room for some numbers of 32 bits, to be written.
    pub fn numbers(&mut self, length: usize) -> &mut [f32] {
        if !matches!(self, Panels::Numbers(_)) {
            *self = Panels::default();
        }
        let Panels::Numbers(data) = self else { unreachable!("just made") };
        data.resize(length, 0.0);
        data
    }

    fn pairs(&mut self, length: usize) -> &mut [Pair] {
        if !matches!(self, Panels::Pairs(_)) {
            *self = Panels::Pairs(Vec::new());
        }
        let Panels::Pairs(data) = self else { unreachable!("just made") };
        data.resize(length, 0);
        data
    }

    /// Packs a matrix of `inner` rows and `columns` columns, row by row in `source`.
    pub fn pack(&mut self, kernels: Simd, source: &[f32], inner: usize, columns: usize) {
        self.pack_runs(kernels, source, inner, columns);
    }

    /// The same of runs of `run` rows, each of which a convolution finds in a row of its image:
    /// pairs never join two of them.
    pub fn pack_runs(&mut self, kernels: Simd, source: &[f32], run: usize, columns: usize) {
        assert!(
            columns.is_multiple_of(PANEL) && source.len().is_multiple_of((run * columns).max(1)),
            "a matrix of whole runs"
        );
        let inner = source.len() / columns.max(1);
        if !kernels.family().rounds() {
            return pack(source, inner, columns, self.numbers(source.len()));
        }
        let pairs = inner / run.max(1) * run.div_ceil(2);
        let packed = self.pairs(pairs * columns);
        let rows =
            source.chunks_exact((run * columns).max(1)).flat_map(|run| run.chunks(2 * columns));
        for (index, both) in rows.enumerate() {
            let (first, second) = both.split_at(columns);
            for panel in 0..columns / PANEL {
                let to = &mut packed[(panel * pairs + index) * PANEL..][..PANEL];
                let own = panel * PANEL..(panel + 1) * PANEL;
                match second.get(own.clone()) {
                    Some(second) => pair_rows(kernels, &first[own], second, to),
                    None => pair_with_zeros(kernels, &first[own], to),
                }
            }
        }
    }

    /// As [`Panels::pack`], of the transpose: `source` has `columns` rows of `inner` columns.
    pub fn pack_transposed(&mut self, kernels: Simd, source: &[f32], inner: usize, columns: usize) {
        if !kernels.family().rounds() {
            return pack_transposed(source, inner, columns, self.numbers(source.len()));
        }
        assert!(columns.is_multiple_of(PANEL) && source.len() == inner * columns);
        let pairs = inner.div_ceil(2);
        let packed = self.pairs(pairs * columns);
        for (rows, panel) in source
            .chunks_exact((PANEL * inner).max(1))
            .zip(packed.chunks_exact_mut((PANEL * pairs).max(1)))
        {
            for (lane, row) in rows.chunks_exact(inner).enumerate() {
                for (index, both) in row.chunks(2).enumerate() {
                    panel[index * PANEL + lane] =
                        pair_of(both[0], both.get(1).copied().unwrap_or(0.0));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::product::tests::noise;
    use super::*;

    #[test]
    fn the_transpose_is_packed_as_the_matrix_is() {
        for kernels in Simd::all() {
            for inner in [1, 2, 7, 18] {
                let (columns, matrix) = (64, noise(inner * 64, 1));
                let transpose: Vec<f32> = (0..columns)
                    .flat_map(|column| (0..inner).map(move |row| row * columns + column))
                    .map(|at| matrix[at])
                    .collect();
                let (mut one, mut other) = (Panels::default(), Panels::default());
                one.pack(kernels, &matrix, inner, columns);
                other.pack_transposed(kernels, &transpose, inner, columns);
                match (one, other) {
                    (Panels::Numbers(one), Panels::Numbers(other)) => assert_eq!(one, other),
                    (Panels::Pairs(one), Panels::Pairs(other)) => assert_eq!(one, other),
                    _ => panic!("two kinds of panels"),
                }
            }
        }
    }
}
