//! A moment as pictures.

use crate::{PlayError, Stage};
use hasard_engine::render::{
    Buffers, FrameScratch, FrameSize, Renderer, SegmentationColours, TopDown, class,
};
use hasard_engine::world::World;
use hasard_envs::Env;
use hasard_media::compose::{Panel, side_by_side};
use hasard_media::{Picture, png};

/// What a view shows.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ViewKind {
    /// What the player sees.
    Colour,
    /// How far it is, near black to far white.
    Depth,
    /// One colour for each class of things.
    Segmented,
    /// One grey for each thing in view, as ViZDoom numbers them.
    Labels,
    /// Luminance.
    Grey,
    /// One colour for each part of the renderer that drew a pixel.
    Phase,
    /// The whole map with all things, from above, north up.
    Automap,
}

impl ViewKind {
    /// Its caption.
    #[must_use]
    pub const fn caption(self) -> &'static str {
        match self {
            ViewKind::Colour => "colour",
            ViewKind::Depth => "depth",
            ViewKind::Segmented => "segmented",
            ViewKind::Labels => "labels",
            ViewKind::Grey => "grey",
            ViewKind::Phase => "phase",
            ViewKind::Automap => "automap",
        }
    }
}

/// The colour of the folder of `hasard_engine::render` that draws what a class stands for: the key
/// is in docs/rendering.md.
const fn phase_colour(seen: u16) -> [u8; 3] {
    match seen {
        class::WALL => [176, 92, 48],
        class::FLOOR | class::OTHER_FLOOR => [72, 128, 72],
        class::CEILING | class::OTHER_CEILING => [96, 112, 176],
        class::SKY => [136, 200, 240],
        class::STATUS_BAR => [112, 112, 112],
        class::WEAPON => [232, 200, 72],
        _ => [208, 64, 160],
    }
}

/// Draws moments of a stage at a size of its own.
pub struct Views {
    renderer: Renderer,
    scratch: FrameScratch,
    size: FrameSize,
    kinds: Vec<ViewKind>,
    colours: SegmentationColours,
    /// The automap and the size of its picture, if one of the views is that.
    automap: Option<(TopDown, usize, usize)>,
}

impl Views {
    /// Views of a stage, in this order, each of `size`. Beside other views the automap is as high
    /// as they are and as wide as its map asks for.
    ///
    /// # Errors
    /// When the size is not drawable.
    pub fn new(stage: &Stage, size: FrameSize, kinds: &[ViewKind]) -> Result<Views, PlayError> {
        let env = stage.shown();
        let mut views = Views::of(env, size, kinds)?;
        if let (Some(automap), [_, _, ..]) = (&mut views.automap, kinds) {
            let [west, south, east, north] = env.extent().map(i64::from);
            let height = i64::from(size.height);
            let width = (height * (east - west) / (north - south).max(1))
                .clamp(height / 4, height * 2) as usize;
            *automap = (env.top_down(width, height as usize), width, height as usize);
        }
        Ok(views)
    }

    /// Views of an environment's worlds, the automap too of `size`.
    ///
    /// # Errors
    /// As [`Views::new`].
    pub fn of(env: &Env, size: FrameSize, kinds: &[ViewKind]) -> Result<Views, PlayError> {
        let kinds = if kinds.is_empty() { vec![ViewKind::Colour] } else { kinds.to_vec() };
        let colours = if env.options().published_colours {
            SegmentationColours::published()
        } else {
            SegmentationColours::distinct()
        };
        let (width, height) = (usize::from(size.width), usize::from(size.height));
        let automap = kinds
            .contains(&ViewKind::Automap)
            .then(|| (env.top_down(width, height), width, height));
        Ok(Views {
            renderer: env.renderer(size)?,
            scratch: FrameScratch::default(),
            size,
            kinds,
            colours,
            automap,
        })
    }

    /// A moment of a world in each view.
    ///
    /// # Panics
    /// When the world is of another environment.
    pub fn pictures(&mut self, world: &World) -> Vec<Picture> {
        self.render(world);
        self.kinds.iter().map(|kind| self.pixels(*kind, world).picture()).collect()
    }

