//! The renderer: draws what one player of a world sees.

use super::camera::Camera;
use super::frame::Frame;
use super::openings::Openings;
use super::plane::{PlaneShader, Planes};
use super::scene::Scene;
use super::silhouette::Silhouettes;
use super::sky::SkyShader;
use super::walk::{Walk, WalkScratch};
use super::{Buffers, View};
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
    /// Sectors that the frame entered.
    entered: Vec<bool>,
    /// Index of the picture that each texture shows.
    pictures: Vec<u32>,
    /// First column of each row's span.
    span_starts: Vec<u16>,
    /// Start of each column's texels in the sky's picture.
    sky_columns: Vec<u32>,
}

impl Renderer {
    /// A renderer for worlds of the scene's map.
    #[must_use]
    pub fn new(scene: Arc<Scene>, view: Arc<View>) -> Renderer {
        let (width, pixels) = (view.width(), view.size.pixels());
        let mut walk = WalkScratch::default();
        walk.resize(width);
        Renderer {
            frame: Frame {
                width,
                colour: vec![0; pixels],
                depth: vec![0; pixels],
                class: vec![0; pixels],
                depth_cap: 255,
            },
            openings: Openings::default(),
            planes: Planes::default(),
            silhouettes: Silhouettes::default(),
            walk,
            entered: vec![false; scene.sector_count],
            pictures: Vec::new(),
            span_starts: vec![0; view.view_rows],
            sky_columns: vec![0; width],
            scene,
            view,
        }
    }

    /// Draws what player `player` of `world` sees.
    ///
    /// # Panics
    /// If the world is of another map than the scene, or has no such player.
    pub fn render(&mut self, world: &World, player: usize, buffers: Buffers) {
        assert_eq!(world.sectors.len(), self.scene.sector_count, "the world is of another map than the scene");
        match (buffers.depth, buffers.labels) {
            (false, false) => self.draw::<false, false>(world, player),
            (true, false) => self.draw::<true, false>(world, player),
            (false, true) => self.draw::<false, true>(world, player),
            (true, true) => self.draw::<true, true>(world, player),
        }
    }

    fn draw<const DEPTH: bool, const CLASS: bool>(&mut self, world: &World, player: usize) {
        let camera = Camera::of_player(world, player, &self.view);
        self.animate(world.tic);
        self.frame.clear::<DEPTH, CLASS>(self.view.view_rows, 0);
        self.openings.reset(self.view.width(), self.view.view_rows);
        self.planes.reset(self.view.width());
        self.silhouettes.reset();
        self.entered.fill(false);
        let mut walk = Walk {
            scene: &self.scene,
            view: &self.view,
            camera: &camera,
            sectors: &world.sectors,
            pictures: &self.pictures,
            frame: &mut self.frame,
            openings: &mut self.openings,
            planes: &mut self.planes,
            silhouettes: &mut self.silhouettes,
            entered: &mut self.entered,
            scratch: &mut self.walk,
        };
        walk.run::<DEPTH, CLASS>();
        self.draw_planes::<DEPTH, CLASS>(&camera);
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
            if plane.first >= plane.end {
                continue;
            }
            if plane.key.sky {
                let shader = SkyShader {
                    camera,
                    view: &self.view,
                    table: &tables[camera.fixed_table.unwrap_or(0)],
                    picture: &self.scene.textures.walls[self.scene.sky],
                };
                shader.columns(&mut self.sky_columns, plane.first, plane.end);
                plane.spans(&mut self.span_starts, |row, first, end| {
                    shader.span::<DEPTH, CLASS>(&mut self.frame, &self.sky_columns, row, first, end);
                });
            } else {
                let shader = PlaneShader::new(camera, &self.view, tables, plane.key);
                let picture = self.pictures[usize::from(plane.key.texture.0)];
                let flat = &self.scene.textures.flats[picture as usize];
                plane.spans(&mut self.span_starts, |row, first, end| {
                    shader.span::<DEPTH, CLASS>(&mut self.frame, flat, row, first, end);
                });
            }
        }
    }

    /// The palette indices of the last frame, row by row.
    #[must_use]
    pub fn indices(&self) -> &[u8] {
        &self.frame.colour
    }
}
