//! Squares of eight by eight bytes in registers of 8 bytes, then single bytes.

use crate::render::buffers::transpose::strip::STRIP;

/// Side of the squares that are turned without vectors.
const SQUARE: usize = 8;

/// Turns eight columns of eight bytes into rows: swaps single bytes across the diagonals of squares
/// of two, then pairs in squares of four, then halves.
fn turn_square(columns: [[u8; SQUARE]; SQUARE]) -> [[u8; SQUARE]; SQUARE] {
    let mut lines = columns.map(u64::from_le_bytes);
    for (apart, mask) in
        [(1, 0x00FF_00FF_00FF_00FF), (2, 0x0000_FFFF_0000_FFFF), (4, 0x0000_0000_FFFF_FFFF)]
    {
        for i in (0..SQUARE).filter(|i| i & apart == 0) {
            let swapped = ((lines[i] >> (8 * apart)) ^ lines[i + apart]) & mask;
            lines[i] ^= swapped << (8 * apart);
            lines[i + apart] ^= swapped;
        }
    }
    lines.map(u64::to_le_bytes)
}

/// Turns the columns from `first` on.
pub(crate) fn from(
    mut first: usize,
    columns: &[u8],
    stride: usize,
    pixels: &mut [u8],
    width: usize,
    rows: usize,
) {
    while first + SQUARE <= width {
        for row in (0..rows).step_by(SQUARE) {
            let square = turn_square(std::array::from_fn(|i| {
                *columns[(first + i) * stride + row..].first_chunk().expect("padded")
            }));
            let lines = pixels.chunks_exact_mut(width).skip(row).take(SQUARE.min(rows - row));
            for (line, bytes) in lines.zip(square) {
                line[first..first + SQUARE].copy_from_slice(&bytes);
            }
        }
        first += SQUARE;
    }
    while first < width {
        let end = (first + STRIP).min(width);
        for (row, line) in pixels.chunks_exact_mut(width).take(rows).enumerate() {
            for x in first..end {
                line[x] = columns[x * stride + row];
            }
        }
        first = end;
    }
}
