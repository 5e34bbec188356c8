//! Snapshots and fingerprints of a world.

use crate::world::parts::riders::Riders;
use crate::world::parts::sector::{Busy, SectorState};
use crate::world::state::world::World;
use std::hash::{Hash, Hasher};
use std::sync::Arc;

impl Clone for World {
    fn clone(&self) -> World {
        World {
            map: Arc::clone(&self.map),
            sectors: self.sectors.clone(),
            sector_damages: self.sector_damages.clone(),
            actors: self.actors.clone(),
            players: self.players.clone(),
            rng: self.rng.clone(),
            tic: self.tic,
            events: self.events.clone(),
            soot: self.soot.clone(),
            trails: self.trails.clone(),
            rockets_shed: self.rockets_shed,
            no_autoaim: self.no_autoaim,
            monsters_drop_items: self.monsters_drop_items,
            awake: self.awake.clone(),
            free_slots: self.free_slots.clone(),
            fresh: self.fresh.clone(),
            fresh_run: self.fresh_run,
            grid: self.grid.clone(),
            movers: self.movers.clone(),
            lights: self.lights.clone(),
            footings: self.footings.clone(),
            riders: Riders::default(),
            scratch_crossings: Vec::new(),
            scratch_slots: Vec::new(),
        }
    }

    /// Copies without allocating where this world's lists are large enough: how an environment
    /// resets.
    fn clone_from(&mut self, source: &World) {
        let World {
            map,
            sectors,
            sector_damages,
            actors,
            players,
            rng,
            tic,
            events,
            soot,
            trails,
            rockets_shed,
            no_autoaim,
            monsters_drop_items,
            awake,
            free_slots,
            fresh,
            fresh_run,
            grid,
            movers,
            lights,
            footings,
            riders: _,
            scratch_crossings: _,
            scratch_slots: _,
        } = source;
        if !Arc::ptr_eq(&self.map, map) {
            self.map = Arc::clone(map);
        }
        self.sectors.clone_from(sectors);
        self.sector_damages.clone_from(sector_damages);
        self.actors.clone_from(actors);
        self.players.clone_from(players);
        self.rng.clone_from(rng);
        self.tic = *tic;
        self.events.clone_from(events);
        self.soot.clone_from(soot);
        self.trails.clone_from(trails);
        self.rockets_shed = *rockets_shed;
        self.no_autoaim = *no_autoaim;
        self.monsters_drop_items = *monsters_drop_items;
        self.awake.clone_from(awake);
        self.free_slots.clone_from(free_slots);
        self.fresh.clone_from(fresh);
        self.fresh_run = *fresh_run;
        self.grid.clone_from(grid);
        self.movers.copy_from(movers);
        self.lights.copy_from(lights);
        self.footings.clone_from(footings);
        self.riders.forget_all();
    }
}

impl Hash for World {
    /// Everything but the map, the caller's list of events, soot and trails, of which nothing else
    /// depends, and all of it as it is now: what is computed when somebody looks hashes as if
    /// somebody had looked.
    fn hash<H: Hasher>(&self, state: &mut H) {
        state.write_usize(self.sectors.len());
        // In this order, and what is at work as one truth each: fingerprints stay what they were.
        for (sector, damage) in self.sectors().zip(&self.sector_damages) {
            let SectorState { floor, ceiling, floor_texture, ceiling_texture, light, busy } =
                sector;
            (floor, ceiling, floor_texture, ceiling_texture, light).hash(state);
            damage.hash(state);
            [Busy::FLOOR, Busy::CEILING, Busy::LIGHT]
                .iter()
                .for_each(|&effect| busy.any(effect).hash(state));
        }
        self.actors.hash(state);
        self.players.hash(state);
        self.rng.hash(state);
        self.tic.hash(state);
        self.no_autoaim.hash(state);
        self.monsters_drop_items.hash(state);
        self.awake.hash(state);
        self.free_slots.hash(state);
        self.fresh.hash(state);
        self.fresh_run.hash(state);
        self.grid.hash(state);
        self.movers.hash(state);
        self.hash_lights(state);
    }
}

impl World {
    /// A 64-bit fingerprint of everything that the world's future depends on, for goldens and
    /// replays: equal on every little-endian platform and for every thread count.
    #[must_use]
    pub fn state_hash(&self) -> u64 {
        let mut hasher = Fingerprint::default();
        self.hash(&mut hasher);
        hasher.finish()
    }
}

/// A word-wise multiply-and-rotate hash; fixed here, so that fingerprints do not change with the
/// standard library.
#[derive(Clone, Debug)]
pub struct Fingerprint(u64);

impl Default for Fingerprint {
    fn default() -> Fingerprint {
        Fingerprint(0x9E37_79B9_7F4A_7C15)
    }
}

impl Fingerprint {
    fn word(&mut self, word: u64) {
        self.0 = (self.0 ^ word).wrapping_mul(0xA24B_AED4_963E_E407).rotate_left(29);
    }
}

impl Hasher for Fingerprint {
    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.word(u64::from_le_bytes(word));
        }
    }

    fn write_u8(&mut self, value: u8) {
        self.word(u64::from(value));
    }

    fn write_u16(&mut self, value: u16) {
        self.word(u64::from(value));
    }

    fn write_u32(&mut self, value: u32) {
        self.word(u64::from(value));
    }

    fn write_u64(&mut self, value: u64) {
        self.word(value);
    }

    fn write_usize(&mut self, value: usize) {
        self.word(value as u64);
    }

    fn write_isize(&mut self, value: isize) {
        self.word(value as i64 as u64);
    }

    fn write_i32(&mut self, value: i32) {
        self.word(value as u32 as u64);
    }

    fn finish(&self) -> u64 {
        let mut z = self.0 ^ (self.0 >> 32);
        z = z.wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z ^ (z >> 29)
    }
}
