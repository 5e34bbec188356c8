//! A moment as pictures.

use crate::{PlayError, Stage};
use hasard_engine::render::{Buffers, FrameSize, Renderer, SegmentationColours};
use hasard_media::Picture;
use hasard_media::compose::{Panel, side_by_side};

/// What a view shows.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ViewKind {
    /// What the player sees.
    Colour,
    /// How far it is, near black to far white.
    Depth,
    /// One colour for each class of things.
    Segmentation,
}

impl ViewKind {
    /// Its caption.
    #[must_use]
    pub const fn caption(self) -> &'static str {
        match self {
            ViewKind::Colour => "colour",
            ViewKind::Depth => "depth",
            ViewKind::Segmentation => "segmentation",
        }
    }
}

/// Draws moments of a stage at a size of its own.
pub struct Views {
    renderer: Renderer,
    size: FrameSize,
    kinds: Vec<ViewKind>,
    colours: SegmentationColours,
    bytes: Vec<u8>,
}

impl Views {
    /// Views of a stage, in this order, each of `size`.
    ///
    /// # Errors
    /// When the size is not drawable.
    pub fn new(stage: &Stage, size: FrameSize, kinds: &[ViewKind]) -> Result<Views, PlayError> {
        let kinds = if kinds.is_empty() { vec![ViewKind::Colour] } else { kinds.to_vec() };
        Ok(Views {
            renderer: stage.env().renderer(size)?,
            size,
            kinds,
            colours: SegmentationColours::distinct(),
            bytes: Vec::new(),
        })
    }

    /// The moment: the view alone, or several side by side with captions.
    ///
    /// # Panics
    /// When the stage is of another environment.
    pub fn draw(&mut self, stage: &Stage) -> Picture {
        let buffers =
            Buffers { depth: self.kinds.contains(&ViewKind::Depth), labels: self.kinds.contains(&ViewKind::Segmentation) };
        self.renderer.render(stage.world(), 0, buffers);
        let kinds = self.kinds.clone();
        let mut pictures: Vec<Picture> = kinds.iter().map(|kind| self.picture(*kind)).collect();
        if pictures.len() == 1 {
            return pictures.remove(0);
        }
        let panels: Vec<Panel> = pictures.iter().zip(&kinds).map(|(picture, kind)| Panel::new(picture, kind.caption())).collect();
        side_by_side(&panels, 1)
    }

    fn picture(&mut self, kind: ViewKind) -> Picture {
        let (width, height) = (usize::from(self.size.width), usize::from(self.size.height));
        let channels = if kind == ViewKind::Depth { 1 } else { 3 };
        self.bytes.resize(width * height * channels, 0);
        let picture = match kind {
            ViewKind::Colour => {
                self.renderer.write_rgb_hwc(&mut self.bytes);
                Picture::from_rgb(width, height, self.bytes.clone())
            }
            ViewKind::Depth => {
                self.renderer.write_depth(&mut self.bytes);
                Picture::from_grey(width, height, &self.bytes)
            }
            ViewKind::Segmentation => {
                self.renderer.write_segmented_hwc(&self.colours, &mut self.bytes);
                Picture::from_rgb(width, height, self.bytes.clone())
            }
        };
        picture.expect("a frame has the size that was asked for")
    }
}
