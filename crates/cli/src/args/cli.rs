//! The program and its commands.

use crate::args::common::UnusedSeed;
use crate::args::pictures::{
    ContactSheetArgs, HighlightsArgs, PlayArgs, RecordArgs, RenderArgs, ReplayArgs,
};
use crate::args::results::{
    ClaimArgs, ReportArgs, ScoreboardArgs, ServeArgs, SiteArgs, VerifyArgs,
};
use crate::args::training::{
    EvalArgs, ExportAgentArgs, MetricsArgs, SettingsArgs, SweepArgs, TrainArgs,
};
use crate::args::worlds::{
    BenchArgs, CheckArgs, EnvsArgs, ExportWadArgs, NewArgs, RolloutArgs, TraceArgs,
};
use clap::{Args, Parser, Subcommand};

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
