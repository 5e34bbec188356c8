//! Macroblocks, slices and parameter sets.

use super::bits::{BitWriter, nal_unit};
use super::cavlc::{Context, write_levels};
use super::plane::{Frame, Plane};
use super::predict::{Intra, intra_chroma, intra_luma, moved, moved_chroma};
use super::tables::INTER_PATTERNS;
use super::transform::{Block, Quantiser, chroma_quantiser, forward, inverse};
use crate::Picture;

/// The order in which coefficients are coded, from low to high frequency (figure 8-8).
const ZIGZAG: [usize; 16] = [0, 1, 4, 8, 5, 2, 3, 6, 9, 12, 13, 10, 7, 11, 14, 15];
/// Frame numbers count modulo this.
const FRAME_NUMBERS: u32 = 256;
/// How far motion is looked for, in samples. Turning moves the picture sideways, falling up and down.
const SEARCH: (i32, i32) = (64, 24);
/// Step of the coarse search.
const SEARCH_STEP: i32 = 4;

/// Place of the n-th 4 x 4 block in its macroblock, in samples (figure 6-10).
fn block_place(index: usize) -> (usize, usize) {
    ((index & 1) * 4 + (index >> 2 & 1) * 8, (index >> 1 & 1) * 4 + (index >> 3) * 8)
}

/// What later macroblocks need to know of one.
#[derive(Clone, Copy, Debug, Default)]
struct Coded {
    /// Motion, or `None` for an intra macroblock.
    motion: Option<(i32, i32)>,
    /// Numbers of coefficients of its luminance blocks, row after row.
    luma: [u8; 16],
    /// The same of its colour differences.
    chroma: [[u8; 4]; 2],
}

/// Residuals of a macroblock as levels, and how it looks when decoded.
struct Residual {
    luma_dc: Block,
    /// In the order of coding. In intra macroblocks without their first coefficients.
    luma: [Block; 16],
    chroma_dc: [[i32; 4]; 2],
    chroma: [[Block; 4]; 2],
    /// Quarters of the macroblock that have luminance levels, a bit each.
    luma_pattern: u8,
    /// 0: no colour-difference levels, 1: first coefficients only, 2: all.
    chroma_pattern: u8,
}

/// Encodes pictures one after the other.
pub(super) struct Encoder {
    width: usize,
    height: usize,
    frames_per_second: (u32, u32),
    quantiser: u8,
    source: Frame,
    /// The picture before as a decoder has it, and the one in the making.
    reference: Frame,
    decoded: Frame,
    coded: Vec<Coded>,
    frame_number: u32,
    key_number: u32,
}

impl Encoder {
    pub fn new(width: usize, height: usize, quantiser: u8, frames_per_second: (u32, u32)) -> Encoder {
        let frame = Frame::new(width, height);
        let macroblocks = frame.planes[0].samples.len() / 256;
        Encoder {
            width,
            height,
            frames_per_second,
            quantiser,
            source: frame.clone(),
            reference: frame.clone(),
            decoded: frame,
            coded: vec![Coded::default(); macroblocks],
            frame_number: 0,
            key_number: 0,
        }
    }

    /// Encodes a picture as one NAL unit. A key picture stands alone; the first one must be key.
    pub fn encode(&mut self, picture: &Picture, key: bool) -> Vec<u8> {
        self.source.fill(picture);
        if key {
            self.frame_number = 0;
            self.key_number = (self.key_number + 1) % 2;
        }
        let mut bits = BitWriter::default();
        self.slice_header(&mut bits, key);
        let (columns, rows) = (self.columns(), self.source.planes[0].height / 16);
        let mut skipped = 0;
        for row in 0..rows {
            for column in 0..columns {
                if key {
                    self.intra_macroblock(&mut bits, column, row, 0);
                } else {
                    self.inter_macroblock(&mut bits, column, row, &mut skipped);
                }
            }
        }
        if skipped > 0 {
            bits.unsigned(skipped);
        }
        std::mem::swap(&mut self.reference, &mut self.decoded);
        self.frame_number = (self.frame_number + 1) % FRAME_NUMBERS;
        nal_unit(if key { 0x65 } else { 0x61 }, &bits.finish())
    }

