//! What an earlier report left in the folder of a new one, which takes its place.
//!
//! `report.md` is its list: it begins as no other file does, and names every figure.

use crate::latex::{DOCUMENT, HEAD};
use crate::markdown::{FIGURES, LEGEND};
use crate::run::TEXT_LIMIT;
use hasard_media::files::read_limited;
use std::collections::BTreeSet;
use std::io::ErrorKind;
use std::path::Path;

/// The file by which the others are known; a report writes it before them.
pub const LIST: &str = "report.md";
/// What every report has beside its list and its figures.
const ALWAYS: [&str; 5] = ["index.html", LIST, "experiments.csv", "runs.csv", "curves.csv"];
/// Of reports with LaTeX: the tables.
pub const TABLES: &str = "tables.tex";
/// The document around them, in which people write: changed, it is theirs.
pub const PAPER: &str = "paper.tex";

/// The files of an earlier report, by their names in its folder; none in a new folder.
pub struct Former(BTreeSet<String>);

impl Former {
    /// Those in the folder of a report that is to be written.
    ///
    /// # Errors
    /// When there is something else in it: a report does not mix with the files of others. Hidden
    /// files do not count, for no report writes any.
    pub fn of(out: &Path) -> Result<Former, String> {
        let remedy = "give a new or an empty folder, or that of an earlier report";
        let entries = match std::fs::read_dir(out) {
            Ok(entries) => entries,
            Err(error) if error.kind() == ErrorKind::NotFound => {
                return Ok(Former(BTreeSet::new()));
            }
            Err(error) => return Err(format!("{}: {error}; {remedy}", out.display())),
        };
        let hidden = |name: &std::ffi::OsStr| name.as_encoded_bytes().starts_with(b".");
        if entries.flatten().all(|entry| hidden(&entry.file_name())) {
            return Ok(Former(BTreeSet::new()));
        }
        let list = text(out, LIST);
        if list.lines().nth(4) != Some(LEGEND) {
            let problem = "is not empty, and what is in it is of no report";
            return Err(format!("{}: {problem}; {remedy}", out.display()));
        }
        let mut files: BTreeSet<String> = ALWAYS.map(String::from).into();
        let tables = text(out, TABLES).lines().next() == HEAD.lines().next();
        files.extend(tables.then(|| TABLES.into()));
        let paper = text(out, PAPER).lines().eq(DOCUMENT.lines());
        files.extend(paper.then(|| PAPER.into()));
        for name in list.lines().filter_map(figure) {
            // A chart stands in the list as SVG, and has the same name in its other forms.
            if let Some(stem) = name.strip_suffix(".svg") {
                let ends = if tables { &["svg", "png", "pdf"][..] } else { &["svg", "png"] };
                files.extend(ends.iter().map(|end| format!("{FIGURES}/{stem}.{end}")));
            } else {
                files.insert(format!("{FIGURES}/{name}"));
            }
        }
        Ok(Former(files))
    }

    /// Removes them for a report of the named files, but for those that it writes anew.
    ///
    /// # Errors
    /// When one of the new files would replace one that is of no report, which is found out before
    /// any goes, or when one cannot be removed.
    pub fn give_way(&self, out: &Path, new: &[&str]) -> Result<(), String> {
        let there = |name: &str| out.join(name).symlink_metadata().is_ok();
        if let Some(name) = new.iter().find(|name| !self.0.contains(**name) && there(name)) {
            let problem = "is not as a report wrote it, and the new one has a file of this name";
            return Err(format!(
                "{}: {problem}; move it, or give another folder",
                out.join(name).display()
            ));
        }
        for name in self.0.iter().filter(|name| !new.contains(&name.as_str()) && there(name)) {
            let path = out.join(name);
            std::fs::remove_file(&path).map_err(|error| {
                format!(
                    "{}: cannot remove: {error}; move it, or give another folder",
                    path.display()
                )
            })?;
        }
        // It stays where something of the user's is in it.
        let _ = std::fs::remove_dir(out.join(FIGURES));
        Ok(())
    }
}

/// A file's text; none where there is no such file.
fn text(out: &Path, name: &str) -> String {
    let bytes = read_limited(&out.join(name), TEXT_LIMIT).unwrap_or_default();
    String::from_utf8_lossy(&bytes).into_owned()
}

/// The file of the figure that a line of the list shows. A name that leads elsewhere is none.
fn figure(line: &str) -> Option<&str> {
    let (_, name) = line.strip_prefix("![")?.strip_suffix(')')?.rsplit_once("](")?;
    let name = name.strip_prefix(FIGURES)?.strip_prefix('/')?;
    let plain = |letter: char| letter.is_ascii_alphanumeric() || matches!(letter, '-' | '_' | '.');
    (name.chars().all(plain) && name.contains(|letter: char| letter.is_ascii_alphanumeric()))
        .then_some(name)
}
