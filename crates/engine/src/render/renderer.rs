//! The renderer: draws what one player of a world sees.

use super::camera::Camera;
use super::convert::Colours;
use super::depth::Depths;
use super::frame::{Columns, Frame, class};
use super::horizon::RowSlopes;
use super::label::{Label, Labels};
use super::look::Looks;
use super::masked::Masked;
use super::openings::Openings;
use super::palette::Tint;
use super::plane::{PlaneShader, Planes, Span};
use super::scene::Scene;
use super::silhouette::Silhouettes;
use super::sky::SkyShader;
use super::sprite::{self, SeenSprite};
use super::stamp::StampColumns;
use super::status_bar::{BarState, StatusBar};
use super::walk::{Walk, WalkScratch};
use super::{Buffers, SegmentationColours, View, convert, weapon};
use crate::simd::Simd;
use crate::world::World;
use std::sync::Arc;

/// Draws frames of one size of the worlds of one map; owns all memory that takes, so that drawing allocates nothing
/// once every buffer has grown.
#[derive(Clone, Debug)]
pub struct Renderer {
    scene: Arc<Scene>,
    view: Arc<View>,
    frame: Frame,
    openings: Openings,
    planes: Planes,
    silhouettes: Silhouettes,
    walk: WalkScratch,
    looks: Looks,
    /// Sectors that the frame entered.
    entered: Vec<bool>,
    /// Index of the picture that each texture shows.
    pictures: Vec<u32>,
    /// First column of each row's span, and one entry that nobody reads.
    span_starts: Vec<u16>,
    /// Spans of the plane at hand.
    spans: Vec<Span>,
    slopes: RowSlopes,
    /// Start of each column's texels in the sky's picture.
    sky_columns: Vec<u32>,
    sprites: Vec<SeenSprite>,
    /// Columns of the sprite or weapon at hand.
    stamp_columns: StampColumns,
    labels: Labels,
    status_bar: StatusBar,
    colours: Colours,
    /// What tints `colours`.
    tint: Tint,
    options: RenderOptions,
    simd: Simd,
}

/// Values of the class buffer that are told apart: more actors than any frame shows.
const CLASSES: usize = 1024;

/// What may be drawn otherwise.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct RenderOptions {
    /// Light amplification (Infrared goggles) has a strong green hue, as the paper says; the published engine only
    /// brightens.
    pub green_goggles: bool,
    /// Depth is what the published engine tells: by a formula each for walls, floors and sprites, and except on floors
    /// it ends at `255 * height / 480` in frames less than 480 rows high, at 63 in learners' frames.
    pub published_depth: bool,
}

impl Renderer {
    /// A renderer for worlds of the scene's map.
    #[must_use]
    pub fn new(scene: Arc<Scene>, view: Arc<View>) -> Renderer {
        let (width, pixels) = (view.width(), view.size.pixels());
        // The status bar's rows keep their depth and class.
        let frame = Frame {
            width,
            colour: vec![0; pixels],
            depth: vec![0; pixels],
            class: vec![class::STATUS_BAR; pixels],
            depths: Depths::default(),
            columns: Columns::new(width, view.view_rows),
        };
        Renderer {
            frame,
            openings: Openings::default(),
            planes: Planes::default(),
            silhouettes: Silhouettes::default(),
            walk: WalkScratch::new(&scene, width),
            looks: Looks::new(scene.sector_count),
            entered: vec![false; scene.sector_count],
            pictures: Vec::new(),
            span_starts: vec![0; view.view_rows + 1],
            spans: Vec::new(),
            slopes: RowSlopes::default(),
            sky_columns: vec![0; width],
            sprites: Vec::new(),
            stamp_columns: StampColumns::default(),
            labels: Labels::default(),
            status_bar: StatusBar::new(&scene.bar, &view),
            colours: Colours::new(scene.assets.palette),
            tint: Tint::default(),
            options: RenderOptions::default(),
            // Whoever makes renderers for users has told them of a wrong choice.
            simd: Simd::chosen().unwrap_or(Simd::widest()),
            scene,
            view,
        }
    }

