//! What people say of a run: a note, tags, whether it is put aside. `notes.json` of a run holds it.

use super::files::{Stamp, read};
pub(crate) use hasard_report::run::TRASH;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};
use std::io::ErrorKind;
use std::path::Path;

/// The file of a run that holds them.
pub(crate) const FILE: &str = "notes.json";

/// What people say of a run.
#[derive(Serialize, Deserialize, Default, Clone, PartialEq, Debug)]
pub(crate) struct Words {
    #[serde(default)]
    pub note: String,
    #[serde(default)]
    pub tags: Vec<String>,
    #[serde(default)]
    pub archived: bool,
    /// What another program or a later version wrote beside them; it stays.
    #[serde(flatten)]
    pub others: Map<String, Value>,
}

impl Words {
    /// Those of a run's folder; `name` is the run's. None are there where there is no file.
    ///
    /// # Errors
    /// Where the file cannot be understood: what somebody wrote there must not be lost.
    pub fn of(run: &Path, name: &str) -> Result<Words, String> {
        let path = run.join(FILE);
        if std::fs::symlink_metadata(&path).is_err_and(|error| error.kind() == ErrorKind::NotFound)
        {
            return Ok(Words::default());
        }
        let problem = match read(&path) {
            Some(text) => match serde_json::from_str(&text) {
                Ok(words) => return Ok(words),
                Err(error) => error.to_string(),
            },
            None => "is no readable text file".to_owned(),
        };
        Err(format!("{name}/{FILE}: {problem}; mend this file or move it away, then save again"))
    }
}

/// The notes of a run and the file that they were read from, as it was then.
pub(crate) struct Notes {
    stamp: Stamp,
    words: Words,
}

impl Default for Notes {
    fn default() -> Notes {
        Notes { stamp: Stamp::NONE, words: Words::default() }
    }
}

impl Notes {
    /// Reads them again if the file is another; whether it was.
    pub fn look(&mut self, run: &Path) -> bool {
        let path = run.join(FILE);
        let stamp = Stamp::of(&path).unwrap_or(Stamp::NONE);
        if stamp == self.stamp {
            return false;
        }
        self.stamp = stamp;
        let words = read(&path).and_then(|text| serde_json::from_str(&text).ok());
        self.words = words.unwrap_or_default();
        true
    }

    /// Nothing where there is nothing to say.
    pub fn as_json(&self) -> Value {
        if self.words == Words::default() { Value::Null } else { json!(self.words) }
    }
}
