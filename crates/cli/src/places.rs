//! What a text names that should be a run: the run itself, or, where it is not one, what lies there
//! instead.

use crate::failure::Failure;
use crate::zoo;
use hasard_envs::edit_distance;
use hasard_media::files::what_lies_at;
use hasard_media::shell::quote;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// The file that makes a directory a run.
const SETTINGS: &str = "config.json";
/// Runs that are named where a folder of them is not one itself.
const NAMED: usize = 5;
/// Folders below a folder in which runs are looked for.
const DEPTH: usize = 3;

/// The run directory or agent file that a text names.
///
/// # Errors
/// One line: for a folder of runs it names the latest of them, for nothing at all what is called
/// nearly so, and what the system says of a place that is closed to us.
pub fn run(text: &OsStr) -> Result<PathBuf, Failure> {
    let place = zoo::find(text)?;
    let kind = what_lies_at(&place).map_err(Failure::bad)?;
    let is_folder = kind.as_ref().is_some_and(std::fs::Metadata::is_dir);
    if is_folder && what_lies_at(&place.join(SETTINGS)).map_err(Failure::bad)?.is_none() {
        let below = runs_below(&place);
        if !below.is_empty() {
            return Err(Failure::bad(format!(
                "{}: is a folder of runs; name one of them: {}",
                place.display(),
                listed(&below)
            )));
        }
    }
    if kind.is_none() && !zoo::is_agent(text) {
        let near =
            near(&place).map_or_else(String::new, |near| format!(" did you mean {}?", quote(near)));
        return Err(Failure::bad(format!(
            "{}: there is no such run or agent's file;{near} `hasard train ENV --out DIR` makes a run, and `hasard eval zoo:NAME` plays an \
             agent that comes with the program",
            place.display()
        )));
    }
    Ok(place)
}

/// Runs below a folder, the latest first.
fn runs_below(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    gather(folder, DEPTH, &mut found);
    let time =
        |run: &PathBuf| std::fs::metadata(run.join(SETTINGS)).and_then(|data| data.modified()).ok();
    // By name where times are equal, so that the list does not depend on the file system.
    found.sort();
    found.sort_by_key(|run| std::cmp::Reverse(time(run)));
    found
}

fn gather(folder: &Path, depth: usize, found: &mut Vec<PathBuf>) {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    for path in entries
        .filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_dir()))
        .map(|entry| entry.path())
    {
        let thrown_away = path.file_name().is_some_and(|name| name == hasard_report::run::TRASH);
        if path.join(SETTINGS).is_file() {
            found.push(path);
        } else if depth > 1 && !thrown_away {
            gather(&path, depth - 1, found);
        }
    }
}

fn listed(runs: &[PathBuf]) -> String {
    let mut text = runs.iter().take(NAMED).map(quote).collect::<Vec<_>>().join(", ");
    if runs.len() > NAMED {
        text += &format!(" and {} more", runs.len() - NAMED);
    }
    text
}

/// What in the same folder is called nearly so.
fn near(place: &Path) -> Option<PathBuf> {
    let wanted = place.file_name()?.to_str()?;
    let folder =
        place.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let names = std::fs::read_dir(folder)
        .ok()?
        .flatten()
        .filter_map(|entry| entry.file_name().into_string().ok());
    // A link that leads nowhere is no other name.
    let others = names.filter(|name| name != wanted);
    let (distance, name) = others.map(|name| (edit_distance(wanted, &name), name)).min()?;
    (distance <= 1 + wanted.len() / 4).then(|| place.with_file_name(name))
}

/// The folder of a file that is not there yet: writing the file makes it.
pub fn absent_folder(file: &Path) -> Option<&Path> {
    file.parent().filter(|folder| !folder.as_os_str().is_empty() && !folder.exists())
}
