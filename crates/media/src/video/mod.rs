//! Video that plays nearly everywhere: H.264 in MP4.
//!
//! Why this and why our own encoder: browsers, phones, office programs and video players all play H.264 of the
//! Constrained Baseline profile, while motion JPEG and AV1 are refused by many of them; the encoders to be had as crates
//! are either bindings to large C or C++ sources or store pixels uncompressed. Frames of a game have hard edges and move
//! as blocks, so a small encoder serves: whole-pixel motion of 16 x 16 blocks, plain intra prediction, one quality. What it
//! leaves out (deblocking, finer motion, rate control) costs bits, not compatibility.
//!
//! | module | what it holds |
//! |---|---|
//! | `bits` | bit strings, Exp-Golomb codes, the byte stuffing of NAL units |
//! | `plane` | luminance and colour-difference planes |
//! | `transform` | the 4 x 4 integer transform and its quantisation |
//! | `cavlc`, `tables` | coding of coefficients |
//! | `predict` | intra prediction and motion compensation |
//! | `encoder` | macroblocks, slices, parameter sets |
//! | `container` | the MP4 file |
//!
//! All arithmetic is on integers: same frames, same bytes. Terms and numbers of clauses are those of ITU-T H.264.

mod bits;
mod cavlc;
mod container;
mod encoder;
mod plane;
mod predict;
mod tables;
mod transform;

use crate::{MediaError, Picture};
use container::Mp4Writer;
use encoder::Encoder;
use std::path::Path;

/// Frames between pictures that stand alone, where players can jump to.
const KEY_INTERVAL: u32 = 140;
/// Quantiser of all pictures, 0 finest to 51: visually clean pixel art.
const QUANTISER: u8 = 22;
/// Largest side in pixels: what level 5.1 of the standard holds in a square.
const MAX_SIDE: usize = 3072;

/// Writes an MP4 frame by frame.
pub struct VideoWriter {
    encoder: Encoder,
    container: Mp4Writer,
    width: usize,
    height: usize,
    frames: u32,
}

impl VideoWriter {
    /// Begins a video of `frames_per_second.0 / frames_per_second.1` frames a second: (35, 4) for a policy's steps.
    ///
    /// # Errors
    /// When the file cannot be made, a side is 0 or above 3072, or the rate is not between 1/10 and 1000.
    pub fn create(path: &Path, width: usize, height: usize, frames_per_second: (u32, u32)) -> Result<VideoWriter, MediaError> {
        if !(1..=MAX_SIDE).contains(&width) || !(1..=MAX_SIDE).contains(&height) {
            return Err(MediaError::Size(format!("a video cannot be {width}x{height}; its sides are 1 to {MAX_SIDE}")));
        }
        let (frames, seconds) = frames_per_second;
        if frames == 0 || seconds == 0 || frames > 1000 * seconds.min(1000) || seconds > 10 * frames.min(1000) {
            return Err(MediaError::Size(format!("a video cannot have {frames}/{seconds} frames a second; give 1/10 to 1000")));
        }
        let encoder = Encoder::new(width, height, QUANTISER, frames_per_second);
        let container = Mp4Writer::create(path, width, height, frames_per_second)?;
        Ok(VideoWriter { encoder, container, width, height, frames: 0 })
    }

    /// Adds a frame.
    ///
    /// # Errors
    /// When its size differs from the video's or the file cannot be written.
    pub fn push(&mut self, picture: &Picture) -> Result<(), MediaError> {
        if (picture.width(), picture.height()) != (self.width, self.height) {
            return Err(MediaError::Size(format!(
                "a frame of {}x{} in a video of {}x{}",
                picture.width(),
                picture.height(),
                self.width,
                self.height
            )));
        }
        let key = self.frames.is_multiple_of(KEY_INTERVAL);
        let unit = self.encoder.encode(picture, key);
        self.frames += 1;
        self.container.push(&unit, key)
    }

    /// Ends the file and puts it in its place.
    ///
    /// # Errors
    /// When there was no frame or the file cannot be written.
    pub fn finish(self) -> Result<(), MediaError> {
        self.container.finish(&self.encoder.sequence_parameters(), &self.encoder.picture_parameters())
    }
}

#[cfg(test)]
mod tests;
