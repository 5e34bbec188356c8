//! Flags of the commands that train and judge agents.

use crate::args::common::{EnvArgs, ObservationArgs, PlaceArgs, Rules, UnusedSeed};
use crate::number::{env_id, env_id_of_run, positive, whole};
use clap::Args;
use hasard_envs::Scenario;
use hasard_learn::runs::temperature::Temperature;
use std::ffi::OsString;
use std::path::PathBuf;

/// `hasard train`.
#[derive(Args, Debug, Clone)]
pub struct TrainArgs {
    /// Environment id, or the file of a task of your own; several, with commas between, for one
    /// agent of several tasks
    #[arg(value_parser = env_id_of_run)]
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
    /// one; --frames, --seed, --threads and what docs/guide/runs.md lists may differ from before
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
    /// Begin with the newest weights and normalisers of another run, or with those of an agent: a
    /// file that export-agent wrote, or zoo:NAME
    #[arg(long, value_name = "RUN")]
    pub init_from: Option<PathBuf>,
    /// Cost that an episode may have; TERM=COST for one named cost term alone, several times for
    /// several constraints. What is given replaces the scenario's budget
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
    /// Threads; results do not depend on their number  [default: all cores, at most 16]
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=256))]
    pub threads: Option<u16>,
    /// Plain kernels: the same bits on every machine, some six times slower.
    /// HASARD_SIMD=plain|avx2|avx512 forces a family without leaving a trace in the settings;
    /// avx512bf16 and amxbf16 begin a run with learning.products=bfloat16
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
    /// Print neither progress nor what the run came to: errors alone
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
#[command(
    after_help = "To have it in reports: hasard eval RUN --json > RUN/eval.jsonl (of a run with closing episodes reports take those)"
)]
pub struct EvalArgs {
    /// Run directory, agent file, or zoo:NAME for an agent that comes with the program
    #[arg(value_name = "RUN|FILE|zoo:NAME")]
    pub run: OsString,
    /// Number of episodes
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..))]
    pub episodes: u32,
    /// Maps that no training has seen, of a task with `train_seeds` in its [map.generate]
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
    /// Runs at a time; they share the cores
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
    #[arg(long, help = scenarios_help(), value_delimiter = ',', value_name = "NAMES")]
    pub scenarios: Vec<String>,
    /// Frames of every run, such as 2M
    #[arg(long, value_parser = positive, allow_negative_numbers = true)]
    pub frames: Option<u64>,
    /// Frames of every run times this, to try an experiment in small; the rates of multipliers grow
    /// as runs shrink
    #[arg(long, value_name = "FACTOR")]
    pub scale: Option<f64>,
    /// Episodes that the agent of each finished run is evaluated on, kept in its directory as
    /// eval.jsonl; reports take those of runs without closing episodes
    #[arg(long, value_name = "EPISODES")]
    pub evaluate: Option<u32>,
    /// Another option of hasard train for every run, such as rules=tables or hard; several times
    /// for several
    #[arg(long, value_name = "NAME[=VALUE]")]
    pub option: Vec<String>,
    /// Run whatever it takes; without it or --frames, a sweep of more than 48 hours is not begun
    #[arg(long)]
    pub yes: bool,
    /// Print the command lines and run nothing
    #[arg(long)]
    pub dry_run: bool,
    /// One JSON object a job
    #[arg(long)]
    pub json: bool,
    /// Refused with a word on --seeds
    #[arg(long = "seed", value_name = "SEED", hide = true)]
    pub seed: Option<u64>,
}

/// With two names as an example.
fn scenarios_help() -> String {
    let names = [Scenario::OTHER_EXAMPLE, Scenario::EXAMPLE].map(Scenario::name).join(",");
    format!("Scenarios, chosen in the same way: {names}")
}

/// `hasard settings`.
#[derive(Args, Debug)]
pub struct SettingsArgs {
    /// Environment id, or the file of a task of your own
    #[arg(default_value = Scenario::EXAMPLE_ID, value_parser = env_id)]
    pub env: String,
    /// The algorithm
    #[arg(long, default_value = "PPOPID")]
    pub algo: String,
    /// quick, paper, released or tables
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

/// `hasard export-agent`.
#[derive(Args, Debug)]
pub struct ExportAgentArgs {
    /// Run directory; with --temperature an agent's file or zoo:NAME too
    pub run: PathBuf,
    /// The latest checkpoint instead of the one that the run selected
    #[arg(long)]
    pub latest: bool,
    /// Divide the policy's logits by T, so that below 1 it takes likelier actions more often than it
    /// was trained to: from 0.01, nearly always the likeliest, to 100  [default: 1]
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    pub temperature: Option<Temperature>,
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
