//! What reading any picture needs: the bounds, and the palette that colours are brought to.

use super::budget::Budget;
use super::{IwadError, picture, png};
use crate::assets::Image;
use crate::wad::Lump;
use std::collections::BTreeMap;

/// Reads pictures of every format into paletted ones.
pub(super) struct Reader {
    /// What the file may still cost.
    pub budget: Budget,
    palette: [[u8; 3]; 256],
    /// Colours that were looked for already.
    found: BTreeMap<[u8; 3], u8>,
}

impl Reader {
    pub fn new(palette: [[u8; 3]; 256]) -> Reader {
        Reader { budget: Budget::new(), palette, found: BTreeMap::new() }
    }

    /// Decodes a picture: a PNG, or the column format of patches.
    pub fn picture(&mut self, lump: &Lump<'_>) -> Result<Image, IwadError> {
        if png::is_png(lump.bytes) {
            png::decode(lump, self)
        } else {
            picture::decode(lump, &mut self.budget)
        }
    }

    /// The palette entry nearest to a colour. Entry 0 is left out, as in ViZDoom,
    /// which keeps it for holes.
    pub fn nearest(&mut self, colour: [u8; 3]) -> u8 {
        let palette = &self.palette;
        *self.found.entry(colour).or_insert_with(|| {
            let distance = |index: u8| -> i32 {
                let entry = palette[usize::from(index)];
                entry.iter().zip(colour).map(|(&a, b)| (i32::from(a) - i32::from(b)).pow(2)).sum()
            };
            (1..=255).min_by_key(|&index| distance(index)).unwrap_or(1)
        })
    }
}