    /// The same as PNG files, made quickly: for frames that are sent to somebody as they come.
    ///
    /// # Panics
    /// When the world is of another environment.
    pub fn png_files(&mut self, world: &World) -> Vec<(ViewKind, Vec<u8>)> {
        self.render(world);
        let file = |kind: ViewKind| match kind {
            // As it was drawn: a byte a pixel.
            ViewKind::Colour => {
                let (width, height) = (usize::from(self.size.width), usize::from(self.size.height));
                let pixels = png::Pixels::Indexed(self.renderer.indices(), self.renderer.palette());
                png::encode_quickly(width, height, pixels)
                    .expect("a frame has the size that was asked for")
            }
            _ => self.pixels(kind, world).png_file(),
        };
        self.kinds.iter().map(|&kind| (kind, file(kind))).collect()
    }

    fn render(&mut self, world: &World) {
        let wants = |wanted: &[ViewKind]| self.kinds.iter().any(|kind| wanted.contains(kind));
        let buffers = Buffers {
            depth: wants(&[ViewKind::Depth]),
            labels: wants(&[ViewKind::Segmented, ViewKind::Labels, ViewKind::Phase]),
        };
        self.renderer.render(&mut self.scratch, world, 0, buffers);
    }

    /// The moment: the view alone, or several side by side with captions.
    ///
    /// # Panics
    /// When the stage is of another environment.
    pub fn draw(&mut self, stage: &Stage) -> Picture {
        let mut pictures = self.pictures(stage.world());
        if pictures.len() == 1 {
            return pictures.remove(0);
        }
        let panels: Vec<Panel> = pictures
            .iter()
            .zip(&self.kinds)
            .map(|(picture, kind)| Panel::new(picture, kind.caption()))
            .collect();
        side_by_side(&panels, 1)
    }

    /// The renderer as of the last moment drawn: depth in its units, and the list of things in
    /// view.
    #[must_use]
    pub fn renderer(&self) -> &Renderer {
        &self.renderer
    }

    /// What a view shows of the moment that was rendered.
    fn pixels(&self, kind: ViewKind, world: &World) -> Pixels {
        let (width, height) = (usize::from(self.size.width), usize::from(self.size.height));
        let drawn = |width: usize, height: usize, channels: usize, write: &dyn Fn(&mut [u8])| {
            let mut bytes = vec![0; width * height * channels];
            write(&mut bytes);
            Pixels { width, height, channels, bytes }
        };
        let renderer = &self.renderer;
        match (kind, &self.automap) {
            (ViewKind::Automap, Some((map, width, height))) => {
                drawn(*width, *height, 3, &|out| map.draw(world, out))
            }
            (ViewKind::Colour | ViewKind::Automap, _) => {
                drawn(width, height, 3, &|out| renderer.write_rgb_hwc(out))
            }
            (ViewKind::Segmented, _) => {
                drawn(width, height, 3, &|out| renderer.write_segmented_hwc(&self.colours, out))
            }
            (ViewKind::Depth, _) => drawn(width, height, 1, &|out| renderer.write_depth(out)),
            (ViewKind::Labels, _) => drawn(width, height, 1, &|out| renderer.write_labels(out)),
            (ViewKind::Phase, _) => drawn(width, height, 3, &|out| {
                let pixels = out.chunks_exact_mut(3).zip(renderer.classes());
                pixels.for_each(|(pixel, seen)| pixel.copy_from_slice(&phase_colour(*seen)));
            }),
            (ViewKind::Grey, _) => drawn(width, height, 1, &|out| renderer.write_grey(out)),
        }
    }
}

/// One view of a moment: red, green and blue or one grey of each pixel, row after row.
struct Pixels {
    width: usize,
    height: usize,
    channels: usize,
    bytes: Vec<u8>,
}

impl Pixels {
    fn picture(self) -> Picture {
        let Pixels { width, height, channels, bytes } = self;
        let picture = if channels == 3 {
            Picture::from_rgb(width, height, bytes)
        } else {
            Picture::from_grey(width, height, &bytes)
        };
        picture.expect("a frame has the size that was asked for")
    }

    fn png_file(self) -> Vec<u8> {
        let pixels = if self.channels == 3 {
            png::Pixels::Rgb(&self.bytes)
        } else {
            png::Pixels::Grey(&self.bytes)
        };
        png::encode_quickly(self.width, self.height, pixels)
            .expect("a frame has the size that was asked for")
    }
}
