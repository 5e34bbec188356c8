//! Texts of users inside HTML, SVG, Markdown, CSV and messages.

/// A text for HTML and SVG, inside elements and quoted attributes.
#[must_use]
pub fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            // Control characters are no XML at all.
            c if c.is_control() && c != '\n' && c != '\t' => escaped.push('\u{fffd}'),
            c => escaped.push(c),
        }
    }
    escaped
}

/// A text for a cell of a Markdown table.
#[must_use]
pub fn escape_markdown(text: &str) -> String {
    text.replace('\\', "\\\\").replace('|', "\\|").replace('<', "&lt;").replace(['\n', '\r'], " ")
}

/// A field of a CSV file: quoted where it must be.
#[must_use]
pub fn escape_csv(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

/// A message that may quote a file by anyone: one line of bounded length, and nothing in it
/// commands a terminal.
#[must_use]
pub fn one_line(problem: &str) -> String {
    let cut = problem.chars().take(1000);
    cut.map(|letter| if letter.is_control() { '\u{fffd}' } else { letter }).collect()
}
