//! Pixels in memory.

use crate::MediaError;

/// Largest side of a picture: what GIF and JPEG-like formats can carry, and a bound on hostile
/// headers.
pub const MAX_SIDE: usize = 65_535;

/// Red, green and blue bytes, row after row.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Picture {
    width: usize,
    height: usize,
    rgb: Vec<u8>,
}

impl Picture {
    /// A picture of one colour.
    ///
    /// # Panics
    /// When a side is 0 or above 65,535: sizes are the caller's, never a file's.
    #[must_use]
    pub fn filled(width: usize, height: usize, colour: [u8; 3]) -> Picture {
        assert!(
            (1..=MAX_SIDE).contains(&width) && (1..=MAX_SIDE).contains(&height),
            "picture of {width}x{height}"
        );
        Picture { width, height, rgb: colour.repeat(width * height) }
    }

    /// A picture from interleaved red, green, blue bytes.
    ///
    /// # Errors
    /// When the number of bytes is not `width * height * 3` or a side is out of range.
    pub fn from_rgb(width: usize, height: usize, rgb: Vec<u8>) -> Result<Picture, MediaError> {
        if !(1..=MAX_SIDE).contains(&width)
            || !(1..=MAX_SIDE).contains(&height)
            || rgb.len() != width * height * 3
        {
            return Err(MediaError::Size(format!(
                "{} bytes are no picture of {width}x{height} in red, green, blue",
                rgb.len()
            )));
        }
        Ok(Picture { width, height, rgb })
    }

    /// A picture from one byte a pixel, black to white: depth, luminance.
    ///
    /// # Errors
    /// When the number of bytes is not `width * height` or a side is out of range.
    pub fn from_grey(width: usize, height: usize, grey: &[u8]) -> Result<Picture, MediaError> {
        Picture::from_rgb(width, height, grey.iter().flat_map(|&g| [g, g, g]).collect())
    }

    /// A picture from an observation of `channels` interleaved channels of which `first..first + 3`
    /// are red, green, blue.
    ///
    /// # Errors
    /// When there are fewer than `first + 3` channels or the number of bytes does not fit.
    pub fn from_channels(
        width: usize,
        height: usize,
        channels: usize,
        first: usize,
        bytes: &[u8],
    ) -> Result<Picture, MediaError> {
        if channels < first + 3 || bytes.len() != width * height * channels {
            return Err(MediaError::Size(format!(
                "{} bytes are no picture of {width}x{height}x{channels}",
                bytes.len()
            )));
        }
        Picture::from_rgb(
            width,
            height,
            bytes
                .chunks_exact(channels)
                .flat_map(|p| [p[first], p[first + 1], p[first + 2]])
                .collect(),
        )
    }

    /// Columns.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// The bytes.
    #[must_use]
    pub fn rgb(&self) -> &[u8] {
        &self.rgb
    }

    /// The colour at a pixel.
    #[must_use]
    pub fn get(&self, x: usize, y: usize) -> [u8; 3] {
        let at = (y * self.width + x) * 3;
        [self.rgb[at], self.rgb[at + 1], self.rgb[at + 2]]
    }

    /// Mixes a colour into a pixel: `share` 0 leaves it, 255 replaces it. Outside the picture
    /// nothing happens.
    pub fn blend(&mut self, x: isize, y: isize, colour: [u8; 3], share: u8) {
        if x < 0 || y < 0 || x as usize >= self.width || y as usize >= self.height {
            return;
        }
        let at = (y as usize * self.width + x as usize) * 3;
        for (byte, new) in self.rgb[at..at + 3].iter_mut().zip(colour) {
            *byte = ((u32::from(*byte) * (255 - u32::from(share))
                + u32::from(new) * u32::from(share)
                + 127)
                / 255) as u8;
        }
    }

    /// Fills the part of a rectangle that lies inside the picture.
    pub fn fill(&mut self, x: usize, y: usize, width: usize, height: usize, colour: [u8; 3]) {
        let right = x.saturating_add(width).min(self.width);
        for row in y..y.saturating_add(height).min(self.height) {
            for column in x..right {
                let at = (row * self.width + column) * 3;
                self.rgb[at..at + 3].copy_from_slice(&colour);
            }
        }
    }

