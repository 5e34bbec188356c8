//! The book's table of contents, as mdBook reads it: headings, and lists of links.

/// A line of the contents.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Entry {
    /// Its words.
    pub title: String,
    /// The page, from the clone's root; a heading has none.
    pub page: Option<String>,
    /// How deep it stands in its list.
    pub depth: usize,
}

/// The entries of a summary whose links begin in `folder`.
pub(super) fn entries(summary: &str, folder: &str) -> Vec<Entry> {
    let line = |line: &str| {
        if line.starts_with("# Summary") {
            return None;
        }
        if let Some(title) = line.strip_prefix("# ") {
            return Some(Entry { title: title.trim().into(), page: None, depth: 0 });
        }
        let depth = line.chars().take_while(|letter| *letter == ' ').count() / 2;
        let rest = line.trim_start().strip_prefix("- ").unwrap_or(line.trim_start());
        let (title, page) = rest.strip_prefix('[')?.split_once("](")?;
        let page = page.strip_suffix(')')?;
        Some(Entry { title: title.into(), page: Some(format!("{folder}/{page}")), depth })
    };
    summary.lines().filter_map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_links_and_depths_are_read() {
        let text =
            "# Summary\n\n[hasard](index.md)\n\n# Use\n\n- [A](a.md)\n  - [B b](x/b.md)\nwords\n";
        let said: Vec<(String, Option<String>, usize)> = entries(text, "docs")
            .into_iter()
            .map(|entry| (entry.title, entry.page, entry.depth))
            .collect();
        let page = |name: &str| Some(format!("docs/{name}"));
        assert_eq!(
            said,
            [
                ("hasard".into(), page("index.md"), 0),
                ("Use".into(), None, 0),
                ("A".into(), page("a.md"), 0),
                ("B b".into(), page("x/b.md"), 1),
            ]
        );
    }
}
