//! Floors that swing. One that nobody stands on is computed when somebody looks at it.

use super::mover::Mover;
use super::{Busy, World};
use crate::map::SectorId;
use crate::math::{Angle, Fixed};
use std::hash::{Hash, Hasher};
use std::sync::Arc;

/// What a swinging floor is doing.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
enum Phase {
    Growing,
    Steady,
    Shrinking,
}

/// A swinging floor.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Waggle {
    pub(crate) sector: SectorId,
    /// The height that it swings about.
    rest: Fixed,
    /// Phase of the swing: 512ths of a sine table entry.
    accumulator: u32,
    accumulator_step: u32,
    /// Eighths of the amplitude: it swings by 8 times this.
    scale: Fixed,
    scale_step: Fixed,
    full_scale: Fixed,
    /// Tics left of the full swing; `None` for ever.
    steady_tics: Option<i32>,
    phase: Phase,
    /// Of the movers' tics those that this state and the sector's stored floor include.
    pub(crate) as_of: u32,
}

impl Hash for Waggle {
    /// Everything but the bookkeeping: worlds that will do the same have equal hashes, whoever looked when.
    fn hash<H: Hasher>(&self, state: &mut H) {
        (self.sector, self.rest).hash(state);
        (self.accumulator, self.accumulator_step).hash(state);
        (self.scale, self.scale_step, self.full_scale).hash(state);
        (self.steady_tics, self.phase).hash(state);
    }
}

/// Longer than any episode.
const FOR_EVER: u32 = u32::MAX;

impl Waggle {
    /// Where the floor is; [`Waggle::advance`] told that it goes on.
    #[inline]
    pub(crate) fn height(&self) -> Fixed {
        let swing = Angle::from_fine((self.accumulator >> 9) as i32).sin() * 8;
        self.rest + swing * self.scale
    }

    /// Tics that pass before one that begins another phase: in these, all is linear.
    fn calm_tics(&self) -> u32 {
        let steps_before = |far: Fixed| if self.scale_step.0 > 0 { (far.0 - 1).max(0) / self.scale_step.0 } else { 0 };
        match (self.phase, self.steady_tics) {
            (Phase::Growing, _) => steps_before(self.full_scale - self.scale) as u32,
            (Phase::Steady, Some(tics @ 1..)) => tics as u32 - 1,
            (Phase::Steady, _) => FOR_EVER,
            (Phase::Shrinking, _) => steps_before(self.scale) as u32,
        }
    }

    /// Some tics; false when it has come to rest in the last of them.
    #[inline]
    pub(crate) fn advance(&mut self, mut tics: u32) -> bool {
        loop {
            let calm = self.calm_tics().min(tics);
            self.accumulator = self.accumulator.wrapping_add(self.accumulator_step.wrapping_mul(calm));
            let steps = Fixed(self.scale_step.0.wrapping_mul(calm as i32));
            match self.phase {
                Phase::Growing => self.scale += steps,
                Phase::Steady => self.steady_tics = self.steady_tics.map(|tics| tics.wrapping_sub(calm as i32)),
                Phase::Shrinking => self.scale -= steps,
            }
            tics -= calm;
            if tics == 0 {
                return true;
            }
            if !self.change_phase() {
                return false;
            }
            tics -= 1;
        }
    }

    /// The tic that begins another phase; false when it has come to rest.
    fn change_phase(&mut self) -> bool {
        match self.phase {
            Phase::Growing => (self.scale, self.phase) = (self.full_scale, Phase::Steady),
            Phase::Steady => (self.steady_tics, self.phase) = (Some(0), Phase::Shrinking),
            Phase::Shrinking => return false,
        }
        self.accumulator = self.accumulator.wrapping_add(self.accumulator_step);
        true
    }

    /// In how many tics it comes to rest; the greatest number if never.
    pub(crate) fn tics_left(mut self) -> u32 {
        let mut total = 0u32;
        loop {
            let calm = self.calm_tics();
            total = total.saturating_add(calm).saturating_add(1);
            if calm == FOR_EVER || !self.advance(calm + 1) {
                return total;
            }
        }
    }
}

impl World {
    /// Has the floors of the sectors with a tag swing by `amplitude` eighths of a map unit about their height, with a
    /// period of 4096 / `frequency` tics. The swing grows to its full size, stays for `seconds` (0: for ever), and
    /// shrinks again. Busy floors are left alone.
    pub fn floor_waggle(&mut self, tag: i32, amplitude: i32, frequency: i32, offset: i32, seconds: i32) {
        let map = Arc::clone(&self.map);
        for sector in map.tagged(tag) {
            let state = &mut self.sectors[sector.0 as usize];
            if state.busy.begin(Busy::FLOOR) {
                continue;
            }
            let full_scale = Fixed(amplitude << 10);
            let waggle = Waggle {
                sector,
                rest: state.floor,
                accumulator: (offset as u32) << 16,
                accumulator_step: (frequency as u32) << 10,
                scale: Fixed::ZERO,
                scale_step: full_scale / (35 + 105 * amplitude / 255),
                full_scale,
                steady_tics: (seconds != 0).then_some(seconds * 35),
                phase: Phase::Growing,
                as_of: self.movers.tics(),
            };
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_tics_at_once_are_as_many_one_by_one() {
        for (amplitude, seconds) in [(192, 1), (300, 0), (512, 3), (0, 1), (-40, 2), (7, -3)] {
            let full_scale = Fixed(amplitude << 10);
            let start = Waggle {
                sector: SectorId(0),
                rest: Fixed::from_int(40),
                accumulator: 0,
                accumulator_step: 256 << 10,
                scale: Fixed::ZERO,
                scale_step: full_scale / (35 + 105 * amplitude / 255),
                full_scale,
                steady_tics: (seconds != 0).then_some(seconds * 35),
                phase: Phase::Growing,
                as_of: 0,
            };
            let mut one_by_one = vec![start];
            for tic in 0..600 {
                let mut waggle = one_by_one[tic];
                if !waggle.advance(1) {
                    assert_eq!(start.tics_left() as usize, tic + 1, "{start:?}");
                    break;
                }
                one_by_one.push(waggle);
            }
            assert_eq!(one_by_one.len() == 601, start.tics_left() == FOR_EVER, "{start:?}");
            for (first, waggle) in one_by_one.iter().enumerate().step_by(5) {
                for (later, expected) in one_by_one.iter().enumerate().skip(first + 1) {
                    let mut ahead = *waggle;
                    assert!(ahead.advance((later - first) as u32));
                    assert_eq!(ahead, *expected, "{start:?}: {later} from {first}");
                }
            }
        }
    }
}
