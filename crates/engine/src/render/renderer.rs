//! The renderer: draws what one player of a world sees.
//!
//! Long because all the phases of a frame are called here, each with the buffers that it may touch.

use crate::render::buffers::frame::{Frame, class};
use crate::render::buffers::labels::{self, InView, Label, Labels};
use crate::render::buffers::request::Buffers;
use crate::render::buffers::written::{
    ClassBuffer, DepthBuffer, NoClass, NoDepth, WithClass, WithDepth,
};
use crate::render::colour::palette::Colours;
use crate::render::colour::tint::Tint;
use crate::render::output::convert;
use crate::render::output::segmentation::SegmentationColours;
use crate::render::overlay::status_bar::{BarState, StatusBar};
use crate::render::overlay::weapon;
use crate::render::planes::shader::PlaneShader;
use crate::render::planes::sky::{self, shader::SkyShader};
use crate::render::planes::{draw, spans, whole};
use crate::render::published_depth::PublishedDepth;
use crate::render::scene::prepared::Scene;
use crate::render::scratch::FrameScratch;
use crate::render::sprites::pass::SpritePass;
use crate::render::sprites::sprite;
use crate::render::view::camera::Camera;
use crate::render::view::depth::DepthEncoding;
use crate::render::view::horizon::PlaneRows;
use crate::render::view::tables::View;
use crate::render::walls::pass::WallPass;
use crate::simd::Simd;
use crate::world::World;
use std::sync::Arc;

/// Draws frames of one size of the worlds of one map. It owns what stays of a frame; what one is
/// drawn in, the [`FrameScratch`], is the caller's. Drawing allocates nothing once every buffer has
/// grown.
#[derive(Clone, Debug)]
pub struct Renderer {
    scene: Arc<Scene>,
    view: Arc<View>,
    frame: Frame,
    slopes: PlaneRows,
    labels: Labels,
    status_bar: StatusBar,
    /// What tints the palette.
    tint: Tint,
    /// The palette as it was tinted last. Most frames have no tint: all worlds share the scene's
    /// palette then, and their caches one copy.
    tinted: Box<Colours>,
    options: RenderOptions,
    /// What writes depth as ViZDoom does, if it is to be written so.
    published: Option<PublishedDepth>,
    simd: Simd,
}

/// Values of the class buffer that are distinguished: more actors than any frame shows.
const CLASSES: usize = 1024;

/// What may be drawn otherwise.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct RenderOptions {
    /// Light amplification (Infrared goggles) has a strong green hue, as the paper says; ViZDoom
    /// only brightens.
    pub green_goggles: bool,
    /// Depth is what ViZDoom writes: by a formula each for walls, floors and sprites, and except on
    /// floors it ends at `255 * height / 480` in frames less than 480 rows high, at 63 in learners'
    /// frames.
    pub published_depth: bool,
}

impl Renderer {
    /// A renderer for worlds of the scene's map.
    #[must_use]
    pub fn new(scene: Arc<Scene>, view: Arc<View>) -> Renderer {
        Renderer {
            frame: Frame::default(),
            slopes: PlaneRows::default(),
            labels: Labels::default(),
            status_bar: StatusBar::new(&scene.bar, &view),
            tint: Tint::default(),
            tinted: Box::new(scene.colours.clone()),
            options: RenderOptions::default(),
            published: None,
            // A wrong choice has been reported by what makes renderers for users.
            simd: Simd::chosen().unwrap_or(Simd::widest()),
            scene,
            view,
        }
    }

    /// Chooses what is drawn otherwise from the next frame on.
    pub fn set_options(&mut self, options: RenderOptions) {
        self.options = options;
        let published = || PublishedDepth::new(self.view.base_rows(), self.view.is_reduced());
        self.published = options.published_depth.then(published);
        let formulas = self.published.as_ref().map(PublishedDepth::formulas);
        self.frame.depths = DepthEncoding::new(formulas);
    }

    /// Draws with these instructions, to compare them: the pixels are the same.
    pub fn set_simd(&mut self, simd: Simd) {
        self.simd = simd;
    }

