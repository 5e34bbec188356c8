//! What is wrong with a file: all of it, each with its place and its remedy.

use crate::edit_distance;
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// Most that are listed; who has more sees the rest after mending these.
const MOST: usize = 100;

/// Something wrong with a scenario's file, or something in it that can never happen.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct Mistake {
    /// Line, from 1.
    pub line: usize,
    /// Column in letters, from 1.
    pub column: usize,
    /// It can be played nevertheless.
    pub warning: bool,
    /// What is wrong, and what to write instead; one line.
    pub text: String,
}

impl fmt::Display for Mistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = if self.warning { "warning: " } else { "" };
        write!(f, "{}:{}: {kind}{}", self.line, self.column, self.text)
    }
}

/// Collects mistakes while a text is read.
#[derive(Debug)]
pub(super) struct Mistakes {
    found: Vec<(usize, bool, String)>,
    /// How often something was wrong, what is listed already included.
    added: usize,
    /// What is read.
    text: String,
    /// The setting that is read, by its number.
    setting: Option<usize>,
    /// In which settings something was said of a place.
    said: BTreeMap<(usize, String), Vec<usize>>,
}

impl Mistakes {
    pub fn new(text: &str) -> Mistakes {
        Mistakes {
            found: Vec::new(),
            added: 0,
            text: text.to_owned(),
            setting: None,
            said: BTreeMap::new(),
        }
    }

    /// From now on the setting of this number is read, or what all have.
    pub fn reading(&mut self, setting: Option<usize>) {
        self.setting = setting;
    }

    /// Puts what `name` makes of the settings in which something is wrong before what is wrong, where
    /// the place is one of `common`, which are outside all layers and say nothing of it. With a list
    /// that is full nobody knows in which settings it is.
    pub fn name_settings(&mut self, common: &[usize], name: impl Fn(&[usize]) -> String) {
        if self.full() {
            return;
        }
        let common: BTreeSet<usize> = common.iter().copied().collect();
        for (at, _, text) in self.found.iter_mut().filter(|(at, ..)| common.contains(at)) {
            if let Some(settings) = self.said.get(&(*at, text.clone())) {
                text.insert_str(0, &name(settings));
            }
        }
    }

    /// The byte of a letter of a drawing that begins at `at`: by its line and column, from 0, where
    /// it is written as it stands.
    pub fn within_drawing(&self, at: usize, line: usize, column: usize) -> usize {
        let from = self.text.get(at..).unwrap_or("");
        let quotes = ["\"\"\"\n", "'''\n", "\"\"\"\r\n", "'''\r\n"];
        let Some(opening) = quotes.iter().find(|quote| from.starts_with(**quote)) else {
            return at;
        };
        let drawing = &from[opening.len()..];
        let Some(start) = (line == 0)
            .then_some(0)
            .or_else(|| Some(drawing.match_indices('\n').nth(line - 1)?.0 + 1))
        else {
            return at;
        };
        let inside = drawing[start..].char_indices().nth(column).map_or(0, |(place, _)| place);
        at + opening.len() + start + inside
    }

    /// Notes what is wrong at a byte of the text.
    pub fn add(&mut self, at: usize, text: impl Into<String>) {
        self.added += 1;
        self.note(at, false, text.into());
    }

    /// Notes what can never happen.
    pub fn warn(&mut self, at: usize, text: impl Into<String>) {
        self.note(at, true, text.into());
    }

    fn note(&mut self, at: usize, warning: bool, text: String) {
        let text: String = text.chars().take(400).flat_map(shown).collect();
        if self.full() {
            return;
        }
        // Levels repeat what they have in common.
        let settings = match self.said.entry((at, text)) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(fresh) => {
                self.found.push((at, warning, fresh.key().1.clone()));
                fresh.insert(Vec::new())
            }
        };
        settings.extend(self.setting.filter(|own| settings.last() != Some(own)));
    }

    /// Whether there are as many as are listed.
    pub fn full(&self) -> bool {
        self.found.len() >= MOST
    }

    /// How often something was wrong so far, said before or not.
    pub fn added(&self) -> usize {
        self.added
    }

    /// Whether anything keeps the file from being played.
    pub fn any(&self) -> bool {
        self.found.iter().any(|(_, warning, _)| !warning)
    }

    /// All, in the order of the text that they are in.
    pub fn into_list(mut self) -> Vec<Mistake> {
        let text = &self.text;
        self.found.sort();
        let places: Vec<(usize, usize)> =
            self.found.iter().map(|(at, ..)| place(text, *at)).collect();
        let all = self.found.into_iter().zip(places);
        all.map(|((_, warning, text), (line, column))| Mistake { line, column, warning, text })
            .collect()
    }
}

/// Letters that command a terminal are spelled out.
fn shown(letter: char) -> Vec<char> {
    if letter.is_control() { letter.escape_default().collect() } else { vec![letter] }
}

/// Line and column of a byte.
fn place(text: &str, at: usize) -> (usize, usize) {
    let mut end = at.min(text.len());
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    let before = &text[..end];
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
    (line, column)
}

/// The beginning of a user's word, for a message.
pub(super) fn excerpt(word: &str) -> String {
    word.chars().take(40).flat_map(char::escape_debug).collect()
}

/// A refusal of an unknown word that names the nearest known one, or all if they are few.
pub(super) fn unknown<'a>(
    what: &str,
    word: &str,
    known: impl IntoIterator<Item = &'a str>,
) -> String {
    let known: Vec<&str> = known.into_iter().collect();
    let near = nearest(word, &known);
    let word = excerpt(word);
    match (near, known.len()) {
        (Some(near), 9..) => format!("{what} `{word}` is unknown; the nearest is `{near}`"),
        (_, 0) => format!("{what} `{word}` is unknown: the file names none"),
        (_, ..9) => format!("{what} `{word}` is unknown; write one of {}", known.join(", ")),
        _ => format!("{what} `{word}` is unknown; write one of {}, ...", known[..8].join(", ")),
    }
}

/// The known word that a mistyped one is near: one letter in three is wrong, or the end is left out.
fn nearest<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    let upper: String = word.chars().take(24).collect::<String>().to_uppercase();
    let distance = |known: &&&str| edit_distance(&upper, &known.to_uppercase());
    let near = known.iter().min_by_key(distance);
    let near = near.filter(|known| distance(known) <= (upper.chars().count() / 3).min(3));
    let longer =
        || known.iter().find(|known| upper.len() > 2 && known.to_uppercase().starts_with(&upper));
    near.or_else(longer).copied()
}

#[cfg(test)]
mod tests;