    /// The last picture as a decoder shows it.
    #[cfg(test)]
    pub fn shown(&self) -> &Frame {
        &self.reference
    }

    fn columns(&self) -> usize {
        self.source.planes[0].width / 16
    }

    /// The sequence parameter set (clause 7.3.2.1): Constrained Baseline, pictures in the order of coding, one reference.
    pub fn sequence_parameters(&self) -> Vec<u8> {
        let (columns, rows) = (self.columns(), self.source.planes[0].height / 16);
        let mut bits = BitWriter::default();
        bits.put(66, 8);
        bits.put(0b1100_0000, 8);
        bits.put(level(columns * rows, self.frames_per_second), 8);
        bits.unsigned(0); // id
        bits.unsigned(FRAME_NUMBERS.ilog2() - 4);
        bits.unsigned(2); // picture order is coding order
        bits.unsigned(1); // reference pictures
        bits.flag(false); // no gaps in frame numbers
        bits.unsigned(columns as u32 - 1);
        bits.unsigned(rows as u32 - 1);
        bits.flag(true); // frames, not fields
        bits.flag(true); // direct_8x8_inference, without effect here
        // Cropping counts in pairs of samples; an odd side shows one more column or row, a copy of the last.
        let (right, bottom) = ((columns * 16 - self.width) / 2, (rows * 16 - self.height) / 2);
        bits.flag(right + bottom > 0);
        if right + bottom > 0 {
            bits.unsigned(0);
            bits.unsigned(right as u32);
            bits.unsigned(0);
            bits.unsigned(bottom as u32);
        }
        bits.flag(true); // usability information (annex E)
        bits.flag(true); // aspect ratio
        bits.put(1, 8); // of square pixels
        bits.flag(false); // overscan
        bits.flag(true); // video signal type
        bits.put(5, 3); // unspecified format
        bits.flag(false); // video range
        bits.flag(true); // colour description:
        bits.put(1, 8); // primaries and
        bits.put(13, 8); // transfer of sRGB,
        bits.put(6, 8); // matrix of BT.601
        bits.flag(false); // chroma location
        bits.flag(true); // timing, in fields
        bits.put(self.frames_per_second.1, 32);
        bits.put(self.frames_per_second.0 * 2, 32);
        bits.flag(true); // constant rate
        bits.flag(false); // no buffering parameters
        bits.flag(false);
        bits.flag(false); // no picture structure
        bits.flag(false); // no bitstream restriction
        nal_unit(0x67, &bits.finish())
    }

    /// The picture parameter set (clause 7.3.2.2).
    pub fn picture_parameters(&self) -> Vec<u8> {
        let mut bits = BitWriter::default();
        bits.unsigned(0); // id
        bits.unsigned(0); // of the sequence
        bits.flag(false); // CAVLC
        bits.flag(false); // no bottom field order
        bits.unsigned(0); // one slice group
        bits.unsigned(0); // one reference
        bits.unsigned(0);
        bits.flag(false); // no weighted prediction
        bits.put(0, 2);
        bits.signed(i32::from(self.quantiser) - 26);
        bits.signed(0);
        bits.signed(0); // chroma quantiser as by the table
        bits.flag(true); // slices say whether they are deblocked
        bits.flag(false); // intra prediction from inter macroblocks is allowed
        bits.flag(false);
        nal_unit(0x68, &bits.finish())
    }

    fn slice_header(&self, bits: &mut BitWriter, key: bool) {
        bits.unsigned(0); // first macroblock
        bits.unsigned(if key { 7 } else { 5 });
        bits.unsigned(0); // picture parameters
        bits.put(self.frame_number, FRAME_NUMBERS.ilog2());
        if key {
            bits.unsigned(self.key_number);
            bits.flag(false); // pictures before are still shown
            bits.flag(false); // not a long-term reference
        } else {
            bits.flag(false); // as many references as usual
            bits.flag(false); // in the usual order
            bits.flag(false); // the oldest reference is dropped
        }
        bits.signed(0); // the usual quantiser
        bits.unsigned(1); // not deblocked: pixel art has its edges on purpose
    }

