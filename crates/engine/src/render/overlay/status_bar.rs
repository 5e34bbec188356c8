//! The status bar. Its pixels stay in the frame from one picture to the next; a part is drawn again
//! when what it shows has changed.

use crate::render::buffers::frame::Frame;
use crate::render::textures::hud::BarArt;
use crate::render::textures::masked::MaskedTexture;
use crate::render::view::tables::View;
use crate::render::view::tables::{BAR_ART_HEIGHT, BAR_ART_WIDTH, bar_scale};
use crate::world::{Face, Weapon, World};

/// Everything that the bar shows.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct BarState {
    ammo: Option<i32>,
    health: i32,
    /// Weapons owned, by slots 2 to 7.
    arms: [bool; 6],
    face: Face,
    face_band: usize,
    armour: i32,
    keys: u8,
    stock: [[i32; 2]; 4],
}

/// Largest number of three digits; more is not shown.
const LARGEST: i32 = 999;

impl BarState {
    /// What a player's bar shows.
    pub fn of_player(world: &World, index: usize) -> BarState {
        let player = &world.players[index];
        let health = world.get(player.actor).map_or(0, |body| body.health).clamp(0, LARGEST);
        let arms = [
            Weapon::Pistol.bit(),
            Weapon::Shotgun.bit() | Weapon::SuperShotgun.bit(),
            Weapon::Chaingun.bit(),
            Weapon::RocketLauncher.bit(),
            Weapon::PlasmaRifle.bit(),
            Weapon::Bfg9000.bit(),
        ]
        .map(|bits| player.weapons & bits != 0);
        let ammo: [i32; 4] = std::array::from_fn(|i| player.ammo[i] + player.just_spent[i]);
        BarState {
            ammo: player.weapon.map(|weapon| ammo[weapon.ammo_type()].clamp(0, LARGEST)),
            health,
            arms,
            face: player.face_state.shown,
            face_band: usize::from(world.face_band(index)),
            armour: player.armor.clamp(0, LARGEST),
            keys: player.keys,
            stock: std::array::from_fn(|i| {
                [ammo[i], player.max_ammo[i]].map(|n| n.clamp(0, LARGEST))
            }),
        }
    }
}

/// Columns of the art that each part takes: ammunition, health, arms, face, armour, keys, stock.
/// They end where nothing is drawn, as a percent sign may be one column wider than its field.
const PARTS: [[usize; 2]; 7] =
    [[0, 48], [48, 108], [108, 143], [143, 179], [179, 238], [238, 249], [249, 320]];
/// Column of the panel of arms.
const ARMS: i32 = 104;
/// Right ends of the big numbers, in art columns, and their row.
const AMMO_END: i32 = 44;
const HEALTH_END: i32 = 90;
const ARMOUR_END: i32 = 221;
const NUMBER_ROW: i32 = 3;

/// Draws the bar of a frame.
#[derive(Clone, Debug)]
pub(crate) struct StatusBar {
    /// The bar without numbers, at the frame's size.
    background: Vec<u8>,
    /// The bar as it is.
    pixels: Vec<u8>,
    /// What it shows.
    shown: Option<BarState>,
}

impl StatusBar {
    pub fn new(art: &BarArt, view: &View) -> StatusBar {
        let (width, rows) = (view.width(), view.bar_rows.len());
        let mut bar = StatusBar {
            background: vec![0; width * rows],
            pixels: vec![0; width * rows],
            shown: None,
        };
        let mut background = std::mem::take(&mut bar.background);
        for (picture, x) in [(&art.bar, 0), (&art.arms, ARMS)] {
            draw(&mut background, view, picture.as_ref(), x, 0);
        }
        bar.background = background;
        bar
    }

