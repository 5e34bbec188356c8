//! Which actors touch which moving sector: lists, and what is remembered of each actor.

use crate::map::{Map, SectorId};
use crate::world::parts::actor::Actor;
use crate::world::parts::lines::{for_each_line_across, stops};

/// Most sectors that are remembered of an actor; one that touches more is looked at afresh every
/// time.
pub(in crate::world) const REMEMBERED: usize = 7;

/// The sectors under one actor, remembered until it moves: items at rest on swinging floors are
/// then cheap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Footing {
    pub(in crate::world) count: u8,
    pub(in crate::world) sectors: [u16; REMEMBERED],
}

impl Footing {
    /// Not known, or more than can be remembered.
    pub(crate) const UNKNOWN: Footing = Footing { count: 0, sectors: [0; REMEMBERED] };

    pub(in crate::world) fn of(map: &Map, actor: &Actor) -> Footing {
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

/// Visits the sector under an actor's centre, and both sides of every open line that cuts its
/// footprint; some twice.
pub(in crate::world) fn for_each_sector_under(
    map: &Map,
    actor: &Actor,
    mut visit: impl FnMut(SectorId),
) {
    visit(actor.sector);
    let Actor { x, y, radius, .. } = *actor;
    for_each_line_across(map, x, y, radius, |_, line| {
        if let Some(back) = line.back_sector
            && !line.flags.blocking
            && !stops(line.flags, actor)
        {
            visit(line.front_sector);
            visit(back);
        }
    });
}

/// An actor of which the lists are out of date: it has moved, came or went.
#[derive(Clone, Copy, Debug)]
pub(in crate::world) struct Moved {
    pub(in crate::world) slot: u16,
    /// Under which sectors it is listed.
    pub(in crate::world) listed: Footing,
}

/// Most actors that are moved from list to list one by one; when there are more, all lists are made
/// anew.
pub(in crate::world) const FEW: usize = 6;

/// The actors on moving sectors: a list for each sector, by falling slots.
#[derive(Clone, Debug, Default)]
pub(crate) struct Riders {
    /// First entry of each sector's list.
    pub(in crate::world) heads: Vec<u32>,
    /// Slot, and the next entry.
    pub(in crate::world) entries: Vec<(u16, u32)>,
    /// First of the entries that no list has.
    pub(in crate::world) free: u32,
    /// Movers of the swinging floors that have a list, in the order of the movers.
    pub(in crate::world) ridden: Vec<u32>,
    /// What has changed since.
    pub(in crate::world) moved: Vec<Moved>,
    /// What the lists were made for; `None`: they must be made anew.
    pub(in crate::world) made_for: Option<u32>,
}

impl Riders {
    /// Ends a list.
    pub(in crate::world) const END: u32 = u32::MAX;

    /// The first entry of a sector's list.
    pub(crate) fn first(&self, sector: SectorId) -> Option<usize> {
        Some(self.heads[sector.0 as usize])
            .filter(|&head| head != Riders::END)
            .map(|head| head as usize)
    }

    /// The slot of an entry, and the entry after it.
    pub(crate) fn entry(&self, at: usize) -> (usize, Option<usize>) {
        let (slot, next) = self.entries[at];
        (
            usize::from(slot),
            Some(next).filter(|&next| next != Riders::END).map(|next| next as usize),
        )
    }

    /// The mover of the swinging floor that is number `at` of those with a list.
    pub(crate) fn ridden(&self, at: usize) -> Option<usize> {
        self.ridden.get(at).map(|&index| index as usize)
    }

    /// Nothing is known of any actor any more.
    pub(crate) fn forget_all(&mut self) {
        self.made_for = None;
    }

    pub(in crate::world) fn forget(&mut self, slot: u16, listed: Footing) {
        if self.made_for.is_none() || self.moved.iter().any(|moved| moved.slot == slot) {
        } else if self.moved.len() < FEW {
            self.moved.push(Moved { slot, listed });
        } else {
            self.made_for = None;
        }
    }

    pub(in crate::world) fn clear(&mut self, sectors: usize) {
        self.heads.clear();
        self.heads.resize(sectors, Riders::END);
        self.entries.clear();
        self.free = Riders::END;
        self.ridden.clear();
        self.moved.clear();
    }

    /// Where the link to the first entry of a list is whose slot is not above `slot`: the entry
    /// before, or none.
    pub(in crate::world) fn before(&self, sector: usize, slot: u16) -> (Option<usize>, u32) {
        let (mut before, mut at) = (None, self.heads[sector]);
        while at != Riders::END && self.entries[at as usize].0 > slot {
            (before, at) = (Some(at as usize), self.entries[at as usize].1);
        }
        (before, at)
    }

    pub(in crate::world) fn link(&mut self, sector: usize, before: Option<usize>, to: u32) {
        match before {
            Some(before) => self.entries[before].1 = to,
            None => self.heads[sector] = to,
        }
    }

    /// Enters an actor into the list of a sector, the swinging floor of which is moved by `mover`.
    pub(in crate::world) fn add(&mut self, sector: usize, slot: u16, mover: Option<usize>) {
        let (before, at) = self.before(sector, slot);
        if at != Riders::END && self.entries[at as usize].0 == slot {
            return;
        }
        if let Some(mover) = mover
            && self.heads[sector] == Riders::END
            && let Err(place) = self.ridden.binary_search(&(mover as u32))
        {
            self.ridden.insert(place, mover as u32);
        }
        let entry = if self.free == Riders::END {
            self.entries.push((slot, at));
            self.entries.len() as u32 - 1
        } else {
            let entry = self.free;
            self.free = std::mem::replace(&mut self.entries[entry as usize], (slot, at)).1;
            entry
        };
        self.link(sector, before, entry);
    }

    /// Takes an actor out of the list of a sector, the swinging floor of which is moved by `mover`.
    pub(in crate::world) fn take(&mut self, sector: usize, slot: u16, mover: usize) {
        let (before, at) = self.before(sector, slot);
        if at == Riders::END || self.entries[at as usize].0 != slot {
            return;
        }
        let next = std::mem::replace(&mut self.entries[at as usize].1, self.free);
        self.free = at;
        self.link(sector, before, next);
        if self.heads[sector] == Riders::END
            && let Ok(place) = self.ridden.binary_search(&(mover as u32))
        {
            self.ridden.remove(place);
        }
    }
}
