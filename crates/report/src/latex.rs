//! The report's tables for a paper: LaTeX with `booktabs`, each to be put in by `\input`.

use crate::document::{Block, Cell, Document, Section, Table};
use crate::run::Kept;
use std::fmt::Write;

/// What a document that puts the tables in needs in its head.
pub const HEAD: &str = "% Tables of `hasard report --latex`. In the head of your document:\n\
    %   \\usepackage{booktabs,longtable,xcolor,graphicx}\n\
    % Green: the cost is within the budget, underlined: with the upper end of its 95 % interval.\n\
    \\providecommand{\\within}[1]{\\textcolor{green!45!black}{#1}}\n\
    \\providecommand{\\surely}[1]{\\within{\\underline{#1}}}\n\n";

/// Sections that are lists of files, which no paper prints.
const LEFT_OUT: [&str; 3] = ["runs", "warnings", "paper"];

/// Rows that a page holds: a table of more goes on over the next ones.
const PAGE: usize = 45;

/// One file of all tables and figures, a section after the other.
#[must_use]
pub fn latex(document: &Document, figures: &str) -> String {
    let mut text = String::from(HEAD);
    for section in
        document.sections.iter().filter(|section| !LEFT_OUT.contains(&section.slug.as_str()))
    {
        write_section(section, figures, &mut text);
    }
    text
}

/// A whole document around `tables.tex`, to look at it.
pub const DOCUMENT: &str = "\\documentclass{article}\n\\usepackage[a4paper,landscape,margin=15mm]{geometry}\n\
    \\usepackage{booktabs,longtable,xcolor,graphicx}\n\\usepackage[T1]{fontenc}\n\\begin{document}\n\\input{tables}\n\\end{document}\n";

fn write_section(section: &Section, figures: &str, text: &mut String) {
    let mut number = 0;
    for block in &section.blocks {
        match block {
            Block::Table(table) => {
                number += 1;
                let caption = captioned(section, &table.caption);
                write_table(table, &caption, &format!("{}-{number}", section.slug), text);
            }
            Block::Figure(figure) => {
                let _ = writeln!(
                    text,
                    "\\begin{{figure}}\\centering\n\\includegraphics[width=\\linewidth]{{{figures}/{}.pdf}}\n\\caption{{{}}}\\label{{fig:{}}}\n\\end{{figure}}\n",
                    figure.slug,
                    escaped(&captioned(section, &figure.caption)),
                    figure.slug
                );
            }
            Block::Heading(_) | Block::Image(_) => {}
        }
    }
}

/// A caption that says of which section it is, for in a paper no heading stands above it.
fn captioned(section: &Section, caption: &str) -> String {
    if caption.is_empty() { section.title.clone() } else { format!("{}: {caption}", section.title) }
}

fn write_table(table: &Table, caption: &str, label: &str, text: &mut String) {
    let long = table.rows.len() > PAGE;
    let is_number = |column: usize| table.rows.iter().any(|row| row[column].sort.is_some());
    let columns: String =
        (0..table.heads.len()).map(|column| if is_number(column) { 'r' } else { 'l' }).collect();
    let caption = format!("\\caption{{{}}}\\label{{tab:{label}}}", escaped(caption));
    let _ = if long {
        // It cannot be shrunk to the width of the page, and so has small letters.
        writeln!(
            text,
            "{{\\scriptsize\\setlength{{\\tabcolsep}}{{2pt}}\n\\begin{{longtable}}{{{columns}}}\n{caption}\\\\\n\\toprule"
        )
    } else {
        writeln!(
            text,
            "\\begin{{table}}\\centering\\small\n{caption}\n\
             \\resizebox{{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}}{{!}}{{%\n\\begin{{tabular}}{{{columns}}}\n\\toprule"
        )
    };
    if !table.spans.is_empty() {
        let heads: Vec<String> = table
            .spans
            .iter()
            .map(|(head, columns)| format!("\\multicolumn{{{columns}}}{{c}}{{{}}}", escaped(head)))
            .collect();
        let _ = writeln!(text, "{} \\\\", heads.join(" & "));
        let mut first = 1;
        for (head, columns) in &table.spans {
            if !head.is_empty() && *columns > 0 {
                let _ = write!(text, "\\cmidrule(lr){{{first}-{}}}", first + columns - 1);
            }
            first += columns;
        }
        text.push('\n');
    }
    let heads: Vec<String> = table.heads.iter().map(|head| escaped(head)).collect();
    let _ = writeln!(text, "{} \\\\\n\\midrule", heads.join(" & "));
    if long {
        text.push_str("\\endhead\n");
    }
    for row in &table.rows {
        let _ = writeln!(text, "{} \\\\", row.iter().map(cell).collect::<Vec<_>>().join(" & "));
    }
    text.push_str(if long {
        "\\bottomrule\n\\end{longtable}}\n\n"
    } else {
        "\\bottomrule\n\\end{tabular}}\n\\end{table}\n\n"
    });
}

