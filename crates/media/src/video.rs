//! MP4 video: H.264 by `rusty_h264-encoder`, put into its container by `muxide`.
//!
//! Both are Rust alone: they build wherever the rest does. `docs/tried/video_encoders.md` compares
//! them with others. The quantiser is constant: a flash or a cut costs bytes, never the pictures
//! after it.

mod segments;

use crate::files::WholeFile;
use crate::{MediaError, Picture, Quality};
use muxide::api::{Muxer, MuxerBuilder, VideoCodec};
use rusty_h264_common::YuvFrame;
use rusty_h264_encoder::{EncoderConfig, Preset};
use segments::{Segments, Unit};
use std::path::{Path, PathBuf};

/// Largest side in pixels: what level 5.1 of the standard holds in a square.
const MAX_SIDE: usize = 3072;

/// Refuses a film that is too large, whatever its format.
pub(crate) fn check_size(width: usize, height: usize) -> Result<(), MediaError> {
    if (1..=MAX_SIDE).contains(&width) && (1..=MAX_SIDE).contains(&height) {
        return Ok(());
    }
    Err(MediaError::Size(format!(
        "a film cannot be {width}x{height}; its sides are 1 to {MAX_SIDE}: give a smaller size, or fewer views beside it"
    )))
}

/// Writes an MP4 frame by frame.
pub(crate) struct VideoWriter {
    path: PathBuf,
    segments: Segments,
    muxer: Muxer<WholeFile>,
    width: usize,
    height: usize,
    /// Seconds of a frame.
    seconds: f64,
    /// Frames taken, and those that are in the file.
    frames: u32,
    written: u32,
}

impl VideoWriter {
    /// Begins a video of `frames_per_second.0 / frames_per_second.1` frames a second: (35, 4) for a
    /// policy's steps.
    ///
    /// # Errors
    /// When the file cannot be made, a side is 0 or above 3072, or the rate is not between 1/10
    /// and 1000.
    pub fn create(
        path: &Path,
        width: usize,
        height: usize,
        frames_per_second: (u32, u32),
        quality: Quality,
    ) -> Result<VideoWriter, MediaError> {
        check_size(width, height)?;
        let (frames, seconds) = frames_per_second;
        if frames == 0
            || seconds == 0
            || frames > 1000 * seconds.min(1000)
            || seconds > 10 * frames.min(1000)
        {
            return Err(MediaError::Size(format!(
                "a video cannot have {frames}/{seconds} frames a second; give 1/10 to 1000"
            )));
        }
        let rate = f64::from(frames) / f64::from(seconds);
        // Colour is stored for squares of 2 x 2 pixels: an odd side shows one more column or row, a
        // copy of the last.
        let (even_width, even_height) = (width.next_multiple_of(2), height.next_multiple_of(2));
        let config = EncoderConfig {
            level_idc: level(width.div_ceil(16) * height.div_ceil(16), rate),
            qp: quality.quantiser(),
            // Stretches that stand alone are cut by `segments`, not by the encoder.
            gop_size: u32::MAX,
            framerate: rate as f32,
            preset: Preset::Balanced,
            // Without arithmetic coding and what goes with it: an eighth more bytes in a quarter of
            // the time.
            ..EncoderConfig::baseline(even_width, even_height)
        };
        let refused = |e: String| {
            MediaError::Size(format!("no video of {width}x{height} can be encoded: {e}"))
        };
        let segments = Segments::new(config).map_err(refused)?;
        let muxer = MuxerBuilder::new(WholeFile::create(path)?)
            .video(VideoCodec::H264, even_width as u32, even_height as u32, rate)
            .build()
            .map_err(|e| refused(e.to_string()))?;
        Ok(VideoWriter {
            path: path.to_owned(),
            segments,
            muxer,
            width,
            height,
            seconds: 1.0 / rate,
            frames: 0,
            written: 0,
        })
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
        let mut frame =
            YuvFrame::black(self.width.next_multiple_of(2), self.height.next_multiple_of(2));
        fill(&mut frame, picture);
        self.frames += 1;
        let coded = self.segments.push(frame).map_err(|e| self.failed(e))?;
        self.write(&coded)
    }

    fn failed(&self, problem: String) -> MediaError {
        MediaError::io(&self.path, "write", std::io::Error::other(problem))
    }

    fn write(&mut self, coded: &[Unit]) -> Result<(), MediaError> {
        for (unit, stands_alone) in coded {
            let time = f64::from(self.written) * self.seconds;
            self.muxer
                .write_video(time, unit, *stands_alone)
                .map_err(|e| self.failed(e.to_string()))?;
            self.written += 1;
        }
        Ok(())
    }

    /// Ends the file and puts it in its place.
    ///
    /// # Errors
    /// When there was no frame or the file cannot be written.
    pub fn finish(mut self) -> Result<(), MediaError> {
        if self.frames == 0 {
            return Err(MediaError::Size(format!(
                "{}: a video needs at least one frame",
                self.path.display()
            )));
        }
        let coded = self.segments.finish().map_err(|e| self.failed(e))?;
        self.write(&coded)?;
        let failed = |e: String| MediaError::io(&self.path, "write", std::io::Error::other(e));
        self.muxer.finish_in_place().map_err(|e| failed(e.to_string()))?;
        self.muxer.into_writer().finish()
    }
}

/// Converts a picture (ITU-R BT.601, video range, in 16.16 fixed point).
fn fill(frame: &mut YuvFrame, picture: &Picture) {
    let (width, last_y) = (picture.width(), picture.height() - 1);
    let line = |y: usize| -> &[[u8; 3]] {
        picture.rgb()[y.min(last_y) * width * 3..][..width * 3].as_chunks().0
    };
    for (y, row) in frame.y.chunks_exact_mut(frame.width).enumerate() {
        for (luma, pixel) in row.iter_mut().zip(line(y)) {
            let [r, g, b] = pixel.map(i32::from);
            *luma = (((16_829 * r + 33_039 * g + 6_416 * b + (1 << 15)) >> 16) + 16) as u8;
        }
        let last = row[width - 1];
        row[width..].fill(last);
    }
    let half = frame.width / 2;
    let rows = frame.u.chunks_exact_mut(half).zip(frame.v.chunks_exact_mut(half));
    for (y, (blues, reds)) in rows.enumerate() {
        let (above, below) = (line(2 * y), line(2 * y + 1));
        for (x, (blue, red)) in blues.iter_mut().zip(reds).enumerate() {
            let (left, right) = (2 * x, (2 * x + 1).min(width - 1));
            let [r, g, b] = [0, 1, 2].map(|k| {
                [above[left], above[right], below[left], below[right]]
                    .map(|pixel| i32::from(pixel[k]))
                    .iter()
                    .sum::<i32>()
            });
            // Sums of four pixels: two bits more to shift away.
            *blue = (((-9_714 * r - 19_070 * g + 28_784 * b + (1 << 17)) >> 18) + 128) as u8;
            *red = (((28_784 * r - 24_103 * g - 4_681 * b + (1 << 17)) >> 18) + 128) as u8;
        }
    }
}

/// The least level (ITU-T H.264, table A-1) that holds a picture of so many macroblocks at so many
/// frames a second.
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
    let fits = |(_, picture, second): &&(u8, usize, f64)| {
        macroblocks <= *picture && macroblocks as f64 * rate <= *second
    };
    LEVELS.iter().find(fits).map_or(52, |(number, _, _)| *number)
}

#[cfg(test)]
mod tests;
