//! The raw flags: each declared once, feeding `--help`, parsing and the tests.

use crate::number::{env_id, positive, whole};
use crate::settings::Elsewhere;
use clap::{Args, Parser, Subcommand, ValueEnum};
use hasard_media::Quality;
use std::ffi::OsString;
use std::path::PathBuf;

/// HASARD: vision-based safe reinforcement learning in Doom-like 3D worlds.
#[derive(Parser, Debug)]
#[command(name = "hasard", version, about, propagate_version = true, arg_required_else_help = true)]
#[command(
    after_help = "Exit code: 0 fine, 1 a negative result, 2 bad input (one line names it and the remedy); 130 after Ctrl-C, 143 after SIGTERM."
)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Subcommand, Debug)]
pub enum Command {
    /// List the environments with their budgets and actions
    Envs(EnvsArgs),
    /// Write the file of a task of your own: it plays at once
    New(NewArgs),
    /// Check the file of a task of your own; draw its map
    Check(CheckArgs),
    /// Play in a window; episodes are kept as human baselines
    Play(PlayArgs),
    /// Run episodes of a policy and print return, cost and statistics
    Rollout(RolloutArgs),
    /// Run recorded inputs tic by tic; prints motion as CSV
    Trace(TraceArgs),
    /// Measure the speed of environments or of training
    Bench(BenchArgs),
    /// Draw a moment of an episode as PNG, in any view
    Render(RenderArgs),
    /// Train an agent
    Train(TrainArgs),
    /// Evaluate a trained agent
    Eval(EvalArgs),
    /// Film an episode (.mp4, .gif), or keep it as a file for replay
    Record(RecordArgs),
    /// Play a recorded episode again: check it, or film it at any size
    Replay(ReplayArgs),
    /// Make short GIFs of agents at their best, and of all levels
    Highlights(HighlightsArgs),
    /// Make one page of tables, curves and heatmaps from runs
    Report(ReportArgs),
    /// Serve a page for the browser: follow runs, watch agents, play
    Serve(ServeArgs),
    /// Run many trainings: an experiment of the paper, or your own file
    Sweep(SweepArgs),
    /// Write a run's selected agent as one small file
    ExportAgent(ExportAgentArgs),
    /// Write what an agent scores on a scoreboard's episodes, with its file
    Claim(ClaimArgs),
    /// Check claims by playing their episodes again, to the bit
    Verify(VerifyArgs),
    /// Make a page of a folder's claims that hold
    Scoreboard(ScoreboardArgs),
    /// Make a small static site from a clone: its README, the book, the scoreboard, films
    Site(SiteArgs),
    /// Write an environment's map as a WAD for editors and engines
    ExportWad(ExportWadArgs),
    /// Draw every level of a scenario in every view
    ContactSheet(ContactSheetArgs),
    /// List every setting of a run with its value and meaning
    Settings(SettingsArgs),
    /// List every key of metrics.jsonl with its unit and meaning
    Metrics(MetricsArgs),
    /// Print a shell's completion script
    Completions(CompletionsArgs),
}

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
    /// Hard constraint: the first violation ends the episode
    #[arg(long)]
    pub hard: bool,
    /// The full action space instead of the simplified one
    #[arg(long)]
    pub full_actions: bool,
    /// Tics (1/35 s) that each action is held
    #[arg(long, value_name = "TICS", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=35))]
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
            || self.frame_skip != 4
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

/// `hasard envs`.
#[derive(Args, Debug)]
pub struct EnvsArgs {
    /// Files of own tasks, in place of the benchmark's environments
    #[arg(value_name = "FILE", value_parser = env_id)]
    pub files: Vec<String>,
    /// One JSON object a line
    #[arg(long)]
    pub json: bool,
    /// Constants of the paper, or of the published package
    #[arg(long, value_enum, default_value_t = Rules::Paper)]
    pub rules: Rules,
    /// Takes a seed as every command does
    #[command(flatten)]
    pub seed: UnusedSeed,
}

/// `hasard new`.
#[derive(Args, Debug)]
pub struct NewArgs {
    /// Name of the task: my_task becomes the scenario MyTask in my_task.toml
    pub name: String,
    /// File to write
    #[arg(short, long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// One JSON object about the file
    #[arg(long)]
    pub json: bool,
    /// Takes a seed as every command does
    #[command(flatten)]
    pub seed: UnusedSeed,
}