    fn inter_macroblock(&mut self, bits: &mut BitWriter, column: usize, row: usize, skipped: &mut u32) {
        let (x, y) = (16 * column, 16 * row);
        let source = self.source.planes[0].block::<16>(x, y);
        let (predicted, skip) = self.predicted_motion(column, row);
        let (motion, difference) = self.find_motion(&source, column, row, predicted, skip);
        let intra = Intra::usable(x, y)
            .map(|mode| absolute_difference(&source, &intra_luma(&self.decoded.planes[0], x, y, mode)))
            .min()
            .unwrap_or(u32::MAX);
        if intra + 64 < difference {
            bits.unsigned(*skipped);
            *skipped = 0;
            self.intra_macroblock(bits, column, row, 5);
            return;
        }
        let luma = moved::<16>(&self.reference.planes[0], x as isize + motion.0 as isize, y as isize + motion.1 as isize);
        let chroma = [1, 2].map(|plane| moved_chroma(&self.reference.planes[plane], x / 2, y / 2, motion));
        let residual = self.code(column, row, &luma, &chroma, false);
        let at = row * self.columns() + column;
        self.coded[at] = Coded { motion: Some(motion), ..Coded::default() };
        let pattern = residual.luma_pattern | residual.chroma_pattern << 4;
        if motion == skip && pattern == 0 {
            *skipped += 1;
            return;
        }
        bits.unsigned(*skipped);
        *skipped = 0;
        bits.unsigned(0); // one block of 16 x 16, from the picture before
        // Motion is counted in quarters of a sample.
        bits.signed(4 * (motion.0 - predicted.0));
        bits.signed(4 * (motion.1 - predicted.1));
        let number = INTER_PATTERNS.iter().position(|known| *known == pattern).expect("every pattern has a number");
        bits.unsigned(number as u32);
        if pattern != 0 {
            bits.signed(0); // the quantiser stays
            self.write_residual(bits, column, row, &residual, false);
        }
    }

    /// `offset`: what is added to the type in a slice that also has inter macroblocks.
    fn intra_macroblock(&mut self, bits: &mut BitWriter, column: usize, row: usize, offset: u32) {
        let (x, y) = (16 * column, 16 * row);
        let source = self.source.planes[0].block::<16>(x, y);
        let luma_plane = &self.decoded.planes[0];
        let mode = Intra::usable(x, y)
            .min_by_key(|mode| absolute_difference(&source, &intra_luma(luma_plane, x, y, *mode)))
            .unwrap_or(Intra::Mean);
        let luma = intra_luma(luma_plane, x, y, mode);
        let (cx, cy) = (x / 2, y / 2);
        let chroma_difference = |mode: &Intra| -> u32 {
            [1, 2]
                .map(|plane| {
                    let source = self.source.planes[plane].block::<8>(cx, cy);
                    absolute_difference(&source, &intra_chroma(&self.decoded.planes[plane], cx, cy, *mode))
                })
                .iter()
                .sum()
        };
        let chroma_mode = Intra::usable(x, y).min_by_key(chroma_difference).unwrap_or(Intra::Mean);
        let chroma = [1, 2].map(|plane| intra_chroma(&self.decoded.planes[plane], cx, cy, chroma_mode));
        let residual = self.code(column, row, &luma, &chroma, true);
        let at = row * self.columns() + column;
        self.coded[at] = Coded::default();
        let luma_type = if residual.luma_pattern == 0 { 0 } else { 12 };
        bits.unsigned(offset + 1 + mode.luma_number() + 4 * u32::from(residual.chroma_pattern) + luma_type);
        bits.unsigned(chroma_mode.chroma_number());
        bits.signed(0); // the quantiser stays
        self.write_residual(bits, column, row, &residual, true);
    }

