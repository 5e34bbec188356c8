//! Rules at work, of whichever scenario: a value that is cloned, copied over and hashed like plain
//! data.

use crate::scenarios::common::outcome::Outcome;
use hasard_engine::world::World;
use std::any::Any;
use std::fmt;
use std::hash::{Hash, Hasher};

/// The rules of a scenario at work in one episode. Its state is plain data: a clone is a snapshot,
/// and what is hashed is what the future depends on.
pub trait Rules: fmt::Debug + Send + Sync {
    /// The world is there, and no tic has run.
    fn prepare(&self, _world: &mut World) {}

    /// Whether light goggles tint the view green.
    fn green_goggles(&self) -> bool {
        false
    }

    /// Whether what is earned and paid in the tics before the first step counts in that step; the
    /// published scenarios pass it over.
    fn pays_the_opening(&self) -> bool {
        false
    }

    /// The script phase of a tic: what the map's scripts do after everything has moved.
    fn script(&mut self, world: &mut World, outcome: &mut Outcome);

    /// The episode ends: what happened after the last script phase, which no further one will read,
    /// is in the world's events. Published scripts never hear of it.
    fn last_words(&mut self, _world: &mut World, _outcome: &mut Outcome) {}

    /// A policy step is over, and perhaps the episode by death or the rules: counts what is counted
    /// by the step.
    fn end_step(&mut self, _world: &World, _over: bool, _outcome: &mut Outcome) {}

    /// Statistics of the episode so far, by name: always the same names in the same order.
    fn stats(&self, world: &World, stats: &mut Vec<(&'static str, f64)>);
}

/// What a boxed value of rules can do beside: be copied and hashed without its type being known.
trait State: Rules + Any {
    fn boxed(&self) -> Box<dyn State>;
    /// Becomes a copy of another value of the same type, in the memory that it has; false where the
    /// other is of another type.
    fn copy_from(&mut self, other: &dyn State) -> bool;
    fn feed(&self, hasher: &mut dyn Hasher);
}

impl<R: Rules + Clone + Hash + Any> State for R {
    fn boxed(&self) -> Box<dyn State> {
        Box::new(self.clone())
    }

    fn copy_from(&mut self, other: &dyn State) -> bool {
        let other: &dyn Any = other;
        other.downcast_ref::<R>().map(|other| self.clone_from(other)).is_some()
    }

    fn feed(&self, mut hasher: &mut dyn Hasher) {
        self.hash(&mut hasher);
    }
}

/// Rules of any scenario.
pub struct AnyRules(Box<dyn State>);

impl AnyRules {
    /// Wraps a scenario's rules.
    pub fn new<R: Rules + Clone + Hash + 'static>(rules: R) -> AnyRules {
        AnyRules(Box::new(rules))
    }
}

impl std::ops::Deref for AnyRules {
    type Target = dyn Rules;

    fn deref(&self) -> &(dyn Rules + 'static) {
        &*self.0
    }
}

impl std::ops::DerefMut for AnyRules {
    fn deref_mut(&mut self) -> &mut (dyn Rules + 'static) {
        &mut *self.0
    }
}

impl Clone for AnyRules {
    fn clone(&self) -> AnyRules {
        AnyRules(self.0.boxed())
    }

    fn clone_from(&mut self, source: &AnyRules) {
        if !self.0.copy_from(&*source.0) {
            self.0 = source.0.boxed();
        }
    }
}

impl Hash for AnyRules {
    fn hash<H: Hasher>(&self, hasher: &mut H) {
        self.0.feed(hasher);
    }
}

impl fmt::Debug for AnyRules {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}
