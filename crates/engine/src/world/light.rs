//! Light that changes.

use super::World;
use crate::map::SectorId;
use std::sync::Arc;

/// A light effect at work in a sector.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) struct Light {
    sector: SectorId,
    effect: Effect,
}

/// How a light changes.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
enum Effect {
    /// A ramp from one level to the other and back.
    Glow { from: i32, to: i32, tics: i32, done: i32 },
    /// Bright and dark by turns.
    Strobe { bright: i32, dark: i32, bright_tics: i32, dark_tics: i32, left: i32 },
}

impl World {
    /// Sets the light of the sectors with a tag at once; values outside 0..=255 are kept, the renderer clamps.
    pub fn light_change_to_value(&mut self, tag: i32, level: i32) {
        let map = Arc::clone(&self.map);
        for sector in map.tagged(tag) {
            self.sectors[sector.0 as usize].light = clamp_light(level);
        }
    }

    /// Has the light of the sectors with a tag glow: from `high` to `low` in `tics` tics, back in as many, and so on.
    /// Sectors with an effect are left alone.
    pub fn light_glow(&mut self, tag: i32, high: i32, low: i32, tics: i32) {
        self.start_lights(tag, Effect::Glow { from: high, to: low, tics: tics.max(1), done: -1 });
    }

    /// Has the light of the sectors with a tag strobe: `dark` (first) and `bright` by turns, all in phase.
    pub fn light_strobe(&mut self, tag: i32, bright: i32, dark: i32, bright_tics: i32, dark_tics: i32) {
        let effect = Effect::Strobe {
            bright: bright.clamp(0, 255),
            dark: dark.clamp(0, 255),
            bright_tics: bright_tics.max(1),
            dark_tics: dark_tics.max(1),
            left: 1,
        };
        self.start_lights(tag, effect);
    }

    fn start_lights(&mut self, tag: i32, effect: Effect) {
        let map = Arc::clone(&self.map);
        for sector in map.tagged(tag) {
            let busy = &mut self.sectors[sector.0 as usize].light_busy;
            if !std::mem::replace(busy, true) {
                self.lights.push(Light { sector, effect });
            }
        }
    }

    /// Runs the lights from number `first` on.
    pub(crate) fn run_lights(&mut self, first: usize) {
        for light in &mut self.lights[first..] {
            let level = &mut self.sectors[light.sector.0 as usize].light;
            match &mut light.effect {
                Effect::Glow { from, to, tics, done } => {
                    *done += 1;
                    if *done > *tics {
                        *done = 1;
                        std::mem::swap(from, to);
                    }
                    *level = clamp_light(*from + (*to - *from) * *done / *tics);
                }
                Effect::Strobe { bright, dark, bright_tics, dark_tics, left } => {
                    *left -= 1;
                    if *left == 0 {
                        let is_dark = i32::from(*level) == *dark;
                        (*level, *left) =
                            if is_dark { (clamp_light(*bright), *bright_tics) } else { (clamp_light(*dark), *dark_tics) };
                    }
                }
            }
        }
        self.lights_run = self.lights.len();
    }
}

fn clamp_light(level: i32) -> i16 {
    level.clamp(i32::from(i16::MIN), i32::from(i16::MAX)) as i16
}
