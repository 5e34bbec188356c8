//! The program `hasard` as a library: glue between the command line and the libraries. `main.rs`
//! and the Python package run it.

// They panic where a stream is closed or its disk is full.
#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

#[macro_use]
mod failure;

mod actor;
mod args;
mod automap;
mod commands;
mod contact_sheet;
#[cfg(test)]
mod documented_tests;
mod episode_lines;
mod help;
mod interrupt;
mod number;
mod places;
mod progress;
mod settings;
mod sources;
mod ticker;
mod zoo;

pub use actor::in_task;
use args::{Cli, Command};
use clap::{ArgMatches, FromArgMatches};
use failure::Failure;
use hasard_envs::{EnvId, EnvOptions, VecEnv};
use hasard_learn::config::{Constraint, EnvConfig};
use hasard_learn::runs::agent::{Choice, TrainedPolicy};
use hasard_learn::runs::episode_row::episode_row;
use hasard_learn::runs::evaluate::{Evaluation, play};
use hasard_learn::runs::together::Invitation;
use hasard_learn::runs::trainer::{Hooks, Summary};
use hasard_learn::team::Team;
use interrupt::Manner;
use serde_json::Value;
use settings::Elsewhere;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

fn parse(words: impl IntoIterator<Item = OsString>) -> Result<(Cli, ArgMatches), clap::Error> {
    // A negative number is a value, wrong as it may be, and no flag of that name: else the hint is
    // about flags.
    let value = |flag: clap::Arg| {
        let takes = !flag.is_positional() && flag.get_action().takes_values();
        if takes { flag.allow_negative_numbers(true) } else { flag }
    };
    let program = help::program().mut_subcommands(|command| command.mut_args(value));
    let matches = program.try_get_matches_from(words)?;
    Ok((Cli::from_arg_matches(&matches)?, matches))
}

/// Runs the command that the words say, the program's name first, and gives the exit code.
pub fn main(words: impl IntoIterator<Item = OsString>) -> u8 {
    let words: Vec<OsString> = words.into_iter().collect();
    let (cli, matches) = match parse(words.iter().cloned()) {
        Ok(parsed) => parsed,
        Err(error) => return failure::report_usage(&error, words.get(1)),
    };
    // Which of a command's flags were typed, and which have their default.
    let typed = matches.subcommand().map_or(&matches, |(_, typed): (_, &ArgMatches)| typed);
    interrupt::behave(Manner::AtOnce);
    // `check` lists it among what it finds.
    if !matches!(cli.command, Command::Check(_)) {
        hasard_envs::maps::report_tasks_to(|left_out| note!("hasard: {left_out}"));
    }
    let outcome = match cli.command {
        Command::Envs(args) => commands::envs::run(&args),
        Command::New(args) => commands::new::run(&args),
        Command::Check(args) => commands::check::run(&args),
        Command::Play(args) => commands::play::run(&args),
        Command::Rollout(args) => commands::rollout::run(&args),
        Command::Trace(args) => commands::trace::run(&args),
        Command::Bench(args) => commands::bench::run(&args),
        Command::Render(args) => commands::render::run(&args),
        Command::Train(args) => commands::train::run(&args, typed),
        Command::Eval(args) => commands::eval::run(&args),
        Command::Record(args) => commands::record::run(&args),
        Command::Highlights(args) => commands::highlights::run(&args),
        Command::Replay(args) => commands::record::replay(&args),
        Command::Report(args) => commands::report::run(&args),
        Command::Serve(args) => commands::serve::run(&args),
        Command::Sweep(args) => commands::sweep::run(&args),
        Command::ExportAgent(args) => commands::export_agent::run(&args),
        Command::Claim(args) => commands::claim::run(&args),
        Command::Verify(args) => commands::verify::run(&args),
        Command::Scoreboard(args) => commands::scoreboard::run(&args),
        Command::Site(args) => commands::site::run(&args),
        Command::ExportWad(args) => commands::export_wad::run(&args),
        Command::ContactSheet(args) => commands::contact_sheet::run(&args),
        Command::Settings(args) => commands::settings::run(&args),
        Command::Metrics(args) => commands::metrics::run(&args),
        Command::Completions(args) => commands::completions::run(&args),
    };
    let code = outcome.map_or_else(Failure::report, |()| 0);
    interrupt::behave(Manner::Idle);
    code
}

