//! Light effects: one knows its state of some tic, and what it is any number of tics later.

use crate::map::SectorId;
use crate::simd::prefetch;
use crate::world::parts::by_sector::BySector;

/// The lights at work, in the order of their start.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lights {
    pub(in crate::world) list: Vec<Light>,
    /// How many of them have run in this tic.
    pub(in crate::world) run: usize,
    /// Tics that the lights have run, and those that are as they were then.
    pub(in crate::world) tics: u32,
    pub(in crate::world) of_sector: BySector,
}

/// A light effect at work in a sector.
#[derive(Clone, Copy, Debug)]
pub(in crate::world) struct Light {
    pub(in crate::world) sector: SectorId,
    pub(in crate::world) effect: Effect,
    /// Of [`Lights::tics`] those that `effect` and the sector's stored level include.
    pub(in crate::world) as_of: u32,
}

/// How a light changes.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(in crate::world) enum Effect {
    /// A ramp from one level to the other and back.
    Glow { from: i32, to: i32, tics: i32, done: i32 },
    /// Bright and dark by turns.
    Strobe { bright: i32, dark: i32, bright_tics: i32, dark_tics: i32, left: i32 },
    /// A gleam that comes and goes every [`PHASES`] tics and is dark between; `phase` is the next
    /// tic's.
    Phased { dark: i32, phase: u32 },
}

/// Tics from one gleam of a phased light to the next; the last of them gleam.
pub(in crate::world) const PHASES: u32 = 64;

/// Tics that a gleam needs to be as bright as light gets. A step less, and it goes again.
pub(in crate::world) const GLEAM_TICS: i32 = 12;

impl Effect {
    /// The effect and its level after some tics more, at least one, from the level that it has now.
    pub(in crate::world) fn after(self, level: i16, count: u32) -> (Effect, i16) {
        match self {
            Effect::Glow { mut from, mut to, tics, done } => {
                let ahead = i64::from(done) + i64::from(count);
                let turns = (ahead - 1).max(0) / i64::from(tics);
                if turns % 2 == 1 {
                    std::mem::swap(&mut from, &mut to);
                }
                let done = (ahead - turns * i64::from(tics)) as i32;
                (
                    Effect::Glow { from, to, tics, done },
                    clamp_light(from + (to - from) * done / tics),
                )
            }
            Effect::Strobe { bright, dark, bright_tics, dark_tics, mut left } => {
                let (mut count, mut level) = (i64::from(count), level);
                let round = i64::from(bright_tics) + i64::from(dark_tics);
                while count >= i64::from(left) {
                    count -= i64::from(left);
                    let is_dark = i32::from(level) == dark;
                    (level, left) = if is_dark {
                        (clamp_light(bright), bright_tics)
                    } else {
                        (clamp_light(dark), dark_tics)
                    };
                    // From a turn on whole rounds change nothing; one of two equal sides never
                    // leaves the bright one.
                    if bright != dark && count >= round {
                        count %= round;
                    }
                }
                (
                    Effect::Strobe {
                        bright,
                        dark,
                        bright_tics,
                        dark_tics,
                        left: left - count as i32,
                    },
                    level,
                )
            }
            Effect::Phased { dark, phase } => {
                let shown = phase.wrapping_add(count - 1) % PHASES;
                let left = (PHASES - shown) as i32;
                let steps = left.min(2 * GLEAM_TICS - 1 - left).max(0);
                let level = dark + (255 - dark) * steps / GLEAM_TICS;
                (Effect::Phased { dark, phase: (shown + 1) % PHASES }, clamp_light(level))
            }
        }
    }
}

impl Lights {
    /// Copies without allocating where this list is large enough.
    pub(crate) fn copy_from(&mut self, source: &Lights) {
        let Lights { list, run, tics, of_sector } = source;
        self.list.clone_from(list);
        (self.run, self.tics) = (*run, *tics);
        self.of_sector.clone_from(of_sector);
    }

    /// Whether some have not run in this tic.
    pub(crate) fn wait(&self) -> bool {
        self.run < self.list.len()
    }

    /// Asks the processor for all of them.
    pub(crate) fn prefetch(&self) {
        prefetch(&self.list[..]);
        self.of_sector.prefetch();
    }

    pub(in crate::world) fn now(&self, index: usize, level: i16) -> (Effect, i16) {
        let Light { effect, as_of, .. } = self.list[index];
        if as_of == self.tics { (effect, level) } else { effect.after(level, self.tics - as_of) }
    }
}

pub(in crate::world) fn clamp_light(level: i32) -> i16 {
    level.clamp(i32::from(i16::MIN), i32::from(i16::MAX)) as i16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_tics_at_once_are_as_many_one_by_one() {
        let effects = [
            Effect::Glow { from: 250, to: 150, tics: 50, done: -1 },
            Effect::Glow { from: -20, to: 40_000, tics: 1, done: -1 },
            Effect::Strobe { bright: 200, dark: 100, bright_tics: 3, dark_tics: 5, left: 1 },
            Effect::Strobe { bright: 90, dark: 90, bright_tics: 3, dark_tics: 1, left: 1 },
            Effect::Phased { dark: 48, phase: 17 },
        ];
        for start in effects {
            let mut one_by_one = vec![(start, 128)];
            for tic in 0..300 {
                let (effect, level) = one_by_one[tic];
                one_by_one.push(effect.after(level, 1));
            }
            for (first, &(effect, level)) in one_by_one.iter().enumerate().step_by(7) {
                for (later, expected) in one_by_one.iter().enumerate().skip(first + 1) {
                    assert_eq!(
                        effect.after(level, (later - first) as u32),
                        *expected,
                        "{start:?}: {later} from {first}"
                    );
                }
            }
        }
    }

    #[test]
    fn glows_change_sides_at_their_ends() {
        let start = Effect::Glow { from: 200, to: 100, tics: 50, done: -1 };
        let level = |tics| start.after(0, tics).1;
        // The first tic shows the start, every fiftieth from there an end.
        assert_eq!([1, 2, 51, 52, 101, 151].map(level), [200, 198, 100, 102, 200, 100]);
    }
}
