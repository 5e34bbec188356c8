//! The lights that a map starts by its sector specials.

use crate::map::{Map, SectorId, special};
use crate::world::parts::lights::{Effect, PHASES};
use crate::world::state::world::World;
use std::sync::Arc;

/// Darkness of phased lights by themselves, and of a sequence whose first sector has no light.
const DARK: i32 = 48;

impl World {
    /// Starts phased lights, and those gleams that run along a row of neighbouring sectors.
    pub(in crate::world) fn start_lights_of_map(&mut self) {
        let map = Arc::clone(&self.map);
        let mut taken = vec![false; map.sectors.len()];
        for (id, sector) in (0..).map(SectorId).zip(&map.sectors) {
            match sector.special & 0xFF {
                special::PHASED => {
                    let phase = (i32::from(sector.light) + 1).rem_euclid(PHASES as i32) as u32;
                    self.start_light(id, Effect::Phased { dark: DARK, phase });
                }
                special::SEQUENCE_START => self.start_sequence(&sequence(&map, id, &mut taken)),
                _ => {}
            }
        }
    }

    /// Has a gleam run along a row of sectors once in every [`PHASES`] tics. One without light is
    /// as dark as that before it.
    fn start_sequence(&mut self, row: &[SectorId]) {
        let (count, mut dark) = (row.len() as u32, DARK);
        for (step, &id) in (1..).zip(row) {
            let light = i32::from(self.map.sectors[id.0 as usize].light);
            dark = if light == 0 { dark } else { light };
            self.start_light(
                id,
                Effect::Phased { dark, phase: PHASES - (count - step) * PHASES / count },
            );
        }
    }
}

/// The sectors of a light sequence from its start: each borders the one before, and two specials
/// take turns. Those that are taken belong to a sequence already.
fn sequence(map: &Map, start: SectorId, taken: &mut [bool]) -> Vec<SectorId> {
    let (mut row, mut wanted) = (vec![start], special::SEQUENCE_STEPS);
    while let Some(&last) = row.last() {
        let lines =
            map.sectors[last.0 as usize].lines.iter().map(|&line| &map.lines[line as usize]);
        let mut neighbours =
            lines.flat_map(|line| [Some(line.front_sector), line.back_sector]).flatten();
        let is_next = |id: &SectorId| {
            map.sectors[id.0 as usize].special & 0xFF == wanted[0] && !taken[id.0 as usize]
        };
        let Some(next) = neighbours.find(is_next) else { break };
        taken[next.0 as usize] = true;
        row.push(next);
        wanted.swap(0, 1);
    }
    row
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::{MapBuilder, Style};
    use crate::math::Fixed;
    use crate::world::monsters::patrol_tests::STYLE;

    /// A row of rooms by special and light, the levels of each after 0 to 64 tics.
    fn levels(rooms: &[(i32, i32)]) -> Vec<Vec<i16>> {
        let mut builder = MapBuilder::new();
        for (room, &(special, light)) in (0..).zip(rooms) {
            builder.rectangle(Style { light, special, ..STYLE }, room * 64, 0, room * 64 + 64, 64);
        }
        builder.thing(1, 32.0, 32.0, 0);
        let map = Map::build(&builder.finish().unwrap(), "row", &[]).unwrap();
        let middle =
            |room: i32| map.sector_at(Fixed::from_int(room * 64 + 32), Fixed::from_int(32));
        let order: Vec<SectorId> = (0..rooms.len() as i32).map(middle).collect();
        let mut world = World::new(Arc::new(map), 1);
        let mut levels: Vec<Vec<i16>> =
            order.iter().map(|&id| vec![world.sector(id).light]).collect();
        for _ in 0..64 {
            world.run_thinkers(&[]);
            world.finish_tic();
            order
                .iter()
                .zip(&mut levels)
                .for_each(|(&id, levels)| levels.push(world.sector(id).light));
        }
        levels
    }

    #[test]
    fn a_phased_light_gleams_for_22_of_64_tics() {
        // Seen in ViZDoom at the street lamps of Remedy Rush, whose sectors have a
        // light of 255.
        let lamp = &levels(&[(special::PHASED, 255)])[0];
        assert_eq!(lamp[0], 255, "as the map says until the first tic");
        assert!(lamp[1..43].iter().all(|&level| level == 48));
        assert_eq!(
            lamp[43..65],
            [
                65, 82, 99, 117, 134, 151, 168, 186, 203, 220, 237, 237, 220, 203, 186, 168, 151,
                134, 117, 99, 82, 65
            ]
        );
        // What remains of the light by 64 says how far it is at the beginning.
        assert_eq!(levels(&[(special::PHASED, 256)])[0][1..43], lamp[2..44]);
        assert_eq!(levels(&[(special::PHASED, 192 + 41)])[0][1..4], [65, 82, 99]);
    }

    #[test]
    fn a_gleam_runs_along_a_sequence() {
        let [step, other] = special::SEQUENCE_STEPS;
        let all = levels(&[
            (special::SEQUENCE_START, 96),
            (step, 0),
            (other, 128),
            (step, 96),
            (step, 50),
            (0, 70),
        ]);
        let brightest = |room: usize| {
            let most = all[room][1..].iter().max();
            all[room][1..].iter().position(|level| Some(level) == most).unwrap()
        };
        // Four rooms take part, a quarter of a round apart. The fifth should be of the other kind.
        assert_eq!([0, 1, 2, 3].map(brightest), [36, 20, 4, 52]);
        let darkest = |room: usize| all[room][1..].iter().copied().min().unwrap();
        assert_eq!([0, 1, 2, 3].map(darkest), [96, 96, 128, 96]);
        assert!(all[4].iter().all(|&level| level == 50) && all[5].iter().all(|&level| level == 70));
        // Of two that begin at both ends of a row the first has it.
        let both = levels(&[
            (special::SEQUENCE_START, 96),
            (step, 90),
            (other, 80),
            (special::SEQUENCE_START, 96),
        ]);
        let darkest = |room: usize| both[room][1..].iter().copied().min().unwrap();
        assert_eq!([0, 1, 2, 3].map(darkest), [96, 90, 80, 96]);
    }
}
