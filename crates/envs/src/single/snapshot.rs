//! A moment of an environment, to come back to.

use crate::error::EnvError;
use crate::interface::step::Step;
use crate::options::EnvOptions;
use crate::registry::scenario::EnvId;
use crate::scenarios::common::outcome::MOST_TERMS;
use crate::single::env::{Env, Totals};
use crate::single::simulation::Game;

/// A saved moment of an environment; [`Env::restore`] brings it back exactly.
#[derive(Clone, Debug)]
pub struct Snapshot {
    id: EnvId,
    options: EnvOptions,
    game: Game,
    seed: u64,
    totals: Totals,
    last: Step,
    last_costs: [f64; MOST_TERMS],
    memory: (Vec<u8>, usize),
}

impl Env {
    /// The present moment, to come back to.
    #[must_use]
    pub fn snapshot(&self) -> Snapshot {
        Snapshot {
            id: self.blueprint.id,
            options: self.blueprint.options.clone(),
            game: self.game.clone(),
            seed: self.seed,
            totals: self.totals,
            last: self.last,
            last_costs: self.last_costs,
            memory: self.eye.memory(),
        }
    }

    /// Comes back to a moment saved from an environment of the same kind; another's is refused, and
    /// nothing changes.
    pub fn restore(&mut self, snapshot: &Snapshot) -> Result<(), EnvError> {
        let own = &self.blueprint;
        if snapshot.id != own.id {
            let why = format!("a snapshot of {} cannot be restored in {}", snapshot.id, own.id);
            return Err(EnvError::Saved { why });
        }
        if let Some(option) = own.options.difference(&snapshot.options) {
            let why = format!(
                "the snapshot is of another {}: its {option} differs; restore it in one made alike",
                own.id
            );
            return Err(EnvError::Saved { why });
        }
        self.game.clone_from(&snapshot.game);
        (self.seed, self.totals) = (snapshot.seed, snapshot.totals);
        (self.last, self.last_costs) = (snapshot.last, snapshot.last_costs);
        self.eye.remember(&snapshot.memory);
        self.happenings.clear();
        Ok(())
    }
}
