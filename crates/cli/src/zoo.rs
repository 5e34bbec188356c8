//! The zoo: trained agents by name. One for each environment is part of the program; more may lie
//! in a folder.

use crate::failure::Failure;
use hasard_learn::config::InitFrom;
use hasard_learn::runs::checksum::sha256;
use hasard_learn::runs::zoo::{PREFIX, bytes, names};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// Ending of an agent's file.
pub const ENDING: &str = "agent";

/// Where further files are looked for: the folder that the variable `HASARD_ZOO` names, and `zoo`
/// in the working directory.
fn folders() -> Vec<PathBuf> {
    let named = std::env::var_os("HASARD_ZOO").map(PathBuf::from);
    named.into_iter().chain([PathBuf::from("zoo")]).collect()
}

/// The place of the agent that a text names: a path, or `zoo:NAME`; what is part of the program has
/// the place `zoo:NAME`.
pub fn find(text: &OsStr) -> Result<PathBuf, Failure> {
    if text.is_empty() {
        return Err(Failure::bad(
            "an empty name names no agent; give a run's folder, an agent's file or zoo:NAME",
        ));
    }
    let Some(name) = after(text, PREFIX) else { return Ok(PathBuf::from(text)) };
    let (name, text) = (name.to_string_lossy(), text.to_string_lossy());
    let wanted = name.strip_suffix("-v0").unwrap_or(&name);
    let all = agents();
    let found = all.iter().find(|(known, _)| known.eq_ignore_ascii_case(wanted));
    found.map(|(_, path)| path.clone()).ok_or_else(|| {
        let names: Vec<String> = all.iter().map(|(known, _)| format!("{PREFIX}{known}")).collect();
        Failure::bad(format!(
            "{text}: the zoo has {}; HASARD_ZOO names a folder with more",
            names.join(", ")
        ))
    })
}

/// What names weights in a command that others can run: `zoo:NAME` where they are of the program,
/// though they were read from a folder of this machine; else their place.
pub fn name(weights: &InitFrom) -> PathBuf {
    names()
        .map(|name| PathBuf::from(format!("{PREFIX}{name}")))
        .find(|place| bytes(place).is_some_and(|bytes| sha256(bytes) == weights.sha256))
        .unwrap_or_else(|| weights.place.clone())
}

/// Whether a text names an agent's file rather than a run directory or an environment.
pub fn is_agent(text: &OsStr) -> bool {
    after(text, PREFIX).is_some()
        || Path::new(text).extension().is_some_and(|ending| ending == ENDING)
}

/// What follows a beginning such as `run:`; names of files are not always text.
#[cfg(unix)]
pub fn after(text: &OsStr, beginning: &str) -> Option<PathBuf> {
    use std::os::unix::ffi::OsStrExt;
    text.as_bytes()
        .strip_prefix(beginning.as_bytes())
        .map(|rest| PathBuf::from(OsStr::from_bytes(rest)))
}

/// What follows a beginning such as `run:`.
#[cfg(not(unix))]
pub fn after(text: &OsStr, beginning: &str) -> Option<PathBuf> {
    text.to_str()?.strip_prefix(beginning).map(PathBuf::from)
}

/// Names and places of all agents: those of folders, the earlier first, then those of the program
/// that no folder has too.
pub fn agents() -> Vec<(String, PathBuf)> {
    let mut all: Vec<(String, PathBuf)> = Vec::new();
    for folder in folders() {
        let mut paths: Vec<PathBuf> = std::fs::read_dir(folder)
            .into_iter()
            .flatten()
            .filter_map(|entry| Some(entry.ok()?.path()))
            .collect();
        paths.sort();
        for path in
            paths.into_iter().filter(|path| path.extension().is_some_and(|ending| ending == ENDING))
        {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            add(&mut all, name, path);
        }
    }
    for name in names() {
        add(&mut all, name.to_string(), PathBuf::from(format!("{PREFIX}{name}")));
    }
    all
}

fn add(all: &mut Vec<(String, PathBuf)>, name: String, place: PathBuf) {
    if all.iter().all(|(known, _)| *known != name) {
        all.push((name, place));
    }
}