/// `hasard check`.
#[derive(Args, Debug)]
pub struct CheckArgs {
    /// The task's file
    pub file: PathBuf,
    /// PNG to write: the map from above, with all things of an episode's start
    #[arg(short, long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// The level that is drawn
    #[arg(long, default_value_t = 1)]
    pub level: u8,
    /// Seed of the episode whose start is drawn
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// One JSON object a mistake, then one about the task
    #[arg(long)]
    pub json: bool,
}

/// `hasard rollout`.
#[derive(Args, Debug)]
pub struct RolloutArgs {
    /// Environment id, see `hasard envs`
    #[arg(value_parser = env_id)]
    pub env: String,
    /// random, sticky:K, noop, hold:BUTTON+BUTTON, hold-after:K:BUTTON, shuttle, carrier, run:DIR,
    /// zoo:NAME; `hasard envs --json` lists the buttons
    #[arg(long, default_value = "random")]
    pub policy: OsString,
    /// Number of episodes
    #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..))]
    pub episodes: u32,
    /// Levels that no training has seen, of a task with `train_seeds` in its [map.generate]
    #[arg(long)]
    pub test_seeds: bool,
    /// Episode i is seeded SEED + i
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// One JSON object an episode
    #[arg(long)]
    pub json: bool,
    /// How to make the environment
    #[command(flatten)]
    pub env_args: EnvArgs,
    /// What is seen
    #[command(flatten)]
    pub observation: ObservationArgs,
}

/// `hasard trace`.
#[derive(Args, Debug)]
pub struct TraceArgs {
    /// Environment id
    #[arg(value_parser = env_id)]
    pub env: String,
    /// Where the player is placed, at rest, in map units and degrees; the episode's own start if
    /// absent
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
    /// Environment id; several, with commas between, are measured in one mixed batch
    #[arg(value_parser = env_id)]
    pub env: String,
    /// Environments in the batch
    #[arg(long, default_value_t = 32, value_parser = clap::value_parser!(u32).range(1..=65536))]
    pub envs: u32,
    /// Worker threads
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=256))]
    pub threads: u32,
    /// Seconds to measure
    #[arg(long, default_value_t = 5.0)]
    pub seconds: f64,
    /// Measure the whole training loop (worlds, inference, learning; one epoch) and what the
    /// processor's matrix products would allow, in turns
    #[arg(long)]
    pub learn: bool,
    /// With --learn: the algorithm
    #[arg(long, default_value = "PPOLag", requires = "learn")]
    pub algo: String,
    /// With --learn: the preset, but for its epochs and minibatches
    #[arg(long, default_value = "paper", requires = "learn")]
    pub preset: String,
    /// With --learn: only with plain kernels; HASARD_SIMD=plain|avx2|avx512|avx512bf16 chooses
    /// others
    #[arg(long, requires = "learn")]
    pub portable: bool,
    /// With --learn: any setting of config.json but threads, such as learning.reuse_forward=true;
    /// may be given several times
    #[arg(long, value_name = "NAME=VALUE", requires = "learn")]
    pub set: Vec<String>,
    /// Seed
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// Print JSON objects, one a line
    #[arg(long)]
    pub json: bool,
    /// How to make the environment
    #[command(flatten)]
    pub env_args: EnvArgs,
    /// What is observed
    #[command(flatten)]
    pub observation: ObservationArgs,
}

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
    /// The whole map with all things, from above, north up
    Automap,
}

