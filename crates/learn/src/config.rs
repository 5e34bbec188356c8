//! Everything that a run is made of. A run's `config.json` is this, and resuming or evaluating needs nothing else.

use std::fmt;
use std::str::FromStr;

use hasard_envs::{EnvId, EnvOptions, FrameSize, Layout, ObservationKind, RuleSet, Scenario};
use serde::{Deserialize, Serialize};

use crate::curriculum::Lesson;
use crate::error::LearnError;
use crate::model::{Convolution, Initialisation};
use crate::sampler::find_terms;

/// An enum of names: its text is what users type, upper and lower case alike.
macro_rules! names {
    ($(#[$meta:meta])* $name:ident ($what:literal) { $($(#[$variant_meta:meta])* $variant:ident = $text:literal,)+ }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
        pub enum $name {
            $($(#[$variant_meta])* #[serde(rename = $text)] $variant,)+
        }

        impl $name {
            /// All of them.
            pub const ALL: &'static [$name] = &[$($name::$variant),+];

            /// Its name.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $($name::$variant => $text,)+ }
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(self.name())
            }
        }

        impl FromStr for $name {
            type Err = LearnError;

            fn from_str(text: &str) -> Result<$name, LearnError> {
                $name::ALL.iter().copied().find(|one| one.name().eq_ignore_ascii_case(text)).ok_or_else(|| {
                    let all: Vec<&str> = $name::ALL.iter().map(|one| one.name()).collect();
                    LearnError::Config(format!("{} '{text}' is unknown; use one of {}", $what, all.join(", ")))
                })
            }
        }
    };
}

names! {
    /// The algorithms, each in a file of its own under `algorithms`.
    AlgorithmKind ("algorithm") {
        /// Proximal policy optimisation; costs are ignored.
        Ppo = "PPO",
        /// PPO on reward minus scaled cost.
        PpoCost = "PPOCost",
        /// PPO with a Lagrange multiplier.
        PpoLag = "PPOLag",
        /// PPO with the budget as part of the state.
        PpoSaute = "PPOSaute",
        /// PPO with a multiplier moved by a PID controller.
        PpoPid = "PPOPID",
        /// Penalised PPO.
        P3o = "P3O",
        /// Trust-region policy optimisation; costs are ignored.
        Trpo = "TRPO",
        /// TRPO with a Lagrange multiplier.
        TrpoLag = "TRPOLag",
        /// TRPO with a multiplier moved by a PID controller.
        TrpoPid = "TRPOPID",
        /// Constrained policy optimisation.
        Cpo = "CPO",
        /// First-order constrained optimisation in policy space.
        Focops = "FOCOPS",
        /// Conservative update policy.
        Cup = "CUP",
        /// Interior-point policy optimisation.
        Ipo = "IPO",
    }
}

impl AlgorithmKind {
    /// Whether it learns what costs are to be expected.
    #[must_use]
    pub const fn has_cost_critics(self) -> bool {
        !matches!(self, Self::Ppo | Self::PpoCost | Self::PpoSaute | Self::Trpo)
    }

    /// Whether policy and critics are networks of their own, as second-order steps want it.
    #[must_use]
    pub const fn separates_networks(self) -> bool {
        matches!(self, Self::Trpo | Self::TrpoLag | Self::TrpoPid | Self::Cpo)
    }
}

names! {
    /// Where the paper and the released code differ, one column of `DECISIONS.md` or the other; or a quick start.
    Preset ("preset") {
        /// The paper's text made self-consistent.
        Paper = "paper",
        /// What the released code does.
        Released = "released",
        /// The paper's algorithms with settings that learn within minutes on a processor, for first steps.
        Quick = "quick",
    }
}

names! {
    /// What keeps the policy from settling too early.
    Exploration ("exploration loss") {
        /// Symmetric divergence from the uniform distribution, as in the original.
        SymmetricKl = "symmetric-kl",
        /// Minus the entropy.
        Entropy = "entropy",
    }
}

names! {
    /// What a constraint's budget is held against.
    ConstraintStatistic ("constraint statistic") {
        /// Mean cost of the episodes that ended lately, against the budget of an episode.
        EpisodeMean = "episode-mean",
        /// Mean cost of the minibatch's steps, against the budget over the longest episode's steps.
        StepMean = "step-mean",
    }
}

/// The environment and its options, in words that a file can hold.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct EnvConfig {
    /// Its id, such as `VolcanicVentureLevel1-v0`.
    pub id: String,
    /// `paper` or `released`.
    pub rules: String,
    /// Hard constraint.
    pub hard: bool,
    /// Full action space.
    pub full_actions: bool,
    /// Tics that an action is held.
    pub frame_skip: u32,
    /// Width and height of a frame.
    pub size: (u16, u16),
    /// `rgb`, `rgb+depth`, `segmented` or `grey`.
    pub observation: String,
    /// Frames stacked.
    pub frame_stack: usize,
    /// Depth ends where the published engine's does.
    #[serde(default, skip_serializing_if = "is_off")]
    pub published_depth: bool,
    /// Segmented in the published colours.
    #[serde(default, skip_serializing_if = "is_off")]
    pub published_colours: bool,
    /// The file of the pictures that worlds are drawn with; `null` for the embedded set. Whoever makes the worlds reads it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub iwad: Option<String>,
}

/// Options that are seldom on are written only then.
#[allow(clippy::trivially_copy_pass_by_ref, reason = "the signature that serde asks for")]
fn is_off(option: &bool) -> bool {
    !option
}

impl EnvConfig {
    /// An environment with the learner's frames and otherwise default options.
    #[must_use]
    pub fn new(id: &str) -> EnvConfig {
        EnvConfig {
            id: id.to_string(),
            rules: "paper".into(),
            hard: false,
            full_actions: false,
            frame_skip: 4,
            size: (128, 72),
            observation: "rgb".into(),
            frame_stack: 1,
            published_depth: false,
            published_colours: false,
            iwad: None,
        }
    }

    /// The same in the environments' own types, without pictures; observations are laid out as the networks read them.
    pub fn options(&self) -> Result<EnvOptions, LearnError> {
        let unknown = |what: &str, given: &str, allowed: &str| {
            LearnError::Config(format!("{what} '{given}' is unknown; use one of {allowed}"))
        };
        let observation = match self.observation.as_str() {
            "rgb" => ObservationKind::Rgb,
            "rgb+depth" => ObservationKind::RgbDepth,
            "segmented" => ObservationKind::Segmented,
            "grey" => ObservationKind::Grey,
            other => return Err(unknown("observation", other, "rgb, rgb+depth, segmented, grey")),
        };
        Ok(EnvOptions {
            rules: self.rule_set()?,
            hard: self.hard,
            full_actions: self.full_actions,
            frame_skip: self.frame_skip,
            size: FrameSize { width: self.size.0, height: self.size.1 },
            observation,
            layout: Layout::Hwc,
            frame_stack: self.frame_stack,
            published_depth: self.published_depth,
            published_colours: self.published_colours,
            ..EnvOptions::default()
        })
    }

    fn rule_set(&self) -> Result<RuleSet, LearnError> {
        match self.rules.as_str() {
            "paper" => Ok(RuleSet::Paper),
            "released" => Ok(RuleSet::Released),
            other => Err(LearnError::Config(format!("rules '{other}' are unknown; use one of paper, released"))),
        }
    }

    pub(crate) fn scenario(&self) -> Option<Scenario> {
        self.id.parse::<EnvId>().ok().map(|id| id.scenario)
    }
}

/// The network's layers; heads and inputs follow from the worlds and the algorithm.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct NetworkConfig {
    /// Convolutions.
    pub convolutions: Vec<Convolution>,
    /// Units of the dense layers.
    pub dense: Vec<usize>,
    /// Units of the GRU; `null` for a feed-forward network.
    pub recurrent: Option<usize>,
    /// Policy and critics as networks of their own.
    pub separate: bool,
    /// Initial weights.
    pub initialisation: Initialisation,
}

