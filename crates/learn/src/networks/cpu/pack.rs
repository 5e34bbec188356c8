//! Matrices stored panel after panel: a panel is read front to back by a tile; row by row the same
//! reads would be kilobytes apart.

use crate::networks::cpu::tile::PANEL;

/// Stores a matrix of `inner` rows and `columns` columns, row by row in `source`, panel after panel
/// in `packed`.
pub fn pack(source: &[f32], inner: usize, columns: usize, packed: &mut [f32]) {
    assert!(
        columns.is_multiple_of(PANEL)
            && source.len() == inner * columns
            && packed.len() == source.len()
    );
    for (row, values) in source.chunks_exact(columns).enumerate() {
        for (panel, part) in values.chunks_exact(PANEL).enumerate() {
            let start = (panel * inner + row) * PANEL;
            packed[start..start + PANEL].copy_from_slice(part);
        }
    }
}

/// As [`pack`], of the transpose: `source` has `columns` rows of `inner` columns.
pub fn pack_transposed(source: &[f32], inner: usize, columns: usize, packed: &mut [f32]) {
    assert!(
        columns.is_multiple_of(PANEL)
            && source.len() == inner * columns
            && packed.len() == source.len()
    );
    const BLOCK: usize = 16;
    for (rows, panel) in
        source.chunks_exact(PANEL * inner).zip(packed.chunks_exact_mut(PANEL * inner))
    {
        let mut first = 0;
        while first < inner {
            let end = (first + BLOCK).min(inner);
            for (lane, row) in rows.chunks_exact(inner).enumerate() {
                for index in first..end {
                    panel[index * PANEL + lane] = row[index];
                }
            }
            first = end;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::product::tests::noise;
    use super::*;

    #[test]
    fn transposed_packing_equals_packing_of_the_transpose() {
        let (inner, columns) = (19, 64);
        let matrix = noise(inner * columns, 5);
        let mut transpose = vec![0.0; matrix.len()];
        for row in 0..inner {
            for column in 0..columns {
                transpose[column * inner + row] = matrix[row * columns + column];
            }
        }
        let (mut a, mut b) = (vec![0.0; matrix.len()], vec![0.0; matrix.len()]);
        pack(&matrix, inner, columns, &mut a);
        pack_transposed(&transpose, inner, columns, &mut b);
        assert_eq!(a, b);
    }
}