    /// Chooses what is drawn otherwise from the next frame on.
    pub fn set_options(&mut self, options: RenderOptions) {
        self.options = options;
        let published = || Depths::published(self.view.base_rows());
        self.frame.depths = if options.published_depth { published() } else { Depths::default() };
    }

    /// Draws with these instructions, to compare them: the pixels are the same.
    pub fn set_simd(&mut self, simd: Simd) {
        self.simd = simd;
    }

    /// Draws what player `player` of `world` sees. The result stays until the next call.
    ///
    /// # Panics
    /// If the world is of another map than the scene, or has no such player.
    pub fn render(&mut self, world: &World, player: usize, buffers: Buffers) {
        assert_eq!(world.sector_count(), self.scene.sector_count, "the world is of another map than the scene");
        match (buffers.depth, buffers.labels) {
            (false, false) => self.draw::<false, false>(world, player),
            (true, false) => self.draw::<true, false>(world, player),
            (false, true) => self.draw::<false, true>(world, player),
            (true, true) => self.draw::<true, true>(world, player),
        }
    }

    fn draw<const DEPTH: bool, const CLASS: bool>(&mut self, world: &World, player: usize) {
        let camera = Camera::of_player(world, player, &self.view);
        self.slopes.update(&self.view, camera.horizon);
        self.animate(world.tic);
        self.frame.clear::<DEPTH, CLASS>(self.view.view_rows);
        self.openings.reset(self.view.width(), self.view.view_rows);
        self.planes.reset(self.view.width());
        self.silhouettes.reset();
        self.entered.fill(false);
        self.looks.reset();
        let mut walk = Walk {
            scene: &self.scene,
            view: &self.view,
            camera: &camera,
            world,
            looks: &mut self.looks,
            pictures: &self.pictures,
            frame: &mut self.frame,
            openings: &mut self.openings,
            planes: &mut self.planes,
            silhouettes: &mut self.silhouettes,
            entered: &mut self.entered,
            scratch: &mut self.walk,
            simd: self.simd,
        };
        walk.run::<DEPTH>();
        self.frame.end_walls::<DEPTH>(self.simd, self.view.view_rows);
        self.draw_planes::<DEPTH, CLASS>(&camera);
        self.draw_masked::<DEPTH, CLASS>(&camera, world, player);
        self.draw_overlay::<DEPTH, CLASS>(&camera, world, player);
    }

    fn draw_masked<const DEPTH: bool, const CLASS: bool>(&mut self, camera: &Camera, world: &World, player: usize) {
        self.labels.list.clear();
        sprite::collect(&mut self.sprites, &self.scene, &self.view, camera, world, player, &self.entered);
        let mut masked = Masked {
            scene: &self.scene,
            view: &self.view,
            camera,
            world,
            pictures: &self.pictures,
            frame: &mut self.frame,
            silhouettes: &mut self.silhouettes,
            labels: &mut self.labels,
            columns: &mut self.stamp_columns,
            simd: self.simd,
        };
        masked.draw::<DEPTH, CLASS>(&self.sprites);
    }

    /// What is drawn over the world: weapon, status bar, flashes.
    fn draw_overlay<const DEPTH: bool, const CLASS: bool>(&mut self, camera: &Camera, world: &World, player: usize) {
        let (scene, view) = (&self.scene, &self.view);
        let state = BarState::of_player(world, player);
        let player = &world.players[player];
        let level = world.get(player.actor).map_or(0, |body| world.sector(body.sector).light);
        let mut canvas =
            weapon::Canvas { frame: &mut self.frame, columns: &mut self.stamp_columns, simd: self.simd, scene, view };
        canvas.weapon::<DEPTH, CLASS>(camera, player, i32::from(level));
        self.status_bar.update(&mut self.frame, &scene.bar, view, state);
        let tint = Tint::of_player(player, self.options.green_goggles);
        if tint != self.tint {
            self.tint = tint;
            self.colours = Colours::new(tint.apply(&scene.assets.palette));
        }
    }

