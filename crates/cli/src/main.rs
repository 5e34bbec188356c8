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
mod sources;
mod zoo;

use args::{Cli, Command};
use clap::{ArgMatches, CommandFactory, FromArgMatches};
use failure::Failure;
use std::process::ExitCode;

fn main() -> ExitCode {
    let parsed = Cli::command().try_get_matches().and_then(|matches| Ok((Cli::from_arg_matches(&matches)?, matches)));
    let (cli, matches) = match parsed {
        Ok(parsed) => parsed,
        Err(error) => return failure::report_usage(&error),
    };
    // Which of a command's flags were typed, and which have their default.
    let typed = matches.subcommand().map_or(&matches, |(_, typed): (_, &ArgMatches)| typed);
    let outcome = match cli.command {
        Command::Envs(args) => commands::envs::run(&args),
        Command::Play(args) => commands::play::run(&args),
        Command::Rollout(args) => commands::rollout::run(&args),
        Command::Trace(args) => commands::trace::run(&args),
        Command::Bench(args) => commands::bench::run(&args),
        Command::Render(args) => commands::render::run(&args),
        Command::Train(args) => commands::train::run(&args, typed),
        Command::Eval(args) => commands::eval::run(&args),
        Command::Record(args) => commands::record::run(&args),
        Command::Replay(args) => commands::record::replay(&args),
        Command::Report(args) => commands::report::run(&args),
        Command::Serve(args) => commands::serve::run(&args),
        Command::Sweep(args) => commands::sweep::run(&args),
        Command::ExportAgent(args) => commands::export_agent::run(&args),
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