/// `hasard play`.
#[derive(Args, Debug)]
#[command(
    after_help = "Keys: WASD move, arrows turn and look, the mouse turns (click to catch it, Esc frees it), Space jump, E use, C crouch,\n\
                        Shift run, Ctrl or left button attack, Q and wheel weapons, T turn round, P pause, R restart, N next episode, Esc quit.\n\
                        Only what the action space has does something; --full-actions gives everything."
)]
pub struct PlayArgs {
    /// Environment id, see `hasard envs`
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
    /// Environment id, see `hasard envs`
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
    /// hold-after:K:BUTTON, run:DIR, zoo:NAME
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

/// `hasard train`.
#[derive(Args, Debug, Clone)]
pub struct TrainArgs {
    /// Environment id
    #[arg(value_parser = env_id)]
    pub env: String,
    /// PPO, PPOCost, PPOLag, PPOSaute, PPOPID, P3O, TRPO, TRPOLag, TRPOPID, CPO, FOCOPS, CUP, IPO
    #[arg(long, default_value = "PPOPID")]
    pub algo: String,
    /// quick: settings that learn within minutes on a CPU; paper, released, tables: 500 million
    /// frames with the settings of the paper's text, of the published code, or of the code that
    /// made the paper's tables (with its rules, unless --rules says others)
    #[arg(long, default_value = "quick")]
    pub preset: String,
    /// Length of the run in frames (game tics: policy steps times frame skip), such as 2M or 1e6
    /// [default: 10M with quick, 500M with the other presets]
    #[arg(long, value_parser = positive, allow_negative_numbers = true)]
    pub frames: Option<u64>,
    /// Run directory  [default: runs/ENV-ALGO-seedSEED]
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Go on from the last checkpoint in the run directory, if there is
    /// one; --frames, --seed, --threads and --set of the learning rate may differ from before
    #[arg(long)]
    pub resume: bool,
    /// Frames between evaluations on episodes of their own, by which the run selects a checkpoint;
    /// ten in its second half if absent, fewer where they would take more than a twentieth of its
    /// frames, none in a run of fewer than 400000; 0 for none
    #[arg(long, value_name = "FRAMES", value_parser = whole, allow_negative_numbers = true)]
    pub eval_every: Option<u64>,
    /// Levels in turn, weights and normalisers carried over: 1,2,3 shares the frames equally,
    /// 1:400000,2:600000 gives each its own; the run ends in the last level, whatever level ENV
    /// names
    #[arg(long, value_name = "LEVELS")]
    pub curriculum: Option<String>,
    /// Begin with the weights and normalisers of another run
    #[arg(long, value_name = "RUN", conflicts_with = "resume")]
    pub init_from: Option<PathBuf>,
    /// Cost that an episode may have; TERM=COST for one named cost term, several times for several
    /// constraints
    #[arg(long, value_name = "COST", aliases = ["budget", "cost-limit"])]
    pub safety_budget: Vec<String>,
    /// What budgets are held against: episode-mean, step-mean, or cvar:SHARE for the mean of the
    /// worst share of the latest episodes, such as cvar:0.1 for the worst tenth (algorithms with
    /// multipliers); the preset's if absent
    #[arg(long, value_name = "STATISTIC")]
    pub constraint_statistic: Option<String>,
    /// PPOCost: factor of the cost in the reward
    #[arg(long, value_name = "FACTOR")]
    pub cost_scale: Option<f64>,
    /// cpu; vulkan, cuda or wgpu where the program was built with that feature; vulkan:1 is the
    /// second card. Such builds also have flex, the graphics interface computed on the CPU, for
    /// comparisons
    #[arg(long, default_value = "cpu")]
    pub device: String,
    /// Sampling and learning take turns, bit-reproducibly; the default on the CPU, where both want
    /// the same cores
    #[arg(long)]
    pub sync: bool,
    /// Sampling and learning run side by side; the default on a graphics card
    #[arg(long = "async", conflicts_with = "sync")]
    pub asynchronous: bool,
    /// Threads; results do not depend on their number  [default: all cores]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=256))]
    pub threads: Option<u16>,
    /// Plain kernels: the same bits on every machine, some six times slower.
    /// HASARD_SIMD=plain|avx2|avx512 forces a family without leaving a trace in the settings;
    /// avx512bf16 begins a run with learning.products=bfloat16
    #[arg(long)]
    pub portable: bool,
    /// Environments side by side  [default: 32]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=65536))]
    pub envs: Option<u32>,
    /// Any setting of config.json, such as learning.rate=0.0003; may be given several times
    #[arg(long, value_name = "NAME=VALUE")]
    pub set: Vec<String>,
    /// Seed of everything random
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// One JSON object a report, as in metrics.jsonl, instead of the progress bar
    #[arg(long)]
    pub json: bool,
    /// No progress bar
    #[arg(short, long)]
    pub quiet: bool,
    /// How to make the environment
    #[command(flatten)]
    pub env_args: EnvArgs,
    /// What the agent sees
    #[command(flatten)]
    pub observation: ObservationArgs,
}

/// `hasard eval`.
#[derive(Args, Debug)]
#[command(after_help = "To have it in reports: hasard eval RUN --json > RUN/eval.jsonl")]
pub struct EvalArgs {
    /// Run directory, agent file, or zoo:NAME for an agent that comes with the program
    #[arg(value_name = "RUN|FILE|zoo:NAME")]
    pub run: OsString,
    /// Number of episodes
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..))]
    pub episodes: u32,
    /// Levels that no training has seen, of a task with `train_seeds` in its [map.generate]
    #[arg(long)]
    pub test_seeds: bool,
    /// Episode i is seeded SEED + i
    #[arg(long, default_value_t = 1_000_000)]
    pub seed: u64,
    /// Take each sub-action's likeliest choice instead of sampling
    #[arg(long)]
    pub greedy: bool,
    /// The latest checkpoint instead of the one that the run selected
    #[arg(long)]
    pub latest: bool,
    /// Play under this rule set instead of the run's; a budget that was the default of the run's
    /// rules becomes that of these
    #[arg(long, value_enum)]
    pub rules: Option<Rules>,
    /// Film so many of the worst episodes, those that cost most, one after the other
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub worst: Option<u16>,
    /// File of the film: .mp4 or .gif  [default: worst.mp4]
    #[arg(short, long, value_name = "FILE", requires = "worst")]
    pub out: Option<PathBuf>,
    /// Write what the critics of the costs expected at each step, and what came, as a table
    #[arg(long, value_name = "FILE.csv")]
    pub calibration: Option<PathBuf>,
    /// One JSON object an episode, then one with "summary"
    #[arg(long)]
    pub json: bool,
    /// Where its maps and pictures are
    #[command(flatten)]
    pub places: PlaceArgs,
}