    /// Chooses the frame of each animated texture.
    fn animate(&mut self, tic: u32) {
        let textures = &self.scene.textures.list;
        self.pictures.clear();
        self.pictures.extend(textures.iter().map(|texture| {
            if texture.frames == 1 { texture.first } else { texture.first + tic / texture.tics % texture.frames }
        }));
    }

    fn draw_planes<const DEPTH: bool, const CLASS: bool>(&mut self, camera: &Camera) {
        let tables = &self.scene.assets.light_tables;
        for plane in self.planes.used() {
            if plane.is_empty() {
                continue;
            }
            let count = plane.spans(self.simd, &mut self.span_starts, &mut self.spans);
            let spans = &self.spans[..count];
            if plane.key.sky {
                let shader = SkyShader {
                    camera,
                    view: &self.view,
                    // Whatever light there is, and by goggles too.
                    table: &tables[0],
                    picture: &self.scene.textures.walls[self.scene.sky],
                };
                shader.columns(&mut self.sky_columns, plane.first, plane.end);
                for &span in spans {
                    shader.span::<DEPTH, CLASS>(&mut self.frame, &self.sky_columns, span);
                }
            } else {
                let picture = self.pictures[usize::from(plane.key.texture.0)] as usize;
                let (flat, square) = (&self.scene.textures.flats[picture], self.scene.textures.squares[picture]);
                let shader = PlaneShader::new(camera, &self.view, &self.slopes, tables, plane.key, square);
                for &span in spans {
                    shader.span::<DEPTH, CLASS>(&mut self.frame, flat, span);
                }
            }
        }
    }

    /// The palette indices of the last frame, row by row.
    #[must_use]
    pub fn indices(&self) -> &[u8] {
        &self.frame.colour
    }

    /// The colours of the palette indices, with the flashes of the last frame.
    #[must_use]
    pub fn palette(&self) -> &[[u8; 3]; 256] {
        &self.colours.palette
    }

    /// The depth of the last frame, if it was drawn: 0 near to 255 far, 7.3 map units a level; weapon and status bar 0.
    #[must_use]
    pub fn depth(&self) -> &[u8] {
        &self.frame.depth
    }

    /// What each pixel of the last frame shows, if labels were drawn: a surface of [`class`], or
    /// [`class::FIRST_ACTOR`] plus an index into [`Renderer::labels`].
    #[must_use]
    pub fn classes(&self) -> &[u16] {
        &self.frame.class
    }

    /// The actors of which the last frame drew a pixel, if labels were drawn, far to near.
    #[must_use]
    pub fn labels(&self) -> &[Label] {
        &self.labels.list
    }

    /// Size of the frames.
    #[must_use]
    pub fn view(&self) -> &View {
        &self.view
    }

    /// Writes the last frame row by row, red, green and blue of each pixel in turn.
    ///
    /// # Panics
    /// If `out` is not three times as long as a frame has pixels.
    pub fn write_rgb_hwc(&self, out: &mut [u8]) {
        assert_eq!(out.len(), self.frame.colour.len() * 3, "a buffer of height * width * 3 bytes is needed");
        convert::rgb_interleaved(self.simd, &self.colours, &self.frame.colour, out);
    }

    /// Writes the last frame as a plane of red, one of green, one of blue.
    ///
    /// # Panics
    /// If `out` is not three times as long as a frame has pixels.
    pub fn write_rgb_chw(&self, out: &mut [u8]) {
        assert_eq!(out.len(), self.frame.colour.len() * 3, "a buffer of 3 * height * width bytes is needed");
        convert::rgb_planes(self.simd, &self.colours, &self.frame.colour, out);
    }

