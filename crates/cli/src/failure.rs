//! How a command fails, and the one line that says so.

use clap::error::{ContextKind, ContextValue, ErrorKind};
use hasard_learn::runs::claim::is_direction;
use std::ffi::OsString;
use std::io;

/// Prints a line on standard error. Where that cannot be written (a full disk, a terminal that is
/// gone) the line is lost and the work goes on: unlike `eprintln!`, no panic.
macro_rules! note {
    ($($argument:tt)*) => { $crate::failure::write_note(format!($($argument)*)) };
}

/// Says what went otherwise than one would expect, and the command goes on.
pub fn warn(text: String) {
    note!("hasard: {text}");
}

/// Why a command did not end well; decides the exit code.
#[derive(Debug)]
pub enum Failure {
    /// The command worked and its result is negative: exit code 1.
    Negative(String),
    /// Bad input or a failed operation: exit code 2, one line that names the input and the remedy.
    BadInput(String),
    /// Standard output was closed by its reader.
    OutputClosed,
    /// A signal of this number asked for the end.
    Interrupted(i32),
}

impl Failure {
    /// Bad input, from anything that prints as one line. What it quotes may come from a file or a
    /// name by anyone: nothing in it commands the terminal.
    pub fn bad(message: impl std::fmt::Display) -> Failure {
        Failure::BadInput(presentable(&message.to_string()))
    }

    /// The same with what it is about before it, if it is of bad input.
    pub fn about(self, what: &str) -> Failure {
        match self {
            Failure::BadInput(message) => Failure::bad(format!("{what}: {message}")),
            other => other,
        }
    }
}

impl Failure {
    /// Says so, and gives the exit code; ends the process where a signal asked for it.
    pub fn report(self) -> u8 {
        match self {
            Failure::Negative(message) => {
                note!("hasard: {message}");
                1
            }
            Failure::BadInput(message) => {
                note!("hasard: {message}");
                2
            }
            // The reader of our output went away (`hasard ... | head`): nothing is wrong.
            Failure::OutputClosed => 0,
            Failure::Interrupted(signal) => crate::interrupt::end_by(signal),
        }
    }

    /// The line alone.
    pub fn line(self) -> String {
        match self {
            Failure::Negative(text) | Failure::BadInput(text) => text,
            Failure::OutputClosed => "standard output was closed".to_string(),
            Failure::Interrupted(signal) => format!("ended by signal {signal}"),
        }
    }
}

/// See [`note!`]. A name or a text of someone else's may stand in it.
pub fn write_note(text: String) {
    let lines = text.split('\n').map(|line| presentable(line) + "\n");
    let line: String = lines.collect();
    let _ = std::io::Write::write_all(&mut std::io::stderr().lock(), line.as_bytes());
}

/// A word of more letters is printed by its ends, quotation marks among them: any path that a person typed is shorter.
const LONGEST_WORD: usize = 1000;

/// A text by anyone as it may be printed: nothing in it commands the terminal, ends the line, turns
/// its order round or fills the screen.
pub fn presentable(text: &str) -> String {
    let plain = |letter: char| !letter.is_control() && !is_direction(letter);
    let shown = |letter: char| if plain(letter) { letter } else { '\u{fffd}' };
    let word = |word: &str| -> String {
        if word.chars().nth(LONGEST_WORD).is_none() {
            return word.chars().map(shown).collect();
        }
        let end: Vec<char> = word.chars().rev().take(2).collect();
        word.chars()
            .take(100)
            .chain("...".chars())
            .chain(end.into_iter().rev())
            .map(shown)
            .collect()
    };
    text.split(' ').map(word).collect::<Vec<String>>().join(" ")
}

/// Lines on standard output of a command whose exit code is its result. Where the reader goes away
/// (`hasard verify DIR | grep -q holds`) the work goes on, and the result stays what it is.
pub struct Lines(Outcome);

impl Lines {
    /// None so far.
    pub fn new() -> Lines {
        Lines(Ok(()))
    }

    /// Prints one.
    pub fn say(&mut self, line: impl std::fmt::Display) {
        if self.0.is_ok() {
            let printed = io::Write::write_fmt(&mut io::stdout().lock(), format_args!("{line}\n"));
            self.0 = printed.map_err(Failure::from);
        }
    }

    /// The command's result; if that is good, what became of the lines.
    pub fn end(self, result: Outcome) -> Outcome {
        result.and(self.0)
    }
}