    /// Brings the bar up to date.
    pub fn update(&mut self, frame: &mut Frame, art: &BarArt, view: &View, state: BarState) {
        let pixels = &mut self.pixels[..];
        let old = self.shown.replace(state);
        let changed =
            |part: fn(&BarState, &BarState) -> bool| old.is_none_or(|old| !part(&old, &state));
        let mut canvas = |part: usize| {
            let [first, end] =
                PARTS[part].map(|art| frame_column(view, base_column(view, art as i32)));
            for row in 0..view.bar_rows.len() {
                let row = row * frame.width;
                pixels[row + first..row + end]
                    .copy_from_slice(&self.background[row + first..row + end]);
            }
        };
        let redraw = [
            changed(|a, b| a.ammo == b.ammo),
            changed(|a, b| a.health == b.health),
            changed(|a, b| a.arms == b.arms),
            changed(|a, b| (a.face, a.face_band) == (b.face, b.face_band)),
            changed(|a, b| a.armour == b.armour),
            changed(|a, b| a.keys == b.keys),
            changed(|a, b| a.stock == b.stock),
        ];
        (0..PARTS.len()).filter(|&part| redraw[part]).for_each(&mut canvas);

        if redraw[0]
            && let Some(ammo) = state.ammo
        {
            number(pixels, view, &art.big_digits, ammo, AMMO_END, NUMBER_ROW);
        }
        if redraw[1] {
            number(pixels, view, &art.big_digits, state.health, HEALTH_END, NUMBER_ROW);
            draw(pixels, view, art.percent.as_ref(), HEALTH_END, NUMBER_ROW);
        }
        if redraw[2] {
            for slot in 0..6 {
                let digits = if state.arms[slot] { &art.yellow_digits } else { &art.grey_digits };
                let (x, y) = (111 + 12 * (slot as i32 % 3), 4 + 10 * (slot as i32 / 3));
                draw(pixels, view, digits[slot + 2].as_ref(), x, y);
            }
        }
        if redraw[3] {
            let face = art.face(state.face, state.face_band);
            draw(pixels, view, face, PARTS[3][0] as i32, 0);
        }
        if redraw[4] {
            number(pixels, view, &art.big_digits, state.armour, ARMOUR_END, NUMBER_ROW);
            draw(pixels, view, art.percent.as_ref(), ARMOUR_END, NUMBER_ROW);
        }
        if redraw[5] {
            // The yellow card is the second of three slots, the blue skull the first.
            for (bit, key, row) in [(1, 3, 0), (0, 1, 1)] {
                if state.keys >> bit & 1 != 0 {
                    draw(pixels, view, art.keys[key].as_ref(), 239, 3 + 10 * row);
                }
            }
        }
        if redraw[6] {
            for (i, [stock, most]) in state.stock.into_iter().enumerate() {
                let y = 5 + 6 * i as i32;
                number(pixels, view, &art.yellow_digits, stock, 288, y);
                number(pixels, view, &art.yellow_digits, most, 314, y);
            }
        }
        frame.colour[view.view_rows * frame.width..].copy_from_slice(&self.pixels);
    }
}

/// Draws a number whose last digit ends left of art column `end`.
fn number(
    pixels: &mut [u8],
    view: &View,
    digits: &[Option<MaskedTexture>; 10],
    value: i32,
    end: i32,
    y: i32,
) {
    let width = digits[0].as_ref().map_or(0, |digit| digit.width as i32);
    let (mut rest, mut x) = (value, end);
    loop {
        x -= width;
        draw(pixels, view, digits[(rest % 10) as usize].as_ref(), x, y);
        rest /= 10;
        if rest == 0 {
            return;
        }
    }
}

/// The base column in which an art column begins.
fn base_column(view: &View, art: i32) -> i64 {
    i64::from(art) * i64::from(view.base_width) / i64::from(BAR_ART_WIDTH)
}

/// The first frame column at or right of a base column.
fn frame_column(view: &View, base: i64) -> usize {
    usize::from(view.first_column[base.clamp(0, i64::from(view.base_width)) as usize])
}

/// Draws a picture with its anchor at an art position. Each picture is placed at whole pixels by
/// itself, and takes the texels at the left and upper edges of pixels.
fn draw(pixels: &mut [u8], view: &View, picture: Option<&MaskedTexture>, x: i32, y: i32) {
    let Some(picture) = picture else { return };
    let (left, top) = (x - picture.offset_x, y - picture.offset_y);
    let [first, end] = [left, left + picture.width as i32].map(|art| base_column(view, art));
    let u_step = (i64::from(BAR_ART_WIDTH) << 16) / i64::from(view.base_width);
    let [rows, art] = bar_scale(view.base_width, view.base_rows()).map(i64::from);
    let top = i64::from(view.base_rows())
        - ((i64::from(BAR_ART_HEIGHT as i32 - top) * rows + art - 1) / art);
    let scale = ((rows << 16) + art / 2) / art;
    let v_step = (1i64 << 32) / scale;
    for column in frame_column(view, first)..frame_column(view, end) {
        let u = ((i64::from(view.columns[column]) - first) * u_step) >> 16;
        let texels = picture.column((u as u32).min(picture.width - 1));
        let first_row = view.bar_rows.partition_point(|&row| i64::from(row) < top);
        for (row, &base) in view.bar_rows.iter().enumerate().skip(first_row) {
            let v = ((i64::from(base) - top) * v_step) >> 16;
            match texels.get(v as usize) {
                Some(&texel) if texel & MaskedTexture::OPAQUE != 0 => {
                    pixels[row * view.width() + column] = texel as u8
                }
                Some(_) => {}
                None => break,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assets::Assets;

    #[test]
    fn the_embedded_bar_is_complete() {
        let art = BarArt::new(&Assets::embedded());
        let single = [&art.bar, &art.arms, &art.percent, &art.dead_face];
        let many = art
            .big_digits
            .iter()
            .chain(&art.grey_digits)
            .chain(&art.yellow_digits)
            .chain(&art.keys);
        assert!(
            single
                .into_iter()
                .chain(many)
                .chain(art.sidedefs.iter().flatten())
                .all(Option::is_some)
        );
    }
}