/// Trains as `hasard train` with these words does, but reports to the caller and not the
/// terminal; as the first of a team whose others [`follow`]. Gives the run's directory and how it
/// ended.
///
/// # Errors
/// One line that names the input and the remedy.
pub fn train(
    team: &Team,
    words: impl IntoIterator<Item = OsString>,
    hooks: &mut Hooks<'_>,
) -> Result<(PathBuf, Summary), String> {
    let program = ["hasard", "train"].map(OsString::from);
    let (cli, matches) =
        parse(program.into_iter().chain(words)).map_err(|error| failure::usage_line(&error))?;
    let typed = matches.subcommand().map_or(&matches, |(_, typed)| typed);
    match cli.command {
        Command::Train(args) => commands::train::begin(&args, typed)
            .and_then(|begun| begun.train(team, hooks))
            .map_err(Failure::line),
        _ => Err("these words are another command's".to_string()),
    }
}

/// Trains with the first worker of a team until that ends the run.
///
/// # Errors
/// One line that names the input and the remedy.
pub fn follow(team: Team, warn: &mut dyn FnMut(String)) -> Result<(), String> {
    let invitation = Invitation::hear(team).map_err(|error| error.to_string())?;
    let options = settings::trained_options(&invitation.config.env, Elsewhere::default())
        .map_err(Failure::line)?;
    invitation
        .follow(&|env, worlds| env.worlds(&options, worlds), warn)
        .map_err(|error| error.to_string())
}

/// The run directory or agent file that a text names: a path, or `zoo:NAME`.
///
/// # Errors
/// One line that names the agents of the zoo.
pub fn agent_place(text: &Path) -> Result<PathBuf, String> {
    zoo::find(text.as_os_str()).map_err(Failure::line)
}

/// Plays an episode of each seed with a policy and gives what `hasard eval --json` prints: a row an
/// episode, then the summary. `elsewhere` is another environment than the policy's own, whose own
/// budget it is held to. `interrupted` is asked between some episodes and others.
///
/// # Errors
/// One line of what went wrong; `None` where it was interrupted.
pub fn evaluate(
    policy: &TrainedPolicy,
    choice: Choice,
    options: &EnvOptions,
    elsewhere: Option<EnvId>,
    seeds: &[u64],
    mut interrupted: impl FnMut() -> bool,
) -> Result<Vec<Value>, Option<String>> {
    let threads = settings::cores();
    let (config, mut rows, mut all) = (policy.config(), Vec::new(), Vec::new());
    let id = elsewhere.map_or_else(|| config.env.id.clone(), |id| id.to_string());
    let make = |env: &EnvConfig, worlds| match elsewhere {
        Some(_) => VecEnv::new(&id, options, worlds),
        None => env.worlds(options, worlds),
    };
    let constraints = elsewhere.map_or_else(
        || config.constraints.clone(),
        |id| vec![Constraint { term: None, budget: id.safety_budget(options.rules, options.hard) }],
    );
    let tasks = config.env.tasks().len();
    for some in seeds.chunks((8 * threads).next_multiple_of(tasks)) {
        if interrupted() {
            return Err(None);
        }
        for episode in
            play(policy, choice, &make, some, threads).map_err(|error| Some(error.to_string()))?
        {
            let mut row = episode_row(&id, all.len() as u64, &episode);
            episode_lines::Under::of(options).say(&mut row);
            rows.push(row);
            all.push(episode);
        }
    }
    let summary = Evaluation::of(&all, &constraints).map_err(|error| Some(error.to_string()))?;
    let mut row = episode_lines::summary_row(&summary, &all);
    row["summary"]["run_frames"] = policy.run_frames().into();
    rows.push(row);
    Ok(rows)
}

/// The environment's id and options of the run in a directory, as its agent sees them; of several
/// tasks the first.
///
/// # Errors
/// One line that names the file and the remedy.
pub fn environment_of_run(directory: &Path) -> Result<(String, EnvOptions), String> {
    let config = hasard_learn::runs::evaluate::run_config(directory)
        .map_err(|error| Failure::bad(error).line())?;
    Ok((
        settings::first_task(&config.env),
        settings::trained_options(&config.env, Elsewhere::default()).map_err(Failure::line)?,
    ))
}

/// Otherwise usual options with maps and pictures as `--maps` and `--iwad` name them; `report` is
/// given what of a map is left out.
///
/// # Errors
/// One line that names the input and the remedy.
pub fn looks(
    maps: Option<&Path>,
    iwad: Option<&Path>,
    report: fn(&str),
) -> Result<EnvOptions, String> {
    sources::looks_reporting(maps, iwad, report).map_err(Failure::line)
}
