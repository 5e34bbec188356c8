//! Animated GIF.

mod lzw;

use crate::files::WholeFile;
use crate::quantise::{MAX_COLOURS, quantise};
use crate::{MediaError, Picture};
use std::path::{Path, PathBuf};

/// Writes an animation frame by frame. Only what changed since the frame before is stored.
pub struct GifWriter {
    path: PathBuf,
    encoder: gif::Encoder<WholeFile>,
    width: usize,
    height: usize,
    /// What a viewer sees after the last stored frame, empty before the first.
    shown: Vec<[u8; 3]>,
    /// The frame that waits to learn how long it stays.
    waiting: Option<gif::Frame<'static>>,
    /// Time at which the waiting frame begins and ends, in seconds.
    began: f64,
    ends: f64,
    /// How far a colour may be from the one that it stands for, of 255; 0 is exact.
    loss: u8,
}

/// How far colours may be off that [`write_within`] tries, one after the other.
const LOSSES: [u8; 10] = [0, 4, 8, 12, 16, 20, 26, 32, 40, 50];

/// Writes pictures of `seconds` each as an animation of at most so many bytes: as exact as that
/// allows. Gives how far colours are off, of 255.
///
/// # Errors
/// When there is no picture, their sizes differ, the file cannot be written, or even coarse colours
/// need more bytes.
pub fn write_within(
    path: &Path,
    pictures: &[Picture],
    seconds: f64,
    most_bytes: u64,
) -> Result<u8, MediaError> {
    let (width, height) = pictures.first().map_or((1, 1), |one| (one.width(), one.height()));
    for loss in LOSSES {
        let mut writer = GifWriter::create(path, width, height)?;
        writer.loss = loss;
        for picture in pictures {
            writer.push(picture, seconds)?;
        }
        let mut file = writer.finished()?;
        if file.written()? <= most_bytes {
            file.finish()?;
            return Ok(loss);
        }
    }
    Err(MediaError::Size(format!(
        "{}: no animation of {} pictures of {width}x{height} fits into {most_bytes} bytes; make it smaller or shorter",
        path.display(),
        pictures.len()
    )))
}

/// How different two colours look: the square of their distance, green counting most.
fn difference(a: [u8; 3], b: [u8; 3]) -> u32 {
    let square = |channel: usize| u32::from(a[channel].abs_diff(b[channel])).pow(2);
    (2 * square(0) + 4 * square(1) + square(2)) / 7
}

impl GifWriter {
    /// Begins an animation that plays for ever.
    ///
    /// # Errors
    /// When the file cannot be made or a side is 0 or above 65,535.
    pub fn create(path: &Path, width: usize, height: usize) -> Result<GifWriter, MediaError> {
        let (Ok(columns), Ok(rows)) = (u16::try_from(width), u16::try_from(height)) else {
            return Err(MediaError::Size(format!(
                "a GIF cannot be {width}x{height}; its sides end at 65535"
            )));
        };
        let failed =
            |e: gif::EncodingError| MediaError::io(path, "write", std::io::Error::other(e));
        let mut encoder =
            gif::Encoder::new(WholeFile::create(path)?, columns, rows, &[]).map_err(failed)?;
        encoder.set_repeat(gif::Repeat::Infinite).map_err(failed)?;
        Ok(GifWriter {
            path: path.to_owned(),
            encoder,
            width,
            height,
            shown: Vec::new(),
            waiting: None,
            began: 0.0,
            ends: 0.0,
            loss: 0,
        })
    }

    /// Adds a frame that stays for `seconds`. GIF counts hundredths, and viewers slow down anything
    /// below two: shorter frames are dropped where they must be, so that the animation as a whole
    /// keeps its time.
    ///
    /// # Errors
    /// When the frame's size differs from the first's or the file cannot be written.
    pub fn push(&mut self, picture: &Picture, seconds: f64) -> Result<(), MediaError> {
        if (picture.width(), picture.height()) != (self.width, self.height) {
            return Err(MediaError::Size(format!(
                "a frame of {}x{} in an animation of {}x{}",
                picture.width(),
                picture.height(),
                self.width,
                self.height
            )));
        }
        let begins = self.ends;
        self.ends += seconds.max(0.0);
        if self.waiting.is_some() && hundredths(begins) - hundredths(self.began) < 2 {
            return Ok(());
        }
        let Some(frame) = self.changed_part(picture) else { return Ok(()) };
        self.store_waiting(begins)?;
        self.waiting = Some(frame);
        self.began = begins;
        Ok(())
    }

    /// Ends the file and puts it in its place.
    ///
    /// # Errors
    /// When there was no frame or the file cannot be written.
    pub fn finish(self) -> Result<(), MediaError> {
        self.finished()?.finish()
    }

