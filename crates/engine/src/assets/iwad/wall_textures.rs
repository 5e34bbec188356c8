//! Wall textures: lists of patches laid over each other, and whole pictures by their own names.

use super::budget::SIDE_LIMIT;
use super::reader::Reader;
use super::{IwadError, Sections, Wanted, long, lump, push, short, still};
use crate::assets::{Assets, Image};
use crate::map::TextureName;
use crate::wad::{Lump, Wad};
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};

/// Bytes of a texture's head and of a patch in it.
const HEAD: usize = 22;
const PATCH: usize = 10;

/// Adds every wall texture and gives their names in file order, for animations.
pub(super) fn load(
    set: &mut Assets,
    wad: &Wad<'_>,
    sections: &Sections<'_>,
    wanted: Wanted<'_>,
    reader: &mut Reader,
) -> Result<Vec<TextureName>, IwadError> {
    let mut patches = Patches::new(wad, sections)?;
    let mut names = Vec::new();
    let mut seen = BTreeSet::new();
    for (list, needed) in [("TEXTURE1", true), ("TEXTURE2", false)] {
        if !needed && wad.find(list).is_none() {
            continue;
        }
        let bytes = lump(wad, list, 4)?;
        let outside =
            || IwadError::Picture { lump: TextureName::new(list), what: "a texture lies outside" };
        let count = usize::try_from(long(bytes, 0)).map_err(|_| outside())?;
        let offsets = count
            .checked_mul(4)
            .and_then(|length| bytes.get(4..4usize.checked_add(length)?))
            .ok_or_else(outside)?;
        for offset in offsets.chunks_exact(4) {
            let start = usize::try_from(long(offset, 0)).map_err(|_| outside())?;
            let texture =
                bytes.get(start..).filter(|texture| texture.len() >= HEAD).ok_or_else(outside)?;
            let name = name_of(texture);
            let image = compose(name, texture, &mut patches, reader)?;
            // Of equal names the first counts here, as in the engines that these lists were made
            // for.
            if seen.insert(name) {
                let index = push(set, image);
                set.textures.insert(name, still(index));
                names.push(name);
            }
        }
    }
    for lump in sections.textures.iter().filter(|lump| wanted(lump.name)) {
        let image = reader.picture(lump)?;
        let index = push(set, Image { offset_x: 0, offset_y: 0, ..image });
        set.textures.insert(lump.name, still(index));
        names.push(lump.name);
    }
    Ok(names)
}

/// The patches by their numbers in textures; each is decoded when first used.
struct Patches<'a> {
    lumps: Vec<Option<Lump<'a>>>,
    decoded: BTreeMap<usize, Image>,
}

impl<'a> Patches<'a> {
    fn new(wad: &Wad<'a>, sections: &Sections<'a>) -> Result<Patches<'a>, IwadError> {
        let bytes = lump(wad, "PNAMES", 4)?;
        let outside =
            || IwadError::Picture { lump: TextureName::new("PNAMES"), what: "a name lies outside" };
        let count = usize::try_from(long(bytes, 0)).map_err(|_| outside())?;
        let names = count
            .checked_mul(8)
            .and_then(|length| bytes.get(4..4usize.checked_add(length)?))
            .ok_or_else(outside)?;
        // Where names repeat, lumps among the patches go before others.
        let mut by_name: BTreeMap<TextureName, Lump<'a>> = BTreeMap::new();
        for lump in sections.rest.iter().chain(&sections.patches) {
            by_name.insert(lump.name, *lump);
        }
        let lumps =
            names.chunks_exact(8).map(|name| by_name.get(&name_of(name)).copied()).collect();
        Ok(Patches { lumps, decoded: BTreeMap::new() })
    }

    /// The patch of a number; none if the file does not have it, as some published files do not.
    fn get(&mut self, number: i16, reader: &mut Reader) -> Result<Option<&Image>, IwadError> {
        let Some((number, lump)) =
            usize::try_from(number).ok().and_then(|n| Some((n, (*self.lumps.get(n)?)?)))
        else {
            return Ok(None);
        };
        if let Entry::Vacant(place) = self.decoded.entry(number) {
            place.insert(reader.picture(&lump)?);
        }
        Ok(self.decoded.get(&number))
    }
}

fn compose(
    name: TextureName,
    texture: &[u8],
    patches: &mut Patches<'_>,
    reader: &mut Reader,
) -> Result<Image, IwadError> {
    let wrong = |what| IwadError::Picture { lump: name, what };
    let (width, height) = (i32::from(short(texture, 12)), i32::from(short(texture, 14)));
    let allowed = 1..=SIDE_LIMIT as i32;
    if !allowed.contains(&width) || !allowed.contains(&height) {
        return Err(wrong("its size is absurd"));
    }
    let count = usize::from(short(texture, 20) as u16);
    let list =
        texture.get(HEAD..HEAD + PATCH * count).ok_or_else(|| wrong("its patches lie outside"))?;
    let size = (width * height) as usize;
    reader.budget.keep(size)?;
    let mut pixels = vec![0; size].into_boxed_slice();
    let mut mask = vec![0; size].into_boxed_slice();
    for entry in list.chunks_exact(PATCH) {
        let (left, top) = (i32::from(short(entry, 0)), i32::from(short(entry, 2)));
        let Some(patch) = patches.get(short(entry, 4), reader)? else { continue };
        let (patch_width, patch_height) = (i32::from(patch.width), i32::from(patch.height));
        let (first_row, end_row) = (top.max(0), (top + patch_height).min(height));
        if first_row >= end_row {
            continue;
        }
        let rows = (end_row - first_row) as usize;
        for x in left.max(0)..(left + patch_width).min(width) {
            reader.budget.visit(rows)?;
            let from = ((x - left) * patch_height + first_row - top) as usize;
            let to = (x * height + first_row) as usize;
            for i in 0..rows {
                if patch.mask.as_ref().is_none_or(|mask| mask[from + i] == 1) {
                    pixels[to + i] = patch.pixels[from + i];
                    mask[to + i] = 1;
                }
            }
        }
    }
    let opaque = mask.iter().all(|&opaque| opaque == 1);
    Ok(Image {
        width: width as u16,
        height: height as u16,
        offset_x: 0,
        offset_y: 0,
        pixels,
        mask: (!opaque).then_some(mask),
    })
}

/// A name of up to 8 bytes at the start of `bytes`.
fn name_of(bytes: &[u8]) -> TextureName {
    let mut name = [0; 8];
    for (to, from) in name.iter_mut().zip(bytes.iter().take_while(|&&byte| byte != 0)) {
        *to = from.to_ascii_uppercase();
    }
    TextureName(name)
}
