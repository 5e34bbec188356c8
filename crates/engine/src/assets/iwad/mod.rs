//! A picture set read from an IWAD such as Freedoom's: palette, light tables, wall textures, flats,
//! sprites, status bar.
//!
//! Everything is checked: whatever a file claims, loading ends in pictures or in an error, within
//! the bounds of [`Budget`](budget::Budget).

mod animation;
mod budget;
mod composites;
mod error;
mod flats;
#[cfg(test)]
mod overlay_tests;
mod picture;
mod png;
mod reader;
mod sections;
mod sky;
mod sprites;
mod substitutes;
#[cfg(test)]
mod tests;
mod wall_textures;
mod words;

pub use error::IwadError;

use super::{Assets, Image, TextureEntry};
use crate::map::TextureName;
use crate::wad::{Wad, WadKind};
use animation::Animations;
use reader::Reader;
use sections::Sections;
use std::collections::{BTreeMap, BTreeSet};

/// Beginnings of the names of status-bar lumps.
const STATUS_BAR: [&str; 9] =
    ["STBAR", "STARMS", "STTNUM", "STTMINUS", "STTPRCNT", "STYSNUM", "STGNUM", "STF", "STKEYS"];

/// Which textures are needed: those of additions can be many more than a map shows.
type Wanted<'a> = &'a dyn Fn(TextureName) -> bool;

/// The picture of soot.
const SOOT: TextureName = TextureName::new("SCORCH1");

/// The map whose sky counts.
const MAP: &str = "MAP01";

impl Assets {
    /// Reads the picture set of an IWAD.
    ///
    /// Of equal names the last lump counts. Where a wall texture and a flat share a name, the wall
    /// texture is taken. Sprites that the file lacks are taken from the embedded set.
    ///
    /// # Errors
    /// The first broken or missing part, by its lump's name.
    pub fn from_iwad(bytes: &[u8]) -> Result<Assets, IwadError> {
        Assets::from_wads(bytes, &[], &|_| true)
    }

    /// The same, with other files laid over the IWAD: what they bring counts before the IWAD's. Of
    /// their single pictures only those that are `wanted`, and the frames of their animations, are
    /// decoded: a published map names 140 of the 1,400 in its file.
    ///
    /// # Errors
    /// The first broken or missing part, by its lump's name.
    pub fn from_wads(
        iwad: &[u8],
        additions: &[&[u8]],
        wanted: &dyn Fn(TextureName) -> bool,
    ) -> Result<Assets, IwadError> {
        let files = std::iter::once(&iwad)
            .chain(additions)
            .map(|bytes| Wad::read(bytes))
            .collect::<Result<Vec<_>, _>>()?;
        let wad = Wad {
            kind: WadKind::Iwad,
            lumps: files.iter().flat_map(|file| &file.lumps).copied().collect(),
        };
        let mut set = Assets {
            palette: palette(&wad)?,
            light_tables: light_tables(&wad)?,
            images: Vec::new(),
            textures: BTreeMap::new(),
            fallbacks: Vec::new(),
            sprites: Vec::new(),
            graphics: BTreeMap::new(),
            sky: sky::of_map(&wad, MAP),
            soot: None,
            left_out: BTreeSet::new(),
        };
        let mut reader = Reader::new(set.palette);
        let sections = Sections::new(&files);
        let animations = Animations::read(&wad);
        let animated = animations.needed(&sections, wanted);
        let needed = &|name| wanted(name) || animated.contains(&name);
        let flats = flats::load(&mut set, &sections, needed, &mut reader)?;
        let walls = wall_textures::load(&mut set, &wad, &sections, needed, &mut reader)?;
        composites::load(&mut set, &wad, &sections, needed, &mut reader)?;
        animations.apply(&mut set, &flats, &walls, wanted);
        for lump in sections.finer.iter().filter(|lump| wanted(lump.name)) {
            set.left_out.insert(format!("the finer picture of {:?}", lump.name));
        }
        substitutes::textures(&mut set);
        sprites::load(&mut set, &sections, &mut reader)?;
        substitutes::sprites(&mut set, &Assets::embedded());
        if let Some(lump) = sections.rest.iter().rfind(|lump| lump.name == SOOT) {
            set.soot = Some(png::stain(lump, &mut reader)?);
        }
        for lump in &sections.rest {
            if STATUS_BAR.iter().any(|prefix| lump.name.as_str().starts_with(prefix)) {
                let image = reader.picture(lump)?;
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
        return Err(IwadError::TooShort {
            lump: TextureName::new(name),
            least,
            length: bytes.len(),
        });
    }
    Ok(bytes)
}

fn palette(wad: &Wad<'_>) -> Result<[[u8; 3]; 256], IwadError> {
    let bytes = lump(wad, "PLAYPAL", 768)?;
    Ok(std::array::from_fn(|i| [bytes[3 * i], bytes[3 * i + 1], bytes[3 * i + 2]]))
}

fn light_tables(wad: &Wad<'_>) -> Result<Box<[[u8; 256]; 32]>, IwadError> {
    let bytes = lump(wad, "COLORMAP", 32 * 256)?;
    Ok(Box::new(std::array::from_fn(|table| {
        std::array::from_fn(|colour| bytes[256 * table + colour])
    })))
}

/// A little-endian 16-bit number at a place that the caller has checked.
fn short(bytes: &[u8], at: usize) -> i16 {
    i16::from_le_bytes([bytes[at], bytes[at + 1]])
}

/// A little-endian 32-bit number at a place that the caller has checked.
fn long(bytes: &[u8], at: usize) -> i32 {
    i32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]])
}
