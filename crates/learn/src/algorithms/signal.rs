//! What constraints cost at present: all that multipliers move by.

/// What a constraint costs at present.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Signal {
    /// Cost of an episode.
    pub episode_cost: f64,
    /// Budget of an episode.
    pub episode_budget: f64,
    /// Steps of the longest episode.
    pub episode_steps: f64,
    /// Mean steps of the episodes that the cost is the mean of.
    pub mean_steps: f64,
    /// Share of the worlds that have the constraint: 1, but for those of one of several tasks.
    pub share: f64,
    /// Cost of the episodes alone that finished since multipliers last moved.
    pub fresh_cost: f64,
    /// Rollouts that those episodes stand for; 0 if there are none.
    pub fresh_weight: f64,
    /// Share of the schedule that is over, 0 to 1.
    pub done: f64,
}

impl Signal {
    /// Cost per step.
    #[must_use]
    pub fn step_cost(&self) -> f64 {
        self.episode_cost / self.episode_steps
    }

    /// Cost above budget, per step: the unit of the released code's multipliers.
    #[must_use]
    pub fn step_excess(&self) -> f64 {
        (self.episode_cost - self.episode_budget) / self.episode_steps
    }

    /// Cost of the new episodes above budget, per step.
    #[must_use]
    pub fn fresh_step_excess(&self) -> f64 {
        (self.fresh_cost - self.episode_budget) / self.episode_steps
    }

    /// A cost that is the same of all episodes, each as long as the longest and some of them of
    /// this rollout.
    #[must_use]
    pub const fn steady(episode_cost: f64, episode_budget: f64, episode_steps: f64) -> Signal {
        let (fresh_cost, mean_steps) = (episode_cost, episode_steps);
        Signal {
            episode_cost,
            episode_budget,
            episode_steps,
            mean_steps,
            share: 1.0,
            fresh_cost,
            fresh_weight: 1.0,
            done: 0.0,
        }
    }

    /// Cost above budget in the unit of a surrogate of the cost, which is a mean over the steps of
    /// all worlds: an episode's cost changes by the change of the mean over its own task's steps,
    /// times the steps that episodes have at present.
    #[must_use]
    pub fn surrogate_excess(&self) -> f64 {
        self.episode_excess() * self.share / self.mean_steps
    }

    /// Cost above budget of an episode.
    #[must_use]
    pub fn episode_excess(&self) -> f64 {
        self.episode_cost - self.episode_budget
    }
}

/// What each constraint costs, taken from the mean costs per step of the experience at hand; empty
/// while that is not known.
pub type Signals<'a> = dyn Fn(&[f64]) -> Vec<Signal> + 'a;
