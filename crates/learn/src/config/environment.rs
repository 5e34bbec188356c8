//! The environment of a run, in words that a file can hold.

use std::path::PathBuf;

use hasard_envs::{
    ActionSpace, CostTerm, Env, EnvError, EnvId, EnvOptions, FRAME_SKIP, FrameSize, Layout,
    Mixture, ObservationKind, RuleSet, Scenario, VecEnv, VecOptions, scenarios::episode_steps,
};
use serde::{Deserialize, Serialize};

use super::own_scenario::OwnScenario;
use crate::error::LearnError;

/// The environment and its options, in words that a file can hold.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct EnvConfig {
    /// Its id, such as `RemedyRushLevel1-v0`; several, joined by commas, are tasks that the
    /// worlds take in turn.
    pub id: String,
    /// The file of an own scenario, with all of its text; `null` for the benchmark's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scenario_file: Option<OwnScenario>,
    /// The files of the own scenarios among several tasks.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub scenario_files: Vec<OwnScenario>,
    /// `paper`, `released` or `tables`.
    pub rules: String,
    /// Detonator's Dilemma 1 under `tables` with the creatures of the first runs.
    #[serde(default, skip_serializing_if = "is_off")]
    pub early_creatures: bool,
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
    /// Depth of walls, things and sky ends where ViZDoom's does, at 255 * rows / 480, not at 255.
    #[serde(default, skip_serializing_if = "is_off")]
    pub published_depth: bool,
    /// Segmented in the published colours.
    #[serde(default, skip_serializing_if = "is_off")]
    pub published_colours: bool,
    /// The file of the pictures that worlds are drawn with; `null` for the embedded set.
    #[serde(default, skip_serializing_if = "Option::is_none", with = "super::place")]
    pub iwad: Option<PathBuf>,
    /// Where the maps come from; `null` for the built-in ones. What makes the worlds reads them.
    #[serde(default, skip_serializing_if = "Option::is_none", with = "super::place")]
    pub maps: Option<PathBuf>,
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
        let own = |id: &str| id.parse::<EnvId>().ok().and_then(|id| OwnScenario::of(id.scenario));
        let mut scenario_files: Vec<OwnScenario> = Vec::new();
        if id.contains(',') {
            for file in id.split(',').filter_map(own) {
                if !scenario_files.contains(&file) {
                    scenario_files.push(file);
                }
            }
        }
        EnvConfig {
            id: id.to_string(),
            scenario_file: own(id),
            scenario_files,
            rules: "paper".into(),
            early_creatures: false,
            hard: false,
            full_actions: false,
            frame_skip: FRAME_SKIP,
            size: (128, 72),
            observation: "rgb".into(),
            frame_stack: 1,
            published_depth: false,
            published_colours: false,
            iwad: None,
            maps: None,
        }
    }

    /// The same in the environments' own types, without maps and pictures; observations are laid
    /// out as the networks read them.
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
            scenario: self.scenario_file.map(OwnScenario::scenario),
            rules: self.rule_set()?,
            early_creatures: self.early_creatures,
            hard: self.hard,
            full_actions: self.full_actions,
            frame_skip: self.frame_skip,
            size: FrameSize { width: self.size.0, height: self.size.1 },
            observation,
            layout: Layout::Hwc,
            frame_stack: self.frame_stack,
            published_depth: self.published_depth,
            published_colours: self.published_colours,
            together: self.joint_actions()?,
            ..EnvOptions::default()
        })
    }

    pub(crate) fn rule_set(&self) -> Result<RuleSet, LearnError> {
        let unknown = |_| {
            LearnError::Config(format!(
                "rules '{}' are unknown; use one of {}",
                self.rules,
                RuleSet::names()
            ))
        };
        self.rules.parse().map_err(unknown)
    }

    pub(crate) fn scenario(&self) -> Option<Scenario> {
        self.env_id().ok().map(|id| id.scenario)
    }

    /// The environment that the id names, in the own scenario if there is one.
    ///
    /// # Errors
    /// Names the nearest id, or says that there are several.
    pub fn env_id(&self) -> Result<EnvId, LearnError> {
        EnvId::within(self.scenario_file.map(OwnScenario::scenario), &self.id)
            .map_err(|error| LearnError::Config(error.to_string()))
    }

    /// Policy steps of its longest episode, if it has tasks of files; those of the benchmark all have
    /// the same, which presets know.
    pub(crate) fn own_episode_steps(&self) -> Option<u32> {
        let own = self.env_ids().ok()?.iter().any(|id| id.scenario.file.is_some());
        own.then(|| self.lengths().into_iter().max())?
    }

    /// Policy steps of the longest episode of each of its tasks; nothing for ids that are not
    /// registered.
    pub(crate) fn lengths(&self) -> Vec<u32> {
        let (Ok(ids), Ok(rules)) = (self.env_ids(), self.rule_set()) else { return Vec::new() };
        let steps = |id: &EnvId| episode_steps(*id, rules, self.hard, self.frame_skip);
        ids.iter().map(steps).collect()
    }

    /// The cost terms of its episodes; nothing for ids that are not registered, such as those of
    /// tests.
    pub(crate) fn cost_terms(&self) -> Result<Option<&'static [CostTerm]>, LearnError> {
        if !self.is_mixed() {
            return Ok(self.scenario().map(Scenario::cost_terms));
        }
        Mixture::cost_terms(&self.env_ids()?)
            .map(Some)
            .map_err(|error| LearnError::Config(error.to_string()))
    }

    /// Whether the worlds have several tasks.
    #[must_use]
    pub fn is_mixed(&self) -> bool {
        self.id.contains(',')
    }

    /// The action space of several tasks together.
    fn joint_actions(&self) -> Result<Option<ActionSpace>, LearnError> {
        if !self.is_mixed() {
            return Ok(None);
        }
        let (ids, rules) = (self.env_ids()?, self.rule_set()?);
        Ok(Some(ActionSpace::together(&ids, rules, self.hard, self.full_actions)))
    }

    /// The buttons of its actions; nothing for ids that are not registered, such as those of tests.
    pub(crate) fn action_space(&self) -> Result<Option<ActionSpace>, LearnError> {
        let (rules, joint) = (self.rule_set()?, self.joint_actions()?);
        let alone = |id| ActionSpace::of(id, rules, self.hard, self.full_actions);
        Ok(joint.or_else(|| self.env_id().ok().map(alone)))
    }

    /// The environment of each task.
    pub(super) fn env_ids(&self) -> Result<Vec<EnvId>, LearnError> {
        self.tasks().iter().map(EnvConfig::env_id).collect()
    }

    /// Each task by itself, in the order of the ids; one that stands there twice comes twice.
    #[must_use]
    pub fn tasks(&self) -> Vec<EnvConfig> {
        if !self.is_mixed() {
            return vec![self.clone()];
        }
        let task = |id: &str| {
            let has = |file: &&OwnScenario| {
                file.scenario().environments().any(|own| own.to_string() == id)
            };
            EnvConfig {
                id: id.to_string(),
                scenario_file: self.scenario_files.iter().find(has).copied(),
                scenario_files: Vec::new(),
                ..self.clone()
            }
        };
        self.id.split(',').map(task).collect()
    }

    /// An environment of each task, whose options are otherwise `options`.
    ///
    /// # Errors
    /// Names the nearest id, or says what is wrong with an option.
    pub fn envs(&self, options: &EnvOptions) -> Result<Vec<Env>, EnvError> {
        let own = |task: EnvConfig| {
            let scenario = task.scenario_file.map(OwnScenario::scenario).or(options.scenario);
            // A batch lays the tasks' own spaces out together.
            let together = None;
            Env::new(&task.id, &EnvOptions { scenario, together, ..options.clone() })
        };
        self.tasks().into_iter().map(own).collect()
    }

    /// Worlds of the task, or of all tasks in turn, whose options are otherwise `options`.
    ///
    /// # Errors
    /// As [`EnvConfig::envs`]; or what does not go together in a batch.
    pub fn worlds(&self, options: &EnvOptions, worlds: VecOptions) -> Result<VecEnv, EnvError> {
        VecEnv::of_envs(&self.envs(options)?, worlds)
    }
}