/// What every command returns.
pub type Outcome = Result<(), Failure>;

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Failure {
        match error.kind() {
            io::ErrorKind::BrokenPipe => Failure::OutputClosed,
            _ => Failure::BadInput(format!(
                "standard output cannot be written: {error}; make room, or send it elsewhere"
            )),
        }
    }
}

/// Prints `--help` and `--version` as they are, and a usage error as one line, whose hint names the
/// command if the first word after the program's name is one; gives the exit code.
pub fn report_usage(error: &clap::Error, first: Option<&OsString>) -> u8 {
    if !error.use_stderr()
        || error.kind() == clap::error::ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand
    {
        return match error.print() {
            Ok(()) if !error.use_stderr() => 0,
            Err(problem) if !error.use_stderr() => Failure::from(problem).report(),
            _ => 2,
        };
    }
    note!("hasard: {} (see `{} --help`)", usage_line(error), command(first));
    2
}

/// A usage error as one line.
pub fn usage_line(error: &clap::Error) -> String {
    if error.kind() == ErrorKind::UnknownArgument
        && let Some(ContextValue::String(flag)) = error.get(ContextKind::InvalidArg)
        && let Some(line) = elsewhere(flag)
    {
        return presentable(&line);
    }
    let text = error.render().to_string();
    let parts: Vec<&str> = text
        .lines()
        .map(str::trim)
        .filter(|line| {
            !line.is_empty()
                && !line.starts_with("Usage:")
                && !line.starts_with("For more information")
                // No word of this program begins with dashes.
                && !line.starts_with("tip: to pass")
        })
        .collect();
    let line = presentable(&parts.join("; ").replace(":; ", ": "));
    // The standard library's words for what is no number without a sign.
    let line = line.replace("invalid digit found in string", "give a whole number, 0 or more");
    let line =
        line.replace("number too large to fit in target type", "give a smaller whole number");
    line.strip_prefix("error: ").unwrap_or(&line).to_string()
}

/// Where a flag that a command does not know is: on the Python package's program, on `train`, or
/// among the settings of `config.json`, by our name or another program's, such as `--lr`.
fn elsewhere(flag: &str) -> Option<String> {
    use clap::CommandFactory;
    let name = flag.trim_start_matches('-');
    let all = crate::args::Cli::command();
    let has = |one: &clap::Command| one.get_arguments().any(|one| one.get_long() == Some(name));
    let having = all.get_subcommands().filter(|one| has(one)).map(clap::Command::get_name);
    let having: Vec<&str> = having.collect();
    // A word too many, which would be a flag with dashes before it.
    if name == flag {
        let line = || format!("'{flag}' is one word too many; did you mean --{flag}?");
        return (!having.is_empty()).then(line);
    }
    if ["on", "workers"].contains(&name) {
        return Some(format!(
            "there is no {flag}; only the `hasard` of `pip install .` has it: docs/python.md, Clusters"
        ));
    }
    if ["env", "environment", "task"].contains(&name) {
        return Some(format!(
            "there is no {flag}; environments stand without a flag, as in `hasard rollout ENV --policy AGENT`, which plays an agent in any"
        ));
    }
    match having[..] {
        [] => {}
        [only] => return Some(format!("{flag} is of `hasard {only}`, not of this command")),
        [ref first @ .., last] if first.len() < 4 => {
            let first = first.join(", ");
            return Some(format!("{flag} is of {first} and {last}, not of this command"));
        }
        _ => return Some(format!("this command has no {flag}")),
    }
    let setting = hasard_learn::config::explained::named(&name.replace('-', "_"))?;
    Some(match crate::commands::flag_of(&setting) {
        Some(own) => format!("there is no {flag}; of a training that is --{own}"),
        None => format!("there is no {flag}; of a training that is --set {setting}=VALUE"),
    })
}

/// The program and, if the first word names one, its command: whose help says more.
fn command(first: Option<&OsString>) -> String {
    use clap::CommandFactory;
    match first.and_then(|first| crate::args::Cli::command().find_subcommand(first).cloned()) {
        Some(known) => format!("hasard {}", known.get_name()),
        None => "hasard".into(),
    }
}

/// Prints a line on standard output and returns from the calling command if that cannot be done:
/// unlike `println!`, no panic when the reader has gone away.
#[macro_export]
macro_rules! say {
    ($($argument:tt)*) => {
        std::io::Write::write_fmt(&mut std::io::stdout().lock(), format_args!("{}\n", format_args!($($argument)*)))?
    };
}
