//! The report as one HTML page that asks nothing of a network: styles, script, figures and pictures
//! are inside.

use crate::chart::{INK_STYLE, inline_svg};
use crate::document::{Block, Cell, Document, Section, Table};
use crate::escape::escape;
use crate::run::Kept;
use std::fmt::Write;

const STYLE: &str = include_str!("page.css");
/// The script of every page, as it stands between its tags: who serves a page can allow this one
/// and no other.
pub const SCRIPT: &str = include_str!("page.js");

/// Long lists of everything, which open on a click (or by a link to them).
const FOLDED: [&str; 3] = ["experiments", "runs", "players"];
/// Tables and figures of a section that are open from the start: those of the longest runs come
/// first.
const OPEN: usize = 8;

/// Writes the page.
#[must_use]
pub fn page(document: &Document) -> String {
    let mut html = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\
         <meta name=\"color-scheme\" content=\"light dark\"><title>{title}</title><style>{INK_STYLE}{STYLE}</style></head><body>\n\
         <header><h1>{title}</h1><p>{}</p></header>\n<nav>",
        escape(&document.subtitle),
        title = escape(&document.title)
    );
    for section in &document.sections {
        let _ = write!(html, "<a href=\"#{}\">{}</a>", section.slug, escape(&section.title));
    }
    html.push_str("</nav>\n<main>\n");
    for section in &document.sections {
        write_section(section, &mut html);
    }
    let _ = writeln!(
        html,
        "</main><div id=\"tip\" hidden></div><script>{SCRIPT}</script></body></html>"
    );
    html
}

fn write_section(section: &Section, html: &mut String) {
    let folded = FOLDED.contains(&section.slug.as_str());
    let (open, close) = if folded { ("<details><summary>", "</summary>") } else { ("", "") };
    let _ = writeln!(
        html,
        "<section id=\"{}\">{open}<h2>{}</h2>{close}",
        section.slug,
        escape(&section.title)
    );
    for text in &section.text {
        let _ = writeln!(html, "<p>{}</p>", with_code(&escape(text)));
    }
    let more = section.blocks.len() - OPEN.min(section.blocks.len());
    for (at, block) in section.blocks.iter().enumerate() {
        if at == OPEN && !folded {
            let _ = writeln!(
                html,
                "<details><summary>{more} more, of shorter runs or other levels</summary>"
            );
        }
        match block {
            Block::Heading(text) => {
                let _ = writeln!(html, "<h3>{}</h3>", escape(text));
            }
            Block::Table(table) => write_table(table, html),
            Block::Figure(figure) => {
                let label = if figure.caption.is_empty() { &figure.slug } else { &figure.caption };
                let _ = writeln!(
                    html,
                    "<figure>{}<figcaption>{}</figcaption></figure>",
                    inline_svg(&figure.drawing, label),
                    escape(&figure.caption)
                );
            }
            Block::Image(image) => {
                let kind = if image.file.ends_with(".gif") { "gif" } else { "png" };
                let _ = writeln!(
                    html,
                    "<figure><img alt=\"{caption}\" width=\"{}\" height=\"{}\" src=\"data:image/{kind};base64,{}\"><figcaption>{caption}</figcaption></figure>",
                    image.size.0,
                    image.size.1,
                    base64(&image.bytes),
                    caption = escape(&image.caption),
                );
            }
        }
    }
    html.push_str(if folded || more > 0 { "</details></section>\n" } else { "</section>\n" });
}

/// What stands between two backticks in a text, as code.
fn with_code(text: &str) -> String {
    let mut parts = text.split('`').peekable();
    let mut html = String::new();
    let mut code = false;
    while let Some(part) = parts.next() {
        // A last backtick without a partner stays as it is.
        match (code, parts.peek()) {
            (false, _) => html += part,
            (true, Some(_)) => html += &format!("<code>{part}</code>"),
            (true, None) => html += &format!("`{part}"),
        }
        code = !code;
    }
    html
}

fn write_table(table: &Table, html: &mut String) {
    // The caption stands outside of what scrolls sideways.
    if !table.caption.is_empty() {
        let _ = write!(html, "<p class=\"caption\">{}</p>", escape(&table.caption));
    }
    let words =
        table.heads.len() < 4 && !table.rows.iter().flatten().any(|cell| cell.sort.is_some());
    let _ = write!(
        html,
        "<div class=\"wide{}{}\"><table>",
        if words { " words" } else { "" },
        if table.heads.len() > 10 { " many" } else { "" }
    );
    html.push_str("<thead>");
    if !table.spans.is_empty() {
        html.push_str("<tr class=\"spans\">");
        for (head, columns) in &table.spans {
            let _ = write!(html, "<th colspan=\"{columns}\">{}</th>", escape(head));
        }
        html.push_str("</tr>");
    }
    html.push_str("<tr class=\"heads\">");
    for (column, head) in table.heads.iter().enumerate() {
        let class = if table.rows.iter().any(|row| is_number(&row[column])) {
            " class=\"number\""
        } else {
            ""
        };
        let _ = write!(
            html,
            "<th scope=\"col\"{class} tabindex=\"0\" aria-sort=\"none\">{}</th>",
            escape(head)
        );
    }
    html.push_str("</tr></thead><tbody>");
    for row in &table.rows {
        html.push_str("<tr>");
        for cell in row {
            write_cell(cell, html);
        }
        html.push_str("</tr>");
    }
    html.push_str("</tbody></table></div>\n");
}

/// Whether a cell reads as a number. A word may carry one to be sorted by; it is still read from
/// the left.
fn is_number(cell: &Cell) -> bool {
    cell.sort.is_some() && cell.text.starts_with(|c: char| c.is_ascii_digit() || c == '-')
}

fn write_cell(cell: &Cell, html: &mut String) {
    let mut classes = Vec::new();
    classes.extend(cell.pale.then_some("pale"));
    classes.extend((is_number(cell) || cell.text == "-").then_some("number"));
    classes.extend((cell.mark.kept == Kept::Surely).then_some("within"));
    classes.extend((cell.mark.kept == Kept::ByMean).then_some("nearly"));
    classes.extend(cell.mark.bold.then_some("best"));
    html.push_str("<td");
    if !classes.is_empty() {
        let _ = write!(html, " class=\"{}\"", classes.join(" "));
    }
    if let Some(sort) = cell.sort {
        let _ = write!(html, " data-sort=\"{sort}\"");
    }
    if !cell.title.is_empty() {
        let _ = write!(html, " title=\"{}\"", escape(&cell.title));
    }
    let _ = write!(html, ">{}", escape(&cell.text));
    if !cell.note.is_empty() {
        let _ = write!(html, " <small>{}</small>", escape(&cell.note));
    }
    html.push_str("</td>");
}

/// Bytes as text, for a `data:` address or the hash of a script (RFC 4648).
#[must_use]
pub fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let word = u32::from_be_bytes([
            0,
            three[0],
            *three.get(1).unwrap_or(&0),
            *three.get(2).unwrap_or(&0),
        ]);
        for place in 0..4 {
            let letter = LETTERS[(word >> (18 - 6 * place)) as usize & 63];
            text.push(if place <= three.len() { char::from(letter) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{base64, with_code};

    #[test]
    fn backticks_mark_code() {
        assert_eq!(with_code("say `a b` and `c`."), "say <code>a b</code> and <code>c</code>.");
        assert_eq!(with_code("one ` alone"), "one ` alone");
    }

    #[test]
    fn base64_as_in_the_rfc() {
        let pairs = [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ];
        for (plain, coded) in pairs {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
    }
}
