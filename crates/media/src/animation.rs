//! A moving picture in the format that its file's name asks for.

use crate::gif::GifWriter;
use crate::video::{VideoWriter, check_size};
use crate::{MediaError, Picture, Quality};
use std::path::Path;

/// Writes frames as MP4 or GIF.
pub struct AnimationWriter(Format);

enum Format {
    /// H.264 in MP4: small, plays nearly everywhere.
    Video(Box<VideoWriter>),
    /// GIF and the seconds of a frame: exact colours where they are few, shown where no video is;
    /// many times larger.
    Gif(Box<GifWriter>, f64),
}

impl AnimationWriter {
    /// Begins `NAME.mp4` or `NAME.gif` of `frames_per_second.0 / frames_per_second.1` frames a
    /// second: (35, 4) for the steps of a policy that acts every four tics. A GIF takes no notice
    /// of the quality.
    ///
    /// # Errors
    /// When the name ends otherwise, the size or rate is unusable, or the file cannot be made.
    pub fn create(
        path: &Path,
        width: usize,
        height: usize,
        frames_per_second: (u32, u32),
        quality: Quality,
    ) -> Result<AnimationWriter, MediaError> {
        match path
            .extension()
            .and_then(|ending| ending.to_str())
            .map(str::to_ascii_lowercase)
            .as_deref()
        {
            Some("mp4") => {
                let writer = VideoWriter::create(path, width, height, frames_per_second, quality)?;
                Ok(AnimationWriter(Format::Video(Box::new(writer))))
            }
            Some("gif") if frames_per_second.0 > 0 => {
                // What one format takes the other takes too, so that a film's name can be changed.
                check_size(width, height)?;
                let seconds = f64::from(frames_per_second.1) / f64::from(frames_per_second.0);
                Ok(AnimationWriter(Format::Gif(
                    Box::new(GifWriter::create(path, width, height)?),
                    seconds,
                )))
            }
            _ => Err(MediaError::format(path, "has a name that ends neither in .mp4 nor in .gif")),
        }
    }

    /// Adds a frame.
    ///
    /// # Errors
    /// When its size differs from the first's or the file cannot be written.
    pub fn push(&mut self, picture: &Picture) -> Result<(), MediaError> {
        match &mut self.0 {
            Format::Video(writer) => writer.push(picture),
            Format::Gif(writer, seconds) => writer.push(picture, *seconds),
        }
    }

    /// Ends the file and puts it in its place.
    ///
    /// # Errors
    /// When there was no frame or the file cannot be written.
    pub fn finish(self) -> Result<(), MediaError> {
        match self.0 {
            Format::Video(writer) => writer.finish(),
            Format::Gif(writer, _) => writer.finish(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_chooses_the_format() {
        let base = std::env::temp_dir().join(format!("hasard-animation-{}", std::process::id()));
        for (ending, head) in [("mp4", &b"ftyp"[..]), ("GIF", b"89a")] {
            let path = base.with_extension(ending);
            let mut writer =
                AnimationWriter::create(&path, 20, 10, (35, 4), Quality::default()).unwrap();
            writer.push(&Picture::filled(20, 10, [1, 2, 3])).unwrap();
            writer.push(&Picture::filled(20, 10, [9, 2, 3])).unwrap();
            writer.finish().unwrap();
            let bytes = std::fs::read(&path).unwrap();
            assert!(bytes[..16].windows(head.len()).any(|part| part == head), "{ending}");
            std::fs::remove_file(path).unwrap();
        }
        let error = refused("a.avi", 20, 10);
        assert_eq!(error, "a.avi: has a name that ends neither in .mp4 nor in .gif");
    }

    fn refused(name: &str, width: usize, height: usize) -> String {
        let made =
            AnimationWriter::create(Path::new(name), width, height, (35, 4), Quality::default());
        made.err().unwrap().to_string()
    }

    /// A film of two views was written as GIF, and as MP4 it was too wide.
    #[test]
    fn both_formats_are_as_large() {
        for (width, height) in [(3073, 10), (10, 3073), (0, 10)] {
            let error = refused("a.gif", width, height);
            assert_eq!(error, refused("a.mp4", width, height));
            assert!(error.contains(&format!("cannot be {width}x{height}")), "{error}");
        }
        assert!(!Path::new("a.gif").exists());
    }
}