    /// Transforms and quantises what a prediction leaves, and stores the macroblock as a decoder will have it.
    fn code(&mut self, column: usize, row: usize, luma: &[[u8; 16]; 16], chroma: &[[[u8; 8]; 8]; 2], intra: bool) -> Residual {
        let quantiser = Quantiser::new(self.quantiser, intra);
        let (x, y) = (16 * column, 16 * row);
        let mut residual = Residual {
            luma_dc: [0; 16],
            luma: [[0; 16]; 16],
            chroma_dc: [[0; 4]; 2],
            chroma: [[[0; 16]; 4]; 2],
            luma_pattern: 0,
            chroma_pattern: 0,
        };
        let source = self.source.planes[0].block::<16>(x, y);
        let mut dc = [0; 16];
        for (index, levels) in residual.luma.iter_mut().enumerate() {
            let (bx, by) = block_place(index);
            let mut coefficients = forward(&difference(&source, luma, bx, by));
            if intra {
                dc[by + bx / 4] = coefficients[0];
                coefficients[0] = 0;
            }
            *levels = quantiser.quantise(&coefficients);
            if levels.iter().any(|level| *level != 0) {
                residual.luma_pattern |= if intra { 15 } else { 1 << (index / 4) };
            }
        }
        let mut scaled_dc = [0; 16];
        if intra {
            residual.luma_dc = quantiser.quantise_luma_dc(&dc);
            scaled_dc = quantiser.scale_luma_dc(&residual.luma_dc);
        }
        let mut decoded = *luma;
        for (index, levels) in residual.luma.iter().enumerate() {
            let (bx, by) = block_place(index);
            let mut coefficients = quantiser.scale(levels);
            if intra {
                coefficients[0] = scaled_dc[by + bx / 4];
            }
            add(&mut decoded, &inverse(&coefficients), bx, by);
        }
        self.decoded.planes[0].set_block(x, y, &decoded);

        let quantiser = Quantiser::new(chroma_quantiser(self.quantiser), intra);
        for (part, predicted) in chroma.iter().enumerate() {
            let plane = part + 1;
            let source = self.source.planes[plane].block::<8>(x / 2, y / 2);
            let mut dc = [0; 4];
            for (index, levels) in residual.chroma[part].iter_mut().enumerate() {
                let mut coefficients = forward(&difference(&source, predicted, index % 2 * 4, index / 2 * 4));
                dc[index] = coefficients[0];
                coefficients[0] = 0;
                *levels = quantiser.quantise(&coefficients);
                if levels.iter().any(|level| *level != 0) {
                    residual.chroma_pattern = 2;
                }
            }
            residual.chroma_dc[part] = quantiser.quantise_chroma_dc(&dc);
            if residual.chroma_dc[part] != [0; 4] {
                residual.chroma_pattern = residual.chroma_pattern.max(1);
            }
            let scaled = quantiser.scale_chroma_dc(&residual.chroma_dc[part]);
            let mut decoded = *predicted;
            for (index, levels) in residual.chroma[part].iter().enumerate() {
                let mut coefficients = quantiser.scale(levels);
                coefficients[0] = scaled[index];
                add(&mut decoded, &inverse(&coefficients), index % 2 * 4, index / 2 * 4);
            }
            self.decoded.planes[plane].set_block(x / 2, y / 2, &decoded);
        }
        residual
    }

    /// Writes the levels that the macroblock's pattern promises (clause 7.3.5.3).
    fn write_residual(&mut self, bits: &mut BitWriter, column: usize, row: usize, residual: &Residual, intra: bool) {
        let at = row * self.columns() + column;
        if intra {
            let context = self.luma_context(column, row, 0, 0);
            write_levels(bits, &ZIGZAG.map(|k| residual.luma_dc[k]), context);
        }
        for (index, levels) in residual.luma.iter().enumerate() {
            if residual.luma_pattern & 1 << (index / 4) == 0 {
                continue;
            }
            let (bx, by) = block_place(index);
            let context = self.luma_context(column, row, bx / 4, by / 4);
            let ordered = ZIGZAG.map(|k| levels[k]);
            let count = write_levels(bits, if intra { &ordered[1..] } else { &ordered }, context);
            self.coded[at].luma[by + bx / 4] = count;
        }
        if residual.chroma_pattern > 0 {
            for dc in &residual.chroma_dc {
                write_levels(bits, dc, Context::ChromaDc);
            }
        }
        if residual.chroma_pattern == 2 {
            for part in 0..2 {
                for (index, levels) in residual.chroma[part].iter().enumerate() {
                    let context = self.chroma_context(column, row, part, index % 2, index / 2);
                    let count = write_levels(bits, &ZIGZAG.map(|k| levels[k])[1..], context);
                    self.coded[at].chroma[part][index] = count;
                }
            }
        }
    }

