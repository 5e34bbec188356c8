//! The editable form of a map: what UDMF text says, field by field.

use super::Blocks;
use std::collections::{BTreeMap, BTreeSet};

/// A texture, flat or lump name: up to 8 upper-case ASCII characters, padded with zeros; all zero
/// means none (`-`).
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct TextureName(pub [u8; 8]);

impl TextureName {
    /// No texture.
    pub const NONE: TextureName = TextureName([0; 8]);

    /// The name, upper-cased and cut to 8 bytes; `-` and the empty string give
    /// [`TextureName::NONE`].
    #[must_use]
    pub const fn new(name: &str) -> TextureName {
        let bytes = name.as_bytes();
        let mut out = [0; 8];
        let mut i = 0;
        while i < bytes.len() && i < 8 {
            out[i] = bytes[i].to_ascii_uppercase();
            i += 1;
        }
        if bytes.len() == 1 && bytes[0] == b'-' {
            out[0] = 0;
        }
        TextureName(out)
    }

    /// The name as text, empty for none.
    #[must_use]
    pub fn as_str(&self) -> &str {
        let end = self.0.iter().position(|&b| b == 0).unwrap_or(8);
        std::str::from_utf8(&self.0[..end]).unwrap_or("")
    }

    /// Whether this names a texture.
    #[must_use]
    pub fn is_some(&self) -> bool {
        self.0[0] != 0
    }
}

impl std::fmt::Debug for TextureName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        // Names come from files by anyone and go into messages, where nothing may command a
        // terminal.
        if self.is_some() {
            write!(f, "{}", self.as_str().escape_debug())
        } else {
            f.write_str("-")
        }
    }
}

/// A map as authored: the lists of a UDMF text, in its units (map units, degrees).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MapSource {
    /// The UDMF namespace, `zdoom` for our maps.
    pub namespace: String,
    /// Vertices, in map units.
    pub vertices: Vec<SourceVertex>,
    /// Linedefs.
    pub lines: Vec<SourceLine>,
    /// Sidedefs.
    pub sides: Vec<SourceSide>,
    /// Sectors.
    pub sectors: Vec<SourceSector>,
    /// Things.
    pub things: Vec<SourceThing>,
    /// What the text asks for beside all this, a phrase each with how often. It is reported, and
    /// not written.
    pub unplayed: BTreeMap<String, usize>,
}

impl MapSource {
    /// Every texture that the map names.
    #[must_use]
    pub fn textures(&self) -> BTreeSet<TextureName> {
        let walls = self.sides.iter().flat_map(|side| [side.top, side.middle, side.bottom]);
        let flats =
            self.sectors.iter().flat_map(|sector| [sector.floor_texture, sector.ceiling_texture]);
        walls.chain(flats).filter(TextureName::is_some).collect()
    }

    /// Turns the two-sided lines that `turned` picks, given their ends (x, y) in map units and the
    /// sectors in front and behind: they run the other way, and front and back change places.
    ///
    /// Which way a line runs shows nowhere, but bodies feel it: within a 64th of a unit they count
    /// as in front of it, so that it decides on which tic a body that falls along a step begins to
    /// slide.
    pub fn turn_lines(
        &mut self,
        mut turned: impl FnMut([(f64, f64); 2], [&SourceSector; 2]) -> bool,
    ) {
        let ends = |vertex: usize| (self.vertices[vertex].x, self.vertices[vertex].y);
        let sector = |side: usize| &self.sectors[self.sides[side].sector];
        for line in &mut self.lines {
            if let Some(back) = line.back
                && turned([ends(line.v1), ends(line.v2)], [sector(line.front), sector(back)])
            {
                std::mem::swap(&mut line.v1, &mut line.v2);
                (line.front, line.back) = (back, Some(line.front));
            }
        }
    }
}

/// A vertex of the source.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SourceVertex {
    /// East, map units.
    pub x: f64,
    /// North, map units.
    pub y: f64,
}

/// A linedef of the source; its front side is on the right when going from `v1` to `v2`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SourceLine {
    /// Index of the first vertex.
    pub v1: usize,
    /// Index of the second vertex.
    pub v2: usize,
    /// Index of the front sidedef.
    pub front: usize,
    /// Index of the back sidedef, if two-sided.
    pub back: Option<usize>,
    /// Blocks every walker (`blocking`).
    pub blocking: bool,
    /// What else it stops (`blockplayers`, ...).
    pub blocks: Blocks,
    /// Upper texture pegged to the higher ceiling (`dontpegtop`).
    pub upper_unpegged: bool,
    /// Lower texture pegged to the ceiling, or middle texture to the floor (`dontpegbottom`).
    pub lower_unpegged: bool,
    /// Line tag (`id`), 0 for none.
    pub id: i32,
    /// Line special.
    pub special: i32,
    /// Somebody can set off its special (`playeruse`, `playercross`, ...). Nothing does here, so
    /// that it is not written.
    pub triggered: bool,
    /// Arguments of the special.
    pub args: [i32; 5],
}

/// A sidedef of the source.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SourceSide {
    /// Index of the sector it faces.
    pub sector: usize,
    /// Texture offset to the right, texels.
    pub offset_x: f64,
    /// Texture offset down, texels.
    pub offset_y: f64,
    /// Texture above the opening.
    pub top: TextureName,
    /// Texture of a one-sided wall, or the masked texture in an opening.
    pub middle: TextureName,
    /// Texture below the opening.
    pub bottom: TextureName,
}

/// A sector of the source.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SourceSector {
    /// Floor height, map units.
    pub floor: i32,
    /// Ceiling height, map units.
    pub ceiling: i32,
    /// Floor texture.
    pub floor_texture: TextureName,
    /// Ceiling texture; `F_SKY1` is the sky.
    pub ceiling_texture: TextureName,
    /// Light, 0..=255 (values outside are kept).
    pub light: i32,
    /// Sector special (83 is the damage of Volcanic Venture before its scripts).
    pub special: i32,
    /// Tag (`id`), 0 for none.
    pub tag: i32,
}

/// A thing of the source.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SourceThing {
    /// East, map units.
    pub x: f64,
    /// North, map units.
    pub y: f64,
    /// Height above the floor, map units.
    pub height: f64,
    /// Facing, whole degrees, counter-clockwise from east.
    pub angle: i32,
    /// Editor number (`type`).
    pub kind: i32,
    /// Thing id (`id`), 0 for none.
    pub id: i32,
    /// Arguments (`arg0`..`arg4`).
    pub args: [i32; 5],
}
