//! The settings of a run, all of them.

use hasard_engine::simd::Simd;
use serde::{Deserialize, Serialize};

use crate::config::budgets::{MOST_CONSTRAINTS, usual_constraints};
use crate::config::change::Change;
use crate::config::constraint::find_terms;
use crate::config::curriculum::Lesson;
use crate::config::names::names;
use crate::config::numbers::{Shown, check_number, refuse};
use crate::config::reflection::reflections;
use crate::config::{
    AlgorithmConfig, AlgorithmKind, Constraint, ConstraintStatistic, CriticInput, EnvConfig,
    EvaluationConfig, InitFrom, LearningConfig, NetworkConfig, Products, ReportingConfig,
    ReturnNormaliser, SamplingConfig,
};
use crate::error::LearnError;

names! {
    /// Where the paper and the released code differ, the one side or the other; or a quick start.
    Preset ("preset") {
        /// The paper's text made self-consistent.
        Paper = "paper",
        /// What the released code does.
        Released = "released",
        /// What the code did that made the paper's tables.
        Tables = "tables",
        /// The paper's algorithms with settings that learn within minutes on a processor, for first
        /// steps.
        Quick = "quick",
    }
}

/// A run.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
// Read by `former`, which knows what older versions wrote.
#[serde(remote = "Self")]
pub struct TrainConfig {
    /// Version of the program that began the run; empty where that did not say.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub version: String,
    /// The algorithm.
    pub algorithm: AlgorithmKind,
    /// The preset that these settings began as.
    pub preset: Preset,
    /// The environment.
    pub env: EnvConfig,
    /// Seed of everything random.
    pub seed: u64,
    /// Length of the run in frames (tics): steps times frame skip.
    pub frames: u64,
    /// The agent or run whose weights the run began with, if any: its place, and
    /// the SHA-256 of the agent's file or of the weights of the run's checkpoint.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub init_from: Option<InitFrom>,
    /// Levels that are trained one after the other; empty for the environment's own level alone.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub curriculum: Vec<Lesson>,
    /// `cpu`, or a graphics device that this program was built for.
    pub device: String,
    /// Steps of the longest episode, by which multipliers measure costs and over which
    /// `sampling.spread_out` spreads the worlds; those keep their own length.
    pub episode_steps: u32,
    /// Constraints, each with its budget.
    pub constraints: Vec<Constraint>,
    /// Share of each budget that learning aims at, whatever the algorithm, or less (see
    /// `budget_margin`): a policy that swings about its aim then keeps the budget. Evaluations hold
    /// costs against the whole budget.
    #[serde(default = "whole")]
    pub budget_share: f64,
    /// How far below a budget learning aims at least, in standard deviations of what the latest
    /// episodes cost, but never below half of the budget: the more costs scatter, the more a mean
    /// over a few hundred episodes may be off. 0.42 are three half-widths of the 95 % interval of
    /// 200 episodes. It holds for constraints on the mean of episodes, not for PPOSaute.
    #[serde(default)]
    pub budget_margin: f64,
    /// What they are held against.
    pub constraint_statistic: ConstraintStatistic,
    /// Layers.
    pub network: NetworkConfig,
    /// Gathering.
    pub sampling: SamplingConfig,
    /// Learning.
    pub learning: LearningConfig,
    /// Numbers of single algorithms.
    pub algorithm_settings: AlgorithmConfig,
    /// When the agent is evaluated.
    #[serde(default)]
    pub evaluation: EvaluationConfig,
    /// What is written.
    pub reporting: ReportingConfig,
    /// What changed when the run was resumed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub changes: Vec<Change>,
}

/// Learning aims at the whole budget where a file does not say otherwise.
fn whole() -> f64 {
    1.0
}

impl TrainConfig {
    /// The settings of a preset for an algorithm on an environment.
    pub fn new(
        algorithm: AlgorithmKind,
        preset: Preset,
        env: EnvConfig,
    ) -> Result<TrainConfig, LearnError> {
        let constraints = usual_constraints(algorithm, &env)?;
        let mut config = TrainConfig::plain(algorithm, preset, env);
        config.constraints = constraints;
        config.check()?;
        Ok(config)
    }