    /// Draws what player `player` of `world` sees. The result stays until the next call.
    ///
    /// # Panics
    /// If the world is of another map than the scene, or has no such player.
    pub fn render(
        &mut self,
        scratch: &mut FrameScratch,
        world: &World,
        player: usize,
        buffers: Buffers,
    ) {
        self.frame.fit(&self.view, self.frame.depths);
        self.draw_buffers(scratch, world, player, buffers);
    }

    /// Draws what player `player` of `world` sees, and lets `write` read it; it does not stay.
    /// Renderers share the memory of such frames with the scratch, so that it is in a near cache
    /// however many worlds take turns.
    ///
    /// # Panics
    /// If the world is of another map than the scene, or has no such player.
    pub fn render_then(
        &mut self,
        scratch: &mut FrameScratch,
        world: &World,
        player: usize,
        buffers: Buffers,
        write: impl FnOnce(&Renderer),
    ) {
        let mut shared = std::mem::take(&mut scratch.frame);
        shared.fit(&self.view, self.frame.depths);
        std::mem::swap(&mut self.frame, &mut shared);
        self.draw_buffers(scratch, world, player, buffers);
        write(self);
        std::mem::swap(&mut self.frame, &mut shared);
        scratch.frame = shared;
    }

    #[inline(never)]
    fn draw_buffers(
        &mut self,
        space: &mut FrameScratch,
        world: &World,
        player: usize,
        buffers: Buffers,
    ) {
        assert_eq!(
            world.sector_count(),
            self.scene.sector_count,
            "the world is of another map than the scene"
        );
        match (buffers.depth, buffers.labels) {
            (false, false) => self.draw::<NoDepth, NoClass>(space, world, player),
            (true, false) => self.draw::<WithDepth, NoClass>(space, world, player),
            (false, true) => self.draw::<NoDepth, WithClass>(space, world, player),
            (true, true) => self.draw::<WithDepth, WithClass>(space, world, player),
        }
    }

    fn draw<D: DepthBuffer, C: ClassBuffer>(
        &mut self,
        space: &mut FrameScratch,
        world: &World,
        player: usize,
    ) {
        space.begin(&self.scene, &self.view, world.tic);
        let camera = Camera::of_player(world, player, &self.view);
        self.slopes.update(&self.view, camera.horizon);
        space.columns.clear::<D>(self.frame.depths);
        let mut walk = WallPass {
            scene: &self.scene,
            view: &self.view,
            camera: &camera,
            world,
            depths: self.frame.depths,
            surfaces: &mut space.surfaces,
            pictures: &space.pictures,
            columns: &mut space.columns,
            clip: &mut space.clip,
            planes: &mut space.planes,
            drawsegs: &mut space.drawsegs,
            entered: &mut space.entered,
            scratch: &mut space.walk,
            walls: &mut space.walls,
            published: self.published.as_mut(),
            simd: self.simd,
        };
        walk.run::<D>();
        self.draw_sky::<D>(space, &camera);
        self.frame.take_walls::<D, C>(self.simd, &space.columns, self.view.view_rows);
        self.draw_planes::<D, C>(space, &camera);
        self.draw_masked::<D, C>(space, &camera, world, player);
        self.draw_overlay::<D, C>(space, &camera, world, player);
    }

    fn draw_masked<D: DepthBuffer, C: ClassBuffer>(
        &mut self,
        space: &mut FrameScratch,
        camera: &Camera,
        world: &World,
        player: usize,
    ) {
        self.labels.list.clear();
        sprite::collect(
            &mut space.sprites,
            &self.scene,
            &self.view,
            camera,
            world,
            player,
            &space.entered,
        );
        space.trails.collect(&self.scene, &self.view, camera, world);
        let mut masked = SpritePass {
            scene: &self.scene,
            view: &self.view,
            camera,
            world,
            pictures: &space.pictures,
            frame: &mut self.frame,
            drawsegs: &mut space.drawsegs,
            labels: &mut self.labels,
            trails: &mut space.trails,
            columns: &mut space.patch_columns,
            published: self.published.as_mut(),
            simd: self.simd,
        };
        masked.draw::<D, C>(&space.sprites);
    }

