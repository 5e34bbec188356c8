//! Which actors touch which moving sector, so that a sector that moves under nobody costs nothing more.

use super::World;
use super::actor::{Actor, NO_BLOCK};
use super::collision::cuts;
use crate::map::{Map, SectorId};
use crate::math::Fixed;

/// Most sectors that are remembered of an actor; one that touches more is looked at afresh every time.
const REMEMBERED: usize = 7;

/// The sectors under one actor, remembered until it moves: items at rest on swinging floors are then cheap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Footing {
    count: u8,
    sectors: [u16; REMEMBERED],
}

impl Footing {
    /// Not known, or more than can be remembered.
    pub(crate) const UNKNOWN: Footing = Footing { count: 0, sectors: [0; REMEMBERED] };

    fn of(map: &Map, actor: &Actor) -> Footing {
        let mut footing = Footing::UNKNOWN;
        let mut fits = true;
        for_each_sector_under(map, actor, |sector| {
            let (sector, count) = (sector.0 as u16, usize::from(footing.count));
            if footing.sectors[..count].contains(&sector) {
            } else if count == REMEMBERED {
                fits = false;
            } else {
                footing.sectors[count] = sector;
                footing.count += 1;
            }
        });
        if fits { footing } else { Footing::UNKNOWN }
    }
}

/// Visits the sector under an actor's centre, and both sides of every open line that cuts its footprint; some twice.
fn for_each_sector_under(map: &Map, actor: &Actor, mut visit: impl FnMut(SectorId)) {
    visit(actor.sector);
    let Actor { x, y, radius, .. } = *actor;
    let blocks = &map.blockmap;
    for row in blocks.row_of(y - radius)..=blocks.row_of(y + radius) {
        for column in blocks.column_of(x - radius)..=blocks.column_of(x + radius) {
            for &index in blocks.lines_in(column, row) {
                let line = &map.lines[index as usize];
                if let Some(back) = line.back_sector
                    && !line.flags.blocking
                    && cuts(line, x, y, radius)
                {
                    visit(line.front_sector);
                    visit(back);
                }
            }
        }
    }
}

/// The actors on moving sectors: lists by sector, made anew whenever movers run.
#[derive(Clone, Debug, Default)]
pub(crate) struct Riders {
    /// First entry of each sector's list.
    heads: Vec<u32>,
    /// The sectors whose lists are not empty.
    sectors: Vec<SectorId>,
    /// Slot, and the next entry.
    entries: Vec<(u16, u32)>,
    /// Scratch: the movers that somebody touches.
    pub(crate) movers: Vec<usize>,
}

impl Riders {
    /// Ends a list.
    const END: u32 = u32::MAX;

    /// The first entry of a sector's list.
    pub(crate) fn first(&self, sector: SectorId) -> Option<usize> {
        Some(self.heads[sector.0 as usize]).filter(|&head| head != Riders::END).map(|head| head as usize)
    }

    /// The slot of an entry, and the entry after it.
    pub(crate) fn entry(&self, at: usize) -> (usize, Option<usize>) {
        let (slot, next) = self.entries[at];
        (usize::from(slot), Some(next).filter(|&next| next != Riders::END).map(|next| next as usize))
    }

    /// The sectors with a list, each once.
    pub(crate) fn sectors(&self) -> impl Iterator<Item = SectorId> + '_ {
        self.sectors.iter().copied()
    }

    fn clear(&mut self, sectors: usize) {
        self.heads.resize(sectors, Riders::END);
        for sector in self.sectors.drain(..) {
            self.heads[sector.0 as usize] = Riders::END;
        }
        self.entries.clear();
    }

    fn add(&mut self, sector: usize, slot: usize) {
        let head = self.heads[sector];
        if head == Riders::END {
            self.sectors.push(SectorId(sector as u32));
        }
        // All entries of one actor are made in a row: a sector met twice has it on top.
        if head == Riders::END || usize::from(self.entries[head as usize].0) != slot {
            self.heads[sector] = self.entries.len() as u32;
            self.entries.push((slot as u16, head));
        }
    }
}

impl World {
    /// An actor has moved, or is in no block any more.
    pub(crate) fn forget_footing(&mut self, slot: usize) {
        if let Some(footing) = self.footings.get_mut(slot) {
            *footing = Footing::UNKNOWN;
        }
    }

    /// Lists the actors that touch a busy sector. Actors keep their places while movers run, so that the lists stay true.
    pub(crate) fn list_riders(&mut self) {
        self.riders.clear(self.sectors.len());
        self.footings.resize(self.actors.len(), Footing::UNKNOWN);
        let World { riders, footings, sectors, actors, map, movers, .. } = self;
        // The short list of swings first: the sectors of a whole world would come into the cache for a bit each.
        let planes = movers.move_planes();
        let busy = |sector: usize| {
            movers.swing_of(SectorId(sector as u32)).is_some()
                || (planes && (sectors[sector].floor_busy || sectors[sector].ceiling_busy))
        };
        for (slot, footing) in footings.iter_mut().enumerate() {
            // Only what is in a block has a known footing: most actors need not be looked at.
            if footing.count == 0 {
                let actor = &actors[slot];
                if actor.removed || actor.block == NO_BLOCK {
                    continue;
                }
                *footing = Footing::of(map, actor);
            }
            let Footing { count, sectors: under } = *footing;
            for &sector in &under[..usize::from(count)] {
                if busy(usize::from(sector)) {
                    riders.add(usize::from(sector), slot);
                }
            }
            if count == 0 {
                let actor = &actors[slot];
                for_each_sector_under(map, actor, |sector| {
                    if busy(sector.0 as usize) {
                        riders.add(sector.0 as usize, slot);
                    }
                });
            }
        }
    }

    /// The highest floor, lowest ceiling and lowest floor under an actor whose footing is known, as they are now.
    pub(crate) fn planes_under(&self, slot: usize) -> Option<(Fixed, Fixed, Fixed)> {
        let Footing { count, sectors } = self.footings[slot];
        let planes = sectors[..usize::from(count)].iter().map(|&sector| {
            let floor = self.floor_of(SectorId(u32::from(sector)));
            (floor, self.sectors[usize::from(sector)].ceiling, floor)
        });
        planes.reduce(|a, b| (a.0.max(b.0), a.1.min(b.1), a.2.min(b.2)))
    }
}
