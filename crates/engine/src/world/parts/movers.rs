//! The floors and ceilings at work.

use crate::map::SectorId;
use crate::math::Fixed;
use crate::simd::prefetch;
use crate::world::parts::by_sector::BySector;
use crate::world::parts::waggle::Waggle;
use std::hash::{Hash, Hasher};

/// The floors and ceilings at work.
#[derive(Clone, Debug)]
pub(crate) struct Movers {
    /// In the order of their start. Where nobody stands on them, entries of swinging floors may lag
    /// behind.
    pub(crate) list: Vec<Mover>,
    /// How many of them have ended.
    pub(in crate::world) ended: usize,
    /// The numbers of the planes among them, rising.
    pub(in crate::world) planes: Vec<u32>,
    /// How many of them have run in this tic.
    pub(in crate::world) run: usize,
    /// Tics that they have run.
    pub(in crate::world) tics: u32,
    /// Those from this number on have yet to run the tic at hand.
    pub(in crate::world) waiting_from: usize,
    /// Of `tics` the one in which the first swinging floor comes to rest.
    pub(in crate::world) next_end: u32,
    /// The movers of sectors whose floors swing.
    pub(in crate::world) swings: BySector,
    /// Changes whenever `swings` does.
    pub(in crate::world) swings_made: u32,
}

impl Default for Movers {
    fn default() -> Movers {
        let (list, planes, swings) = (Vec::new(), Vec::new(), BySector::default());
        let (waiting_from, next_end) = (usize::MAX, u32::MAX);
        Movers {
            list,
            ended: 0,
            planes,
            run: 0,
            tics: 0,
            waiting_from,
            next_end,
            swings,
            swings_made: 0,
        }
    }
}

impl Movers {
    /// Copies without allocating where this list is large enough.
    pub(crate) fn copy_from(&mut self, source: &Movers) {
        let Movers { list, ended, planes, run, tics, waiting_from, next_end, swings, swings_made } =
            source;
        self.list.clone_from(list);
        self.planes.clone_from(planes);
        (self.ended, self.run, self.tics, self.waiting_from) = (*ended, *run, *tics, *waiting_from);
        (self.next_end, self.swings_made) = (*next_end, *swings_made);
        self.swings.clone_from(swings);
    }

    /// Tics that the movers have run.
    pub(crate) fn tics(&self) -> u32 {
        self.tics
    }

    /// Whether some have not run in this tic.
    pub(crate) fn wait(&self) -> bool {
        self.run < self.list.len()
    }

    /// Changes whenever another floor swings, one comes to rest, or their movers get other numbers.
    pub(crate) fn swings_made(&self) -> u32 {
        self.swings_made
    }

    /// Has every mover run in the tic to come, wherever it is.
    #[cfg(test)]
    pub(crate) fn run_all_next(&mut self) {
        self.next_end = 0;
    }

    pub(in crate::world) fn renew_swings(&mut self) {
        self.swings_made = self.swings_made.wrapping_add(1);
    }

    /// Starts a mover.
    pub(crate) fn add(&mut self, mover: Mover) {
        self.renew_swings();
        self.list.push(mover);
        self.note(self.list.len() - 1);
    }

    /// Ends the mover of a floor if it swings, before its time.
    pub(in crate::world) fn stop_swing(&mut self, sector: SectorId) -> bool {
        let Some(index) = self.swings.get(sector) else { return false };
        self.swings.clear(sector);
        self.end(index);
        true
    }

    /// Ends the planes that are floors of sectors of which `stopped` says so, before their time.
    pub(in crate::world) fn stop_planes(&mut self, stopped: impl Fn(SectorId) -> bool) {
        for at in 0..self.planes.len() {
            let index = self.planes[at] as usize;
            if matches!(self.list[index], Mover::Plane(plane) if !plane.ceiling && stopped(plane.sector))
            {
                self.end(index);
            }
        }
        self.forget_ended_planes();
    }

    pub(in crate::world) fn forget_ended_planes(&mut self) {
        let Movers { list, planes, .. } = self;
        planes.retain(|&index| list[index as usize] != Mover::Ended);
    }

    /// The mover of number `index` has ended. It stays in the list, lest the others get other
    /// numbers, until all of them are run.
    pub(in crate::world) fn end(&mut self, index: usize) {
        self.renew_swings();
        self.list[index] = Mover::Ended;
        self.ended += 1;
    }

    /// Notes what follows from the mover of number `index`.
    pub(in crate::world) fn note(&mut self, index: usize) {
        match &self.list[index] {
            Mover::Plane(_) => self.planes.push(index as u32),
            Mover::Waggle(waggle) => {
                self.swings.set(waggle.sector, index);
                self.next_end = self.next_end.min(waggle.as_of.saturating_add(waggle.tics_left()));
            }
            Mover::Ended => {}
        }
    }

    /// Whether planes are on their way anywhere; if not, the sectors with movers are those whose
    /// floors swing.
    pub(crate) fn move_planes(&self) -> bool {
        !self.planes.is_empty()
    }

    /// The mover of a sector whose floor swings.
    #[inline]
    pub(crate) fn swing_of(&self, sector: SectorId) -> Option<usize> {
        self.swings.get(sector)
    }

    /// Asks the processor for all of them.
    pub(crate) fn prefetch(&self) {
        prefetch(&self.list[..]);
        self.swings.prefetch();
    }

    /// The swinging floor of number `index` as it is now, if its entry lags behind.
    pub(crate) fn ahead(&self, index: usize) -> Option<Waggle> {
        let Mover::Waggle(mut waggle) = self.list[index] else { return None };
        let now = self.tics - u32::from(index >= self.waiting_from);
        if waggle.as_of >= now {
            return None;
        }
        waggle.advance(now - waggle.as_of);
        waggle.as_of = now;
        Some(waggle)
    }
}

impl Hash for Movers {
    /// The movers as they are now.
    fn hash<H: Hasher>(&self, state: &mut H) {
        let at_work =
            |movers: &[Mover]| movers.iter().filter(|&mover| *mover != Mover::Ended).count();
        state.write_usize(at_work(&self.list));
        for (index, mover) in
            self.list.iter().enumerate().filter(|&(_, mover)| *mover != Mover::Ended)
        {
            self.ahead(index).map_or(*mover, Mover::Waggle).hash(state);
        }
        at_work(&self.list[..self.run]).hash(state);
    }
}

/// A floor or ceiling at work.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) enum Mover {
    /// A plane on its way to a height.
    Plane(PlaneMover),
    /// A floor that swings.
    Waggle(Waggle),
    /// What has arrived, come to rest or been stopped.
    Ended,
}

/// A plane on its way to a height.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) struct PlaneMover {
    pub(in crate::world) sector: SectorId,
    pub(in crate::world) ceiling: bool,
    /// Downwards; a target that lies the other way is reached at once.
    pub(in crate::world) down: bool,
    /// Map units per tic, positive.
    pub(in crate::world) speed: Fixed,
    pub(in crate::world) target: Fixed,
}
