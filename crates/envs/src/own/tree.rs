//! A TOML text as a tree whose every value knows where it stands.

use super::mistakes::Mistakes;
use toml::de::{DeTable, DeValue};

/// A value and the byte of the text that it begins at.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub value: Value,
    pub at: usize,
}

/// What a value is.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Bool(bool),
    Whole(i64),
    Number(f64),
    Text(String),
    List(Vec<Node>),
    Table(Vec<Entry>),
    /// A date or a number out of range: nothing here takes it.
    Other,
}

/// A key with its value.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub key: String,
    pub at: usize,
    pub node: Node,
}

/// Deepest nesting that is read: far more than any task needs.
const DEEPEST: usize = 16;

/// The tree of a text; mistakes of its syntax are noted.
pub(super) fn parse(text: &str, mistakes: &mut Mistakes) -> Node {
    let (table, errors) = DeTable::parse_recoverable(text);
    for error in &errors {
        let at = error.span().map_or(0, |span| span.start);
        // The parser's own words, in one line.
        let message: Vec<&str> = error.message().lines().map(str::trim).collect();
        mistakes
            .add(at, format!("{}; https://toml.io shows how TOML is written", message.join(", ")));
    }
    Node { value: of_table(table.get_ref(), 0, mistakes), at: 0 }
}

fn of_table(table: &DeTable<'_>, depth: usize, mistakes: &mut Mistakes) -> Value {
    let mut entries: Vec<Entry> = Vec::with_capacity(table.len());
    for (key, value) in table {
        let node = of_value(value.get_ref(), value.span().start, depth + 1, mistakes);
        entries.push(Entry { key: key.get_ref().to_string(), at: key.span().start, node });
    }
    // The order of the text, not that of the alphabet: names are numbered by their first
    // appearance.
    entries.sort_by_key(|entry| entry.at);
    Value::Table(entries)
}

fn of_value(value: &DeValue<'_>, at: usize, depth: usize, mistakes: &mut Mistakes) -> Node {
    let value = match value {
        _ if depth > DEEPEST => {
            mistakes.add(
                at,
                format!("tables within tables, more than {DEEPEST} deep; nothing here is"),
            );
            Value::Other
        }
        DeValue::Boolean(value) => Value::Bool(*value),
        DeValue::Integer(value) => {
            let digits: String =
                value.as_str().chars().filter(|letter| !matches!(letter, '_' | '+')).collect();
            i64::from_str_radix(&digits, value.radix()).map_or(Value::Other, Value::Whole)
        }
        DeValue::Float(value) => {
            let digits: String = value.as_str().chars().filter(|letter| *letter != '_').collect();
            digits
                .parse()
                .ok()
                .filter(|number: &f64| number.is_finite())
                .map_or(Value::Other, Value::Number)
        }
        DeValue::String(text) => Value::Text(text.to_string()),
        DeValue::Datetime(_) => Value::Other,
        DeValue::Array(items) => Value::List(
            items
                .iter()
                .map(|item| of_value(item.get_ref(), item.span().start, depth + 1, mistakes))
                .collect(),
        ),
        DeValue::Table(table) => of_table(table, depth, mistakes),
    };
    Node { value, at }
}

impl Node {
    /// Where it and all within it stand.
    pub fn places(&self) -> Vec<usize> {
        let within: Vec<usize> = match &self.value {
            Value::List(nodes) => nodes.iter().flat_map(Node::places).collect(),
            Value::Table(entries) => entries
                .iter()
                .flat_map(|entry| [vec![entry.at], entry.node.places()].concat())
                .collect(),
            _ => Vec::new(),
        };
        [vec![self.at], within].concat()
    }

    /// An empty table.
    pub fn empty() -> Node {
        Node { value: Value::Table(Vec::new()), at: 0 }
    }

    /// What it is, for a message.
    pub fn what(&self) -> &'static str {
        match self.value {
            Value::Bool(_) => "true or false",
            Value::Whole(_) => "a whole number",
            Value::Number(_) => "a number",
            Value::Text(_) => "a text",
            Value::List(_) => "a list",
            Value::Table(_) => "a table",
            Value::Other => "a date or a number out of range",
        }
    }

    /// What to add to a message that asks for a number: `, not a list`; nothing where it is one.
    pub fn other_than_a_number(&self) -> String {
        match self.value {
            Value::Whole(_) | Value::Number(_) => String::new(),
            Value::Text(_) => ", without quotes".to_string(),
            _ => format!(", not {}", self.what()),
        }
    }

    /// The entry of a table.
    pub fn get(&self, key: &str) -> Option<&Entry> {
        let Value::Table(entries) = &self.value else { return None };
        entries.iter().find(|entry| entry.key == key)
    }

    /// The text that it is.
    pub fn text(&self) -> Option<&str> {
        if let Value::Text(text) = &self.value { Some(text) } else { None }
    }
}
