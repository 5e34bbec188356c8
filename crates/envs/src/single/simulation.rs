//! A scenario at work: a world, the rules that script it, and what the episode has brought.

use crate::scenarios::common::outcome::Outcome;
use crate::scenarios::common::rules::AnyRules;
use hasard_engine::world::{Command, World};

/// Everything that changes in an episode. A clone is a snapshot.
#[derive(Debug)]
pub(crate) struct Game {
    pub world: World,
    pub rules: AnyRules,
    pub outcome: Outcome,
    /// The episode has been left: what the rules have finished ends as the next tic would begin.
    pub left: bool,
}

impl Clone for Game {
    fn clone(&self) -> Game {
        Game {
            world: self.world.clone(),
            rules: self.rules.clone(),
            outcome: self.outcome.clone(),
            left: self.left,
        }
    }

    /// Reuses the lists that this game has grown: how an environment resets.
    fn clone_from(&mut self, source: &Game) {
        self.world.clone_from(&source.world);
        self.rules.clone_from(&source.rules);
        self.outcome.clone_from(&source.outcome);
        self.left = source.left;
    }
}

impl Game {
    /// A game whose world has not run yet.
    pub fn new(world: World, rules: AnyRules) -> Game {
        Game { world, rules, outcome: Outcome::default(), left: false }
    }

    /// Runs one tic: players, actors and sector movers, then the scripts, then what came new. What
    /// happens after the scripts is for the scripts of the next tic: an item that lay in the way of
    /// a platform rising under the agent, say.
    ///
    /// The tic after the one in which the rules finished the episode does not run: it is then that
    /// the episode ends, which may be a policy step later (recorded: the tic of the last landing is
    /// still seen, the next is not).
    ///
    /// `noted` sees the world with the events that the scripts have read.
    pub fn tic_noted(&mut self, command: Command, noted: impl FnOnce(&World)) {
        if self.outcome.finished {
            self.left = true;
            return;
        }
        self.world.run_thinkers(&[command]);
        self.rules.script(&mut self.world, &mut self.outcome);
        noted(&self.world);
        self.world.events.clear();
        self.world.finish_tic();
    }

    /// Runs one tic.
    pub fn tic(&mut self, command: Command) {
        self.tic_noted(command, |_| ());
    }

    /// Whether death or the rules have ended the episode.
    pub fn over(&self) -> bool {
        self.left || self.world.players[0].dead
    }
}
