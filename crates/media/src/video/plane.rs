//! Luminance and colour-difference planes.

use crate::Picture;

/// One component of a picture, padded to whole macroblocks.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Plane {
    pub width: usize,
    pub height: usize,
    pub samples: Vec<u8>,
}

impl Plane {
    pub fn new(width: usize, height: usize) -> Plane {
        Plane { width, height, samples: vec![0; width * height] }
    }

    /// A square block.
    pub fn block<const N: usize>(&self, x: usize, y: usize) -> [[u8; N]; N] {
        let mut block = [[0; N]; N];
        for (row, line) in block.iter_mut().enumerate() {
            line.copy_from_slice(&self.samples[(y + row) * self.width + x..][..N]);
        }
        block
    }

    /// Stores a square block.
    pub fn set_block<const N: usize>(&mut self, x: usize, y: usize, block: &[[u8; N]; N]) {
        for (row, line) in block.iter().enumerate() {
            self.samples[(y + row) * self.width + x..][..N].copy_from_slice(line);
        }
    }
}

/// Luminance, blue difference, red difference; the latter two at half the width and height.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Frame {
    pub planes: [Plane; 3],
}

impl Frame {
    /// A frame for pictures of a size, sides rounded up to whole macroblocks.
    pub fn new(width: usize, height: usize) -> Frame {
        let (w, h) = (width.next_multiple_of(16), height.next_multiple_of(16));
        Frame { planes: [Plane::new(w, h), Plane::new(w / 2, h / 2), Plane::new(w / 2, h / 2)] }
    }

    /// Converts a picture (ITU-R BT.601, video range, in 16.16 fixed point). Beyond the picture's edge its last row and
    /// column go on.
    pub fn fill(&mut self, picture: &Picture) {
        let [luma, blue, red] = &mut self.planes;
        let (last_x, last_y) = (picture.width() - 1, picture.height() - 1);
        for y in 0..luma.height {
            for x in 0..luma.width {
                let [r, g, b] = picture.get(x.min(last_x), y.min(last_y)).map(i32::from);
                luma.samples[y * luma.width + x] = (((16_829 * r + 33_039 * g + 6_416 * b + (1 << 15)) >> 16) + 16) as u8;
            }
        }
        for y in 0..blue.height {
            for x in 0..blue.width {
                let mut sum = [0i32; 3];
                for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    let pixel = picture.get((2 * x + dx).min(last_x), (2 * y + dy).min(last_y));
                    for (sum, value) in sum.iter_mut().zip(pixel) {
                        *sum += i32::from(value);
                    }
                }
                // Sums of four pixels: two bits more to shift away.
                let [r, g, b] = sum;
                let at = y * blue.width + x;
                blue.samples[at] = (((-9_714 * r - 19_070 * g + 28_784 * b + (1 << 17)) >> 18) + 128) as u8;
                red.samples[at] = (((28_784 * r - 24_103 * g - 4_681 * b + (1 << 17)) >> 18) + 128) as u8;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_black_and_pure_colours() {
        for (colour, expected) in [
            ([0, 0, 0], [16, 128, 128]),
            ([255, 255, 255], [235, 128, 128]),
            ([255, 0, 0], [81, 90, 240]),
            ([0, 255, 0], [145, 54, 34]),
            ([0, 0, 255], [41, 240, 110]),
        ] {
            let mut frame = Frame::new(2, 2);
            frame.fill(&Picture::filled(2, 2, colour));
            assert_eq!(frame.planes.clone().map(|plane| plane.samples[0]), expected, "{colour:?}");
            // The edge goes on into the padding.
            assert_eq!(frame.planes.map(|plane| *plane.samples.last().unwrap()), expected);
        }
    }
}
