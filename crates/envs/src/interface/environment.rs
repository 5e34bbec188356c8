//! What a batch asks of the worlds in it.

use crate::interface::batch::Episode;
use crate::interface::happening::Happening;
use crate::interface::insight::Insight;
use crate::interface::step::{CostTerm, Step};
use crate::spaces::action::ActionSpace;

/// A world with a task in it: what [`crate::VecEnv`] makes batches of.
///
/// Everything that happens must follow from the seed of the last [`reset`](Environment::reset) and
/// the actions since.
pub trait Environment: Send {
    /// The action space.
    fn action_space(&self) -> &ActionSpace;

    /// Shape of an observation, in the order of the chosen layout.
    fn observation_shape(&self) -> [usize; 3];

    /// The cost terms, in the order of [`step_costs`](Environment::step_costs).
    fn cost_terms(&self) -> &'static [CostTerm];

    /// A number that two environments share only if the same seed and actions lead both to the
    /// same states, so that what was saved from one can be restored in the other; 0 says nothing.
    fn fingerprint(&self) -> u64 {
        0
    }

    /// Starts the episode of `seed`.
    fn reset(&mut self, seed: u64);

    /// Advances by one policy step. The caller has checked the action: [`ActionSpace::check`]. After
    /// an episode's end nothing moves: reward and cost are 0, the flags stay.
    fn step(&mut self, actions: &[u8], deltas: &[f32]) -> Step;

    /// The last step's amount of each cost term.
    fn step_costs(&self) -> &[f64];

    /// Writes the observation of the present state, as long as the product of the observation
    /// shape.
    fn observe(&mut self, out: &mut [u8]);

    /// As [`observe`](Environment::observe), and writes what else is shown of the state, a row of
    /// [`Insight::bytes`]: zeros where there is nothing to show.
    fn observe_with(&mut self, out: &mut [u8], _what: Insight, insight: &mut [u8]) {
        insight.fill(0);
        self.observe(out);
    }

    /// Where the player stands, in map units; the origin where there are no places.
    fn position(&self) -> [i32; 2] {
        [0, 0]
    }

    /// The map's extent: x from, y from, x to, y to in map units; `None` where there are no places.
    fn extent(&self) -> Option<[i32; 4]> {
        None
    }

    /// Appends the scenario's statistics of the episode so far, by name: always the same names in
    /// the same order.
    fn stats(&self, _stats: &mut Vec<(&'static str, f64)>) {}

    /// Names of the statistics.
    fn stat_names(&self) -> Vec<&'static str> {
        let mut stats = Vec::new();
        self.stats(&mut stats);
        stats.into_iter().map(|(name, _)| name).collect()
    }

    /// What happened in the last step, in order; nothing unless [`crate::EnvOptions::events`] asks
    /// for it. Of the tics before the first observation, and of a reset, nothing is noted.
    fn happenings(&self) -> &[Happening] {
        &[]
    }

    /// The episode so far, as it would be reported if it ended now (its lane is left 0), with every
    /// cost term in the order of [`cost_terms`](Environment::cost_terms).
    fn episode(&self) -> Episode;
}