    /// Copies another picture in, its upper left pixel at (`x`, `y`); what does not fit is left
    /// out.
    pub fn paste(&mut self, other: &Picture, x: usize, y: usize) {
        let columns = other.width.min(self.width.saturating_sub(x));
        for row in 0..other.height.min(self.height.saturating_sub(y)) {
            let to = ((y + row) * self.width + x) * 3;
            let from = row * other.width * 3;
            self.rgb[to..to + columns * 3].copy_from_slice(&other.rgb[from..from + columns * 3]);
        }
    }

    /// Every pixel as a square of `factor` x `factor`.
    #[must_use]
    pub fn enlarged(&self, factor: usize) -> Picture {
        let factor = factor.max(1);
        let (width, height) = (self.width * factor, self.height * factor);
        let mut rgb = Vec::with_capacity(width * height * 3);
        for row in self.rgb.chunks_exact(self.width * 3) {
            let start = rgb.len();
            for pixel in row.chunks_exact(3) {
                for _ in 0..factor {
                    rgb.extend_from_slice(pixel);
                }
            }
            for _ in 1..factor {
                rgb.extend_from_within(start..start + width * 3);
            }
        }
        Picture { width, height, rgb }
    }

    /// The picture in at most 255 colours, as near as they can be: its PNG file takes half the room
    /// or less.
    #[must_use]
    pub fn in_few_colours(&self) -> Picture {
        let few = crate::quantise::quantise(self);
        let rgb = few.indices.iter().flat_map(|&index| few.palette[usize::from(index)]).collect();
        Picture { width: self.width, height: self.height, rgb }
    }

    /// The picture in another size, each pixel taken from the nearest one: keeps the hard edges of
    /// pixel art.
    #[must_use]
    pub fn resized(&self, width: usize, height: usize) -> Picture {
        let (width, height) = (width.clamp(1, MAX_SIDE), height.clamp(1, MAX_SIDE));
        let mut rgb = Vec::with_capacity(width * height * 3);
        for y in 0..height {
            let from_y = (2 * y + 1) * self.height / (2 * height);
            for x in 0..width {
                rgb.extend_from_slice(&self.get((2 * x + 1) * self.width / (2 * width), from_y));
            }
        }
        Picture { width, height, rgb }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_checked() {
        assert!(Picture::from_rgb(2, 2, vec![0; 11]).is_err());
        assert!(Picture::from_rgb(0, 2, vec![]).is_err());
        assert!(Picture::from_channels(1, 1, 3, 1, &[1, 2, 3]).is_err());
        assert_eq!(Picture::from_channels(1, 1, 4, 0, &[1, 2, 3, 4]).unwrap().rgb(), [1, 2, 3]);
    }

    #[test]
    fn enlarging_and_resizing_by_a_whole_factor_agree() {
        let picture = Picture::from_rgb(3, 2, (0..18).map(|i| i * 10).collect()).unwrap();
        assert_eq!(picture.enlarged(3), picture.resized(9, 6));
        assert_eq!(picture.enlarged(3).resized(3, 2), picture);
    }

    #[test]
    fn few_colours_are_kept_and_many_become_few() {
        let few =
            Picture::from_grey(100, 2, &[0u8, 1].map(|_| (0..100).collect::<Vec<u8>>()).concat())
                .unwrap();
        assert_eq!(few.in_few_colours(), few);
        let many = Picture::from_rgb(
            32,
            32,
            (0..32 * 32 * 3).map(|i| (i / 3 * 7 + i % 3 * 31) as u8).collect(),
        )
        .unwrap();
        let colours = |picture: &Picture| {
            picture.rgb().chunks(3).collect::<std::collections::BTreeSet<_>>().len()
        };
        assert!(colours(&many.in_few_colours()) <= 255);
    }

    #[test]
    fn drawing_outside_is_cut() {
        let mut picture = Picture::filled(4, 4, [0; 3]);
        picture.fill(2, 2, 100, 100, [1; 3]);
        picture.paste(&Picture::filled(9, 9, [2; 3]), 3, 3);
        picture.blend(-1, 0, [9; 3], 255);
        picture.blend(0, 0, [100; 3], 128);
        assert_eq!(picture.get(2, 2), [1; 3]);
        assert_eq!(picture.get(3, 3), [2; 3]);
        assert_eq!(picture.get(0, 0), [50; 3]);
    }
}