    /// What is drawn over the world: weapon, status bar, flashes.
    fn draw_overlay<D: DepthBuffer, C: ClassBuffer>(
        &mut self,
        space: &mut FrameScratch,
        camera: &Camera,
        world: &World,
        player: usize,
    ) {
        let (scene, view) = (&self.scene, &self.view);
        let state = BarState::of_player(world, player);
        let player = &world.players[player];
        let level = world.get(player.actor).map_or(0, |body| world.sector(body.sector).light);
        let (columns, cache) = (&mut space.patch_columns, &mut space.weapons);
        let mut canvas =
            weapon::Canvas { frame: &mut self.frame, columns, cache, simd: self.simd, scene, view };
        canvas.weapon::<D, C>(camera, player, i32::from(level));
        self.status_bar.update(&mut self.frame, &scene.bar, view, state);
        let tint = Tint::of_player(player, self.options.green_goggles);
        if tint != self.tint {
            self.tint = tint;
            if tint != Tint::default() {
                *self.tinted = Colours::new(tint.apply(&scene.assets.palette));
            }
        }
    }

    /// Draws the sky, as far as its colours go, into the workspace's columns: its depth is what
    /// they were emptied to.
    fn draw_sky<D: DepthBuffer>(&mut self, space: &mut FrameScratch, camera: &Camera) {
        let picture = &self.scene.textures.walls[self.scene.sky];
        // Whatever light there is, and by goggles too.
        let shader = SkyShader {
            camera,
            view: &self.view,
            table: &self.scene.assets.light_tables[0],
            picture,
        };
        for plane in space.planes.used().iter().filter(|plane| plane.key.sky && !plane.is_empty()) {
            let rows = self
                .slopes
                .sky_rows(|horizon| sky::shader::texel_rows(&self.view, horizon, picture.height));
            sky::draw(&shader, self.simd, &mut space.columns, plane, &mut space.sky_columns, rows);
            if D::WRITTEN
                && let Some(published) = &self.published
            {
                let (shown, farthest) = (plane.first..plane.end, self.frame.depths.farthest());
                let ends = [&plane.top[shown.clone()], &plane.bottom[shown]];
                published.below(plane.first, ends, |x, row| {
                    space.columns.put_depth(x, row, || farthest);
                });
            }
        }
    }

    fn draw_planes<D: DepthBuffer, C: ClassBuffer>(
        &mut self,
        space: &mut FrameScratch,
        camera: &Camera,
    ) {
        let tables = &self.scene.assets.light_tables;
        for plane in space.planes.used() {
            if plane.is_empty() || (plane.key.sky && !C::WRITTEN) {
                continue;
            }
            if plane.key.sky {
                let count = spans::list(plane, self.simd, &mut space.span_starts, &mut space.spans);
                self.frame.classify(&space.spans[..count], class::SKY);
                continue;
            }
            let picture = space.pictures[usize::from(plane.key.texture.0)] as usize;
            let (flat, square) =
                (&self.scene.textures.flats[picture], self.scene.textures.squares[picture]);
            let shader =
                PlaneShader::new(camera, &self.view, &self.slopes, tables, plane.key, square);
            if whole::draw::<D, C>(&shader, self.simd, &mut self.frame, flat, plane) {
                continue;
            }
            let count = spans::list(plane, self.simd, &mut space.span_starts, &mut space.spans);
            draw::draw::<D, C>(&shader, self.simd, &mut self.frame, flat, &space.spans[..count]);
        }
    }

    /// The colours of palette indices in the last frame.
    fn colours(&self) -> &Colours {
        if self.tint == Tint::default() { &self.scene.colours } else { &self.tinted }
    }

    /// The palette indices of the last frame, row by row.
    #[must_use]
    pub fn indices(&self) -> &[u8] {
        &self.frame.colour
    }

    /// The colours of the palette indices, with the flashes of the last frame.
    #[must_use]
    pub fn palette(&self) -> &[[u8; 3]; 256] {
        &self.colours().palette
    }

    /// The depth of the last frame, if it was drawn: 0 near to 255 far, 7.3 map units a level;
    /// weapon and status bar 0.
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

    /// The actors of which the last frame drew a pixel, if labels were drawn, far to near; what
    /// came later may have hidden some.
    #[must_use]
    pub fn labels(&self) -> &[Label] {
        &self.labels.list
    }

