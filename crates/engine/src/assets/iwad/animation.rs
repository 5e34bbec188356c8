//! Which textures are animated: a WAD's own list, or the classic one; and what `ANIMDEFS` adds.

use super::push;
use super::sections::Sections;
use super::words::words;
use crate::assets::{Assets, TextureEntry};
use crate::map::TextureName;
use crate::wad::Wad;
use std::collections::BTreeSet;

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

/// Most frames of an animation.
const FRAME_LIMIT: usize = 255;

/// A run of names in file order, each of which shows all in turn.
struct Run {
    walls: bool,
    first: TextureName,
    last: TextureName,
    tics: u8,
}

/// A name that shows pictures in turn.
struct Sequence {
    name: TextureName,
    pictures: Vec<TextureName>,
    tics: u8,
}

/// All that is animated.
pub(super) struct Animations {
    runs: Vec<Run>,
    sequences: Vec<Sequence>,
    /// Names whose picture ViZDoom distorts.
    warped: BTreeSet<TextureName>,
}

impl Animations {
    pub fn read(wad: &Wad<'_>) -> Animations {
        let mut animations =
            Animations { runs: Vec::new(), sequences: Vec::new(), warped: BTreeSet::new() };
        if let Some(list) = wad.find("ANIMATED") {
            for entry in list.chunks_exact(ENTRY).take_while(|entry| entry[0] != 255) {
                let name = |at: usize| {
                    let end =
                        entry[at..at + 9].iter().position(|&byte| byte == 0).unwrap_or(8).min(8);
                    TextureName::new(std::str::from_utf8(&entry[at..at + end]).unwrap_or(""))
                };
                let tics = super::long(entry, 19).clamp(1, 255) as u8;
                animations.runs.push(Run {
                    walls: entry[0] & 1 == 1,
                    first: name(10),
                    last: name(1),
                    tics,
                });
            }
        } else {
            for (walls, list) in [(false, &FLATS[..]), (true, &WALLS[..])] {
                let run = |(first, last): &(&str, &str)| Run {
                    walls,
                    first: TextureName::new(first),
                    last: TextureName::new(last),
                    tics: TICS,
                };
                animations.runs.extend(list.iter().map(run));
            }
        }
        for lump in wad.lumps.iter().filter(|lump| lump.name.as_str() == "ANIMDEFS") {
            animations.define(&words(lump.bytes));
        }
        animations
    }

    /// Adds the definitions of an `ANIMDEFS` lump. Frames are shown for the tics of the first one,
    /// whole tics at least.
    fn define(&mut self, words: &[&str]) {
        let is = |at: usize, word: &str| {
            words.get(at).is_some_and(|found| found.eq_ignore_ascii_case(word))
        };
        let name = |at: usize| TextureName::new(words.get(at).copied().unwrap_or(""));
        let tics = |at: usize| {
            words
                .get(at)
                .and_then(|word| word.parse::<f32>().ok())
                .map_or(TICS, |tics| tics.clamp(1.0, 255.0) as u8)
        };
        let mut at = 0;
        while at < words.len() {
            if is(at, "warp") || is(at, "warp2") {
                self.warped.insert(name(at + 2));
                at += 3;
            } else if is(at, "flat") || is(at, "texture") {
                let (walls, first) = (is(at, "texture"), name(at + 1));
                let mut sequence = Sequence { name: first, pictures: Vec::new(), tics: TICS };
                at += 2;
                loop {
                    if is(at, "pic") && sequence.pictures.len() < FRAME_LIMIT {
                        if sequence.pictures.is_empty() {
                            sequence.tics = tics(at + 3);
                        }
                        sequence.pictures.push(name(at + 1));
                        at += if is(at + 2, "rand") { 5 } else { 4 };
                    } else if is(at, "range") {
                        self.runs.push(Run {
                            walls,
                            first,
                            last: name(at + 1),
                            tics: tics(at + 3),
                        });
                        at += 4;
                    } else if ["allowdecals", "oscillate", "random"].iter().any(|word| is(at, word))
                    {
                        at += 1;
                    } else {
                        break;
                    }
                }
                if !sequence.pictures.is_empty() {
                    self.sequences.push(sequence);
                }
            } else {
                at += 1;
            }
        }
    }

    /// The pictures that the animations of what is wanted need beside.
    pub fn needed(
        &self,
        sections: &Sections<'_>,
        wanted: super::Wanted<'_>,
    ) -> BTreeSet<TextureName> {
        let mut needed = BTreeSet::new();
        for sequence in self.sequences.iter().filter(|sequence| wanted(sequence.name)) {
            needed.extend(&sequence.pictures);
        }
        for run in &self.runs {
            let lumps = if run.walls { &sections.textures } else { &sections.flats };
            let find = |name| lumps.iter().rposition(|lump| lump.name == name);
            if let Some((first, last)) =
                find(run.first).zip(find(run.last)).filter(|(first, last)| first < last)
                && lumps[first..=last].iter().any(|lump| wanted(lump.name))
            {
                needed.extend(lumps[first..=last].iter().map(|lump| lump.name));
            }
        }
        needed
    }

    /// Animates what was loaded, given the names of flats and walls in file order. All frames of a
    /// run show the same picture at the same time.
    pub fn apply(
        &self,
        set: &mut Assets,
        flats: &[TextureName],
        walls: &[TextureName],
        wanted: super::Wanted<'_>,
    ) {
        for run in &self.runs {
            let names = if run.walls { walls } else { flats };
            let find = |name| names.iter().rposition(|&other| other == name);
            // Runs that the files lack, or have backwards, are left still.
            let Some((first, last)) =
                find(run.first).zip(find(run.last)).filter(|(first, last)| first < last)
            else {
                continue;
            };
            if last - first < FRAME_LIMIT {
                let run_names = &names[first..=last];
                if let Some(entry) = in_row(set, run_names, run.tics) {
                    run_names.iter().for_each(|name| _ = set.textures.insert(*name, entry));
                }
            }
        }
        for sequence in &self.sequences {
            if let Some(entry) = in_row(set, &sequence.pictures, sequence.tics) {
                set.textures.insert(sequence.name, entry);
            }
        }
        for name in
            self.warped.iter().filter(|&&name| set.textures.contains_key(&name) && wanted(name))
        {
            set.left_out.insert(format!("the ripples of {name:?}"));
        }
    }
}

/// The animation of some names: their own pictures if those lie in a row, copies otherwise (as
/// where another file replaces some); none if one is missing.
fn in_row(set: &mut Assets, names: &[TextureName], tics: u8) -> Option<TextureEntry> {
    let firsts = names
        .iter()
        .map(|name| set.textures.get(name).map(|entry| entry.first))
        .collect::<Option<Vec<u32>>>()?;
    let frames = u8::try_from(firsts.len()).ok()?;
    let mut first = *firsts.first()?;
    if !firsts.iter().zip(first..).all(|(&found, expected)| found == expected) {
        let copies: Vec<_> =
            firsts.iter().map(|&index| set.images[index as usize].clone()).collect();
        first = copies.into_iter().map(|image| push(set, image)).min()?;
    }
    Some(TextureEntry { first, frames, tics })
}
