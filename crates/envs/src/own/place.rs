//! Files of scenarios where ids stand: `my_task.toml`, or `my_task.toml#2` for its second level.

use super::map_file::{WithMaps, with_maps};
use crate::interface::fingerprint::of_text;
use crate::{EnvError, Scenario};
use std::io::Read;
use std::path::Path;

/// Longest file that is read, bytes: a hundred times a long one.
pub const LARGEST_TEXT: u64 = 256 << 10;

/// Whether a text names a scenario's file rather than an id.
#[must_use]
pub fn is_file(text: &str) -> bool {
    let ends_so = |path: &str| {
        Path::new(path).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"))
    };
    ends_so(text) || text.rsplit_once('#').is_some_and(|(path, _)| ends_so(path))
}

/// The path and the level, as written, of `my_task.toml#2`; of any other text the whole, and no level.
#[must_use]
pub fn path_and_level(text: &str) -> (&str, Option<&str>) {
    match text.rsplit_once('#') {
        Some((path, level)) if is_file(path) => (path, Some(level)),
        _ => (text, None),
    }
}

/// The text of a scenario's file, and of the maps that it names in other files.
///
/// # Errors
/// One line that names the file and what is wrong with it, or with a map's.
pub fn read_text(path: &Path) -> Result<String, EnvError> {
    let WithMaps { text, wrong } = read(path)?;
    wrong.map_or(Ok(text), |why| Err(error_in(path, &why)))
}

/// The same, for [`super::check`]: what is wrong with a map's file is a mistake among the others. And
/// the line of the first such, if there is one.
///
/// # Errors
/// One line that names the file and what is wrong with it.
pub fn read_to_check(path: &Path) -> Result<(String, Option<EnvError>), EnvError> {
    let WithMaps { text, wrong } = read(path)?;
    Ok((text, wrong.map(|why| error_in(path, &why))))
}

fn error_in(path: &Path, why: &str) -> EnvError {
    let shown = crate::error::excerpt(&path.display().to_string());
    EnvError::Scenario { why: format!("{shown}: {why}") }
}

fn read(path: &Path) -> Result<WithMaps, EnvError> {
    let wrong = |why: String| error_in(path, &why);
    let unreadable = |error: std::io::Error| {
        wrong(format!("cannot be read: {error}; `hasard new NAME` writes a file to begin with"))
    };
    let file = crate::maps::files::open(path).map_err(unreadable)?;
    let mut bytes = Vec::new();
    file.take(LARGEST_TEXT + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > LARGEST_TEXT {
        return Err(wrong(format!(
            "larger than the {} KiB that a scenario's file may have",
            LARGEST_TEXT >> 10
        )));
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        let line = error.as_bytes()[..error.utf8_error().valid_up_to()]
            .iter()
            .filter(|byte| **byte == b'\n')
            .count()
            + 1;
        wrong(format!("line {line} is no UTF-8 text; save the file as UTF-8"))
    })?;
    // A run needs nothing but the text: the map comes with it.
    Ok(with_maps(text, path.parent().unwrap_or(Path::new(""))))
}

/// A fingerprint of a text, 16 hexadecimal digits: two texts that differ have two, but for an
/// accident that nobody will see.
#[must_use]
pub fn fingerprint(text: &str) -> String {
    format!("{:016x}", of_text(text))
}

/// What to say if the file of a scenario is another by now than what a `keeper` of its text, such as
/// a run, kept when it `began`; `None` if it is the same, or gone, or there is none.
#[must_use]
pub fn changed(scenario: Scenario, began: &str, keeper: &str) -> Option<String> {
    let file = scenario.file?;
    let now = read_text(Path::new(file.path)).ok()?;
    (now != file.text).then(|| {
        let (path, was, is) = (file.path, file.hash, fingerprint(&now));
        format!("{path}: has changed since {began} ({was}, now {is}); the text that the {keeper} keeps is played")
    })
}

#[cfg(test)]
mod tests {
    use super::is_file;

    #[test]
    fn a_number_sign_is_a_level_only_behind_the_ending() {
        for text in ["task.toml", "task.TOML#2", "folder#2/task.toml", "folder#2/task.toml#3"] {
            assert!(is_file(text), "{text}");
        }
        for text in ["RemedyRushLevel1-v0", "task#2", "toml", "folder.toml/map.wad"] {
            assert!(!is_file(text), "{text}");
        }
    }
}