/// How experience is gathered.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct SamplingConfig {
    /// Worlds.
    pub lanes: usize,
    /// Steps of a trajectory.
    pub rollout: usize,
    /// Threads that run the policy, each with worlds of its own.
    pub samplers: usize,
    /// Threads that step the worlds of each sampler; with 0 it steps them itself.
    pub world_threads: usize,
    /// Groups of worlds of each sampler: with 2 and world threads, one half steps while the policy works on the other.
    pub groups: usize,
    /// Lanes start their first episode after different numbers of random steps.
    pub spread_out: bool,
    /// Sampling and learning take turns, bit-reproducibly; otherwise they run side by side.
    pub synchronous: bool,
    /// Rollouts that may wait for the learner when both run side by side.
    pub accumulated: usize,
    /// Updates that a rollout may be older than the learner; older ones are thrown away.
    pub max_policy_lag: u64,
}

/// How the networks learn.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct LearningConfig {
    /// Passes over a rollout.
    pub epochs: usize,
    /// Parts that the rollout's trajectories are dealt into in each pass.
    pub minibatches: usize,
    /// Discount.
    pub gamma: f32,
    /// Lambda of the advantage estimate.
    pub gae_lambda: f32,
    /// Learning rate.
    pub rate: f64,
    /// Learning rate at the end of the run, reached linearly; equal to `rate` for a constant one.
    pub final_rate: f64,
    /// Adam's decays.
    pub adam_betas: (f64, f64),
    /// Adam's epsilon.
    pub adam_epsilon: f64,
    /// Norm that gradients are cut down to.
    pub max_gradient_norm: f64,
    /// Clipping of the probability ratio: 1/(1+clip) to 1+clip.
    pub clip_ratio: f64,
    /// Clipping of value changes.
    pub clip_value: f64,
    /// Weight of the value losses.
    pub value_coefficient: f64,
    /// Exploration loss.
    pub exploration: Exploration,
    /// Its weight.
    pub exploration_coefficient: f64,
    /// Time-outs count as cut-off rather than as ends: the value of what would have come is added.
    pub bootstrap_time_outs: bool,
    /// Threads.
    pub threads: usize,
}

