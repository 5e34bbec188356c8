//! Many training runs from one description: grids of environments, algorithms, seeds and options,
//! and the experiments of the HASARD paper by name.
//!
//! | module | what it holds |
//! |---|---|
//! | [`Sweep`], [`Grid`] | what to run, and its expansion into jobs |
//! | `file` | the TOML file that describes a sweep |
//! | [`paper`] | the paper's experiments |
//! | [`Job`] | one run: a directory and a command line |
//! | [`run_jobs`] | running them side by side, resuming what is unfinished |
//!
//! Every run is one process with one command line, so that a cluster's scheduler can take them
//! over; nothing here knows how to train.
//!
//! ```
//! let sweep = hasard_sweep::Sweep::parse(
//!     "frames = 2000000\nscenarios = ['RemedyRush']\nalgorithms = ['PPO', 'PPOLag']\nseeds = [1, 2]\n\
//!      [options]\nrules = 'released'\nsafety-budget = [2.5, 5.0]",
//! )
//! .unwrap();
//! let jobs = sweep.jobs().unwrap();
//! assert_eq!(jobs.len(), 8);
//! assert_eq!(
//!     jobs[0].command_line("hasard"),
//!     "hasard train RemedyRushLevel1-v0 --algo PPO --frames 2000000 --seed 1 --rules released --safety-budget 2.5 \
//!      --out runs/RemedyRushLevel1-v0/PPO/rules=released,safety-budget=2.5/seed1"
//! );
//! ```

// They panic where a stream is closed or its disk is full.
#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

mod execute;
mod file;
mod grid;
mod job;
mod option;
pub mod paper;
mod table;

pub use execute::{Event, STOPS_WITH_INPUT, Stop, Summary, run_jobs};
pub use grid::{Grid, Sweep};
pub use job::{Job, State};
pub use option::OptionValue;

/// A message that may quote a file by anyone: one line of bounded length, and nothing in it
/// commands a terminal.
fn one_line(problem: &str) -> String {
    let cut = problem.chars().take(1000);
    cut.map(|letter| if letter.is_control() { '\u{fffd}' } else { letter }).collect()
}

#[cfg(test)]
mod tests;
