//! Which lumps are what, by the markers that they stand between.

use crate::wad::{Lump, Wad};

/// The lumps by what their place in their file says that they are; markers left out. Of equal names
/// the last counts.
#[derive(Default)]
pub(super) struct Sections<'a> {
    /// Floors and ceilings.
    pub flats: Vec<Lump<'a>>,
    /// Sprites.
    pub sprites: Vec<Lump<'a>>,
    /// Parts of wall textures.
    pub patches: Vec<Lump<'a>>,
    /// Whole wall textures.
    pub textures: Vec<Lump<'a>>,
    /// Finer pictures in the place of textures.
    pub finer: Vec<Lump<'a>>,
    /// Everything else.
    pub rest: Vec<Lump<'a>>,
}

impl<'a> Sections<'a> {
    pub fn new(files: &[Wad<'a>]) -> Sections<'a> {
        let mut sections = Sections::default();
        for file in files {
            let mut current = "";
            for lump in &file.lumps {
                match lump.name.as_str() {
                    "F_START" | "FF_START" => current = "F",
                    "S_START" | "SS_START" => current = "S",
                    "P_START" | "PP_START" => current = "P",
                    "TX_START" => current = "TX",
                    "HI_START" => current = "HI",
                    "F_END" | "FF_END" | "S_END" | "SS_END" | "P_END" | "PP_END" | "TX_END"
                    | "HI_END" => current = "",
                    _ if lump.bytes.is_empty() => {}
                    _ => sections.list(current).push(*lump),
                }
            }
        }
        sections
    }

    fn list(&mut self, section: &str) -> &mut Vec<Lump<'a>> {
        match section {
            "F" => &mut self.flats,
            "S" => &mut self.sprites,
            "P" => &mut self.patches,
            "TX" => &mut self.textures,
            "HI" => &mut self.finer,
            _ => &mut self.rest,
        }
    }
}