fn cell(cell: &Cell) -> String {
    let mut text = escaped(&cell.text);
    if cell.mark.bold && text != "-" {
        text = format!("\\textbf{{{text}}}");
    }
    match cell.mark.kept {
        Kept::Surely => text = format!("\\surely{{{text}}}"),
        Kept::ByMean => text = format!("\\within{{{text}}}"),
        Kept::Over | Kept::Unknown => {}
    }
    if cell.pale && text != "-" {
        text = format!("\\textit{{{text}}}");
    }
    if !cell.note.is_empty() {
        let _ = write!(text, " {{\\scriptsize {}}}", escaped(&cell.note));
    }
    text
}

/// A text in which nothing is a command.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '\\' => out.push_str("\\textbackslash{}"),
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => {
                out.push('\\');
                out.push(character);
            }
            '~' => out.push_str("\\textasciitilde{}"),
            '^' => out.push_str("\\textasciicircum{}"),
            '<' => out.push_str("\\textless{}"),
            '>' => out.push_str("\\textgreater{}"),
            '±' => out.push_str("$\\pm$"),
            '†' => out.push_str("$\\dagger$"),
            '‡' => out.push_str("$\\ddagger$"),
            '’' => out.push('\''),
            // What no common font of LaTeX has must not end its run.
            other if other.is_ascii_graphic() || other == ' ' => out.push(other),
            other if other.is_alphabetic() && other < '\u{180}' => out.push(other),
            _ => out.push('?'),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Mark;

    #[test]
    fn a_table_is_booktabs_and_no_text_is_a_command() {
        let bold = Cell {
            mark: Mark { kept: Kept::Surely, bold: true },
            sort: Some(3.0),
            ..Cell::text("3.00 ± 0.50")
        };
        let table = Table {
            caption: String::new(),
            spans: vec![(String::new(), 1), ("Remedy_Rush".into(), 1)],
            heads: vec!["algorithm".into(), "return".into()],
            rows: vec![vec![Cell::text("PPO & more"), bold]],
        };
        let mut text = String::new();
        write_table(&table, "50 % of \\input{x}", "main-1", &mut text);
        for part in [
            "\\caption{50 \\% of \\textbackslash{}input\\{x\\}}\\label{tab:main-1}",
            "\\begin{tabular}{lr}\n\\toprule\n\\multicolumn{1}{c}{} & \\multicolumn{1}{c}{Remedy\\_Rush} \\\\\n\\cmidrule(lr){2-2}",
            "PPO \\& more & \\surely{\\textbf{3.00 $\\pm$ 0.50}} \\\\\n\\bottomrule",
        ] {
            assert!(text.contains(part), "{part}\n{text}");
        }
    }

    #[test]
    fn a_table_of_more_rows_than_a_page_goes_on_over_the_next() {
        let mut table = Table {
            heads: vec!["seed".into()],
            rows: (0..=PAGE).map(|seed| vec![Cell::number(seed as f64)]).collect(),
            ..Table::default()
        };
        let written = |table: &Table| {
            let mut text = String::new();
            write_table(table, "all", "all-1", &mut text);
            text
        };
        let long = written(&table);
        for part in [
            "\\begin{longtable}{r}\n\\caption{all}",
            "\\midrule\n\\endhead\n0.00 \\\\",
            "\\end{longtable}}",
        ] {
            assert!(long.contains(part), "{part}\n{long}");
        }
        table.rows.pop();
        assert!(!written(&table).contains("longtable"));
    }
}
