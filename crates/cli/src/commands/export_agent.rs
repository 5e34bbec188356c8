//! `hasard export-agent`: the agent of a run as one small file.

use crate::args::ExportAgentArgs;
use crate::failure::{Failure, Outcome, warn};
use crate::places;
use crate::zoo::ENDING;
use hasard_learn::error::LearnError;
use hasard_learn::runs::agent_file::{AgentFile, export, export_latest, tempered};
use hasard_learn::runs::run_directory::damaged_selection;
use hasard_media::files::{WholeFile, what_lies_at};
use hasard_media::shell::quote;
use serde_json::json;
use std::io::Write;
use std::path::{Path, PathBuf};

/// The file of the agent that a run selects; a line says so where the run's word on it is damaged.
pub fn export_selected(run: &Path) -> Result<Vec<u8>, LearnError> {
    if let Some(problem) = damaged_selection(run) {
        note!("hasard: {problem}; the best candidate is taken");
    }
    export(run)
}

/// Refuses what is a file already, where a run's folder is wanted.
fn refuse_file(text: &Path, place: &Path) -> Outcome {
    if !AgentFile::is_at(place) {
        return Ok(());
    }
    let text = text.display();
    if AgentFile::read(place).is_err() {
        return Err(Failure::bad(format!("{text} is a file; name a run's folder")));
    }
    let copy = if place.is_file() {
        format!("copy {}", quote(place))
    } else {
        "every command that plays an agent takes this name".into()
    };
    Err(Failure::bad(format!("{text} is an agent's file already: {copy}, or name a run's folder")))
}

/// Refuses a name under which something else than an agent's file lies.
fn keep_others(out: &Path) -> Outcome {
    let there = what_lies_at(out).map_err(Failure::bad)?;
    if !there.is_some_and(|kind| kind.is_file()) {
        return Ok(());
    }
    AgentFile::read(out).map(drop).map_err(|error| match error {
        LearnError::Content { .. } => Failure::bad(format!(
            "{}: what is there is no agent's file; move it, or choose another name with --out",
            out.display()
        )),
        other => Failure::bad(other),
    })
}

/// The bytes of a run's agent.
fn of_run(args: &ExportAgentArgs, run: &Path) -> Result<Vec<u8>, Failure> {
    if args.latest { export_latest(run, &mut warn) } else { export_selected(run) }
        .map_err(Failure::bad)
}

/// The bytes of an agent's file.
fn of_file(args: &ExportAgentArgs, file: &Path) -> Result<Vec<u8>, Failure> {
    if args.latest {
        return Err(Failure::bad(format!(
            "--latest: {} is an agent's file, which has one agent; leave --latest out",
            file.display()
        )));
    }
    Ok(AgentFile::read_whole(file).map_err(Failure::bad)?.0)
}

/// Runs the command.
pub fn run(args: &ExportAgentArgs) -> Outcome {
    let run = places::run(args.run.as_os_str())?;
    if args.temperature.is_none() {
        refuse_file(&args.run, &run)?;
    }
    let bytes = if AgentFile::is_at(&run) { of_file(args, &run)? } else { of_run(args, &run)? };
    let bytes = match args.temperature {
        None => bytes,
        Some(temperature) => tempered(&bytes, temperature).map_err(|problem| {
            Failure::bad(format!("--temperature {temperature}: {}: {problem}", run.display()))
        })?,
    };
    let file = AgentFile::parse(&bytes).map_err(Failure::bad)?;
    let name = file.card.config.env.id.trim_end_matches("-v0");
    let out = args.out.clone().unwrap_or_else(|| PathBuf::from(format!("{name}.{ENDING}")));
    if out.extension().is_none_or(|ending| ending != ENDING) {
        return Err(Failure::bad(format!(
            "--out {}: give a name that ends in .{ENDING}",
            out.display()
        )));
    }
    keep_others(&out)?;
    let mut whole = WholeFile::create(&out).map_err(Failure::bad)?;
    whole
        .write_all(&bytes)
        .map_err(|error| Failure::bad(format!("cannot write {}: {error}", out.display())))?;
    whole.finish().map_err(Failure::bad)?;
    if args.json {
        say!(
            "{}",
            json!({ "file": out.display().to_string(), "bytes": bytes.len(), "env": file.card.config.env.id })
        );
    } else {
        let file = quote(&out);
        say!(
            "{}: {} bytes; evaluate the quantised agent: hasard eval {file}",
            out.display(),
            bytes.len()
        );
    }
    Ok(())
}