    /// The whole animation, in a file that is not in its place yet.
    fn finished(mut self) -> Result<WholeFile, MediaError> {
        if self.waiting.is_none() {
            return Err(MediaError::Size(format!(
                "{}: an animation needs at least one frame",
                self.path.display()
            )));
        }
        let ends = self.ends;
        self.store_waiting(ends)?;
        self.encoder
            .into_inner()
            .map_err(|e| MediaError::io(&self.path, "write", std::io::Error::other(e)))
    }

    /// Writes the waiting frame, which ends at `until`.
    fn store_waiting(&mut self, until: f64) -> Result<(), MediaError> {
        if let Some(mut frame) = self.waiting.take() {
            frame.delay =
                (hundredths(until) - hundredths(self.began)).clamp(2, i64::from(u16::MAX)) as u16;
            let written = match self.loss {
                0 => self.encoder.write_frame(&frame),
                _ => self.encoder.write_lzw_pre_encoded_frame(&frame),
            };
            written.map_err(|e| MediaError::io(&self.path, "write", std::io::Error::other(e)))?;
        }
        Ok(())
    }

    /// The smallest rectangle around the pixels that differ from what is shown; `None` if none
    /// does.
    fn changed_part(&mut self, picture: &Picture) -> Option<gif::Frame<'static>> {
        let quantised = quantise(picture);
        let colour = |at: usize| quantised.palette[usize::from(quantised.indices[at])];
        let first = self.shown.is_empty();
        let most = u32::from(self.loss).pow(2);
        let stays = |at: usize, shown: &[[u8; 3]]| difference(colour(at), shown[at]) <= most;
        let (mut left, mut right, mut top, mut bottom) = (self.width, 0, self.height, 0);
        if first {
            (left, right, top, bottom) = (0, self.width, 0, self.height);
        } else {
            for y in 0..self.height {
                for x in 0..self.width {
                    if !stays(y * self.width + x, &self.shown) {
                        (left, right) = (left.min(x), right.max(x + 1));
                        (top, bottom) = (top.min(y), y + 1);
                    }
                }
            }
            if right == 0 {
                return None;
            }
        }
        let unchanged = MAX_COLOURS as u8;
        let mut buffer = Vec::with_capacity((right - left) * (bottom - top));
        for y in top..bottom {
            for at in y * self.width + left..y * self.width + right {
                buffer.push(if !first && stays(at, &self.shown) {
                    unchanged
                } else {
                    quantised.indices[at]
                });
            }
        }
        if first {
            self.shown.extend((0..self.width * self.height).map(colour));
        }
        let part = right - left;
        let place = |k: usize| (top + k / part) * self.width + left + k % part;
        if most > 0 {
            let shown = &self.shown;
            let seen = |symbol: u8, at: usize| match symbol {
                same if same == unchanged => (!first).then_some(shown[at]),
                index => quantised.palette.get(usize::from(index)).copied(),
            };
            let mut symbols = std::mem::take(&mut buffer);
            buffer = lzw::encode(&mut symbols, |k, symbol| {
                let at = place(k);
                let off = difference(seen(symbol, at)?, colour(at));
                (off <= most).then_some(off)
            });
            for (k, symbol) in symbols.into_iter().enumerate() {
                if symbol != unchanged {
                    self.shown[place(k)] = quantised.palette[usize::from(symbol)];
                }
            }
        } else {
            self.shown = (0..self.width * self.height).map(colour).collect();
        }
        let mut palette = quantised.palette.concat();
        palette.resize((MAX_COLOURS + 1) * 3, 0);
        Some(gif::Frame {
            left: left as u16,
            top: top as u16,
            width: (right - left) as u16,
            height: (bottom - top) as u16,
            transparent: Some(unchanged),
            dispose: gif::DisposalMethod::Keep,
            palette: Some(palette),
            buffer: buffer.into(),
            ..gif::Frame::default()
        })
    }
}

