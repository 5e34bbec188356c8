//! MP4 video: H.264 by `rusty_h264-encoder`, put into its container by `muxide`.
//!
//! Both are Rust alone: they build wherever the rest does. `docs/tried/video_encoders.md` compares them with others.

use crate::files::WholeFile;
use crate::{MediaError, Picture};
use muxide::api::{Muxer, MuxerBuilder, VideoCodec};
use rusty_h264_common::YuvFrame;
use rusty_h264_encoder::{Encoder, EncoderConfig, Preset};
use std::path::{Path, PathBuf};

/// Most frames between pictures that stand alone, where players can jump to.
const KEY_INTERVAL: u32 = 140;
/// Bits a pixel that the encoder aims at: 60 seconds of 320x258 at 35 frames a second are below 3 MB.
const BITS_A_PIXEL: f64 = 0.132;
/// Quantiser that the search for that rate begins with.
const QUANTISER: u8 = 32;
/// Largest side in pixels: what level 5.1 of the standard holds in a square.
const MAX_SIDE: usize = 3072;

/// Writes an MP4 frame by frame.
pub(crate) struct VideoWriter {
    path: PathBuf,
    encoder: Encoder,
    muxer: Muxer<WholeFile>,
    frame: YuvFrame,
    width: usize,
    height: usize,
    /// Seconds of a frame.
    seconds: f64,
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
        let rate = f64::from(frames) / f64::from(seconds);
        // Colour is stored for squares of 2 x 2 pixels: an odd side shows one more column or row, a copy of the last.
        let frame = YuvFrame::black(width.next_multiple_of(2), height.next_multiple_of(2));
        let config = EncoderConfig {
            level_idc: level(width.div_ceil(16) * height.div_ceil(16), rate),
            qp: QUANTISER,
            gop_size: KEY_INTERVAL,
            bitrate: ((frame.width * frame.height) as f64 * rate * BITS_A_PIXEL) as u32,
            framerate: rate as f32,
            preset: Preset::Balanced,
            ..EncoderConfig::new(frame.width, frame.height)
        };
        let refused = |e: String| MediaError::Size(format!("no video of {width}x{height} can be encoded: {e}"));
        let encoder = Encoder::new(config).map_err(|e| refused(e.to_string()))?;
        let muxer = MuxerBuilder::new(WholeFile::create(path)?)
            .video(VideoCodec::H264, frame.width as u32, frame.height as u32, rate)
            .build()
            .map_err(|e| refused(e.to_string()))?;
        Ok(VideoWriter { path: path.to_owned(), encoder, muxer, frame, width, height, seconds: 1.0 / rate, frames: 0 })
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
        fill(&mut self.frame, picture);
        let failed = |e: String| MediaError::io(&self.path, "write", std::io::Error::other(e));
        // Steered to a rate, the encoder holds nothing back: a picture in is a picture out.
        let unit = self.encoder.try_encode(&self.frame).map_err(|e| failed(e.to_string()))?;
        let time = f64::from(self.frames) * self.seconds;
        self.muxer.write_video(time, &unit, stands_alone(&unit)).map_err(|e| failed(e.to_string()))?;
        self.frames += 1;
        Ok(())
    }

    /// Ends the file and puts it in its place.
    ///
    /// # Errors
    /// When there was no frame or the file cannot be written.
    pub fn finish(mut self) -> Result<(), MediaError> {
        if self.frames == 0 {
            return Err(MediaError::Size(format!("{}: a video needs at least one frame", self.path.display())));
        }
        let failed = |e: String| MediaError::io(&self.path, "write", std::io::Error::other(e));
        self.muxer.finish_in_place().map_err(|e| failed(e.to_string()))?;
        self.muxer.into_writer().finish()
    }
}

/// Whether coded bytes hold an IDR picture (NAL unit type 5).
fn stands_alone(unit: &[u8]) -> bool {
    unit.windows(4).any(|bytes| bytes[..3] == [0, 0, 1] && bytes[3] & 31 == 5)
}

/// Converts a picture (ITU-R BT.601, video range, in 16.16 fixed point).
fn fill(frame: &mut YuvFrame, picture: &Picture) {
    let (last_x, last_y) = (picture.width() - 1, picture.height() - 1);
    for (y, row) in frame.y.chunks_exact_mut(frame.width).enumerate() {
        for (x, luma) in row.iter_mut().enumerate() {
            let [r, g, b] = picture.get(x.min(last_x), y.min(last_y)).map(i32::from);
            *luma = (((16_829 * r + 33_039 * g + 6_416 * b + (1 << 15)) >> 16) + 16) as u8;
        }
    }
    let half = frame.width / 2;
    for (at, (blue, red)) in frame.u.iter_mut().zip(&mut frame.v).enumerate() {
        let (x, y) = (at % half * 2, at / half * 2);
        let mut sum = [0i32; 3];
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let pixel = picture.get((x + dx).min(last_x), (y + dy).min(last_y));
            sum.iter_mut().zip(pixel).for_each(|(sum, value)| *sum += i32::from(value));
        }
        // Sums of four pixels: two bits more to shift away.
        let [r, g, b] = sum;
        *blue = (((-9_714 * r - 19_070 * g + 28_784 * b + (1 << 17)) >> 18) + 128) as u8;
        *red = (((28_784 * r - 24_103 * g - 4_681 * b + (1 << 17)) >> 18) + 128) as u8;
    }
}

/// The least level (ITU-T H.264, table A-1) that holds a picture of so many macroblocks at so many frames a second.
fn level(macroblocks: usize, rate: f64) -> u8 {
    const LEVELS: [(u8, usize, f64); 7] = [
        (30, 1620, 40_500.0),
        (31, 3600, 108_000.0),
        (32, 5120, 216_000.0),
        (40, 8192, 245_760.0),
        (50, 22_080, 589_824.0),
        (51, 36_864, 983_040.0),
        (52, 36_864, 2_073_600.0),
    ];
    let fits = |(_, picture, second): &&(u8, usize, f64)| macroblocks <= *picture && macroblocks as f64 * rate <= *second;
    LEVELS.iter().find(fits).map_or(52, |(number, _, _)| *number)
}

#[cfg(test)]
mod tests;
