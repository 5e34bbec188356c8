//! Light that changes. Nothing but pictures shows it, so that it is computed when somebody looks:
//! an effect knows its state of some tic, and what it is any number of tics later.

use crate::map::SectorId;
use crate::world::parts::lights::Effect;
use crate::world::parts::lights::Light;
use crate::world::parts::lights::clamp_light;

use crate::world::parts::sector::Busy;
use crate::world::state::world::World;
use std::hash::{Hash, Hasher};
use std::sync::Arc;

impl World {
    /// Sets the light of the sectors with a tag at once; values outside 0..=255 are kept, the
    /// renderer clamps.
    pub fn light_change_to_value(&mut self, tag: i32, level: i32) {
        let map = Arc::clone(&self.map);
        for sector in map.tagged(tag) {
            self.sector_mut(sector).light = clamp_light(level);
        }
    }

    /// Has the light of the sectors with a tag glow: from `high` to `low` in `tics` tics, back in
    /// as many, and so on. Sectors with an effect are left alone.
    pub fn light_glow(&mut self, tag: i32, high: i32, low: i32, tics: i32) {
        self.start_lights(tag, Effect::Glow { from: high, to: low, tics: tics.max(1), done: -1 });
    }

    /// Has the light of the sectors with a tag strobe: `dark` (first) and `bright` by turns, all in
    /// phase.
    pub fn light_strobe(
        &mut self,
        tag: i32,
        bright: i32,
        dark: i32,
        bright_tics: i32,
        dark_tics: i32,
    ) {
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
        map.tagged(tag).for_each(|sector| self.start_light(sector, effect));
    }

    pub(in crate::world) fn start_light(&mut self, sector: SectorId, effect: Effect) {
        if !self.sectors[sector.0 as usize].busy.begin(Busy::LIGHT) {
            self.lights.of_sector.set(sector, self.lights.list.len());
            self.lights.list.push(Light { sector, effect, as_of: self.lights.tics });
        }
    }

    /// A tic of all lights.
    pub(crate) fn run_lights(&mut self) {
        self.lights.tics += 1;
        self.lights.run = self.lights.list.len();
    }

    /// A tic of the lights that have not run in this one.
    pub(crate) fn run_new_lights(&mut self) {
        for light in &mut self.lights.list[self.lights.run..] {
            let level = &mut self.sectors[light.sector.0 as usize].light;
            (light.effect, *level) = light.effect.after(*level, 1);
        }
        self.lights.run = self.lights.list.len();
    }

    /// The light of a sector.
    #[inline]
    pub(crate) fn light_of(&self, sector: SectorId) -> i16 {
        let state = &self.sectors[sector.0 as usize];
        // Of a map with a few lights most sectors have none: the list need not be read for them.
        match state.busy.any(Busy::LIGHT).then(|| self.lights.of_sector.get(sector)).flatten() {
            None => state.light,
            Some(index) => self.lights.now(index, state.light).1,
        }
    }

    /// Brings the stored level of a sector up to this tic.
    pub(crate) fn settle_light(&mut self, sector: SectorId) {
        if let Some(index) = self.lights.of_sector.get(sector) {
            let level = &mut self.sectors[sector.0 as usize].light;
            (self.lights.list[index].effect, *level) = self.lights.now(index, *level);
            self.lights.list[index].as_of = self.lights.tics;
        }
    }

    /// Hashes the lights as they are now.
    pub(crate) fn hash_lights<H: Hasher>(&self, state: &mut H) {
        state.write_usize(self.lights.list.len());
        for (index, light) in self.lights.list.iter().enumerate() {
            light.sector.hash(state);
            self.lights.now(index, self.sectors[light.sector.0 as usize].light).0.hash(state);
        }
        self.lights.run.hash(state);
    }
}
