//! The player's own weapon in the lower part of the view, with its muzzle flash.

use crate::render::buffers::frame::{Frame, class};
use crate::render::buffers::written::{ClassBuffer, DepthBuffer};
use crate::render::colour::tint::power_shows;
use crate::render::overlay::weapon_cache::{LayerKey, WeaponCache};
use crate::render::patch;
use crate::render::patch::data::{Patch, PatchColumns, TEXEL_BITS, first_row};
use crate::render::scene::prepared::Scene;
use crate::render::view::camera::Camera;
use crate::render::view::light::Light;
use crate::render::view::tables::View;
use crate::simd::Simd;
use crate::world::{OPAQUE, Player, PlayerSprite};

/// The screen that weapon positions are given on is 320 by 200 pixels; its middle row is that of
/// the view.
const SCREEN_WIDTH: i64 = 320;
const MIDDLE_ROW: i64 = 100;
/// Where a weapon is drawn.
pub(crate) struct Canvas<'a> {
    pub frame: &'a mut Frame,
    pub scene: &'a Scene,
    pub view: &'a View,
    /// Scratch: the columns of the layer at hand.
    pub columns: &'a mut PatchColumns,
    pub cache: &'a mut WeaponCache,
    pub simd: Simd,
}

impl Canvas<'_> {
    /// Draws both layers of a player's weapon; `level` is the light of its sector.
    pub fn weapon<D: DepthBuffer, C: ClassBuffer>(
        &mut self,
        camera: &Camera,
        player: &Player,
        level: i32,
    ) {
        let opacity = if power_shows(player.blur_tics) { OPAQUE / 2 } else { OPAQUE };
        for sprite in player.sprites.iter().flatten() {
            let table = match (sprite.bright, camera.fixed_table) {
                (true, None) => 0,
                _ => Light::new(camera, level).nearest_table(),
            };
            self.layer::<D, C>(sprite, table, opacity);
        }
    }

    fn layer<D: DepthBuffer, C: ClassBuffer>(
        &mut self,
        sprite: &PlayerSprite,
        table: usize,
        opacity: u8,
    ) {
        let (scene, view) = (self.scene, self.view);
        let shown = scene.assets.sprites.get(usize::from(sprite.sprite));
        let image = shown
            .and_then(|shown| shown.frames.get(usize::from(sprite.frame)))
            .map(|frame| frame.images[0]);
        let picture = image.and_then(|image| scene.sprite_pictures.get(image as usize)?.as_ref());
        let (Some(image), Some(picture)) = (image, picture) else { return };
        let is_opaque = opacity == OPAQUE;
        let (size, place) = (view.size(), [sprite.x, sprite.y]);
        let key = LayerKey { scene: scene.serial, size, image, light_table: table, place };
        if is_opaque && self.cache.copy::<D, C>(&key, self.frame) {
            return;
        }
        let left =
            (i64::from(sprite.x.0) - (i64::from(picture.offset_x) << 16)) << (TEXEL_BITS - 16);
        let top =
            (i64::from(sprite.y.0) - (i64::from(picture.offset_y) << 16)) << (TEXEL_BITS - 16);
        let u_step = (SCREEN_WIDTH << TEXEL_BITS) / i64::from(view.base_width);
        // Rows are 1.2 times as high as columns are wide.
        let v_step = u_step * 10 / 12;
        // Columns from the left edge of the one in which the picture begins, rows by their lower
        // edge.
        let column = |texel: u32| {
            let position = (left + (i64::from(texel) << TEXEL_BITS)) >> 16;
            (position * i64::from(view.base_width) / SCREEN_WIDTH) >> (TEXEL_BITS - 16)
        };
        let u = -u_step * column(0);
        let v =
            v_step * (1 - i64::from(view.base_view_rows / 2)) + (MIDDLE_ROW << TEXEL_BITS) - top;
        // Frame columns and rows that show the picture at all.
        let row = |texel: u32| first_row(view, texel, v, v_step) as usize;
        let [first, end] = [column(0), column(picture.width)]
            .map(|column| column.clamp(0, i64::from(view.base_width)) as usize);
        let [first, end] = [first, end].map(|column| usize::from(view.first_column[column]));
        let texel = |&column: &u32| {
            (((u + u_step * i64::from(column)) >> TEXEL_BITS) as u32).min(picture.width - 1) as u16
        };
        self.columns
            .open(0..view.view_rows as i16, view.columns[first..end.max(first)].iter().map(texel));
        let stamp = Patch {
            picture,
            table: &scene.assets.light_tables[table],
            first,
            columns: self.columns,
            rows: row(0)..row(picture.height),
            v,
            v_step,
            mixture: (!is_opaque).then(|| scene.blend.mixture(opacity)),
            depth: 0,
            class: class::WEAPON,
        };
        if is_opaque {
            self.cache.note(key, &stamp, self.simd, view);
        }
        patch::draw::<D, C>(&stamp, self.simd, self.frame, &view.rows);
    }
}
