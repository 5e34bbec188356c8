//! Flags of the commands that show: windows, pictures, films.

use crate::args::common::{EnvArgs, LooksArgs, Size, UnusedSeed};
use crate::number::env_id;
use clap::{Args, ValueEnum};
use hasard_media::Quality;
use std::ffi::OsString;
use std::path::PathBuf;

/// A view of a moment: what `hasard render` draws, and what stands beside the player's view in a
/// video.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// What the player sees
    #[value(alias = "colour")]
    Rgb,
    /// Distance, 0 near to 255 far, 7.3 map units a level
    Depth,
    /// One colour for each class of things, and for walls, floor, ceiling and sky
    Segmented,
    /// Raw labels: 0 for surfaces, n * 255 / (N + 1) for the n-th of N things drawn, 255 for the
    /// weapon
    Labels,
    /// Luminance
    #[value(alias = "gray")]
    Grey,
    /// One colour for each part of the renderer: walls, floors, ceilings, sky, things, weapon,
    /// status bar (docs/rendering.md has the key)
    Phase,
    /// The whole map with all things, from above, north up
    Automap,
}

/// What a video shows.
#[derive(Args, Debug, Clone)]
#[command(next_help_heading = "Picture")]
pub struct FilmArgs {
    /// Other views beside the player's, separated by commas; a film is up to 3072 wide, all together
    #[arg(long, value_enum, value_delimiter = ',', value_name = "VIEW,...")]
    pub beside: Vec<View>,
    /// Tics (1/35 s) from one frame to the next; 1 for .mp4 and 5 for .gif if absent
    #[arg(long, value_name = "TICS", value_parser = clap::value_parser!(u32).range(1..=350))]
    pub frame_every: Option<u32>,
    /// How exact an .mp4 is, 0 to 100: every frame alike, the size follows; a .gif takes no notice
    /// of it [default: 55]
    #[arg(long, value_name = "QUALITY")]
    pub quality: Option<Quality>,
    /// How depth and segmentation look
    #[command(flatten)]
    pub looks: LooksArgs,
}

/// `hasard play`.
#[derive(Args, Debug)]
#[command(
    after_help = "Keys: WASD move, arrows turn and look, the mouse turns (click to catch it, Esc frees it), Space jump, E use, C crouch,\n\
                        Shift run, Ctrl or left button attack, Q and wheel weapons, T turn round, P pause, R restart, N next episode, Esc quit.\n\
                        Only what the action space has does something; --full-actions gives everything."
)]
pub struct PlayArgs {
    /// Environment id (see `hasard envs`), or the file of a task of your own
    #[arg(value_parser = env_id)]
    pub env: String,
    /// Folder in which every finished episode is kept; `hasard report FOLDER` counts them as
    /// results
    #[arg(short, long, value_name = "DIR", default_value = "human")]
    pub out: PathBuf,
    /// Keep no episodes
    #[arg(long, conflicts_with = "out")]
    pub no_record: bool,
    /// Name of the player in the kept episodes
    #[arg(long, value_name = "NAME", default_value = "human")]
    pub player: String,
    /// Seed of the first episode, each further one is seeded one higher; one with a view if absent
    #[arg(long)]
    pub seed: Option<u64>,
    /// How to make the environment
    #[command(flatten)]
    pub env_args: EnvArgs,
}

/// `hasard render`.
#[derive(Args, Debug)]
pub struct RenderArgs {
    /// Environment id (see `hasard envs`), or the file of a task of your own
    #[arg(value_parser = env_id)]
    pub env: String,
    /// PNG file to write
    #[arg(short, long, value_name = "FILE", default_value = "frame.png")]
    pub out: PathBuf,
    /// What is drawn
    #[arg(long, value_enum, default_value_t = View::Rgb)]
    pub buffer: View,
    /// Other views beside it, separated by commas
    #[arg(long, value_enum, value_delimiter = ',', value_name = "VIEW,...")]
    pub beside: Vec<View>,
    /// Who acts before the picture: random, sticky:K, noop, hold:BUTTON+BUTTON,
    /// hold-after:K:BUTTON, shuttle, carrier, run:DIR, FILE.agent, zoo:NAME
    #[arg(long, default_value = "random")]
    pub policy: OsString,
    /// Policy steps before the picture
    #[arg(long, default_value_t = 0)]
    pub step: u32,
    /// Seed of the episode
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// One JSON object about the picture, with the things in view if labels were drawn
    #[arg(long)]
    pub json: bool,
    /// How to make the environment
    #[command(flatten)]
    pub env_args: EnvArgs,
    /// How depth and segmentation look
    #[command(flatten)]
    pub looks: LooksArgs,
}

