//! `hasard completions`: what a shell needs to complete commands and flags.

use crate::args::CompletionsArgs;
use crate::failure::Outcome;
use crate::help::program;
use std::io::Write;

/// Runs the command.
pub fn run(args: &CompletionsArgs) -> Outcome {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut program(), "hasard", &mut script);
    std::io::stdout().lock().write_all(&script)?;
    Ok(())
}
