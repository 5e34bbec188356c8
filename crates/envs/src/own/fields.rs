//! Reads a table field by field: each of its kind and within bounds, and none that nobody asked
//! for.

use super::mistakes::{Mistakes, excerpt, unknown};
use super::tree::{Entry, Node, Value};

/// A table that is being read.
pub(super) struct Fields<'n> {
    entries: &'n [Entry],
    asked: Vec<&'static str>,
    /// What it is, for messages: `[map]`.
    pub name: &'static str,
    pub at: usize,
}

impl<'n> Fields<'n> {
    /// Begins to read a table; one that is none is noted, and reads as empty.
    pub fn of(node: &'n Node, name: &'static str, mistakes: &mut Mistakes) -> Fields<'n> {
        let entries = match &node.value {
            Value::Table(entries) => &entries[..],
            _ => {
                mistakes.add(node.at, format!("{name} must be a table, not {}", node.what()));
                &[]
            }
        };
        Fields { entries, asked: Vec::new(), name, at: node.at }
    }

    /// A field's value.
    pub fn node(&mut self, key: &'static str) -> Option<&'n Node> {
        self.asked.push(key);
        self.entries.iter().find(|entry| entry.key == key).map(|entry| &entry.node)
    }

    /// Where a field stands, if it is there; it counts as read only once its value is asked for.
    pub fn place_of(&self, key: &str) -> Option<usize> {
        self.entries.iter().find(|entry| entry.key == key).map(|entry| entry.at)
    }

    /// A whole number.
    pub fn whole(
        &mut self,
        key: &'static str,
        from: i64,
        to: i64,
        mistakes: &mut Mistakes,
    ) -> Option<i64> {
        let node = self.node(key)?;
        match node.value {
            Value::Whole(number) if (from..=to).contains(&number) => Some(number),
            _ => {
                let given = node.other_than_a_number();
                mistakes.add(
                    node.at,
                    format!("{key} must be a whole number from {from} to {to}{given}"),
                );
                None
            }
        }
    }

    /// A number.
    pub fn number(
        &mut self,
        key: &'static str,
        from: f64,
        to: f64,
        mistakes: &mut Mistakes,
    ) -> Option<f64> {
        let node = self.node(key)?;
        let number = number(node).filter(|number| (from..=to).contains(number));
        if number.is_none() {
            let given = node.other_than_a_number();
            mistakes.add(node.at, format!("{key} must be a number from {from} to {to}{given}"));
        }
        number
    }

    /// True or false.
    pub fn flag(&mut self, key: &'static str, mistakes: &mut Mistakes) -> bool {
        let Some(node) = self.node(key) else { return false };
        match node.value {
            Value::Bool(value) => value,
            _ => {
                mistakes.add(node.at, format!("{key} must be true or false, not {}", node.what()));
                false
            }
        }
    }

    /// A text.
    pub fn text(&mut self, key: &'static str, mistakes: &mut Mistakes) -> Option<(&'n str, usize)> {
        let node = self.node(key)?;
        let text = node.text();
        if text.is_none() {
            mistakes.add(node.at, format!("{key} must be a text in quotes, not {}", node.what()));
        }
        text.map(|text| (text, node.at))
    }

    /// A text or a list of texts.
    pub fn texts(
        &mut self,
        key: &'static str,
        mistakes: &mut Mistakes,
    ) -> Option<Vec<(&'n str, usize)>> {
        let node = self.node(key)?;
        Some(texts(node, key, mistakes))
    }

    /// The items of a list of tables, `[[key]]`.
    pub fn tables(
        &mut self,
        key: &'static str,
        most: usize,
        mistakes: &mut Mistakes,
    ) -> &'n [Node] {
        let Some(node) = self.node(key) else { return &[] };
        match &node.value {
            Value::List(items) if items.len() <= most => items,
            Value::List(_) => {
                mistakes.add(node.at, format!("at most {most} of [[{key}]]"));
                &[]
            }
            _ => {
                mistakes.add(
                    node.at,
                    format!("write [[{key}]] with two brackets: there may be several"),
                );
                &[]
            }
        }
    }

    /// Notes the fields that nobody asked for.
    pub fn finish(self, mistakes: &mut Mistakes) {
        for entry in self.entries.iter().filter(|entry| !self.asked.contains(&&*entry.key)) {
            mistakes.add(
                entry.at,
                format!(
                    "{} of {}",
                    unknown("field", &entry.key, self.asked.iter().copied()),
                    self.name
                ),
            );
        }
    }
}

/// The number that a value is.
pub(super) fn number(node: &Node) -> Option<f64> {
    match node.value {
        Value::Whole(number) => Some(number as f64),
        Value::Number(number) => Some(number),
        _ => None,
    }
}

/// A text or a list of texts.
pub(super) fn texts<'n>(
    node: &'n Node,
    key: &str,
    mistakes: &mut Mistakes,
) -> Vec<(&'n str, usize)> {
    let one = |node: &'n Node, mistakes: &mut Mistakes| {
        if node.text().is_none() {
            mistakes.add(node.at, format!("{key} takes texts in quotes, not {}", node.what()));
        }
        node.text().map(|text| (text, node.at))
    };
    match &node.value {
        Value::List(items) => items.iter().filter_map(|item| one(item, mistakes)).collect(),
        _ => one(node, mistakes).into_iter().collect(),
    }
}

/// So many whole numbers within bounds.
pub(super) fn wholes<const N: usize>(
    node: &Node,
    key: &str,
    from: i64,
    to: i64,
    mistakes: &mut Mistakes,
) -> Option<[i32; N]> {
    let found: Option<Vec<i32>> = match &node.value {
        Value::List(items) => items
            .iter()
            .map(|item| match item.value {
                Value::Whole(number) if (from..=to).contains(&number) => Some(number as i32),
                _ => None,
            })
            .collect(),
        _ => None,
    };
    let found = found.and_then(|numbers| numbers.try_into().ok());
    if found.is_none() {
        mistakes
            .add(node.at, format!("{key} must be a list of {N} whole numbers from {from} to {to}"));
    }
    found
}

/// A name of the user's own: of a zone, a counter, a cost term, a spawn.
pub(super) fn own_name(word: &str, at: usize, what: &str, mistakes: &mut Mistakes) -> bool {
    let letters = word.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
    let fits =
        letters && !word.is_empty() && word.len() <= 40 && !word.as_bytes()[0].is_ascii_digit();
    if !fits {
        mistakes.add(
            at,
            format!(
                "{what} `{}`: a name has 1 to 40 letters, digits and _, no digit first",
                excerpt(word)
            ),
        );
    }
    fits
}