    /// The mean number of coefficients in the blocks to the left and above (clause 9.2.1).
    fn luma_context(&self, column: usize, row: usize, bx: usize, by: usize) -> Context {
        let count = |c: usize, r: usize| self.coded[r / 4 * self.columns() + c / 4].luma[r % 4 * 4 + c % 4];
        context(4 * column + bx, 4 * row + by, count)
    }

    fn chroma_context(&self, column: usize, row: usize, part: usize, bx: usize, by: usize) -> Context {
        let count = |c: usize, r: usize| self.coded[r / 2 * self.columns() + c / 2].chroma[part][r % 2 * 2 + c % 2];
        context(2 * column + bx, 2 * row + by, count)
    }

    /// Motion that the neighbours predict, and the motion of a skipped macroblock (clauses 8.4.1.1 and 8.4.1.3).
    fn predicted_motion(&self, column: usize, row: usize) -> ((i32, i32), (i32, i32)) {
        let columns = self.columns();
        let at = |c: usize, r: usize| self.coded[r * columns + c].motion;
        // Outer `None`: no such macroblock; inner `None`: intra.
        let left = (column > 0).then(|| at(column - 1, row));
        let above = (row > 0).then(|| at(column, row - 1));
        let corner = if row > 0 && column + 1 < columns {
            Some(at(column + 1, row - 1))
        } else if row > 0 && column > 0 {
            Some(at(column - 1, row - 1))
        } else {
            None
        };
        let predicted = if above.is_none() && corner.is_none() && left.is_some() {
            left.flatten().unwrap_or_default()
        } else {
            let all = [left.flatten(), above.flatten(), corner.flatten()];
            let mut moving = all.iter().flatten();
            match (moving.next(), moving.next()) {
                // If a single neighbour refers to a picture, its motion counts alone.
                (Some(only), None) => *only,
                _ => {
                    let [a, b, c] = all.map(Option::unwrap_or_default);
                    (median(a.0, b.0, c.0), median(a.1, b.1, c.1))
                }
            }
        };
        let still = |neighbour: Option<Option<(i32, i32)>>| neighbour.is_none_or(|motion| motion == Some((0, 0)));
        (predicted, if still(left) || still(above) { (0, 0) } else { predicted })
    }

