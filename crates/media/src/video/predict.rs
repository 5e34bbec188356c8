//! Prediction of blocks from what was coded before (clauses 8.3.3, 8.3.4 and 8.4.2).

use super::plane::Plane;

/// How a block is predicted from its neighbours in the same picture.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Intra {
    /// The row above goes on downwards.
    Vertical,
    /// The column to the left goes on to the right.
    Horizontal,
    /// The mean of both.
    Mean,
}

impl Intra {
    /// All that can be used at a place: a direction needs its neighbours.
    pub fn usable(x: usize, y: usize) -> impl Iterator<Item = Intra> {
        [Intra::Mean, Intra::Vertical, Intra::Horizontal].into_iter().filter(move |mode| match mode {
            Intra::Vertical => y > 0,
            Intra::Horizontal => x > 0,
            Intra::Mean => true,
        })
    }

    /// Number of the mode in `mb_type` of luminance blocks.
    pub fn luma_number(self) -> u32 {
        match self {
            Intra::Vertical => 0,
            Intra::Horizontal => 1,
            Intra::Mean => 2,
        }
    }

    /// Number of the mode in `intra_chroma_pred_mode`.
    pub fn chroma_number(self) -> u32 {
        match self {
            Intra::Mean => 0,
            Intra::Horizontal => 1,
            Intra::Vertical => 2,
        }
    }
}

/// Predicts the 16 x 16 luminance samples at (`x`, `y`) from reconstructed neighbours.
pub(super) fn intra_luma(plane: &Plane, x: usize, y: usize, mode: Intra) -> [[u8; 16]; 16] {
    match mode {
        Intra::Vertical => [above(plane, x, y); 16],
        Intra::Horizontal => left::<16>(plane, x, y).map(|sample| [sample; 16]),
        Intra::Mean => {
            let top = (y > 0).then(|| above::<16>(plane, x, y));
            let side = (x > 0).then(|| left::<16>(plane, x, y));
            [[mean(&[top.as_ref().map(|t| &t[..]), side.as_ref().map(|s| &s[..])]); 16]; 16]
        }
    }
}

/// Predicts the 8 x 8 colour-difference samples at (`x`, `y`). The mean is taken for each quarter from the neighbours
/// that lie nearest to it.
pub(super) fn intra_chroma(plane: &Plane, x: usize, y: usize, mode: Intra) -> [[u8; 8]; 8] {
    match mode {
        Intra::Vertical => [above(plane, x, y); 8],
        Intra::Horizontal => left::<8>(plane, x, y).map(|sample| [sample; 8]),
        Intra::Mean => {
            let top = (y > 0).then(|| above::<8>(plane, x, y));
            let side = (x > 0).then(|| left::<8>(plane, x, y));
            let mut block = [[0; 8]; 8];
            for (quarter_x, quarter_y) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                let top = top.as_ref().map(|t| &t[4 * quarter_x..][..4]);
                let side = side.as_ref().map(|s| &s[4 * quarter_y..][..4]);
                // Off the diagonal only one side counts, where it exists.
                let value = match (quarter_x, quarter_y) {
                    (1, 0) if top.is_some() => mean(&[top]),
                    (0, 1) if side.is_some() => mean(&[side]),
                    _ => mean(&[top, side]),
                };
                for row in &mut block[4 * quarter_y..][..4] {
                    row[4 * quarter_x..][..4].fill(value);
                }
            }
            block
        }
    }
}

fn above<const N: usize>(plane: &Plane, x: usize, y: usize) -> [u8; N] {
    std::array::from_fn(|k| plane.samples[(y - 1) * plane.width + x + k])
}

fn left<const N: usize>(plane: &Plane, x: usize, y: usize) -> [u8; N] {
    std::array::from_fn(|k| plane.samples[(y + k) * plane.width + x - 1])
}

/// The rounded mean of the samples that exist; 128 if none does. Their number is a power of two.
fn mean(sides: &[Option<&[u8]>]) -> u8 {
    let samples = || sides.iter().flatten().flat_map(|side| side.iter());
    let count = samples().count() as u32;
    if count == 0 {
        return 128;
    }
    ((samples().map(|sample| u32::from(*sample)).sum::<u32>() + count / 2) / count) as u8
}

/// A block of `N` x `N` samples of the picture before, moved by whole samples; beyond the edge the last one goes on.
pub(super) fn moved<const N: usize>(plane: &Plane, x: isize, y: isize) -> [[u8; N]; N] {
    let mut block = [[0; N]; N];
    if x >= 0 && y >= 0 && x as usize + N <= plane.width && y as usize + N <= plane.height {
        return plane.block(x as usize, y as usize);
    }
    for (row, line) in block.iter_mut().enumerate() {
        let from = (y + row as isize).clamp(0, plane.height as isize - 1) as usize * plane.width;
        for (column, sample) in line.iter_mut().enumerate() {
            *sample = plane.samples[from + (x + column as isize).clamp(0, plane.width as isize - 1) as usize];
        }
    }
    block
}

/// Colour differences of a block whose luminance moved by whole samples: theirs moved by half as many, and between two
/// samples the mean is taken (clause 8.4.2.2.2).
pub(super) fn moved_chroma(plane: &Plane, x: usize, y: usize, motion: (i32, i32)) -> [[u8; 8]; 8] {
    let (left, top) = (x as isize + (motion.0 >> 1) as isize, y as isize + (motion.1 >> 1) as isize);
    let block: [[u8; 9]; 9] = moved(plane, left, top);
    // Eighths of a sample: none or four.
    let (fx, fy) = ((motion.0 & 1) as u32 * 4, (motion.1 & 1) as u32 * 4);
    std::array::from_fn(|r| {
        std::array::from_fn(|c| {
            let sample = |dr: usize, dc: usize| u32::from(block[r + dr][c + dc]);
            let sum = (8 - fx) * (8 - fy) * sample(0, 0)
                + fx * (8 - fy) * sample(0, 1)
                + (8 - fx) * fy * sample(1, 0)
                + fx * fy * sample(1, 1);
            ((sum + 32) >> 6) as u8
        })
    })
}
