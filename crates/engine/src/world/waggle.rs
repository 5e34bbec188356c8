//! Floors that swing.

use super::World;
use super::mover::Mover;
use crate::map::SectorId;
use crate::math::{Angle, Fixed};
use std::sync::Arc;

/// What a swinging floor is doing.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
enum Phase {
    Growing,
    Steady,
    Shrinking,
}

/// A swinging floor.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) struct Waggle {
    sector: SectorId,
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
}

impl Waggle {
    /// Where it is at work.
    pub(super) fn sector(&self) -> SectorId {
        self.sector
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
            if std::mem::replace(&mut state.floor_busy, true) {
                continue;
            }
            let full_scale = Fixed(amplitude << 10);
            self.movers.push(Mover::Waggle(Waggle {
                sector,
                rest: state.floor,
                accumulator: (offset as u32) << 16,
                accumulator_step: (frequency as u32) << 10,
                scale: Fixed::ZERO,
                scale_step: full_scale / (35 + 105 * amplitude / 255),
                full_scale,
                steady_tics: (seconds != 0).then_some(seconds * 35),
                phase: Phase::Growing,
            }));
        }
    }

    /// One tic of a swinging floor; false when it has come to rest.
    pub(crate) fn run_waggle(&mut self, waggle: &mut Waggle) -> bool {
        match waggle.phase {
            Phase::Growing => {
                waggle.scale += waggle.scale_step;
                if waggle.scale >= waggle.full_scale {
                    waggle.scale = waggle.full_scale;
                    waggle.phase = Phase::Steady;
                }
            }
            Phase::Steady => {
                waggle.steady_tics = waggle.steady_tics.map(|tics| tics - 1);
                if waggle.steady_tics == Some(0) {
                    waggle.phase = Phase::Shrinking;
                }
            }
            Phase::Shrinking => {
                waggle.scale -= waggle.scale_step;
                if waggle.scale <= Fixed::ZERO {
                    self.shift_plane(waggle.sector, false, waggle.rest);
                    self.sectors[waggle.sector.0 as usize].floor_busy = false;
                    return false;
                }
            }
        }
        waggle.accumulator = waggle.accumulator.wrapping_add(waggle.accumulator_step);
        let swing = Angle::from_fine((waggle.accumulator >> 9) as i32).sin() * 8;
        self.shift_plane(waggle.sector, false, waggle.rest + swing * waggle.scale);
        true
    }
}