    /// Writes the last frame's luminance.
    ///
    /// # Panics
    /// If `out` is not as long as a frame has pixels.
    pub fn write_grey(&self, out: &mut [u8]) {
        assert_eq!(out.len(), self.frame.colour.len(), "a buffer of height * width bytes is needed");
        convert::grey(self.simd, &self.colours, &self.frame.colour, out);
    }

    /// Writes the last frame's depth, which must have been asked for.
    ///
    /// # Panics
    /// If `out` is not as long as a frame has pixels.
    pub fn write_depth(&self, out: &mut [u8]) {
        assert_eq!(out.len(), self.frame.depth.len(), "a buffer of height * width bytes is needed");
        out.copy_from_slice(&self.frame.depth);
    }

    /// Writes the last frame row by row, red, green, blue and depth of each pixel in turn; depth must have been asked for.
    ///
    /// # Panics
    /// If `out` is not four times as long as a frame has pixels.
    pub fn write_rgb_depth_hwc(&self, out: &mut [u8]) {
        assert_eq!(out.len(), self.frame.colour.len() * 4, "a buffer of height * width * 4 bytes is needed");
        convert::rgb_depth_interleaved(self.simd, &self.colours, &self.frame.colour, &self.frame.depth, out);
    }

    /// Writes the last frame with one colour per class, red, green and blue of each pixel in turn; labels must have been
    /// asked for.
    ///
    /// # Panics
    /// If `out` is not three times as long as a frame has pixels.
    pub fn write_segmented_hwc(&self, colours: &SegmentationColours, out: &mut [u8]) {
        assert_eq!(out.len(), self.frame.class.len() * 3, "a buffer of height * width * 3 bytes is needed");
        convert::classes_interleaved(self.simd, &self.class_colours(colours), &self.frame.class, out);
    }

    /// Writes the last frame with one colour per class as three planes; labels must have been asked for.
    ///
    /// # Panics
    /// If `out` is not three times as long as a frame has pixels.
    pub fn write_segmented_chw(&self, colours: &SegmentationColours, out: &mut [u8]) {
        assert_eq!(out.len(), self.frame.class.len() * 3, "a buffer of 3 * height * width bytes is needed");
        convert::classes_planes(&self.class_colours(colours), &self.frame.class, out);
    }

    /// Writes the last frame's labels as the published engine gives them: 1 for floors and ceilings with a picture of 64 by
    /// 64 texels, 0 for other surfaces, the `n`th of `N` actors `n * 255 / (N + 1)`, the weapon 255; labels must have been
    /// asked for.
    ///
    /// # Panics
    /// If `out` is not as long as a frame has pixels.
    pub fn write_labels(&self, out: &mut [u8]) {
        assert_eq!(out.len(), self.frame.class.len(), "a buffer of height * width bytes is needed");
        let count = self.labels.list.len() + 1;
        let mut values = [0; CLASSES];
        values[usize::from(class::WEAPON)] = 255;
        let ones = [class::FLOOR, class::CEILING];
        ones.iter().for_each(|&class| values[usize::from(class)] = 1);
        let actors = &mut values[usize::from(class::FIRST_ACTOR)..];
        actors.iter_mut().take(count - 1).enumerate().for_each(|(index, value)| *value = ((index + 1) * 255 / count) as u8);
        convert::classes_one_byte(&values, class::WEAPON, ones, &self.frame.class, out);
    }

    /// The colour of each value of the class buffer.
    fn class_colours(&self, colours: &SegmentationColours) -> [[u8; 3]; CLASSES] {
        let surfaces = (0..class::FIRST_ACTOR).map(|class| colours.surface(class));
        let actors = self.labels.list.iter().map(|label| colours.actor(label.kind));
        let mut table = [[0; 3]; CLASSES];
        table.iter_mut().zip(surfaces.chain(actors)).for_each(|(to, colour)| *to = colour);
        table
    }
}