fn hundredths(seconds: f64) -> i64 {
    (seconds * 100.0).round() as i64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Plays a GIF back: (hundredths at which it appears, pixels).
    fn play(path: &Path) -> (Vec<(u32, Vec<u8>)>, u32) {
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(std::fs::File::open(path).unwrap()).unwrap();
        let width = usize::from(decoder.width());
        let mut shown = vec![0u8; width * usize::from(decoder.height()) * 3];
        let mut time = 0;
        let mut frames = Vec::new();
        while let Some(frame) = decoder.read_next_frame().unwrap() {
            for (i, p) in frame.buffer.chunks_exact(4).enumerate() {
                if p[3] != 0 {
                    let x = usize::from(frame.left) + i % usize::from(frame.width);
                    let y = usize::from(frame.top) + i / usize::from(frame.width);
                    shown[(y * width + x) * 3..][..3].copy_from_slice(&p[..3]);
                }
            }
            frames.push((time, shown.clone()));
            time += u32::from(frame.delay);
        }
        (frames, time)
    }

    #[test]
    fn plays_back_pixel_for_pixel_in_time() {
        let path = std::env::temp_dir().join(format!("hasard-{}-plays.gif", std::process::id()));
        let mut pictures = Vec::new();
        for k in 0..7 {
            let mut picture = Picture::filled(40, 30, [10, 20, 30]);
            picture.fill(k * 4, k * 2, 9, 9, [200, k as u8 * 30, 0]);
            pictures.push(picture);
        }
        let mut writer = GifWriter::create(&path, 40, 30).unwrap();
        for picture in &pictures {
            // Twice the same: the second only prolongs the first. 35 / 4 pictures a second, as
            // policies act.
            writer.push(picture, 2.0 / 35.0).unwrap();
            writer.push(picture, 2.0 / 35.0).unwrap();
        }
        assert!(writer.push(&Picture::filled(41, 30, [0; 3]), 0.1).is_err());
        writer.finish().unwrap();
        let (frames, time) = play(&path);
        assert_eq!(frames.len(), 7);
        assert_eq!(time, 80);
        for (k, (at, pixels)) in frames.iter().enumerate() {
            assert_eq!(*at, (k as f64 * 400.0 / 35.0).round() as u32);
            assert_eq!(pixels, pictures[k].rgb());
        }
        std::fs::remove_file(path).unwrap();
    }

    /// Noise that moves: what a small file is hard to make of.
    fn noise() -> Vec<Picture> {
        let mut state = 1u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 24) as u8 / 4
        };
        let pictures = (0..6).map(|k: u8| {
            let bytes = (0..50 * 40).flat_map(|_| [next(), 90 + next(), k * 20]).collect();
            Picture::from_rgb(50, 40, bytes).unwrap()
        });
        pictures.collect()
    }

    #[test]
    fn a_smaller_file_is_off_by_no_more_than_it_says() {
        let path = std::env::temp_dir().join(format!("hasard-{}-within.gif", std::process::id()));
        let pictures = noise();
        assert_eq!(write_within(&path, &pictures, 0.1, 1 << 20).unwrap(), 0);
        let whole = std::fs::metadata(&path).unwrap().len();
        let loss = write_within(&path, &pictures, 0.1, whole * 7 / 10).unwrap();
        assert!(loss > 0);
        assert!(std::fs::metadata(&path).unwrap().len() <= whole * 7 / 10);
        let (frames, time) = play(&path);
        assert_eq!((frames.len(), time), (6, 60));
        for ((_, pixels), picture) in frames.iter().zip(&pictures) {
            let few = picture.in_few_colours();
            for (seen, wanted) in pixels.chunks(3).zip(few.rgb().chunks(3)) {
                let off = difference(seen.try_into().unwrap(), wanted.try_into().unwrap());
                assert!(off <= u32::from(loss).pow(2), "{seen:?} for {wanted:?}");
            }
        }
        // What does not fit leaves what was there.
        let before = std::fs::read(&path).unwrap();
        let error = write_within(&path, &pictures, 0.1, 100).unwrap_err().to_string();
        assert!(error.contains("fits into 100 bytes"), "{error}");
        assert_eq!(std::fs::read(&path).unwrap(), before);
        std::fs::remove_file(&path).unwrap();
        assert!(write_within(&path, &[], 0.1, 100).is_err());
    }

    #[test]
    fn too_many_frames_a_second_keep_the_time() {
        let path = std::env::temp_dir().join(format!("hasard-{}-fast.gif", std::process::id()));
        let mut writer = GifWriter::create(&path, 2, 2).unwrap();
        for k in 0..100u8 {
            writer.push(&Picture::filled(2, 2, [k, 0, 0]), 0.01).unwrap();
        }
        writer.finish().unwrap();
        let (frames, time) = play(&path);
        assert_eq!((frames.len(), time), (50, 100));
        std::fs::remove_file(path).unwrap();
    }

    #[test]
    fn an_empty_animation_is_an_error_and_leaves_no_file() {
        let path = std::env::temp_dir().join(format!("hasard-{}-empty.gif", std::process::id()));
        let error = GifWriter::create(&path, 2, 2).unwrap().finish().unwrap_err().to_string();
        assert!(error.contains("at least one frame"), "{error}");
        assert!(!path.exists());
        assert!(GifWriter::create(&path, 70_000, 2).is_err());
    }
}
