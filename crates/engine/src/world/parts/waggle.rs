//! The swing of a floor: where it is, and where it will be any number of tics later.

use crate::map::SectorId;
use crate::math::{Angle, Fixed};
use std::hash::{Hash, Hasher};

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
    pub(crate) rest: Fixed,
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
    /// Everything but the bookkeeping: worlds that will do the same have equal hashes, no
    /// matter when they were looked at.
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
    /// A floor that begins to swing about `rest` by `amplitude` eighths of a map unit, with a
    /// period of 4096 / `frequency` tics.
    pub(crate) fn new(
        sector: SectorId,
        rest: Fixed,
        amplitude: i32,
        frequency: i32,
        offset: i32,
        seconds: i32,
    ) -> Waggle {
        let full_scale = Fixed(amplitude << 10);
        Waggle {
            sector,
            rest,
            accumulator: (offset as u32) << 16,
            accumulator_step: (frequency as u32) << 10,
            scale: Fixed::ZERO,
            scale_step: full_scale / (35 + 105 * amplitude / 255),
            full_scale,
            steady_tics: (seconds != 0).then_some(seconds * 35),
            phase: Phase::Growing,
            as_of: 0,
        }
    }

    /// Where the floor is; [`Waggle::advance`] returned that it goes on.
    #[inline]
    pub(crate) fn height(&self) -> Fixed {
        let swing = Angle::from_fine((self.accumulator >> 9) as i32).sin() * 8;
        self.rest + swing * self.scale
    }

    /// Tics that pass before one that begins another phase: in these, all is linear.
    fn calm_tics(&self) -> u32 {
        let steps_before = |far: Fixed| {
            if self.scale_step.0 > 0 { (far.0 - 1).max(0) / self.scale_step.0 } else { 0 }
        };
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
            self.accumulator =
                self.accumulator.wrapping_add(self.accumulator_step.wrapping_mul(calm));
            let steps = Fixed(self.scale_step.0.wrapping_mul(calm as i32));
            match self.phase {
                Phase::Growing => self.scale += steps,
                Phase::Steady => {
                    self.steady_tics = self.steady_tics.map(|tics| tics.wrapping_sub(calm as i32))
                }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_tics_at_once_are_as_many_one_by_one() {
        for (amplitude, seconds) in [(192, 1), (300, 0), (512, 3), (0, 1), (-40, 2), (7, -3)] {
            let start = Waggle::new(SectorId(0), Fixed::from_int(40), amplitude, 256, 0, seconds);
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