    /// The motion that leaves the least, weighed with the bits that it takes itself; and what it leaves.
    fn find_motion(
        &self,
        source: &[[u8; 16]; 16],
        column: usize,
        row: usize,
        predicted: (i32, i32),
        skip: (i32, i32),
    ) -> ((i32, i32), u32) {
        let plane = &self.reference.planes[0];
        let (x, y) = (16 * column as i32, 16 * row as i32);
        let cost = |motion: (i32, i32)| {
            let bits = if motion == skip { 0 } else { code_length(motion.0 - predicted.0) + code_length(motion.1 - predicted.1) };
            difference_to_moved(source, plane, x + motion.0, y + motion.1) + 6 * bits
        };
        // What the neighbours did is the likeliest: most of a picture moves as one.
        let before = &self.coded[row * self.columns() + column];
        let mut candidates = vec![skip, predicted, (0, 0)];
        candidates.extend(before.motion);
        let mut best = (u32::MAX, (0, 0));
        for motion in candidates {
            best = best.min((cost(motion), motion));
        }
        // A coarse search only where that leaves much.
        if best.0 > 1024 {
            for dy in (-SEARCH.1..=SEARCH.1).step_by(SEARCH_STEP as usize) {
                for dx in (-SEARCH.0..=SEARCH.0).step_by(SEARCH_STEP as usize) {
                    best = best.min((cost((dx, dy)), (dx, dy)));
                }
            }
        }
        let mut step = SEARCH_STEP / 2;
        while step > 0 && best.0 > 128 {
            let middle = best.1;
            for (dx, dy) in [(-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (1, -1), (-1, 1), (1, 1)] {
                let motion = (middle.0 + dx * step, middle.1 + dy * step);
                if motion.0.abs() <= SEARCH.0 + 8 && motion.1.abs() <= SEARCH.1 + 8 {
                    best = best.min((cost(motion), motion));
                }
            }
            if best.1 == middle {
                step /= 2;
            }
        }
        best = (difference_to_moved(source, plane, x + best.1.0, y + best.1.1), best.1);
        (best.1, best.0)
    }
}

fn context(c: usize, r: usize, count: impl Fn(usize, usize) -> u8) -> Context {
    Context::Neighbours(match (c.checked_sub(1), r.checked_sub(1)) {
        (Some(left), Some(above)) => (count(left, r) + count(c, above)).div_ceil(2),
        (Some(left), None) => count(left, r),
        (None, Some(above)) => count(c, above),
        (None, None) => 0,
    })
}

fn median(a: i32, b: i32, c: i32) -> i32 {
    a.max(b).min(a.min(b).max(c))
}

/// Bits of a difference of motion, about.
fn code_length(difference: i32) -> u32 {
    2 * (32 - (8 * difference.unsigned_abs()).leading_zeros()) + 1
}

fn absolute_difference<const N: usize>(a: &[[u8; N]; N], b: &[[u8; N]; N]) -> u32 {
    a.iter().zip(b).map(|(a, b)| row_difference(a, b)).sum()
}

fn row_difference<const N: usize>(a: &[u8; N], b: &[u8; N]) -> u32 {
    a.iter().zip(b).map(|(a, b)| u32::from(a.abs_diff(*b))).sum()
}

fn difference_to_moved(source: &[[u8; 16]; 16], plane: &Plane, x: i32, y: i32) -> u32 {
    if x >= 0 && y >= 0 && x as usize + 16 <= plane.width && y as usize + 16 <= plane.height {
        let rows = source.iter().enumerate();
        rows.map(|(row, line)| {
            let at = (y as usize + row) * plane.width + x as usize;
            let other: &[u8; 16] = plane.samples[at..at + 16].try_into().expect("sixteen samples");
            row_difference(line, other)
        })
        .sum()
    } else {
        absolute_difference(source, &moved(plane, x as isize, y as isize))
    }
}

/// Residuals of the 4 x 4 block at (`x`, `y`) of a block.
fn difference<const N: usize>(source: &[[u8; N]; N], predicted: &[[u8; N]; N], x: usize, y: usize) -> Block {
    std::array::from_fn(|k| i32::from(source[y + k / 4][x + k % 4]) - i32::from(predicted[y + k / 4][x + k % 4]))
}

/// Adds residuals to the 4 x 4 block at (`x`, `y`) of a prediction.
fn add<const N: usize>(block: &mut [[u8; N]; N], residuals: &Block, x: usize, y: usize) {
    for (k, residual) in residuals.iter().enumerate() {
        let sample = &mut block[y + k / 4][x + k % 4];
        *sample = (i32::from(*sample) + residual).clamp(0, 255) as u8;
    }
}

/// The least level (table A-1) that holds a picture of so many macroblocks at so many frames a second.
fn level(macroblocks: usize, frames_per_second: (u32, u32)) -> u32 {
    let a_second = macroblocks as u64 * u64::from(frames_per_second.0) / u64::from(frames_per_second.1);
    const LEVELS: [(u32, usize, u64); 9] = [
        (21, 792, 19_800),
        (22, 1620, 20_250),
        (30, 1620, 40_500),
        (31, 3600, 108_000),
        (32, 5120, 216_000),
        (40, 8192, 245_760),
        (50, 22_080, 589_824),
        (51, 36_864, 983_040),
        (52, 36_864, 2_073_600),
    ];
    LEVELS.iter().find(|(_, picture, second)| macroblocks <= *picture && a_second <= *second).map_or(52, |(number, _, _)| *number)
}
