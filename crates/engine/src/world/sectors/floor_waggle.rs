//! Floors that swing, as movers of a world. One that nobody stands on is computed when somebody
//! looks at it.

use crate::map::SectorId;
use crate::math::Fixed;
use crate::world::parts::movers::Mover;
use crate::world::parts::sector::Busy;
use crate::world::parts::waggle::Waggle;
use crate::world::state::world::World;
use std::sync::Arc;

impl World {
    /// Has the floors of the sectors with a tag swing by `amplitude` eighths of a map unit about
    /// their height, with a period of 4096 / `frequency` tics. The swing grows to its full size,
    /// stays for `seconds` (0: for ever), and shrinks again. Busy floors are left alone.
    pub fn floor_waggle(
        &mut self,
        tag: i32,
        amplitude: i32,
        frequency: i32,
        offset: i32,
        seconds: i32,
    ) {
        let map = Arc::clone(&self.map);
        for sector in map.tagged(tag) {
            let state = &mut self.sectors[sector.0 as usize];
            if state.busy.begin(Busy::FLOOR) {
                continue;
            }
            let mut waggle =
                Waggle::new(sector, state.floor, amplitude, frequency, offset, seconds);
            waggle.as_of = self.movers.tics();
            self.movers.add(Mover::Waggle(waggle));
        }
    }

    /// One tic of a swinging floor, the mover of number `index`; false when it has come to rest.
    pub(crate) fn run_waggle(&mut self, index: usize) -> bool {
        let tics = self.movers.tics();
        let Mover::Waggle(waggle) = &mut self.movers.list[index] else { return true };
        let sector = waggle.sector;
        let state = &mut self.sectors[sector.0 as usize];
        // What nobody looked at first comes to where it was before this tic.
        let skipped = (tics - waggle.as_of).saturating_sub(1);
        if skipped > 0 {
            waggle.advance(skipped);
            state.floor = waggle.height();
        }
        let goes_on = waggle.advance(1);
        waggle.as_of = tics;
        let height = if goes_on { waggle.height() } else { waggle.rest };
        if self.riders.first(sector).is_none() {
            state.floor = height;
        } else {
            self.shift_plane(sector, false, height);
        }
        if !goes_on {
            self.sectors[sector.0 as usize].busy.end(Busy::FLOOR);
        }
        goes_on
    }

    /// The floor of a sector.
    #[inline]
    pub(crate) fn floor_of(&self, sector: SectorId) -> Fixed {
        match self.movers.swing_of(sector) {
            None => self.sectors[sector.0 as usize].floor,
            Some(index) => self.swung_floor(sector, index),
        }
    }

    fn swung_floor(&self, sector: SectorId, index: usize) -> Fixed {
        match self.movers.ahead(index) {
            Some(waggle) => waggle.height(),
            None => self.sectors[sector.0 as usize].floor,
        }
    }

    /// Brings the stored floor of a sector up to this tic.
    pub(crate) fn settle_floor(&mut self, sector: SectorId) {
        if let Some(index) = self.movers.swing_of(sector)
            && let Some(waggle) = self.movers.ahead(index)
        {
            self.sectors[sector.0 as usize].floor = waggle.height();
            self.movers.list[index] = Mover::Waggle(waggle);
        }
    }
}
