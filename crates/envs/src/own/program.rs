//! A plan in its map: the tables that the rules run by. Made once for a setting, shared by all its
//! worlds.

use super::generate::Layout;
use super::model::{Goal, MapPlan, Place, Plan, Trigger, When};
use crate::EnvError;
use crate::scenarios::common::stage::Area;
use hasard_engine::map::{Map, Sector, SectorId};
use hasard_engine::math::Fixed;
use hasard_engine::world::ActorKind;

/// First tag that tiles get; a letter of the legend that needs one has its number added.
pub(super) const FIRST_TAG: i32 = 1000;

/// Kinds of occasions on which rules act, each with its own list of rules.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(usize)]
pub(super) enum Occasion {
    Start,
    Pickup,
    Damage,
    Death,
    Kill,
    Hit,
    Shot,
    Enter,
    Leave,
    In,
    Land,
    Jump,
    Use,
    Timer,
    Step,
    Counter,
    Near,
}

/// Number of kinds of occasions.
const OCCASIONS: usize = Occasion::Near as usize + 1;

impl Occasion {
    /// The kind of a trigger.
    pub const fn of(trigger: Trigger) -> Occasion {
        match trigger {
            Trigger::Start => Occasion::Start,
            Trigger::Pickup(_) => Occasion::Pickup,
            Trigger::Damage { .. } => Occasion::Damage,
            Trigger::Death => Occasion::Death,
            Trigger::Kill(_) => Occasion::Kill,
            Trigger::Hit(_) => Occasion::Hit,
            Trigger::Shot => Occasion::Shot,
            Trigger::Enter(_) => Occasion::Enter,
            Trigger::Leave(_) => Occasion::Leave,
            Trigger::In(_) => Occasion::In,
            Trigger::Land => Occasion::Land,
            Trigger::Jump => Occasion::Jump,
            Trigger::Use => Occasion::Use,
            Trigger::Timer { .. } => Occasion::Timer,
            Trigger::Step => Occasion::Step,
            Trigger::Counter { .. } => Occasion::Counter,
            Trigger::Near { .. } => Occasion::Near,
        }
    }
}

/// A tile that is set anew at each reset.
#[derive(Clone, Copy, Debug)]
pub(super) struct LooseTile {
    pub sector: SectorId,
    pub floor: [i32; 2],
}

/// The tables of a setting.
#[derive(Debug)]
pub(super) struct Program {
    pub plan: Plan,
    /// The rules of each kind of occasion, in the order of the file.
    lists: [Vec<u16>; OCCASIONS],
    /// The zones of each sector, a bit each.
    pub zones_of: Vec<u32>,
    /// Zones that are rectangles.
    pub rectangles: Vec<(u8, [Fixed; 4])>,
    /// The areas of each zone, and those where nothing hurts.
    pub areas: Vec<Vec<Area>>,
    pub free: Vec<Area>,
    /// Of each sector, whether its floor hurts.
    pub hurts: Vec<bool>,
    /// The tags of each zone.
    pub tags: Vec<Vec<i32>>,
    /// Areas of the start, one of which is drawn where there are several.
    pub starts: Vec<(Area, i32)>,
    /// Tiles with a floor at random, in the order of the map.
    pub loose: Vec<LooseTile>,
    /// The sectors of a map that is generated, row by row from the south-west.
    pub layout: Option<Layout>,
    /// Tags whose floors swing: eighths of a map unit, frequency.
    pub waggles: Vec<(i32, i32, i32)>,
    /// Damage of tags: points, tics.
    pub damages: Vec<(i32, [i32; 2])>,
    /// Of each kind of thing the spawn that brings it back, if its things are not marked.
    pub comes_back: Vec<(ActorKind, u8)>,
    /// Names of the counters, for statistics.
    pub names: Vec<&'static str>,
    /// Levels that no training has seen.
    pub test_seeds: bool,
    /// Somebody moves by goals.
    pub walkers: bool,
}