/// `hasard record`.
#[derive(Args, Debug)]
pub struct RecordArgs {
    /// Environment id, the file of a task of your own, run directory, agent file or zoo:NAME (the
    /// agent acts), or .episode file
    #[arg(value_name = "ENV|RUN|zoo:NAME|FILE")]
    pub what: OsString,
    /// File to write: .mp4, .gif or .episode
    #[arg(short, long, value_name = "FILE", default_value = "episode.mp4")]
    pub out: PathBuf,
    /// Who acts in ENV: random, sticky:K, noop, hold:BUTTON+BUTTON, hold-after:K:BUTTON, shuttle,
    /// carrier, run:DIR, FILE.agent, zoo:NAME [default: random]
    #[arg(long)]
    pub policy: Option<OsString>,
    /// Most policy steps that are taken; to the episode's end if absent
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    pub steps: Option<u32>,
    /// Seed of the episode
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// One JSON object about what was written
    #[arg(long)]
    pub json: bool,
    /// What is shown
    #[command(flatten)]
    pub film: FilmArgs,
    /// How to make the environment
    #[command(flatten)]
    pub env_args: EnvArgs,
}

/// `hasard replay`.
#[derive(Args, Debug)]
pub struct ReplayArgs {
    /// Episode file, from `hasard record` or `hasard play`
    pub file: PathBuf,
    /// Video (.mp4), .gif or .png to write; without it the episode is played and its result checked
    #[arg(short, long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Policy step at which a .png is drawn; the episode's end if absent
    #[arg(long)]
    pub step: Option<u32>,
    /// Frame size; 640x480 if absent, 160x120 as .gif
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
    /// One JSON object about the episode
    #[arg(long)]
    pub json: bool,
    /// What is shown
    #[command(flatten)]
    pub film: FilmArgs,
    /// Takes a seed as every command does
    #[command(flatten)]
    pub seed: UnusedSeed,
}

/// `hasard highlights`.
#[derive(Args, Debug)]
pub struct HighlightsArgs {
    /// Agents: zoo:NAME, run directories, agent files [default: the six of the zoo for
    /// level 1]
    #[arg(value_name = "AGENT|RUN|zoo:NAME")]
    pub what: Vec<OsString>,
    /// Folder to write SCENARIO.gif to
    #[arg(short, long, value_name = "DIR", default_value = "highlights")]
    pub out: PathBuf,
    /// Seconds of each
    #[arg(long, default_value_t = 6.0)]
    pub seconds: f64,
    /// Size of the game's picture; a strip with return, cost and budget stands below it
    #[arg(long, value_name = "WxH", default_value = "320x240")]
    pub size: Size,
    /// Episodes to choose from: the one of most return within the budget
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub episodes: u32,
    /// Seed of the first episode
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// Most megabytes of a file; colours become coarser where it must be
    #[arg(long, value_name = "MB", default_value_t = 3.0)]
    pub most_mb: f64,
    /// Also levels.gif: every level of these agents' scenarios at once, a column a scenario
    #[arg(long)]
    pub levels: bool,
    /// One JSON object a file
    #[arg(long)]
    pub json: bool,
}

/// `hasard contact-sheet`.
#[derive(Args, Debug)]
pub struct ContactSheetArgs {
    /// Scenarios such as RemedyRush; all six if absent
    #[arg(value_name = "SCENARIO")]
    pub scenarios: Vec<String>,
    /// Folder to write: for each scenario its sheet, and one moment of it at 640x480
    #[arg(short, long, value_name = "DIR", default_value = "sheets")]
    pub out: PathBuf,
    /// Added to the seed of every moment; 0 draws the moments that were chosen for the
    /// documentation
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// Draw with the art of an IWAD such as Freedoom: a file, or `auto` for Debian's package or the
    /// one in Python's `vizdoom`
    #[arg(long, value_name = "FILE")]
    pub iwad: Option<PathBuf>,
    /// Play in the published maps, or your own: a folder laid out as the published package's, a
    /// WAD, or `auto` for the package `hasard` of the python3 on the path
    #[arg(long, value_name = "DIR")]
    pub maps: Option<PathBuf>,
    /// One JSON object a file
    #[arg(long)]
    pub json: bool,
}
