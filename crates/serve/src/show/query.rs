//! What an address asks for. It holds the whole state of a show, so that a copied link shows the
//! same moment.

use crate::asked::seed;
use hasard_engine::render::FrameSize;
use hasard_envs::{EnvError, EnvId, EnvOptions, RuleSet};
use hasard_play::ViewKind;
use serde::Deserialize;

/// Largest picture of a view.
const LARGEST: (u16, u16) = (1280, 960);

fn default_size() -> String {
    "320x240".into()
}

fn default_agent() -> String {
    "random".into()
}

/// `/api/watch`.
#[derive(Deserialize, Clone, Debug)]
pub(crate) struct WatchQuery {
    /// Id of the environment; an agent's own if empty.
    #[serde(default)]
    pub env: String,
    /// `random`, `sticky:K`, ..., `run:ID`, `zoo:NAME` or `episode:NAME`.
    #[serde(default = "default_agent")]
    pub agent: String,
    #[serde(default, deserialize_with = "seed")]
    pub seed: u64,
    /// Step to begin at.
    #[serde(default)]
    pub step: u32,
    /// Size of the view.
    #[serde(default = "default_size")]
    pub size: String,
    /// Other views beside it.
    #[serde(default)]
    pub beside: String,
    /// The best checkpoint instead of the newest, the likeliest actions instead of drawn ones.
    #[serde(default)]
    pub best: bool,
    #[serde(default)]
    pub greedy: bool,
    /// Begin paused.
    #[serde(default)]
    pub paused: bool,
    #[serde(default)]
    pub hard: bool,
    #[serde(default)]
    pub full: bool,
    /// `paper` if empty.
    #[serde(default)]
    pub rules: String,
}

/// `/api/play`.
#[derive(Deserialize, Clone, Debug)]
pub(crate) struct PlayQuery {
    pub env: String,
    #[serde(default, deserialize_with = "seed")]
    pub seed: u64,
    #[serde(default = "default_size")]
    pub size: String,
    #[serde(default)]
    pub hard: bool,
    #[serde(default)]
    pub full: bool,
}

impl WatchQuery {
    /// Checks everything that can be checked before a world is made.
    pub fn check(&self) -> Result<(), String> {
        if !self.env.is_empty() {
            self.env.parse::<EnvId>().map_err(|error| error.to_string())?;
        }
        self.rules()?;
        self.views()?;
        size(&self.size).map(drop)
    }

    pub fn size(&self) -> FrameSize {
        size(&self.size).unwrap_or(FrameSize::CLASSIC)
    }

    fn rules(&self) -> Result<RuleSet, String> {
        if self.rules.is_empty() {
            Ok(RuleSet::Paper)
        } else {
            self.rules.parse().map_err(|error: EnvError| error.to_string())
        }
    }

    pub fn options(&self) -> EnvOptions {
        EnvOptions {
            rules: self.rules().unwrap_or_default(),
            hard: self.hard,
            full_actions: self.full,
            ..EnvOptions::default()
        }
    }

    /// The player's view, then those beside it.
    pub fn views(&self) -> Result<Vec<ViewKind>, String> {
        let mut views = vec![ViewKind::Colour];
        for name in self.beside.split(',').filter(|name| !name.is_empty()) {
            let view = match name {
                "depth" => ViewKind::Depth,
                "segmented" => ViewKind::Segmented,
                "automap" => ViewKind::Automap,
                _ => return Err("beside takes depth, segmented and automap".into()),
            };
            if !views.contains(&view) {
                views.push(view);
            }
        }
        Ok(views)
    }
}

impl PlayQuery {
    /// As [`WatchQuery::check`].
    pub fn check(&self) -> Result<(), String> {
        self.env.parse::<EnvId>().map_err(|error| error.to_string())?;
        size(&self.size).map(drop)
    }

    pub fn size(&self) -> FrameSize {
        size(&self.size).unwrap_or(FrameSize::CLASSIC)
    }

    pub fn options(&self) -> EnvOptions {
        EnvOptions { hard: self.hard, full_actions: self.full, ..EnvOptions::default() }
    }
}

fn size(text: &str) -> Result<FrameSize, String> {
    let sides = text
        .split_once('x')
        .and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)));
    match sides {
        Some((width, height))
            if (64..=LARGEST.0).contains(&width) && (48..=LARGEST.1).contains(&height) =>
        {
            Ok(FrameSize { width, height })
        }
        _ => Err(format!("size is WIDTHxHEIGHT from 64x48 to {}x{}", LARGEST.0, LARGEST.1)),
    }
}
