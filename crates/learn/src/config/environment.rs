//! The environment of a run, in words that a file can hold.

use std::path::PathBuf;

use hasard_envs::{EnvId, EnvOptions, FrameSize, Layout, ObservationKind, RuleSet, Scenario};
use serde::{Deserialize, Serialize};

use super::own_scenario::OwnScenario;
use crate::error::LearnError;

/// The environment and its options, in words that a file can hold.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct EnvConfig {
    /// Its id, such as `VolcanicVentureLevel1-v0`.
    pub id: String,
    /// The file of an own scenario, with all of its text; `null` for the benchmark's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scenario_file: Option<OwnScenario>,
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
    /// The file of the pictures that worlds are drawn with; `null` for the embedded set. Whoever
    /// makes the worlds reads it.
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
        EnvConfig {
            id: id.to_string(),
            scenario_file: id.parse::<EnvId>().ok().and_then(|id| OwnScenario::of(id.scenario)),
            rules: "paper".into(),
            early_creatures: false,
            hard: false,
            full_actions: false,
            frame_skip: 4,
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
    pub fn env_id(&self) -> Result<EnvId, LearnError> {
        EnvId::within(self.scenario_file.map(OwnScenario::scenario), &self.id)
            .map_err(|error| LearnError::Config(error.to_string()))
    }
}
