//! A report before it is written down: sections of text, tables, figures and pictures.

use crate::chart::Drawing;
use crate::run::Kept;

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

impl Table {
    /// The same without those of the named columns in which all rows say the same: the caption says
    /// it once.
    #[must_use]
    pub fn folded(mut self, heads: &[&str]) -> Table {
        for head in heads {
            let Some(column) = self.heads.iter().position(|own| own == head) else { continue };
            if *head == "options" {
                self.share_options(column);
            }
            let all_the_same =
                self.rows.windows(2).all(|pair| pair[0][column].text == pair[1][column].text);
            if self.rows.len() < 2 || !all_the_same {
                continue;
            }
            let said = match &self.rows[0][column].text {
                text if ["level", "budget", "frames"].contains(head) => format!("{head} {text}"),
                text => text.clone(),
            };
            if !said.is_empty() && said != "-" {
                self.caption = if self.caption.is_empty() {
                    said
                } else {
                    format!("{}; {said}", self.caption)
                };
            }
            self.heads.remove(column);
            self.rows.iter_mut().for_each(|row| drop(row.remove(column)));
            let mut before = 0;
            for span in &mut self.spans {
                before += span.1;
                if column < before {
                    span.1 -= 1;
                    break;
                }
            }
        }
        self
    }
}

impl Table {
    /// Takes what all rows' options have in common out of them and into the caption.
    fn share_options(&mut self, column: usize) {
        let parts = |row: &Vec<Cell>| {
            row[column].text.split(", ").map(String::from).collect::<Vec<String>>()
        };
        let Some((first, rest)) = self.rows.split_first().filter(|(_, rest)| !rest.is_empty())
        else {
            return;
        };
        let rest: Vec<Vec<String>> = rest.iter().map(parts).collect();
        let shared: Vec<String> = parts(first)
            .into_iter()
            .filter(|part| !part.is_empty() && rest.iter().all(|own| own.contains(part)))
            .collect();
        if shared.is_empty() {
            return;
        }
        for row in &mut self.rows {
            let own: Vec<String> =
                parts(row).into_iter().filter(|part| !shared.contains(part)).collect();
            row[column].text = own.join(", ");
        }
        let said = shared.join(", ");
        self.caption =
            if self.caption.is_empty() { said } else { format!("{}; {said}", self.caption) };
    }
}

/// How a cell is marked.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Mark {
    /// How the cost stands to the budget: green letters if its mean is within, on green ground if
    /// surely.
    pub kept: Kept,
    /// Bold: the best return within the budget and what cannot be distinguished from it; the least
    /// cost if none is within.
    pub bold: bool,
}

impl Mark {
    /// A cost that stands so to its budget.
    #[must_use]
    pub fn of(kept: Kept) -> Mark {
        Mark { kept, bold: false }
    }
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
    /// What it says when pointed at.
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
        let Some(estimate) = estimate else {
            return Cell { text: "-".into(), pale: true, ..Cell::default() };
        };
        let half = estimate
            .half_width
            .map_or_else(String::new, |half| format!(" ± {}", like(half, estimate.mean)));
        let listed: Vec<String> = samples.iter().take(12).map(|sample| number(*sample)).collect();
        Cell {
            text: format!("{}{half}", number(estimate.mean)),
            note: format!("n={}", estimate.n),
            sort: Some(estimate.mean),
            title: format!(
                "{}{}",
                listed.join(", "),
                if samples.len() > 12 { ", ..." } else { "" }
            ),
            ..Cell::default()
        }
    }
}

/// A number with about four digits, as a reader compares them.
#[must_use]
pub fn number(value: f64) -> String {
    // What rounds to zero is zero, not "-0.00".
    let value = if value.abs() < 0.005 { 0.0 } else { value };
    match value.abs() {
        size if size >= 1000.0 => format!("{value:.0}"),
        size if size >= 100.0 => format!("{value:.1}"),
        _ => format!("{value:.2}"),
    }
}

/// A number with as many decimals as another that it stands beside.
fn like(value: f64, beside: f64) -> String {
    match beside.abs() {
        size if size >= 1000.0 => format!("{value:.0}"),
        size if size >= 100.0 => format!("{value:.1}"),
        _ => format!("{value:.2}"),
    }
}

/// A number of frames: 2M, 500k.
#[must_use]
pub fn frames(value: f64) -> String {
    // The sum of no runs is -0.
    let value = if value == 0.0 { 0.0 } else { value };
    let (scaled, unit) = match value {
        v if v >= 1e9 => (v / 1e9, "G"),
        v if v >= 1e6 => (v / 1e6, "M"),
        v if v >= 1e3 => (v / 1e3, "k"),
        v => (v, ""),
    };
    let text = format!("{scaled:.2}");
    format!("{}{unit}", text.trim_end_matches('0').trim_end_matches('.'))
}

/// A count with its noun: 1 run, 2 runs.
#[must_use]
pub fn count(number: usize, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
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
    fn what_all_rows_say_is_said_once() {
        let row = |cells: [&str; 3]| cells.map(Cell::text).to_vec();
        let table = Table {
            spans: vec![(String::new(), 2), ("x".into(), 1)],
            heads: ["level", "algorithm", "options"].map(String::from).to_vec(),
            rows: vec![row(["1", "PPO", "rules tables"]), row(["1", "P3O", "rules tables"])],
            ..Table::default()
        };
        let folded = table.folded(&["level", "algorithm", "options"]);
        assert_eq!((folded.caption.as_str(), folded.heads.len()), ("level 1; rules tables", 1));
        assert_eq!(
            (folded.rows[1][0].text.as_str(), folded.spans[0].1, folded.spans[1].1),
            ("P3O", 1, 0)
        );
        // Options are shared part by part.
        let heads = ["algorithm", "options"].map(String::from).to_vec();
        let rows = [["PPO", "hard true, rules tables"], ["P3O", "rules tables"]]
            .map(|cells| cells.map(Cell::text).to_vec())
            .to_vec();
        let folded = Table { heads, rows, ..Table::default() }.folded(&["options"]);
        let left: Vec<&str> = folded.rows.iter().map(|row| row[1].text.as_str()).collect();
        assert_eq!((folded.caption.as_str(), left), ("rules tables", vec!["hard true", ""]));
    }

    #[test]
    fn numbers_and_names_read_well() {
        assert_eq!(
            [1234.5, 123.45, 12.345, -0.5].map(number),
            ["1234", "123.5", "12.35", "-0.50"].map(String::from)
        );
        assert_eq!(
            [2e6, 1.5e6, 409_600.0, 5e8, 12.0].map(frames),
            ["2M", "1.5M", "409.6k", "500M", "12"].map(String::from)
        );
        assert_eq!(
            (number(-0.001), frames(-0.0), count(1, "run"), count(0, "run")),
            ("0.00".into(), "0".into(), "1 run".into(), "0 runs".into())
        );
        assert_eq!(slug("Volcanic Venture: PPO/Lag  (x=1)"), "volcanic-venture-ppo-lag-x-1");
    }
}
