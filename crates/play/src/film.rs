//! A stage's moments as a moving picture.

use crate::{PlayError, Stage, ViewKind, Views};
use hasard_engine::render::FrameSize;
use hasard_media::compose::with_footer;
use hasard_media::{AnimationWriter, Picture, Quality};
use std::path::Path;

/// Tics a second.
const TICS: u32 = 35;

/// Writes a stage as MP4 or GIF: views side by side, and below them time, return and cost.
pub struct Film {
    views: Views,
    writer: AnimationWriter,
    /// Tics from one frame to the next, and those since the last one.
    every: u32,
    since: u32,
    frames: u32,
    size: (usize, usize),
}

impl Film {
    /// Begins a film at a stage's present moment, with a frame every `every` tics.
    ///
    /// # Errors
    /// When the file's name ends neither in .mp4 nor in .gif, or it cannot be made.
    pub fn begin(
        stage: &Stage,
        path: &Path,
        size: FrameSize,
        kinds: &[ViewKind],
        every: u32,
    ) -> Result<Film, PlayError> {
        Film::begin_at(Quality::default(), stage, path, size, kinds, every)
    }

    /// As [`Film::begin`], an MP4 of a chosen quality.
    ///
    /// # Errors
    /// As there.
    pub fn begin_at(
        quality: Quality,
        stage: &Stage,
        path: &Path,
        size: FrameSize,
        kinds: &[ViewKind],
        every: u32,
    ) -> Result<Film, PlayError> {
        let mut views = Views::new(stage, size, kinds)?;
        let first = moment(&mut views, stage);
        let mut writer = AnimationWriter::create(
            path,
            first.width(),
            first.height(),
            (TICS, every.max(1)),
            quality,
        )?;
        writer.push(&first)?;
        Ok(Film {
            views,
            writer,
            every: every.max(1),
            since: 0,
            frames: 1,
            size: (first.width(), first.height()),
        })
    }

    /// A tic has passed. The episode's last moment is always shown.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn tic(&mut self, stage: &Stage) -> Result<(), PlayError> {
        self.since += 1;
        if self.since >= self.every || stage.ended() {
            self.since = 0;
            self.frames += 1;
            self.writer.push(&moment(&mut self.views, stage))?;
        }
        Ok(())
    }

    /// Ends the film. Gives its number of frames, and their width and height.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn finish(self) -> Result<(u32, (usize, usize)), PlayError> {
        self.writer.finish()?;
        Ok((self.frames, self.size))
    }
}

/// The views with the episode's sums below.
fn moment(views: &mut Views, stage: &Stage) -> Picture {
    let episode = stage.env().episode();
    let seconds = f64::from(stage.world().tic) / f64::from(TICS);
    let line = format!(
        "{seconds:5.1} s   return {:.2}   cost {:.2}",
        episode.episode_return, episode.cost
    );
    with_footer(&views.draw(stage), &line)
}
