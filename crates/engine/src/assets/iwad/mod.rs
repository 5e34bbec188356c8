//! A picture set read from an IWAD such as Freedoom's: palette, light tables, wall textures, flats, sprites, status bar.
//!
//! Everything is checked: whatever a file claims, loading ends in pictures or in an error, within the bounds of
//! [`Budget`](budget::Budget).

mod animation;
mod budget;
mod error;
mod flats;
mod picture;
mod sprites;
mod substitutes;
#[cfg(test)]
mod tests;
mod wall_textures;

pub use error::IwadError;
pub(crate) use substitutes::STAND_INS;

use super::{Assets, Image, TextureEntry};
use crate::map::TextureName;
use crate::wad::{Lump, Wad};
use budget::Budget;
use std::collections::BTreeMap;

/// Beginnings of the names of status-bar lumps.
const STATUS_BAR: [&str; 9] = ["STBAR", "STARMS", "STTNUM", "STTMINUS", "STTPRCNT", "STYSNUM", "STGNUM", "STF", "STKEYS"];

impl Assets {
    /// Reads the picture set of an IWAD.
    ///
    /// Of equal names the last lump counts. Where a wall texture and a flat share a name, the wall texture is taken.
    /// Sprites that the file lacks are taken from the embedded set.
    ///
    /// # Errors
    /// The first broken or missing part, by its lump's name.
    pub fn from_iwad(bytes: &[u8]) -> Result<Assets, IwadError> {
        let wad = Wad::read(bytes)?;
        let mut budget = Budget::new();
        let mut set = Assets {
            palette: palette(&wad)?,
            light_tables: light_tables(&wad)?,
            images: Vec::new(),
            textures: BTreeMap::new(),
            fallbacks: Vec::new(),
            sprites: Vec::new(),
            graphics: BTreeMap::new(),
        };
        let sections = Sections::new(&wad);
        let flats = flats::load(&mut set, &sections, &mut budget)?;
        let walls = wall_textures::load(&mut set, &wad, &sections, &mut budget)?;
        animation::apply(&mut set, &wad, &flats, &walls);
        substitutes::textures(&mut set);
        sprites::load(&mut set, &sections, &mut budget)?;
        substitutes::sprites(&mut set, &Assets::embedded());
        for lump in &sections.rest {
            if STATUS_BAR.iter().any(|prefix| lump.name.as_str().starts_with(prefix)) {
                let image = picture::decode(lump, &mut budget)?;
                let index = push(&mut set, image);
                set.graphics.insert(lump.name, index);
            }
        }
        Ok(set)
    }
}

/// Adds a picture and gives its index.
fn push(set: &mut Assets, image: Image) -> u32 {
    set.images.push(image);
    set.images.len() as u32 - 1
}

/// A texture without animation.
fn still(first: u32) -> TextureEntry {
    TextureEntry { first, frames: 1, tics: 8 }
}

fn lump<'a>(wad: &Wad<'a>, name: &'static str, least: usize) -> Result<&'a [u8], IwadError> {
    let bytes = wad.find(name).ok_or(IwadError::Missing { lump: name })?;
    if bytes.len() < least {
        return Err(IwadError::TooShort { lump: TextureName::new(name), least, length: bytes.len() });
    }
    Ok(bytes)
}

fn palette(wad: &Wad<'_>) -> Result<[[u8; 3]; 256], IwadError> {
    let bytes = lump(wad, "PLAYPAL", 768)?;
    Ok(std::array::from_fn(|i| [bytes[3 * i], bytes[3 * i + 1], bytes[3 * i + 2]]))
}

fn light_tables(wad: &Wad<'_>) -> Result<Box<[[u8; 256]; 32]>, IwadError> {
    let bytes = lump(wad, "COLORMAP", 32 * 256)?;
    Ok(Box::new(std::array::from_fn(|table| std::array::from_fn(|colour| bytes[256 * table + colour]))))
}

/// The lumps by what their place in the file says that they are; markers left out.
struct Sections<'a> {
    flats: Vec<Lump<'a>>,
    sprites: Vec<Lump<'a>>,
    patches: Vec<Lump<'a>>,
    rest: Vec<Lump<'a>>,
}

impl<'a> Sections<'a> {
    fn new(wad: &Wad<'a>) -> Sections<'a> {
        let mut sections = Sections { flats: Vec::new(), sprites: Vec::new(), patches: Vec::new(), rest: Vec::new() };
        let mut current = "";
        for lump in &wad.lumps {
            match lump.name.as_str() {
                "F_START" | "FF_START" => current = "F",
                "S_START" | "SS_START" => current = "S",
                "P_START" | "PP_START" => current = "P",
                "F_END" | "FF_END" | "S_END" | "SS_END" | "P_END" | "PP_END" => current = "",
                _ if lump.bytes.is_empty() => {}
                _ => match current {
                    "F" => sections.flats.push(*lump),
                    "S" => sections.sprites.push(*lump),
                    "P" => sections.patches.push(*lump),
                    _ => sections.rest.push(*lump),
                },
            }
        }
        sections
    }
}

/// A little-endian 16-bit number at a place that the caller has checked.
fn short(bytes: &[u8], at: usize) -> i16 {
    i16::from_le_bytes([bytes[at], bytes[at + 1]])
}

/// A little-endian 32-bit number at a place that the caller has checked.
fn long(bytes: &[u8], at: usize) -> i32 {
    i32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]])
}
