//! The raw flags: each declared once, feeding `--help`, parsing and the tests.

use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// HASARD: vision-based safe reinforcement learning in Doom-like 3D worlds.
#[derive(Parser, Debug)]
#[command(name = "hasard", version, about, propagate_version = true, arg_required_else_help = true)]
#[command(after_help = "Exit code: 0 fine, 1 a negative result, 2 bad input (one line names it and the remedy).")]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Subcommand, Debug)]
pub enum Command {
    /// List the environments with their budgets and action spaces
    Envs(EnvsArgs),
    /// Play episodes with a fixed policy or a trained agent and print return, cost and statistics
    Rollout(RolloutArgs),
    /// Run recorded inputs tic by tic and print position, velocity and view as CSV
    Trace(TraceArgs),
    /// Measure environment speed: random actions, resets included, observations written
    Bench(BenchArgs),
    /// Draw a moment of an episode as PNG: colour, depth, segmentation or map
    Render(RenderArgs),
    /// Write an environment's map as a WAD that other engines load
    ExportWad(ExportWadArgs),
}

/// Options of every command that makes an environment.
#[derive(Args, Debug, Clone)]
#[command(next_help_heading = "Environment")]
pub struct EnvArgs {
    /// Constants of the paper, or of the published package
    #[arg(long, value_enum, default_value_t = Rules::Paper)]
    pub rules: Rules,
    /// Hard constraint: harm ends the episode
    #[arg(long)]
    pub hard: bool,
    /// The full action space instead of the simplified one
    #[arg(long)]
    pub full_actions: bool,
    /// Tics (1/35 s) that each action is held
    #[arg(long, value_name = "TICS", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=35))]
    pub frame_skip: u32,
    /// Frame size; 128x72 is the learner's nearest-neighbour reduction of 160x120
    #[arg(long, value_name = "WxH")]
    pub size: Option<Size>,
    /// What is observed
    #[arg(long, value_enum, default_value_t = Observation::Rgb)]
    pub observation: Observation,
    /// Number of last frames stacked along the channels
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=16))]
    pub frame_stack: u8,
    /// Limit the depth of walls as the published engine does
    #[arg(long)]
    pub published_depth: bool,
    /// Segment in the published colours, some of which several classes share
    #[arg(long)]
    pub published_colours: bool,
    /// Draw with the art of an IWAD such as Freedoom: a file, or `auto` for Debian's package
    #[arg(long, value_name = "FILE")]
    pub iwad: Option<PathBuf>,
}

/// `--rules`.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rules {
    /// The paper's text made self-consistent
    Paper,
    /// What the published package does
    Released,
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
        let size = Size { width: width.parse().map_err(|_| remedy)?, height: height.parse().map_err(|_| remedy)? };
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

/// `hasard envs`.
#[derive(Args, Debug)]
pub struct EnvsArgs {
    /// One JSON object a line
    #[arg(long)]
    pub json: bool,
    /// Constants of the paper, or of the published package
    #[arg(long, value_enum, default_value_t = Rules::Paper)]
    pub rules: Rules,
    /// Accepted for uniformity; the list does not depend on it
    #[arg(long, hide = true, default_value_t = 0)]
    pub seed: u64,
}

/// `hasard rollout`.
#[derive(Args, Debug)]
pub struct RolloutArgs {
    /// Environment id, see `hasard envs`
    pub env: String,
    /// random, sticky:K, noop, hold:BUTTON+BUTTON, hold-after:K:BUTTON, run:DIR
    #[arg(long, default_value = "random")]
    pub policy: String,
    /// Number of episodes
    #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..))]
    pub episodes: u32,
    /// Episode i is seeded SEED + i
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// One JSON object an episode
    #[arg(long)]
    pub json: bool,
    /// How to make the environment
    #[command(flatten)]
    pub env_args: EnvArgs,
}

/// `hasard trace`.
#[derive(Args, Debug)]
pub struct TraceArgs {
    /// Environment id
    pub env: String,
    /// Where the player is placed, at rest: X,Y,Z,ANGLE[,PITCH] in map units and degrees; the episode's own start if absent
    #[arg(long, value_name = "X,Y,Z,ANGLE[,PITCH]", allow_hyphen_values = true)]
    pub start: Option<String>,
    /// No-op tics before the player is placed
    #[arg(long, default_value_t = 13, value_name = "N")]
    pub after: u32,
    /// CSV file with an `action` column
    #[arg(long, value_name = "FILE")]
    pub actions: PathBuf,
    /// Print CSV (the default)
    #[arg(long)]
    pub csv: bool,
    /// One JSON object a tic instead of CSV
    #[arg(long, conflicts_with = "csv")]
    pub json: bool,
    /// Seed of the episode
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// How to make the environment
    #[command(flatten)]
    pub env_args: EnvArgs,
}

/// `hasard bench`.
#[derive(Args, Debug)]
pub struct BenchArgs {
    /// Environment id
    pub env: String,
    /// Worlds in the batch
    #[arg(long, default_value_t = 32, value_parser = clap::value_parser!(u32).range(1..=65536))]
    pub envs: u32,
    /// Worker threads
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub threads: u32,
    /// Seconds to measure
    #[arg(long, default_value_t = 5.0)]
    pub seconds: f64,
    /// Seed
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
    /// How to make the environment
    #[command(flatten)]
    pub env_args: EnvArgs,
}

/// What `hasard render` draws.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Buffer {
    /// What the player sees
    Rgb,
    /// Distance, near black to far white
    Depth,
    /// One colour per class
    Segmented,
}

/// `hasard render`.
#[derive(Args, Debug)]
pub struct RenderArgs {
    /// Environment id
    pub env: String,
    /// PNG file to write
    #[arg(short, long, value_name = "FILE", default_value = "frame.png")]
    pub out: PathBuf,
    /// Which buffer
    #[arg(long, value_enum, default_value_t = Buffer::Rgb)]
    pub buffer: Buffer,
    /// Policy that acts before the picture
    #[arg(long, default_value = "random")]
    pub policy: String,
    /// Policy steps before the picture
    #[arg(long, default_value_t = 0)]
    pub step: u32,
    /// Seed of the episode
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// How to make the environment
    #[command(flatten)]
    pub env_args: EnvArgs,
}

/// `hasard export-wad`.
#[derive(Args, Debug)]
pub struct ExportWadArgs {
    /// Environment id
    pub env: String,
    /// WAD file to write
    #[arg(short, long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Constants of the paper, or of the published package
    #[arg(long, value_enum, default_value_t = Rules::Paper)]
    pub rules: Rules,
    /// The hard constraint's map
    #[arg(long)]
    pub hard: bool,
    /// Accepted for uniformity; maps do not depend on it
    #[arg(long, hide = true, default_value_t = 0)]
    pub seed: u64,
}
