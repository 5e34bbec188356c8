//! Which textures are animated: a WAD's own list, or the classic one.

use crate::assets::{Assets, TextureEntry};
use crate::map::TextureName;
use crate::wad::Wad;

/// Tics that a frame of the classic animations is shown.
const TICS: u8 = 8;

/// First and last flats of the classic animations.
const FLATS: [(&str, &str); 9] = [
    ("NUKAGE1", "NUKAGE3"),
    ("FWATER1", "FWATER4"),
    ("SWATER1", "SWATER4"),
    ("LAVA1", "LAVA4"),
    ("BLOOD1", "BLOOD3"),
    ("RROCK05", "RROCK08"),
    ("SLIME01", "SLIME04"),
    ("SLIME05", "SLIME08"),
    ("SLIME09", "SLIME12"),
];

/// First and last wall textures of the classic animations.
const WALLS: [(&str, &str); 13] = [
    ("BLODGR1", "BLODGR4"),
    ("SLADRIP1", "SLADRIP3"),
    ("BLODRIP1", "BLODRIP4"),
    ("FIREWALA", "FIREWALL"),
    ("GSTFONT1", "GSTFONT3"),
    ("FIRELAV3", "FIRELAVA"),
    ("FIREMAG1", "FIREMAG3"),
    ("FIREBLU1", "FIREBLU2"),
    ("ROCKRED1", "ROCKRED3"),
    ("BFALL1", "BFALL4"),
    ("SFALL1", "SFALL4"),
    ("WFALL1", "WFALL4"),
    ("DBRAIN1", "DBRAIN4"),
];

/// Bytes of an entry of an `ANIMATED` lump: kind, last name, first name, tics.
const ENTRY: usize = 23;

/// Turns runs of names in file order into animations. All frames of a run show the same picture at the same time.
pub(super) fn apply(set: &mut Assets, wad: &Wad<'_>, flats: &[TextureName], walls: &[TextureName]) {
    if let Some(list) = wad.find("ANIMATED") {
        for entry in list.chunks_exact(ENTRY).take_while(|entry| entry[0] != 255) {
            let name = |at: usize| {
                let end = entry[at..at + 9].iter().position(|&byte| byte == 0).unwrap_or(8).min(8);
                TextureName::new(std::str::from_utf8(&entry[at..at + end]).unwrap_or(""))
            };
            let tics = super::long(entry, 19).clamp(1, 255) as u8;
            animate(set, if entry[0] & 1 == 1 { walls } else { flats }, name(10), name(1), tics);
        }
    } else {
        for (names, list) in [(flats, &FLATS[..]), (walls, &WALLS[..])] {
            for (first, last) in list {
                animate(set, names, TextureName::new(first), TextureName::new(last), TICS);
            }
        }
    }
}

/// Runs that the file lacks, or has backwards, are left still.
fn animate(set: &mut Assets, names: &[TextureName], first: TextureName, last: TextureName, tics: u8) {
    let find = |name| names.iter().position(|&other| other == name);
    let Some((first, last)) = find(first).zip(find(last)).filter(|(first, last)| first < last) else { return };
    let run = &names[first..=last];
    let (Ok(frames), Some(start)) = (u8::try_from(run.len()), set.textures.get(&run[0]).map(|entry| entry.first)) else {
        return;
    };
    // A name listed twice, or as wall and flat, would break the row of pictures.
    let in_row = run.iter().enumerate().all(|(i, name)| set.textures[name].first == start + i as u32);
    if in_row {
        for name in run {
            set.textures.insert(*name, TextureEntry { first: start, frames, tics });
        }
    }
}