/// What a video shows.
#[derive(Args, Debug, Clone)]
#[command(next_help_heading = "Picture")]
pub struct FilmArgs {
    /// Other views beside the player's, separated by commas
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

/// `hasard record`.
#[derive(Args, Debug)]
pub struct RecordArgs {
    /// Environment id, run directory, agent file or zoo:NAME (the agent acts), or .episode file
    #[arg(value_name = "ENV|RUN|zoo:NAME|FILE")]
    pub what: OsString,
    /// File to write: .mp4, .gif or .episode
    #[arg(short, long, value_name = "FILE", default_value = "episode.mp4")]
    pub out: PathBuf,
    /// Who acts in ENV: random, sticky:K, noop, hold:BUTTON+BUTTON, hold-after:K:BUTTON, run:DIR,
    /// zoo:NAME [default: random]
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

/// `hasard highlights`.
#[derive(Args, Debug)]
pub struct HighlightsArgs {
    /// Agents: zoo:NAME, run directories, agent files [default: the six of the zoo]
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

/// `hasard site`.
#[derive(Args, Debug)]
pub struct SiteArgs {
    /// Films to show beside those of the clone: .mp4 and .gif
    #[arg(value_name = "FILM")]
    pub films: Vec<PathBuf>,
    /// Folder to write to
    #[arg(short, long, value_name = "DIR", default_value = "site")]
    pub out: PathBuf,
    /// The clone of the repository
    #[arg(long, value_name = "DIR", default_value = ".")]
    pub root: PathBuf,
    /// One JSON object about what was written
    #[arg(long)]
    pub json: bool,
    /// Takes a seed as every command does
    #[command(flatten)]
    pub seed: UnusedSeed,
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

/// `hasard report`.
#[derive(Args, Debug)]
pub struct ReportArgs {
    /// Run directories or folders that hold them, .episode files, and .jsonl files of `hasard
    /// rollout --json`
    #[arg(required = true)]
    pub runs: Vec<PathBuf>,
    /// Folder to write
    #[arg(short, long, value_name = "DIR", default_value = "report")]
    pub out: PathBuf,
    /// Title of the page
    #[arg(long, default_value = "HASARD results")]
    pub title: String,
    /// For a paper too: tables.tex (booktabs), a document around it, and every figure as PDF
    #[arg(long)]
    pub latex: bool,
    /// One JSON object about what was written
    #[arg(long)]
    pub json: bool,
    /// Takes a seed as every command does
    #[command(flatten)]
    pub seed: UnusedSeed,
}

/// `hasard serve`.
#[derive(Args, Debug)]
pub struct ServeArgs {
    /// Folders below which runs are looked for, while they run too; `runs` if absent. Files of own
    /// tasks, which can be watched and played
    #[arg(value_name = "RUNS")]
    pub runs: Vec<PathBuf>,
    /// Address to listen at; beyond this machine only with the token that is printed
    #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:8350")]
    pub listen: std::net::SocketAddr,
    /// What visitors must know; drawn anew if absent and --listen goes beyond this machine
    #[arg(long, value_name = "TEXT")]
    pub token: Option<String>,
    /// Folder in which episodes that are played are kept
    #[arg(long, value_name = "DIR", default_value = "human")]
    pub out: PathBuf,
    /// Open the page in the browser
    #[arg(long)]
    pub open: bool,
    /// Let visitors write notes and tags of runs, archive them, and move them to the folder .trash
    #[arg(long)]
    pub edit: bool,
    /// Where maps are now that runs were trained in and that are no longer there
    #[arg(long, value_name = "DIR")]
    pub maps: Option<PathBuf>,
    /// Where the IWAD is now that runs were trained with and that is no longer there
    #[arg(long, value_name = "FILE")]
    pub iwad: Option<PathBuf>,
}

/// `hasard sweep`.
#[derive(Args, Debug)]
pub struct SweepArgs {
    /// TOML file, or an experiment: main, safety-bounds, curriculum, segmentation, depth, heatmaps,
    /// trpo, cost-scale, hard, full-actions, efficiency, human, behaviour, witness (tables and
    /// figures of the paper), all-algorithms, or quick, quick-all, quick-algorithms with the quick
    /// preset. docs/guide/reproduce.md says what each fills and how long it takes
    pub what: OsString,
    /// Folder of the runs
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Runs at a time; they share the cores out
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub parallel: Option<u16>,
    /// Preset of every run: quick, paper, released or tables
    #[arg(long)]
    pub preset: Option<String>,
    /// Seeds, the outermost loop: 1,2,3 or 11-15
    #[arg(long, value_delimiter = ',', value_name = "SEEDS")]
    pub seeds: Vec<String>,
    /// Algorithms: of an experiment those of its own that are named, or others in their place
    #[arg(long, value_delimiter = ',', value_name = "NAMES")]
    pub algos: Vec<String>,
    /// Levels, chosen in the same way: 1,2,3
    #[arg(long, value_delimiter = ',')]
    pub levels: Vec<u32>,
    /// Scenarios, chosen in the same way: RemedyRush,VolcanicVenture
    #[arg(long, value_delimiter = ',', value_name = "NAMES")]
    pub scenarios: Vec<String>,
    /// Frames of every run, such as 2M; changes nothing else
    #[arg(long, value_parser = positive, allow_negative_numbers = true)]
    pub frames: Option<u64>,
    /// Frames of every run times this, to try an experiment in small; the rates of multipliers grow
    /// as runs shrink
    #[arg(long, value_name = "FACTOR")]
    pub scale: Option<f64>,
    /// Episodes that the agent of each finished run is evaluated on, kept in its directory as
    /// eval.jsonl
    #[arg(long, value_name = "EPISODES")]
    pub evaluate: Option<u32>,
    /// Another option of hasard train for every run, such as rules=tables or hard; several times
    /// for several
    #[arg(long, value_name = "NAME[=VALUE]")]
    pub option: Vec<String>,
    /// Run whatever it takes; without it, --scale or --frames, a sweep of more than 48 hours is not
    /// begun
    #[arg(long)]
    pub yes: bool,
    /// Print the command lines and run nothing
    #[arg(long)]
    pub dry_run: bool,
    /// One JSON object a job
    #[arg(long)]
    pub json: bool,
    /// Takes a seed as every command does
    #[command(flatten)]
    pub seed: UnusedSeed,
}

/// `hasard export-agent`.
#[derive(Args, Debug)]
pub struct ExportAgentArgs {
    /// Run directory
    pub run: PathBuf,
    /// File to write, .agent; named after the environment if absent
    #[arg(short, long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// One JSON object about the file
    #[arg(long)]
    pub json: bool,
    /// Takes a seed as every command does
    #[command(flatten)]
    pub seed: UnusedSeed,
}

/// `hasard claim`.
#[derive(Args, Debug)]
pub struct ClaimArgs {
    /// Run directory, agent file, or zoo:NAME for an agent that comes with the program
    #[arg(value_name = "RUN|FILE|zoo:NAME")]
    pub agent: OsString,
    /// Name of the agent on a scoreboard
    #[arg(long, default_value = "hasard")]
    pub name: String,
    /// The rule set of the claim  [default: the run's]
    #[arg(long, value_enum)]
    pub rules: Option<Rules>,
    /// Number of episodes; scoreboards list claims of 200 and more
    #[arg(long, default_value_t = 200, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub episodes: u32,
    /// The command that trained the agent  [default: from the run's settings]
    #[arg(long, value_name = "COMMAND")]
    pub how: Option<String>,
    /// Folder that claim and agent are written to
    #[arg(short, long, value_name = "DIR", default_value = "scoreboard")]
    pub out: PathBuf,
    /// One JSON object about the claim
    #[arg(long)]
    pub json: bool,
    /// Takes a seed as every command does
    #[command(flatten)]
    pub seed: UnusedSeed,
}

/// `hasard verify`.
#[derive(Args, Debug)]
pub struct VerifyArgs {
    /// A claim (.claim.json), its agent beside it; or a folder of claims
    #[arg(value_name = "CLAIM")]
    pub claim: PathBuf,
    /// Number of threads; what is found does not depend on it  [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// One JSON object a claim
    #[arg(long)]
    pub json: bool,
    /// Takes a seed as every command does
    #[command(flatten)]
    pub seed: UnusedSeed,
}

/// `hasard scoreboard`.
#[derive(Args, Debug)]
pub struct ScoreboardArgs {
    /// Folder of claims and their agents; the page becomes its index.html
    pub folder: PathBuf,
    /// Title of the page
    #[arg(long, default_value = "HASARD scoreboard")]
    pub title: String,
    /// One JSON object about the page
    #[arg(long)]
    pub json: bool,
    /// Takes a seed as every command does
    #[command(flatten)]
    pub seed: UnusedSeed,
}

/// `hasard export-wad`.
#[derive(Args, Debug)]
pub struct ExportWadArgs {
    /// Environment id
    #[arg(value_parser = env_id)]
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
    /// Takes a seed as every command does
    #[command(flatten)]
    pub seed: UnusedSeed,
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

/// `hasard settings`.
#[derive(Args, Debug)]
pub struct SettingsArgs {
    /// Environment id
    #[arg(default_value = "VolcanicVentureLevel1-v0", value_parser = env_id)]
    pub env: String,
    /// The algorithm
    #[arg(long, default_value = "PPOPID")]
    pub algo: String,
    /// paper, released or quick
    #[arg(long, default_value = "quick")]
    pub preset: String,
    /// One JSON object a setting
    #[arg(long)]
    pub json: bool,
    /// Takes a seed as every command does
    #[command(flatten)]
    pub seed: UnusedSeed,
}

/// `hasard metrics`.
#[derive(Args, Debug)]
pub struct MetricsArgs {
    /// One JSON object a key
    #[arg(long)]
    pub json: bool,
    /// Takes a seed as every command does
    #[command(flatten)]
    pub seed: UnusedSeed,
}

/// `hasard completions`.
#[derive(Args, Debug)]
pub struct CompletionsArgs {
    /// The shell; for bash: hasard completions bash >
    /// ~/.local/share/bash-completion/completions/hasard
    #[arg(value_enum)]
    pub shell: clap_complete::Shell,
    /// Takes a seed as every command does
    #[command(flatten)]
    pub seed: UnusedSeed,
}