    /// Refuses settings that no run can have, naming the setting and what it may be.
    pub fn check(&self) -> Result<(), LearnError> {
        let (sampling, learning) = (&self.sampling, &self.learning);
        if learning.products == Products::Bfloat16 && (learning.portable || self.device != "cpu") {
            let where_else = if learning.portable { "with --portable" } else { "on a card" };
            return refuse("learning.products", &format_args!("bfloat16 {where_else}"), "float32");
        }
        self.check_counts()?;
        if !sampling.rollout.is_multiple_of(self.trajectory_steps()) {
            let allowed = format!("a multiple of the recurrence ({})", self.trajectory_steps());
            return refuse("the rollout length", &sampling.rollout, &allowed);
        }
        if sampling.world_threads > 256 {
            return refuse("the number of world threads", &sampling.world_threads, "0 to 256");
        }
        // Alone, samplers share out any number of worlds; groups are all of one size.
        if sampling.groups > 1
            && !sampling.lanes.is_multiple_of(sampling.samplers * sampling.groups)
        {
            let parts = sampling.samplers * sampling.groups;
            return refuse(
                "the number of worlds",
                &sampling.lanes,
                &format!("a multiple of samplers times groups ({parts})"),
            );
        }
        self.check_numbers()?;
        if self.algorithm.is_second_order() && !self.network.separate {
            return refuse(
                "separate networks",
                &"off",
                &format!("on for {}, whose steps are the policy's alone", self.algorithm),
            );
        }
        let predicts = learning.auxiliary_depth > 0.0 || learning.auxiliary_labels > 0.0;
        if predicts && self.network.separate {
            return refuse(
                "learning.auxiliary_depth or .auxiliary_labels",
                &"above 0 where policy and critics are networks of their own",
                "0",
            );
        }
        if predicts && self.network.mirror {
            return refuse("network.mirror", &"true where depth or labels are predicted", "false");
        }
        if self.network.mirror
            && let Some(space) = self.env.action_space()?
        {
            reflections(&space)?;
        }
        if self.algorithm == AlgorithmKind::Cup
            && learning
                .cost_gamma
                .unwrap_or(learning.gamma.max(learning.final_gamma.unwrap_or(0.0)))
                >= 1.0
        {
            let allowed = "below 1 for CUP, whose projection has 1 / (1 - gamma) for a horizon";
            return refuse("the discount of costs", &1, allowed);
        }
        if let (Some(rate), false) = (learning.critic_rate, self.network.separate) {
            return refuse(
                "the learning rate of the critics",
                &Shown(rate),
                "null unless network.separate is on",
            );
        }
        if learning.critic_inputs.contains(&CriticInput::TimeLeft) && self.lengths_differ() {
            return refuse(
                "an input of the critics",
                &"time-left",
                "another one for tasks or lessons whose episodes differ in length",
            );
        }
        if learning.critic_rate.is_some() && learning.rate == 0.0 {
            let allowed = "null where learning.rate is 0: the rate of the critics changes as that does, in proportion";
            return refuse("the learning rate of the critics", &"above 0", allowed);
        }
        if learning.normaliser == ReturnNormaliser::PopArt && !sampling.synchronous {
            let allowed = "running unless sampling.synchronous is on: actors beside the learner have heads of another scale";
            return refuse("the normaliser of returns", &learning.normaliser, allowed);
        }
        if learning.normaliser == ReturnNormaliser::PopArt && learning.cost_uses_reward_normaliser {
            return refuse(
                "the normaliser of returns",
                &learning.normaliser,
                "running where costs use that of the rewards",
            );
        }
        let seen = &learning.critic_inputs;
        if let Some(twice) = (1..seen.len()).find(|&index| seen[..index].contains(&seen[index])) {
            return refuse(
                "an input of the critics",
                &format!("'{}' twice", seen[twice]),
                "named once",
            );
        }
        if self.frames == 0 {
            return refuse("the number of frames", &self.frames, "at least 1");
        }
        if learning.schedule_frames == Some(0) {
            return refuse(
                "the length of the schedules",
                &0,
                "at least 1 frame, or null for that of the run",
            );
        }
        if let ConstraintStatistic::Cvar(share) = self.constraint_statistic {
            if !(share > 0.0 && share <= 1.0) {
                return refuse(
                    "the share of the CVaR",
                    &Shown(share),
                    "above 0 and at most 1, such as cvar:0.1",
                );
            }
            if !self.algorithm.has_multipliers() {
                let allowed = format!(
                    "episode-mean or step-mean for {}, which has no multiplier to move",
                    self.algorithm
                );
                return refuse("the constraint statistic", &self.constraint_statistic, &allowed);
            }
        }
        if self.constraints.is_empty() || self.constraints.len() > MOST_CONSTRAINTS {
            let allowed = format!("1 to {MOST_CONSTRAINTS}");
            return refuse("the number of constraints", &self.constraints.len(), &allowed);
        }
        if self.env.is_mixed() {
            self.check_tasks()?;
        }
        for constraint in &self.constraints {
            check_number("a budget", constraint.budget)?;
        }
        // Ids that are not registered, such as those of tests, fail when their worlds are made.
        if let Some(terms) = self.env.cost_terms()? {
            find_terms(terms, &self.constraints)?;
        }
        if self.algorithm.knows_one_cost() && self.constraints.len() > 1 {
            let allowed =
                format!("1 for {}, which shapes the reward by a single cost", self.algorithm);
            return refuse("the number of constraints", &self.constraints.len(), &allowed);
        }
        if self.algorithm == AlgorithmKind::PpoSaute
            && self.constraints.iter().any(|c| c.budget == 0.0)
        {
            return refuse(
                "the budget of PPOSaute",
                &0,
                "above 0, for what is left of it is measured in its units",
            );
        }
        if self.algorithm == AlgorithmKind::PpoSaute && self.budget_share == 0.0 {
            return refuse("budget_share of PPOSaute", &0, "above 0, as its budget is");
        }
        self.check_annealing()?;
        self.check_lessons()?;
        self.check_value_phase()
    }

