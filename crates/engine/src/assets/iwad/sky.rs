//! Which picture is the sky: what `MAPINFO` says of the map.

use super::words::words;
use crate::map::TextureName;
use crate::wad::Wad;

/// The sky of `map` by the last `MAPINFO` that names one.
pub(super) fn of_map(wad: &Wad<'_>, map: &str) -> Option<TextureName> {
    let mut sky = None;
    for lump in
        wad.lumps.iter().filter(|lump| ["MAPINFO", "ZMAPINFO"].contains(&lump.name.as_str()))
    {
        let words = words(lump.bytes);
        let mut of_this_map = false;
        for (at, word) in words.iter().enumerate() {
            if word.eq_ignore_ascii_case("map") {
                of_this_map = words.get(at + 1).is_some_and(|name| name.eq_ignore_ascii_case(map));
            } else if of_this_map && word.eq_ignore_ascii_case("sky1") {
                // Old texts write `sky1 NAME 0`, new ones `sky1 = "NAME", 0`.
                let name = words.get(at + 1).filter(|&&next| next != "=").or(words.get(at + 2));
                sky = name.map(|name| TextureName::new(name)).or(sky);
            }
        }
    }
    sky
}
