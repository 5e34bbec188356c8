//! Rockets begin their trail of squares, and end it.

use crate::math::Rng;
use crate::world::parts::trail::{Chance, LONGEST_LIFE, Trail};
use crate::world::state::world::World;
use crate::world::tables::states::Phase;

impl World {
    /// A rocket that was just thrown begins its trail, if rockets have any here.
    pub(in crate::world) fn begin_trail(&mut self, slot: usize) {
        if !self.rockets_shed || self.actors[slot].phase == Phase::Death {
            return;
        }
        let tic = self.tic;
        self.trails.retain(|trail| trail.ended.saturating_add(LONGEST_LIFE) > tic);
        let rocket = &self.actors[slot];
        let velocity = [rocket.vx, rocket.vy, rocket.vz];
        let place = [rocket.x + rocket.vx, rocket.y + rocket.vy, rocket.z + rocket.vz];
        // Distinguished by what the world has drawn so far, which goes on as if nobody had looked.
        let key = Rng::for_lane(self.rng.state(), u64::from(tic)).state();
        let trail =
            Trail::new(self.id_of(slot), place, velocity, tic, rocket.sector, Chance::Own(key));
        self.trails.push(trail);
    }

    /// The rocket of a slot, or whatever is in it, flies no more.
    pub(in crate::world) fn end_trail(&mut self, slot: usize) {
        let (id, tic) = (self.id_of(slot), self.tic);
        if let Some(trail) =
            self.trails.iter_mut().find(|trail| trail.rocket == id && trail.ended == Trail::FLYING)
        {
            trail.ended = tic;
        }
    }
}
