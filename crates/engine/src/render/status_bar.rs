//! The status bar. Its pixels stay in the frame from one picture to the next; a part is drawn again when what it
//! shows has changed.

use super::View;
use super::frame::Frame;
use super::picture::MaskedPicture;
use crate::assets::Assets;
use crate::map::TextureName;
use crate::world::{Actor, Player, Weapon};

/// The pictures of the bar; what a set lacks is not drawn.
#[derive(Clone, Debug)]
pub(super) struct BarArt {
    bar: Option<MaskedPicture>,
    arms: Option<MaskedPicture>,
    big_digits: [Option<MaskedPicture>; 10],
    percent: Option<MaskedPicture>,
    grey_digits: [Option<MaskedPicture>; 10],
    yellow_digits: [Option<MaskedPicture>; 10],
    /// By band of health, then by [`Mood`].
    faces: [[Option<MaskedPicture>; Mood::COUNT]; FACE_BANDS],
    dead_face: Option<MaskedPicture>,
    /// Blue, yellow and red cards, then skulls.
    keys: [Option<MaskedPicture>; 6],
}

/// Bands of health that the face tells apart.
const FACE_BANDS: usize = 5;

impl BarArt {
    pub fn new(assets: &Assets) -> BarArt {
        let find = |name: String| {
            let index = *assets.graphics.get(&TextureName::new(&name))?;
            Some(MaskedPicture::new(assets.images.get(index as usize)?))
        };
        let digits = |prefix: &str| std::array::from_fn(|digit| find(format!("{prefix}{digit}")));
        BarArt {
            bar: find("STBAR".into()),
            arms: find("STARMS".into()),
            big_digits: digits("STTNUM"),
            percent: find("STTPRCNT".into()),
            grey_digits: digits("STGNUM"),
            yellow_digits: digits("STYSNUM"),
            faces: std::array::from_fn(|band| {
                std::array::from_fn(|mood| {
                    find(match mood {
                        0..=2 => format!("STFST{band}{mood}"),
                        3 => format!("STFKILL{band}"),
                        _ => format!("STFOUCH{band}"),
                    })
                })
            }),
            dead_face: find("STFDEAD0".into()),
            keys: std::array::from_fn(|i| find(format!("STKEYS{i}"))),
        }
    }
}

/// What the face does.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Mood {
    /// Looks right, ahead or left.
    Glance(u8),
    /// Is being hurt.
    Rage,
    /// Is being hurt much.
    Ouch,
}

impl Mood {
    const COUNT: usize = 5;
    /// Tics between glances.
    const GLANCE_TICS: u32 = 17;
    /// Damage counter from which a blow is a heavy one.
    const HEAVY_BLOW: u8 = 20;

    fn index(self) -> usize {
        match self {
            Mood::Glance(direction) => usize::from(direction),
            Mood::Rage => 3,
            Mood::Ouch => 4,
        }
    }
}

/// Everything that the bar shows.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct BarState {
    ammo: Option<i32>,
    health: i32,
    arms: u8,
    dead: bool,
    mood: Mood,
    armour: i32,
    keys: u8,
    stock: [[i32; 2]; 4],
}

/// Largest number of three digits; more is not shown.
const LARGEST: i32 = 999;

impl BarState {
    /// What a player's bar shows.
    pub fn of_player(player: &Player, body: Option<&Actor>, tic: u32) -> BarState {
        let health = body.map_or(0, |body| body.health).clamp(0, LARGEST);
        let owned = |weapon: Weapon| player.weapons >> (weapon as u16) & 1 != 0;
        let slots = [
            owned(Weapon::Pistol),
            owned(Weapon::Shotgun) || owned(Weapon::SuperShotgun),
            owned(Weapon::Chaingun),
            owned(Weapon::RocketLauncher),
            owned(Weapon::PlasmaRifle),
            owned(Weapon::Bfg9000),
        ];
        let mood = match player.damage_count {
            0 => Mood::Glance(glance(tic / Mood::GLANCE_TICS)),
            count if count > Mood::HEAVY_BLOW => Mood::Ouch,
            _ => Mood::Rage,
        };
        BarState {
            ammo: player.weapon.and_then(ammo_of).map(|kind| player.ammo[kind].clamp(0, LARGEST)),
            health,
            arms: (0..6).fold(0, |bits, i| bits | u8::from(slots[i]) << i),
            dead: player.dead,
            mood,
            armour: player.armor.clamp(0, LARGEST),
            keys: player.keys,
            stock: std::array::from_fn(|i| [player.ammo[i], player.max_ammo[i]].map(|n| n.clamp(0, LARGEST))),
        }
    }
}

