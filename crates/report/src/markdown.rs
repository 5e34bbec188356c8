//! The report as Markdown, its figures beside it as files.

use crate::document::{Block, Cell, Document, Table};
use crate::escape::escape_markdown;
use crate::run::Kept;
use std::fmt::Write;

/// Folder of figures and pictures, beside the Markdown file.
pub const FIGURES: &str = "figures";

/// What stands below the title of every report: by this line the folder of an earlier one is known.
pub const LEGEND: &str = "A ✓ stands for green ground, a (✓) for green letters.";

/// Writes the report. Bold is bold; a tick stands for green ground, one in brackets for green
/// letters.
#[must_use]
pub fn markdown(document: &Document) -> String {
    let mut text = format!(
        "# {}\n\n{}\n\n{LEGEND}\n",
        escape_markdown(&document.title),
        escape_markdown(&document.subtitle)
    );
    for section in &document.sections {
        let _ = write!(text, "\n## {}\n", escape_markdown(&section.title));
        for paragraph in &section.text {
            let _ = write!(text, "\n{}\n", escape_markdown(paragraph));
        }
        for block in &section.blocks {
            let _ = match block {
                Block::Heading(heading) => write!(text, "\n### {}\n", escape_markdown(heading)),
                Block::Table(table) => {
                    text.push_str(&markdown_table(table));
                    Ok(())
                }
                Block::Figure(figure) => {
                    write!(
                        text,
                        "\n![{}]({FIGURES}/{}.svg)\n",
                        escape_markdown(&figure.caption),
                        figure.slug
                    )
                }
                Block::Image(image) => write!(
                    text,
                    "\n![{}]({FIGURES}/{})\n",
                    escape_markdown(&image.caption),
                    image.file
                ),
            };
        }
    }
    text
}

fn markdown_table(table: &Table) -> String {
    let mut text = String::from("\n");
    if !table.caption.is_empty() {
        let _ = write!(text, "**{}**\n\n", escape_markdown(&table.caption));
    }
    // Markdown has one row of heads: a head that spans columns is put before each of theirs.
    let mut heads = Vec::new();
    let spans =
        table.spans.iter().flat_map(|(head, columns)| std::iter::repeat_n(head.as_str(), *columns));
    for (head, span) in table.heads.iter().zip(spans.chain(std::iter::repeat(""))) {
        heads.push(escape_markdown(format!("{span} {head}").trim()));
    }
    let _ = writeln!(text, "| {} |", heads.join(" | "));
    let rule = |column: usize| {
        if table.rows.iter().any(|row| row[column].sort.is_some()) { "---:" } else { "---" }
    };
    let _ = writeln!(text, "| {} |", (0..heads.len()).map(rule).collect::<Vec<_>>().join(" | "));
    for row in &table.rows {
        let _ =
            writeln!(text, "| {} |", row.iter().map(markdown_cell).collect::<Vec<_>>().join(" | "));
    }
    text
}

fn markdown_cell(cell: &Cell) -> String {
    let mut text = escape_markdown(&cell.text);
    if cell.pale && text != "-" {
        text = format!("*{text}*");
    }
    if cell.mark.bold && text != "-" {
        text = format!("**{text}**");
    }
    text += match cell.mark.kept {
        Kept::Surely => " ✓",
        Kept::ByMean => " (✓)",
        Kept::Over | Kept::Unknown => "",
    };
    if !cell.note.is_empty() {
        let _ = write!(text, " ({})", escape_markdown(&cell.note));
    }
    text
}
