//! The program `hasard`: glue between the command line and the libraries.

#[macro_use]
mod failure;

mod actor;
mod args;
mod automap;
mod commands;
mod contact_sheet;
mod episode_lines;
mod settings;

use args::{Cli, Command};
use clap::Parser;
use failure::Failure;
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return failure::report_usage(&error),
    };
    let outcome = match cli.command {
        Command::Envs(args) => commands::envs::run(&args),
        Command::Play(args) => commands::play::run(&args),
        Command::Rollout(args) => commands::rollout::run(&args),
        Command::Trace(args) => commands::trace::run(&args),
        Command::Bench(args) => commands::bench::run(&args),
        Command::Render(args) => commands::render::run(&args),
        Command::Train(args) => commands::train::run(&args),
        Command::Eval(args) => commands::eval::run(&args),
        Command::Record(args) => commands::record::run(&args),
        Command::Replay(args) => commands::record::replay(&args),
        Command::Report(args) => commands::report::run(&args),
        Command::Sweep(args) => commands::sweep::run(&args),
        Command::ExportWad(args) => commands::export_wad::run(&args),
        Command::ContactSheet(args) => commands::contact_sheet::run(&args),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Negative(message)) => {
            eprintln!("hasard: {message}");
            ExitCode::from(1)
        }
        Err(Failure::BadInput(message)) => {
            eprintln!("hasard: {message}");
            ExitCode::from(2)
        }
        // The reader of our output went away (`hasard ... | head`): nothing is wrong.
        Err(Failure::OutputClosed) => ExitCode::SUCCESS,
    }
}