/// A constraint: a cost and the budget of an episode.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Constraint {
    /// Name of a cost term; `null` for the scalar cost.
    pub term: Option<String>,
    /// Cost that an episode may have.
    pub budget: f64,
}

/// Numbers of single algorithms.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct AlgorithmConfig {
    /// PPOCost: factor of the cost in the reward.
    pub penalty_scale: f64,
    /// Lagrangian algorithms: the multiplier before the first update.
    pub multiplier_initial: f64,
    /// Lagrangian algorithms: change of the multiplier per update and unit of cost per step above budget.
    pub multiplier_rate: f64,
    /// PID: proportional, integral and derivative gains.
    pub pid_gains: (f64, f64, f64),
    /// PID: the integral before the first update.
    pub pid_initial: f64,
    /// PID: decay of the moving averages of error and cost.
    pub pid_decay: f64,
    /// PID: updates that the derivative looks back.
    pub pid_delay: usize,
    /// P3O: weight of the penalty.
    pub p3o_kappa: f64,
    /// P3O: clipped surrogate and (1 - gamma) times the excess of an episode, as its paper has it.
    pub p3o_clipped: bool,
    /// Saute: discount of the budget.
    pub saute_gamma: f64,
    /// Saute: reward once the budget is spent.
    pub saute_unsafe_reward: f64,
    /// Saute: the safety state is an input of the network.
    pub saute_visible: bool,
    /// Saute: time over which the budget is spread (steps, or tics as in the released code).
    pub saute_horizon: f64,
    /// Second-order algorithms: bound of the mean divergence of a step.
    pub trust_radius: f64,
    /// Second-order algorithms: iterations of the conjugate-gradient method.
    pub conjugate_iterations: usize,
    /// Second-order algorithms: multiple of the identity added to the Fisher matrix.
    pub fisher_damping: f64,
    /// Second-order algorithms: tries of the line search.
    pub line_search_steps: usize,
    /// Second-order algorithms: factor between the tries.
    pub line_search_factor: f64,
    /// TRPO family: one objective for gradient and line search, and cost critics that learn. The released code searches on
    /// the reward alone and never trains the cost critic.
    pub trpo_consistent: bool,
    /// FOCOPS: largest divergence of a sample that still counts.
    pub focops_eta: f64,
    /// FOCOPS: temperature.
    pub focops_temperature: f64,
    /// FOCOPS and CUP: largest multiplier.
    pub multiplier_limit: f64,
    /// IPO: steepness of the barrier.
    pub ipo_kappa: f64,
    /// IPO: largest penalty.
    pub ipo_limit: f64,
}

