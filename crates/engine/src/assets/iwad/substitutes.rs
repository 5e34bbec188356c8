//! What stands in for the pictures that our worlds show and an IWAD lacks.

use super::push;
use crate::assets::{Assets, Image};
use crate::map::{STAND_INS, TextureName};
use std::collections::BTreeMap;

/// For any other name, one of these.
const FALLBACKS: [&str; 6] = ["STONE3", "BIGBRIK1", "BROWN1", "GRAY4", "ZIMMER3", "STARGR2"];

/// Gives missing textures a stand-in.
pub(super) fn textures(set: &mut Assets) {
    for (name, stand_in, _) in STAND_INS {
        if let Some(&entry) = set.textures.get(&TextureName::new(stand_in)) {
            set.textures.entry(TextureName::new(name)).or_insert(entry);
        }
    }
    set.fallbacks = FALLBACKS
        .iter()
        .filter_map(|name| set.textures.get(&TextureName::new(name)).copied())
        .collect();
    if set.fallbacks.is_empty() {
        set.fallbacks = set.textures.values().take(FALLBACKS.len()).copied().collect();
    }
}

/// Takes sprites that the file lacks from the embedded set, in the nearest of the file's colours:
/// the engine of the published worlds brought some along itself, the pistol to pick up among them.
pub(super) fn sprites(set: &mut Assets, embedded: &Assets) {
    let mut colours: BTreeMap<u8, u8> = BTreeMap::new();
    let mut taken: BTreeMap<u32, u32> = BTreeMap::new();
    for index in 0..set.sprites.len() {
        if !set.sprites[index].frames.is_empty() {
            continue;
        }
        let Some(mut sprite) = embedded.sprites.get(index).cloned() else { continue };
        for image in sprite.frames.iter_mut().flat_map(|frame| &mut frame.images) {
            let Some(original) = embedded.images.get(*image as usize) else { continue };
            *image = *taken.entry(*image).or_insert_with(|| {
                let palette = set.palette;
                let mut recolour = |&pixel: &u8| {
                    *colours
                        .entry(pixel)
                        .or_insert_with(|| nearest(&palette, embedded.palette[usize::from(pixel)]))
                };
                let pixels = original.pixels.iter().map(&mut recolour).collect();
                push(set, Image { pixels, ..original.clone() })
            });
        }
        set.sprites[index] = sprite;
    }
}

/// The palette entry with the least sum of squared differences.
fn nearest(palette: &[[u8; 3]; 256], colour: [u8; 3]) -> u8 {
    let distance = |other: &[u8; 3]| -> i32 {
        other.iter().zip(colour).map(|(&a, b)| (i32::from(a) - i32::from(b)).pow(2)).sum()
    };
    (0..=255u8).min_by_key(|&index| distance(&palette[usize::from(index)])).unwrap_or(0)
}