impl Program {
    /// The tables of a plan in a map.
    pub fn new(plan: Plan, map: &Map, names: &[&'static str]) -> Result<Program, EnvError> {
        let mut lists: [Vec<u16>; OCCASIONS] = std::array::from_fn(|_| Vec::new());
        for (index, when) in plan.whens.iter().enumerate() {
            lists[Occasion::of(when.trigger) as usize].push(index as u16);
        }
        let mut program = Program {
            lists,
            zones_of: vec![0; map.sectors.len()],
            rectangles: Vec::new(),
            areas: vec![Vec::new(); plan.zones.len()],
            free: Vec::new(),
            hurts: map.sectors.iter().map(Sector::hurts).collect(),
            tags: vec![Vec::new(); plan.zones.len()],
            starts: Vec::new(),
            loose: Vec::new(),
            layout: None,
            waggles: Vec::new(),
            damages: Vec::new(),
            comes_back: Vec::new(),
            names: names.to_vec(),
            test_seeds: false,
            walkers: plan.spawns.iter().any(|spawn| spawn.goal != Goal::None),
            plan,
        };
        program.find_zones(map)?;
        if let MapPlan::Tiles(tiles) = program.plan.map.clone() {
            program.place_tiles(&tiles, map);
        }
        if program.free.is_empty() {
            program.free = extent(map);
        }
        for (index, spawn) in program
            .plan
            .spawns
            .iter()
            .enumerate()
            .filter(|(_, spawn)| !spawn.marked && spawn.respawn.is_some())
        {
            program.comes_back.extend(spawn.kinds.iter().map(|(kind, _)| (*kind, index as u8)));
        }
        Ok(program)
    }

    /// The rules of a kind of occasion.
    pub fn rules(&self, occasion: Occasion) -> impl Iterator<Item = (u16, &When)> {
        self.lists[occasion as usize]
            .iter()
            .map(|index| (*index, &self.plan.whens[usize::from(*index)]))
    }

    /// Whether a kind of occasion has rules.
    pub fn has(&self, occasion: Occasion) -> bool {
        !self.lists[occasion as usize].is_empty()
    }

    /// The areas of a place.
    pub fn areas_of(&self, place: Place) -> &[Area] {
        match place {
            Place::Free | Place::Area(_) => &self.free,
            Place::Zone(zone) => &self.areas[usize::from(zone)],
        }
    }

    /// Whether a point within one of a zone's areas is in the zone: a sector need not fill the
    /// rectangle about it, as a tile does.
    pub fn holds(&self, zone: u8, [x, y]: [Fixed; 2], map: &Map) -> bool {
        let of = &self.plan.zones[usize::from(zone)];
        let within = |[west, south, east, north]: [i32; 4]| {
            let fits =
                |low, value, high| Fixed::from_int(low) <= value && value <= Fixed::from_int(high);
            fits(west, x, east) && fits(south, y, north)
        };
        of.tags.is_none()
            || self.zones_of[map.sector_at(x, y).0 as usize] >> zone & 1 == 1
            || of.area.is_some_and(within)
    }

    /// Zones that the map's own tags and rectangles make.
    fn find_zones(&mut self, map: &Map) -> Result<(), EnvError> {
        for (index, zone) in self.plan.zones.iter().enumerate() {
            if let Some([west, south, east, north]) = zone.area {
                self.rectangles
                    .push((index as u8, [west, south, east, north].map(Fixed::from_int)));
                self.areas[index].push([west, south, east, north]);
            }
            let Some([first, last]) = zone.tags else { continue };
            for tag in first..=last {
                let mut found = false;
                for sector in map.tagged(tag) {
                    found = true;
                    self.zones_of[sector.0 as usize] |= 1 << index;
                    let [west, east, south, north] =
                        map.sectors[sector.0 as usize].bounds.map(Fixed::floor);
                    self.areas[index].push([west, south, east, north]);
                }
                if found {
                    self.tags[index].push(tag);
                }
            }
            if self.tags[index].is_empty() {
                let mut tags: Vec<i32> = map.sectors.iter().map(|sector| sector.tag).collect();
                tags.sort_unstable();
                tags.dedup();
                tags.retain(|tag| *tag != 0);
                let known = match tags.len() {
                    0 => "none of the map's sectors has a tag".to_string(),
                    _ => {
                        let shown: Vec<_> = tags.iter().take(20).map(ToString::to_string).collect();
                        let more = if tags.len() > 20 { " and more" } else { "" };
                        format!("the map has {}{more}", shown.join(", "))
                    }
                };
                let asked = if first == last {
                    format!("the tag {first}, which no sector has")
                } else {
                    format!("the tags {first} to {last}, of which no sector has one")
                };
                return Err(EnvError::Map {
                    why: format!("zone {} has {asked}; {known}", zone.name),
                });
            }
        }
        Ok(())
    }
}

/// A map's extent as an area.
fn extent(map: &Map) -> Vec<Area> {
    let mut area = [i32::MAX, i32::MAX, i32::MIN, i32::MIN];
    for vertex in &map.vertices {
        let (x, y) = (vertex.x.floor(), vertex.y.floor());
        area = [area[0].min(x), area[1].min(y), area[2].max(x), area[3].max(y)];
    }
    vec![area]
}