/// What a run writes, and when.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct ReportingConfig {
    /// Seconds between reports; 0 reports after every rollout.
    pub report_seconds: f64,
    /// Seconds between checkpoints; 0 writes one after every rollout that the disk keeps up with.
    pub checkpoint_seconds: f64,
    /// Checkpoints that are kept beside the best feasible one.
    pub keep: usize,
    /// Episodes that means are taken over.
    pub window: usize,
}

/// A run.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct TrainConfig {
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
    /// Levels that are trained one after the other; empty for the environment's own level alone.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub curriculum: Vec<Lesson>,
    /// `cpu`, or a graphics device that this program was built for.
    pub device: String,
    /// Steps of the longest episode.
    pub episode_steps: u32,
    /// Constraints, each with its budget.
    pub constraints: Vec<Constraint>,
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
    /// What is written.
    pub reporting: ReportingConfig,
}

impl TrainConfig {
    /// The settings of a preset for an algorithm on an environment.
    pub fn new(algorithm: AlgorithmKind, preset: Preset, env: EnvConfig) -> Result<TrainConfig, LearnError> {
        let id: EnvId = env.id.parse().map_err(|error: hasard_envs::EnvError| LearnError::Config(error.to_string()))?;
        let budget = if env.hard { 0.0 } else { id.scenario.safety_budget(env.rule_set()?) };
        let mut config = TrainConfig::plain(algorithm, preset, env);
        config.constraints[0].budget = budget;
        config.check()?;
        Ok(config)
    }

    /// Refuses settings that no run can have, naming the setting and what it may be.
    pub fn check(&self) -> Result<(), LearnError> {
        let refuse = |name: &str, given: &dyn fmt::Display, allowed: &str| {
            Err(LearnError::Config(format!("{name} cannot be {given}; it must be {allowed}")))
        };
        let (sampling, learning) = (&self.sampling, &self.learning);
        for (name, given, most) in [
            ("the number of worlds", sampling.lanes, 65_536),
            ("the rollout length", sampling.rollout, 4096),
            ("the number of samplers", sampling.samplers, 256),
            ("the number of groups", sampling.groups, 256),
            ("the number of accumulated rollouts", sampling.accumulated, 64),
            ("the number of epochs", learning.epochs, 1000),
            ("the number of minibatches", learning.minibatches, sampling.lanes),
            ("the number of learner threads", learning.threads, 256),
            ("the number of kept checkpoints", self.reporting.keep, 1000),
            ("the window of episodes", self.reporting.window, 100_000),
            ("the steps of the longest episode", self.episode_steps as usize, 100_000),
            ("the delay of the PID controller", self.algorithm_settings.pid_delay, 100_000),
            ("the conjugate-gradient iterations", self.algorithm_settings.conjugate_iterations, 1000),
            ("the tries of the line search", self.algorithm_settings.line_search_steps, 1000),
        ] {
            if !(1..=most).contains(&given) {
                return refuse(name, &given, &format!("1 to {most}"));
            }
        }
        if sampling.world_threads > 256 {
            return refuse("the number of world threads", &sampling.world_threads, "0 to 256");
        }
        if !sampling.lanes.is_multiple_of(sampling.samplers * sampling.groups) {
            let parts = sampling.samplers * sampling.groups;
            return refuse("the number of worlds", &sampling.lanes, &format!("a multiple of samplers times groups ({parts})"));
        }
        for (name, given, low, high) in [
            ("gamma", f64::from(learning.gamma), 0.0, 1.0),
            ("lambda of the advantages", f64::from(learning.gae_lambda), 0.0, 1.0),
            ("the learning rate", learning.rate, 0.0, 10.0),
            ("the final learning rate", learning.final_rate, 0.0, 10.0),
            ("the largest gradient norm", learning.max_gradient_norm, 0.0, f64::MAX),
            ("the ratio clip", learning.clip_ratio, 0.0, 10.0),
            ("the value clip", learning.clip_value, 0.0, f64::MAX),
            ("the exploration coefficient", learning.exploration_coefficient, 0.0, 1e3),
            ("the seconds between reports", self.reporting.report_seconds, 0.0, f64::MAX),
            ("the seconds between checkpoints", self.reporting.checkpoint_seconds, 0.0, f64::MAX),
            ("the penalty scale", self.algorithm_settings.penalty_scale, 0.0, f64::MAX),
        ] {
            if !(low..=high).contains(&given) {
                return refuse(name, &given, &format!("a number from {low} to {high}"));
            }
        }
        if self.algorithm.separates_networks() && !self.network.separate {
            return refuse(
                "separate networks",
                &"off",
                &format!("on for {}, whose steps are the policy's alone", self.algorithm),
            );
        }
        if self.frames == 0 {
            return refuse("the number of frames", &self.frames, "at least 1");
        }
        if self.constraints.is_empty() || self.constraints.len() > 8 {
            return refuse("the number of constraints", &self.constraints.len(), "1 to 8");
        }
        for constraint in &self.constraints {
            if !constraint.budget.is_finite() || constraint.budget < 0.0 {
                return refuse("a budget", &constraint.budget, "a number of at least 0");
            }
        }
        // Ids that are not registered, such as those of tests, tell when their worlds are made.
        if let Some(scenario) = self.env.scenario() {
            find_terms(scenario.cost_terms(), &self.constraints)?;
        }
        if self.algorithm == AlgorithmKind::PpoSaute && self.constraints.iter().any(|c| c.budget == 0.0) {
            return refuse("the budget of PPOSaute", &0, "above 0, for what is left of it is measured in its units");
        }
        Ok(())
    }

