//! Flags that several commands have.

use crate::settings::Elsewhere;
use clap::{Args, ValueEnum};
use hasard_envs::FRAME_SKIP;
use std::path::PathBuf;

/// `--seed` of a command that draws nothing by chance: scripts give it to all alike.
#[derive(Args, Debug, Clone, Default)]
pub struct UnusedSeed {
    /// Accepted for uniformity; nothing depends on it
    #[arg(long = "seed", value_name = "SEED", hide = true, default_value_t = 0)]
    _seed: u64,
}

/// Options of every command that makes an environment.
#[derive(Args, Debug, Clone)]
#[command(next_help_heading = "Environment")]
pub struct EnvArgs {
    /// Constants of the paper, of the published package, or of the code behind the paper's tables
    #[arg(long, value_enum, default_value_t = Rules::Paper)]
    pub rules: Rules,
    /// Detonator's Dilemma 1 under `--rules tables`: the creatures of the first runs (PPO, PPOCost,
    /// PPOLag), not of the later
    #[arg(long)]
    pub early_creatures: bool,
    /// Hard constraint: a violation ends the episode; in Armament Burden it takes the burden and
    /// slows the agent
    #[arg(long)]
    pub hard: bool,
    /// The full action space instead of the simplified one
    #[arg(long)]
    pub full_actions: bool,
    /// Tics (1/35 s) that each action is held
    #[arg(long, value_name = "TICS", default_value_t = FRAME_SKIP, value_parser = clap::value_parser!(u32).range(1..=35))]
    pub frame_skip: u32,
    /// Frame size, 64x48 to 1920x1080; if absent 128x72 for learners (the nearest-neighbour
    /// reduction of 160x120), 640x480 to play and render, 320x240 to record, 160x120 as .gif
    #[arg(long, value_name = "WxH")]
    pub size: Option<Size>,
    /// Draw with the art of an IWAD such as Freedoom: a file, or `auto` for Debian's package or the
    /// one in Python's `vizdoom`
    #[arg(long, value_name = "FILE")]
    pub iwad: Option<PathBuf>,
    /// Play in the published maps, or your own: a folder laid out as the published package's, a
    /// WAD, or `auto` for the package `hasard` of the python3 on the path
    #[arg(long, value_name = "DIR")]
    pub maps: Option<PathBuf>,
}

impl EnvArgs {
    /// Whether rules or actions differ from the usual ones; size, pictures and maps are another
    /// matter.
    pub fn changes_rules(&self) -> bool {
        self.rules != Rules::Paper
            || self.early_creatures
            || self.hard
            || self.full_actions
            || self.frame_skip != FRAME_SKIP
    }

    /// Where the maps and pictures of an agent's run are.
    pub fn elsewhere(&self) -> Elsewhere<'_> {
        Elsewhere { maps: self.maps.as_deref(), iwad: self.iwad.as_deref() }
    }
}

/// Where a run's files are now.
#[derive(Args, Debug, Clone, Default)]
pub struct PlaceArgs {
    /// Where the run's maps are now, if elsewhere than when it was trained; or other maps to play
    /// in
    #[arg(long, value_name = "DIR")]
    pub maps: Option<PathBuf>,
    /// Where the IWAD of the run's pictures is now
    #[arg(long, value_name = "FILE")]
    pub iwad: Option<PathBuf>,
}

impl PlaceArgs {
    /// The same for those who make worlds.
    pub fn elsewhere(&self) -> Elsewhere<'_> {
        Elsewhere { maps: self.maps.as_deref(), iwad: self.iwad.as_deref() }
    }
}

/// Options of what a learner sees.
#[derive(Args, Debug, Clone)]
#[command(next_help_heading = "Observation")]
pub struct ObservationArgs {
    /// What is observed
    #[arg(long, value_enum, default_value_t = Observation::Rgb)]
    pub observation: Observation,
    /// Number of last frames stacked along the channels
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=16))]
    pub frame_stack: u8,
    /// How depth and segmentation look
    #[command(flatten)]
    pub looks: LooksArgs,
}

/// Options of how depth and segmentation look.
#[derive(Args, Debug, Clone, Default)]
pub struct LooksArgs {
    /// Depth of walls, things and sky ends at 255 * rows / 480, as in ViZDoom, not at 255
    #[arg(long)]
    pub published_depth: bool,
    /// Segment in the published colours, some of which several classes share
    #[arg(long)]
    pub published_colours: bool,
}

/// `--rules`.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rules {
    /// The paper's text made self-consistent
    Paper,
    /// What the published package does
    Released,
    /// What the code did when the paper's tables were made
    Tables,
}

/// `--observation`.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Observation {
    /// Red, green, blue
    Rgb,
    /// Red, green, blue and depth
    #[value(name = "rgb+depth")]
    RgbDepth,
    /// One fixed colour per class
    Segmented,
    /// Luminance
    Grey,
}

/// A frame size such as `160x120`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Columns.
    pub width: u16,
    /// Rows.
    pub height: u16,
}

impl Size {
    /// The learner's frame.
    pub const LEARNER: Size = Size { width: 128, height: 72 };
}

impl std::str::FromStr for Size {
    type Err = String;
    fn from_str(text: &str) -> Result<Size, String> {
        let remedy = "write WIDTHxHEIGHT such as 160x120, from 64x48 to 1920x1080";
        let (width, height) = text.split_once(['x', 'X']).ok_or(remedy)?;
        let size = Size {
            width: width.parse().map_err(|_| remedy)?,
            height: height.parse().map_err(|_| remedy)?,
        };
        if !(64..=1920).contains(&size.width) || !(48..=1080).contains(&size.height) {
            return Err(remedy.into());
        }
        Ok(size)
    }
}

impl std::fmt::Display for Size {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}x{}", self.width, self.height)
    }
}
