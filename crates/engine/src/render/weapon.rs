//! The player's own weapon in the lower part of the view, with its muzzle flash.

use super::View;
use super::camera::Camera;
use super::frame::{Frame, class};
use super::light::Light;
use super::palette::power_shows;
use super::picture::MaskedPicture;
use super::scene::Scene;
use crate::world::{OPAQUE, Player, PlayerSprite};

/// The screen that weapon positions are given on is 320 by 200 pixels; its middle row is that of the view.
const SCREEN_WIDTH: i64 = 320;
const MIDDLE_ROW: i64 = 100;
/// Fractional bits of texture positions.
const TEXEL_BITS: u32 = 32;

/// Draws both layers of a player's weapon; `level` is the light of its sector.
pub(super) fn draw<const DEPTH: bool, const CLASS: bool>(
    frame: &mut Frame,
    scene: &Scene,
    view: &View,
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
        let table = &scene.assets.light_tables[table];
        layer::<DEPTH, CLASS>(frame, scene, view, sprite, table, opacity);
    }
}

fn layer<const DEPTH: bool, const CLASS: bool>(
    frame: &mut Frame,
    scene: &Scene,
    view: &View,
    sprite: &PlayerSprite,
    table: &[u8; 256],
    opacity: u8,
) {
    let shown = scene.assets.sprites.get(usize::from(sprite.sprite));
    let image = shown.and_then(|shown| shown.frames.get(usize::from(sprite.frame))).map(|frame| frame.images[0]);
    let picture = image.and_then(|image| scene.sprite_pictures.get(image as usize)?.as_ref());
    let Some(picture) = picture else { return };
    let left = (i64::from(sprite.x.0) - (i64::from(picture.offset_x) << 16)) << (TEXEL_BITS - 16);
    let top = (i64::from(sprite.y.0) - (i64::from(picture.offset_y) << 16)) << (TEXEL_BITS - 16);
    let u_step = (SCREEN_WIDTH << TEXEL_BITS) / i64::from(view.base_width);
    // Rows are 1.2 times as high as columns are wide.
    let v_step = u_step * 10 / 12;
    // Columns from the left edge of the one in which the picture begins, rows by their lower edge.
    let column = |texel: u32| {
        let position = (left + (i64::from(texel) << TEXEL_BITS)) >> 16;
        (position * i64::from(view.base_width) / SCREEN_WIDTH) >> (TEXEL_BITS - 16)
    };
    let u = -u_step * column(0);
    let v = v_step * (1 - i64::from(view.base_view_rows / 2)) + (MIDDLE_ROW << TEXEL_BITS) - top;
    // Frame columns and rows that show the picture at all.
    let row = |texel: u32| {
        let row = ((i64::from(texel) << TEXEL_BITS) - v + v_step - 1).div_euclid(v_step);
        view.first_row[row.clamp(0, i64::from(view.base_view_rows)) as usize] as usize
    };
    let [first, end] = [column(0), column(picture.width)].map(|column| column.clamp(0, i64::from(view.base_width)) as usize);
    let columns = usize::from(view.first_column[first])..usize::from(view.first_column[end]);
    let rows = row(0)..row(picture.height);
    // Column by column, as the picture lies.
    for x in columns {
        let texel = ((u + u_step * i64::from(view.columns[x])) >> TEXEL_BITS) as u32;
        let texels = picture.column(texel.min(picture.width - 1));
        for row in rows.clone() {
            let texel = texels[((v + v_step * i64::from(view.rows[row])) >> TEXEL_BITS) as usize];
            if texel & MaskedPicture::OPAQUE == 0 {
                continue;
            }
            let at = row * frame.width + x;
            let pixel = &mut frame.colour[at];
            let lit = table[usize::from(texel as u8)];
            *pixel = if opacity == OPAQUE { lit } else { scene.blend.over(lit, *pixel, opacity) };
            if DEPTH {
                frame.depth[at] = 0;
            }
            if CLASS {
                frame.class[at] = class::WEAPON;
            }
        }
    }
}