    /// Refuses a value phase that no run can have.
    pub(crate) fn check_value_phase(&self) -> Result<(), LearnError> {
        let refuse = |name: &str, given, allowed: &str| refuse(name, &Shown(given), allowed);
        let learning = &self.learning;
        let (passes, clone) = (learning.value_phase_passes, learning.value_phase_clone);
        if learning.value_phase == Some(0) {
            return refuse("learning.value_phase", 0.0, "a number of rollouts from 1, or null");
        }
        if learning.value_phase.is_some() && self.algorithm.is_second_order() {
            let allowed =
                "null for algorithms of the second order, whose critics have critic_steps";
            return refuse(
                "learning.value_phase",
                learning.value_phase.unwrap_or(0) as f64,
                allowed,
            );
        }
        if !(1..=1000).contains(&passes) {
            return refuse("learning.value_phase_passes", passes as f64, "1 to 1000");
        }
        if !(0.0..=1e6).contains(&clone) {
            return refuse("learning.value_phase_clone", clone, "a number from 0 to 1000000");
        }
        Ok(())
    }

    /// Steps of the trajectories that are learned from.
    #[must_use]
    pub fn trajectory_steps(&self) -> usize {
        self.learning.recurrence.unwrap_or(usize::MAX).min(self.sampling.rollout)
    }

    /// Share of the schedules that is over after so many frames, 0 to 1.
    #[must_use]
    pub fn progress(&self, frames: u64) -> f64 {
        (frames as f64 / self.learning.schedule_frames.unwrap_or(self.frames) as f64).min(1.0)
    }

    /// Discount of the costs that critics predict after so many frames.
    #[must_use]
    pub fn cost_gamma_after(&self, frames: u64) -> f64 {
        let (gamma, _) = self.learning.horizon_after(self.progress(frames));
        self.learning.cost_gamma.unwrap_or(gamma)
    }

    /// Writes down what a run that begins goes by from then on: how long its schedules are, and what
    /// its products are rounded to, if `HASARD_SIMD` names a family that rounds.
    #[must_use]
    pub fn begun(self) -> TrainConfig {
        let mut config = self.scheduled();
        let rounds = |simd: Simd| simd.family().rounds();
        if Simd::forced().ok().flatten().is_some_and(rounds)
            && config.device == "cpu"
            && !config.learning.portable
        {
            config.learning.products = Products::Bfloat16;
        }
        config
    }

    /// Writes down how long its schedules are: as long as the run, unless they were given a length.
    pub(super) fn scheduled(mut self) -> TrainConfig {
        self.learning.schedule_frames.get_or_insert(self.frames);
        self
    }

    /// Frames that a run was begun with, if it was given more when it was resumed.
    #[must_use]
    pub fn extended_from(&self) -> Option<u64> {
        let first = self.changes.iter().find(|change| change.setting == "frames")?.from.as_u64()?;
        (self.frames > first).then_some(first)
    }

    /// Frames of one rollout of all worlds.
    #[must_use]
    pub fn frames_per_rollout(&self) -> u64 {
        (self.sampling.lanes * self.sampling.rollout) as u64 * u64::from(self.env.frame_skip)
    }
}

#[cfg(test)]
mod tests;
