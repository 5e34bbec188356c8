//! What a map asks for that the engine does not do. It is asked here since things are known by the
//! world alone.

use crate::map::{MapSource, SourceLine, special};
use crate::world::tables::kinds::ActorKind;
use std::collections::BTreeMap;

/// Sector specials that are played, or that mean nothing.
const SECTOR_SPECIALS: [i32; 7] = {
    let [step, other_step] = special::SEQUENCE_STEPS;
    // 8 and 17 flicker in older games' numbers only.
    [special::PHASED, special::SEQUENCE_START, step, other_step, 8, 17, special::LAVA]
};

/// Editor numbers of player starts, of deathmatch starts, of where teleporters lead and of the
/// editor's camera, which nothing is lost by.
const NO_THINGS: [i32; 7] = [1, 2, 3, 4, 11, 14, 32000];

impl MapSource {
    /// What the engine leaves out of this map, a phrase each with how often it occurs; empty if
    /// nothing.
    #[must_use]
    pub fn left_out(&self) -> Vec<String> {
        let count = |numbers: &mut dyn Iterator<Item = i32>| {
            let mut counts: BTreeMap<i32, usize> = BTreeMap::new();
            numbers.for_each(|number| *counts.entry(number).or_default() += 1);
            counts
        };
        let acts = |line: &SourceLine| special::acts(&self.namespace, line.special, line.triggered);
        let plays = |special: i32| {
            special == 0 || special::are_of(&self.namespace) && SECTOR_SPECIALS.contains(&special)
        };
        let known =
            |kind: i32| NO_THINGS.contains(&kind) || ActorKind::from_editor_number(kind).is_some();
        let lists = [
            (
                "line special",
                count(&mut self.lines.iter().filter(|line| acts(line)).map(|line| line.special)),
            ),
            (
                "sector special",
                count(
                    &mut self
                        .sectors
                        .iter()
                        .map(|sector| sector.special)
                        .filter(|&special| !plays(special)),
                ),
            ),
            (
                "thing type",
                count(&mut self.things.iter().map(|thing| thing.kind).filter(|&kind| !known(kind))),
            ),
        ];
        let phrase = |(what, counts): (&str, BTreeMap<i32, usize>)| {
            let list: Vec<String> = counts
                .iter()
                .take(24)
                .map(|(number, times)| format!("{number} ({times})"))
                .collect();
            (!list.is_empty()).then(|| format!("{what} {}", list.join(" ")))
        };
        let fields = self.unplayed.iter().map(|(what, times)| format!("{what} ({times})"));
        lists.into_iter().filter_map(phrase).chain(fields).collect()
    }
}
