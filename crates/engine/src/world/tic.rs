//! One tic: who acts, in which order.

use crate::world::parts::actor::Actor;
use crate::world::parts::command::Command;
use crate::world::state::world::World;
use crate::world::tables::kinds::ActorKind;
use crate::world::tables::states::is_timed;

impl World {
    /// The first part of a tic: players think and move, then power-ups, lights, all other actors in
    /// slot order, and moving floors and ceilings. Player `i` obeys `commands[i]`, nothing if that
    /// is missing.
    pub fn run_thinkers(&mut self, commands: &[Command]) {
        for index in 0..self.players.len() {
            let command = commands.get(index).copied().unwrap_or_default();
            self.think_player(index, &command);
        }
        for index in 0..self.players.len() {
            self.run_player_body(index);
        }
        for index in 0..self.players.len() {
            self.tick_powers(index);
        }
        self.run_lights();
        let mut from = 0;
        while let Some(slot) = self.next_awake(from) {
            self.run_actor(slot);
            from = slot + 1;
        }
        self.run_movers();
    }

    /// The last part of a tic, after the caller's scripts: what was created during the tic is run
    /// once, until nothing new comes; then time advances.
    pub fn finish_tic(&mut self) {
        while self.fresh_run < self.fresh.len() || self.movers.wait() || self.lights.wait() {
            self.run_new_lights();
            while self.fresh_run < self.fresh.len() {
                let id = self.fresh[self.fresh_run];
                self.fresh_run += 1;
                if self.get(id).is_some() {
                    self.run_actor(usize::from(id.slot));
                }
            }
            self.run_new_movers();
        }
        self.fresh.clear();
        self.fresh_run = 0;
        self.tic += 1;
    }

    /// One tic of an actor that is no player's body: move, then animation; then it sleeps if
    /// nothing moves it.
    fn run_actor(&mut self, slot: usize) {
        let id = self.id_of(slot);
        if !self.actors[slot].at_rest() {
            self.move_actor(slot);
        }
        if self.get(id).is_none() {
            return;
        }
        let Actor { kind, phase, .. } = self.actors[slot];
        let timed = is_timed(kind, phase);
        if !timed {
            self.tick_animation(slot);
        }
        if self.get(id).is_some() {
            self.awake[slot] = !timed || !self.actors[slot].at_rest();
        }
    }

    /// One tic of a player's body.
    fn run_player_body(&mut self, index: usize) {
        let player = &self.players[index];
        let slot = usize::from(player.actor.slot);
        let full_height = ActorKind::Player.height();
        if !player.dead {
            self.actors[slot].height = full_height * player.crouch;
        }
        self.move_actor(slot);
        self.tick_animation(slot);
    }
}
