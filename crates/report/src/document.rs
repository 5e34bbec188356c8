//! A report before it is written down: sections of text, tables, figures and pictures.

use crate::chart::Drawing;

/// The whole report.
#[derive(Clone, Debug, Default)]
pub struct Document {
    /// Its title.
    pub title: String,
    /// A line of facts below the title.
    pub subtitle: String,
    /// The sections.
    pub sections: Vec<Section>,
}

/// A part of the report.
#[derive(Clone, Debug, Default)]
pub struct Section {
    /// Name in links and files: lower-case letters and dashes.
    pub slug: String,
    /// Its title.
    pub title: String,
    /// What it shows and how it was made.
    pub text: Vec<String>,
    /// What it holds, in order.
    pub blocks: Vec<Block>,
}

/// A table, figure or picture.
#[derive(Clone, Debug)]
pub enum Block {
    /// A heading inside the section.
    Heading(String),
    /// A table.
    Table(Table),
    /// A figure: SVG and PNG.
    Figure(Figure),
    /// A picture with pixels.
    Image(Image),
}

/// A figure with the name of its files.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Name of its files, without ending.
    pub slug: String,
    /// What it shows.
    pub caption: String,
    /// The shapes.
    pub drawing: Drawing,
}

/// A picture with the name of its file.
#[derive(Clone, Debug)]
pub struct Image {
    /// Name of its file, with ending (`.png`, `.gif`).
    pub file: String,
    /// What it shows.
    pub caption: String,
    /// The bytes of the file.
    pub bytes: Vec<u8>,
    /// Width and height at which it is shown.
    pub size: (usize, usize),
}

/// A table.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// What it shows.
    pub caption: String,
    /// Heads that span several columns, with their numbers of columns; may be empty.
    pub spans: Vec<(String, usize)>,
    /// Head of each column.
    pub heads: Vec<String>,
    /// Rows of as many cells.
    pub rows: Vec<Vec<Cell>>,
}

/// How a cell is marked.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Mark {
    /// Not at all.
    #[default]
    None,
    /// The cost is within the budget: green.
    Within,
    /// The best return within the budget, or the least cost if none is: bold.
    Best,
    /// Both.
    WithinBest,
}

/// A cell.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Cell {
    /// What is read.
    pub text: String,
    /// Small letters beside it, such as the number of seeds.
    pub note: String,
    /// What rows are sorted by, if it is a number.
    pub sort: Option<f64>,
    /// What it tells when pointed at.
    pub title: String,
    /// Green, bold.
    pub mark: Mark,
    /// Pale: a published value, or a word of less weight.
    pub pale: bool,
}

impl Cell {
    /// A cell of words.
    #[must_use]
    pub fn text(text: impl Into<String>) -> Cell {
        Cell { text: text.into(), ..Cell::default() }
    }

    /// A cell of a number.
    #[must_use]
    pub fn number(value: f64) -> Cell {
        Cell { text: number(value), sort: Some(value), ..Cell::default() }
    }

    /// The same cell, reading otherwise.
    #[must_use]
    pub fn with_text(mut self, text: impl Into<String>) -> Cell {
        self.text = text.into();
        self
    }

    /// A cell of a mean with its interval and the number of samples.
    #[must_use]
    pub fn estimate(estimate: Option<crate::statistics::Estimate>, samples: &[f64]) -> Cell {
        let Some(estimate) = estimate else { return Cell { text: "-".into(), pale: true, ..Cell::default() } };
        let half = estimate.half_width.map_or_else(String::new, |half| format!(" ± {}", number(half)));
        let listed: Vec<String> = samples.iter().take(12).map(|sample| number(*sample)).collect();
        Cell {
            text: format!("{}{half}", number(estimate.mean)),
            note: format!("n={}", estimate.n),
            sort: Some(estimate.mean),
            title: format!("{}{}", listed.join(", "), if samples.len() > 12 { ", ..." } else { "" }),
            ..Cell::default()
        }
    }
}

/// A number with about four digits, as a reader compares them.
#[must_use]
pub fn number(value: f64) -> String {
    match value.abs() {
        size if size >= 1000.0 => format!("{value:.0}"),
        size if size >= 100.0 => format!("{value:.1}"),
        _ => format!("{value:.2}"),
    }
}

/// A number of frames: 2M, 500k.
#[must_use]
pub fn frames(value: f64) -> String {
    let (scaled, unit) = match value {
        v if v >= 1e9 => (v / 1e9, "G"),
        v if v >= 1e6 => (v / 1e6, "M"),
        v if v >= 1e3 => (v / 1e3, "k"),
        v => (v, ""),
    };
    let text = format!("{scaled:.2}");
    format!("{}{unit}", text.trim_end_matches('0').trim_end_matches('.'))
}

/// A name for links and files: lower-case letters, digits and dashes.
#[must_use]
pub fn slug(text: &str) -> String {
    let mut slug = String::new();
    for character in text.chars().flat_map(char::to_lowercase) {
        if character.is_ascii_alphanumeric() {
            slug.push(character);
        } else if !slug.ends_with('-') && !slug.is_empty() {
            slug.push('-');
        }
    }
    let slug = slug.trim_end_matches('-');
    // File systems end names at 255 bytes.
    slug.chars().take(120).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_names_read_well() {
        assert_eq!([1234.5, 123.45, 12.345, -0.5].map(number), ["1234", "123.5", "12.35", "-0.50"].map(String::from));
        assert_eq!([2e6, 1.5e6, 409_600.0, 5e8, 12.0].map(frames), ["2M", "1.5M", "409.6k", "500M", "12"].map(String::from));
        assert_eq!(slug("Volcanic Venture: PPO/Lag  (x=1)"), "volcanic-venture-ppo-lag-x-1");
    }
}