    /// Replaces one setting, named as in `config.json`: `learning.rate=0.0003`.
    ///
    /// # Errors
    /// When the text is no `NAME=VALUE`, or there is no such setting, or it cannot have that value.
    pub fn with(&self, setting: &str) -> Result<TrainConfig, LearnError> {
        let wrong = |error: serde_json::Error| LearnError::Config(error.to_string());
        let (name, given) =
            setting.split_once('=').ok_or_else(|| LearnError::Config("write NAME=VALUE, such as learning.rate=0.0003".into()))?;
        let mut all = serde_json::to_value(self).map_err(wrong)?;
        let place = all.pointer_mut(&setting_pointer(name)).ok_or_else(|| {
            let known = "names are those of a run's config.json, such as learning.rate";
            LearnError::Config(format!("there is no setting '{name}'; {known}"))
        })?;
        *place = serde_json::from_str(given).unwrap_or_else(|_| given.into());
        serde_json::from_value(all).map_err(wrong)
    }

    /// Frames of one rollout of all worlds.
    #[must_use]
    pub fn frames_per_rollout(&self) -> u64 {
        (self.sampling.lanes * self.sampling.rollout) as u64 * u64::from(self.env.frame_skip)
    }
}

/// Where a setting such as `learning.rate` stands in `config.json`, as a JSON pointer.
#[must_use]
pub fn setting_pointer(name: &str) -> String {
    format!("/{}", name.replace('.', "/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_settings_are_refused_by_name() {
        let good = TrainConfig::new(AlgorithmKind::PpoLag, Preset::Paper, EnvConfig::new("RemedyRushLevel1-v0")).unwrap();
        let refuse = |change: fn(&mut TrainConfig), word: &str| {
            let mut config = good.clone();
            change(&mut config);
            let message = config.check().unwrap_err().to_string();
            assert!(message.contains(word), "{message}");
        };
        refuse(|c| c.sampling.lanes = 33, "number of worlds");
        refuse(|c| c.learning.gamma = 1.5, "gamma");
        refuse(|c| c.learning.rate = f64::NAN, "learning rate");
        refuse(|c| c.constraints[0].budget = -1.0, "budget");
        refuse(|c| c.frames = 0, "frames");
        refuse(|c| c.constraints[0].term = Some("rain".into()), "harmful_items");
        assert!("ppolag".parse::<AlgorithmKind>().is_ok());
        let message = "PPOLagg".parse::<AlgorithmKind>().unwrap_err().to_string();
        assert!(message.contains("PPOLagg") && message.contains("P3O"), "{message}");
        assert!(TrainConfig::new(AlgorithmKind::Ppo, Preset::Paper, EnvConfig::new("Nonsense-v0")).is_err());
    }
}