    /// The actors of which the last frame shows a pixel, if labels were drawn, far to near: those
    /// of [`Renderer::labels`] that nothing nearer, no weapon and no status bar hides altogether.
    #[must_use]
    pub fn in_view(&self) -> Vec<InView> {
        labels::in_view(&self.labels.list, &self.frame.class, self.view.width())
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
        assert_eq!(
            out.len(),
            self.frame.colour.len() * 3,
            "a buffer of height * width * 3 bytes is needed"
        );
        convert::rgb_interleaved(self.simd, self.colours(), &self.frame.colour, out);
    }

    /// Writes the last frame as a plane of red, one of green, one of blue.
    ///
    /// # Panics
    /// If `out` is not three times as long as a frame has pixels.
    pub fn write_rgb_chw(&self, out: &mut [u8]) {
        assert_eq!(
            out.len(),
            self.frame.colour.len() * 3,
            "a buffer of 3 * height * width bytes is needed"
        );
        convert::rgb_planes(self.simd, self.colours(), &self.frame.colour, out);
    }

    /// Writes the last frame's luminance.
    ///
    /// # Panics
    /// If `out` is not as long as a frame has pixels.
    pub fn write_grey(&self, out: &mut [u8]) {
        assert_eq!(
            out.len(),
            self.frame.colour.len(),
            "a buffer of height * width bytes is needed"
        );
        convert::grey(self.simd, self.colours(), &self.frame.colour, out);
    }

    /// Writes the last frame's depth, which must have been asked for.
    ///
    /// # Panics
    /// If `out` is not as long as a frame has pixels.
    pub fn write_depth(&self, out: &mut [u8]) {
        assert_eq!(out.len(), self.frame.depth.len(), "a buffer of height * width bytes is needed");
        out.copy_from_slice(&self.frame.depth);
    }

    /// Writes the last frame row by row, red, green, blue and depth of each pixel in turn; depth
    /// must have been asked for.
    ///
    /// # Panics
    /// If `out` is not four times as long as a frame has pixels.
    pub fn write_rgb_depth_hwc(&self, out: &mut [u8]) {
        assert_eq!(
            out.len(),
            self.frame.colour.len() * 4,
            "a buffer of height * width * 4 bytes is needed"
        );
        convert::rgb_depth_interleaved(
            self.simd,
            self.colours(),
            &self.frame.colour,
            &self.frame.depth,
            out,
        );
    }

    /// Writes the last frame with one colour per class, red, green and blue of each pixel in turn;
    /// labels must have been asked for.
    ///
    /// # Panics
    /// If `out` is not three times as long as a frame has pixels.
    pub fn write_segmented_hwc(&self, colours: &SegmentationColours, out: &mut [u8]) {
        assert_eq!(
            out.len(),
            self.frame.class.len() * 3,
            "a buffer of height * width * 3 bytes is needed"
        );
        convert::classes_interleaved(
            self.simd,
            &self.class_colours(colours),
            &self.frame.class,
            out,
        );
    }

    /// Writes the last frame with one colour per class as three planes; labels must have been asked
    /// for.
    ///
    /// # Panics
    /// If `out` is not three times as long as a frame has pixels.
    pub fn write_segmented_chw(&self, colours: &SegmentationColours, out: &mut [u8]) {
        assert_eq!(
            out.len(),
            self.frame.class.len() * 3,
            "a buffer of 3 * height * width bytes is needed"
        );
        convert::classes_planes(&self.class_colours(colours), &self.frame.class, out);
    }

    /// Writes the last frame's labels as ViZDoom gives them: 1 for floors and ceilings with a
    /// picture of 64 by 64 texels, 0 for other surfaces, the `n`th of `N` actors `n * 255 /
    /// (N + 1)`, the weapon 255; labels must have been asked for.
    ///
    /// # Panics
    /// If `out` is not as long as a frame has pixels.
    pub fn write_labels(&self, out: &mut [u8]) {
        assert_eq!(out.len(), self.frame.class.len(), "a buffer of height * width bytes is needed");
        let count = self.labels.list.len();
        let mut values = [0; CLASSES];
        values[usize::from(class::WEAPON)] = 255;
        let actors = &mut values[usize::from(class::FIRST_ACTOR)..];
        actors
            .iter_mut()
            .take(count)
            .enumerate()
            .for_each(|(index, value)| *value = labels::value(index, count));
        convert::classes_one_byte(&values, class::WEAPON, &self.frame.class, out);
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
