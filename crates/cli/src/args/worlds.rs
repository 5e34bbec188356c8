//! Flags of the commands about environments: list, make, check, play through, measure.

use crate::args::common::{EnvArgs, ObservationArgs, Rules, UnusedSeed};
use crate::number::env_id;
use clap::Args;
use std::ffi::OsString;
use std::path::PathBuf;

/// `hasard envs`.
#[derive(Args, Debug)]
pub struct EnvsArgs {
    /// Files of own tasks, in place of the benchmark's environments
    #[arg(value_name = "FILE", value_parser = env_id)]
    pub files: Vec<String>,
    /// One JSON object a line
    #[arg(long)]
    pub json: bool,
    /// Constants of the paper, of the published package, or of the code behind the paper's tables
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
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..))]
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
    /// Environment id (see `hasard envs`), or the file of a task of your own
    #[arg(value_parser = env_id)]
    pub env: String,
    /// random, sticky:K, noop, hold:BUTTON+BUTTON, hold-after:K:BUTTON, shuttle, carrier, run:DIR,
    /// FILE.agent, zoo:NAME; `hasard envs --json` lists the buttons
    #[arg(long, default_value = "random")]
    pub policy: OsString,
    /// Number of episodes
    #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..))]
    pub episodes: u32,
    /// Maps that no training has seen, of a task with `train_seeds` in its [map.generate]
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

/// `hasard trace`, which plays tic by tic and draws nothing.
#[derive(Args, Debug)]
#[command(mut_arg("frame_skip", |arg| arg.hide(true)), mut_arg("size", |arg| arg.hide(true)))]
pub struct TraceArgs {
    /// Environment id, or the file of a task of your own
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
    /// Environment id, or the file of a task of your own; several, with commas between, are measured
    /// in one mixed batch
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
    /// With --learn: only with plain kernels; HASARD_SIMD=plain|avx2|avx512|avx512bf16|amxbf16
    /// chooses others
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

/// `hasard export-wad`.
#[derive(Args, Debug)]
pub struct ExportWadArgs {
    /// Environment id, or the file of a task of your own
    #[arg(value_parser = env_id)]
    pub env: String,
    /// WAD file to write
    #[arg(short, long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Constants of the paper, of the published package, or of the code behind the paper's tables
    #[arg(long, value_enum, default_value_t = Rules::Paper)]
    pub rules: Rules,
    /// The hard constraint's map
    #[arg(long)]
    pub hard: bool,
    /// One JSON object about the file
    #[arg(long)]
    pub json: bool,
    /// Takes a seed as every command does
    #[command(flatten)]
    pub seed: UnusedSeed,
}