/// The ammunition of a weapon, as an index into [`Player::ammo`].
fn ammo_of(weapon: Weapon) -> Option<usize> {
    match weapon {
        Weapon::Pistol | Weapon::Chaingun => Some(0),
        Weapon::Shotgun | Weapon::SuperShotgun => Some(1),
        Weapon::RocketLauncher => Some(2),
        Weapon::PlasmaRifle | Weapon::Bfg9000 => Some(3),
    }
}

/// Where the face looks in the `n`th stretch of time: of no consequence, so not drawn from the world's stream.
fn glance(n: u32) -> u8 {
    ((n.wrapping_mul(0x9E37_79B1) >> 16) % 3) as u8
}

/// Columns of the art that each part takes: ammunition, health, arms, face, armour, keys, stock.
const PARTS: [[usize; 2]; 7] = [[0, 48], [48, 104], [104, 143], [143, 179], [179, 236], [236, 249], [249, 320]];
/// Right ends of the big numbers, in art columns, and their row.
const AMMO_END: i32 = 44;
const HEALTH_END: i32 = 90;
const ARMOUR_END: i32 = 221;
const NUMBER_ROW: i32 = 3;

/// Draws the bar of a frame.
#[derive(Clone, Debug)]
pub(super) struct StatusBar {
    /// The bar without numbers, at the frame's size.
    background: Vec<u8>,
    /// What the frame shows now.
    shown: Option<BarState>,
}

impl StatusBar {
    pub fn new(art: &BarArt, view: &View) -> StatusBar {
        let (width, rows) = (view.width(), view.bar_rows.len());
        let mut bar = StatusBar { background: vec![0; width * rows], shown: None };
        let mut background = std::mem::take(&mut bar.background);
        for (picture, x) in [(&art.bar, 0), (&art.arms, PARTS[2][0] as i32)] {
            draw(&mut background, view, picture.as_ref(), x, 0);
        }
        bar.background = background;
        bar
    }

    /// Brings the bar up to date.
    pub fn update(&mut self, frame: &mut Frame, art: &BarArt, view: &View, state: BarState) {
        let start = view.view_rows * frame.width;
        let pixels = &mut frame.colour[start..];
        let old = self.shown.replace(state);
        let changed = |part: fn(&BarState, &BarState) -> bool| old.is_none_or(|old| !part(&old, &state));
        let mut canvas = |part: usize| {
            let [first, end] = PARTS[part].map(|art| usize::from(view.first_bar_column[art]));
            for row in 0..view.bar_rows.len() {
                let row = row * frame.width;
                pixels[row + first..row + end].copy_from_slice(&self.background[row + first..row + end]);
            }
        };
        let redraw = [
            changed(|a, b| a.ammo == b.ammo),
            changed(|a, b| a.health == b.health),
            changed(|a, b| a.arms == b.arms),
            changed(|a, b| (face_band(a), a.mood, a.dead) == (face_band(b), b.mood, b.dead)),
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
                let digits = if state.arms >> slot & 1 != 0 { &art.yellow_digits } else { &art.grey_digits };
                let (x, y) = (111 + 12 * (slot as i32 % 3), 4 + 10 * (slot as i32 / 3));
                draw(pixels, view, digits[slot + 2].as_ref(), x, y);
            }
        }
        if redraw[3] {
            let face = if state.dead { &art.dead_face } else { &art.faces[face_band(&state)][state.mood.index()] };
            draw(pixels, view, face.as_ref(), PARTS[3][0] as i32, 0);
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
    }
}

/// Which face a state of health has, 0 the healthiest.
fn face_band(state: &BarState) -> usize {
    ((100 - state.health.min(100)) as usize * FACE_BANDS / 101).min(FACE_BANDS - 1)
}

/// Draws a number whose last digit ends left of art column `end`.
fn number(pixels: &mut [u8], view: &View, digits: &[Option<MaskedPicture>; 10], value: i32, end: i32, y: i32) {
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

/// Draws a picture with its anchor at an art position, each pixel by the nearest texel.
fn draw(pixels: &mut [u8], view: &View, picture: Option<&MaskedPicture>, x: i32, y: i32) {
    let Some(picture) = picture else { return };
    let (left, top) = (x - picture.offset_x, y - picture.offset_y);
    let columns = [left, left + picture.width as i32].map(|art| art.clamp(0, 320) as usize);
    let rows = [top, top + picture.height as i32].map(|art| art.clamp(0, 32) as usize);
    let (columns, rows) = (columns.map(|art| view.first_bar_column[art]), rows.map(|art| view.first_bar_row[art]));
    for column in usize::from(columns[0])..usize::from(columns[1]) {
        let texels = picture.column((i32::from(view.bar_columns[column]) - left) as u32);
        for row in usize::from(rows[0])..usize::from(rows[1]) {
            let texel = texels[(i32::from(view.bar_rows[row]) - top) as usize];
            if texel & MaskedPicture::OPAQUE != 0 {
                pixels[row * view.width() + column] = texel as u8;
            }
        }
    }
}
