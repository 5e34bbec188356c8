//! What the repository's files say of each other: whoever clones it has everything that they name.

use std::path::{Path, PathBuf};

fn repository() -> PathBuf {
    Path::new("../..").canonicalize().unwrap()
}

/// Text files of the repository, without what is built.
fn files(folder: &Path, endings: &[&str], into: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir()
            && !name.starts_with('.')
            && !["target", "runs", "node_modules"].contains(&name.as_str())
        {
            files(&path, endings, into);
        } else if path
            .extension()
            .is_some_and(|ending| endings.iter().any(|known| ending == *known))
        {
            into.push(path);
        }
    }
}

/// Pages that lie outside of the repository are not named: what they mean is said instead.
#[test]
fn nothing_outside_of_the_repository_is_named() {
    let outside =
        ["DECISIONS", "training", "scenarios", "rendering", "engine", "measured", "python"];
    let mut all = Vec::new();
    files(&repository(), &["rs", "md", "toml", "csv", "py", "json", "js", "css", "html"], &mut all);
    assert!(all.len() > 300, "{} files", all.len());
    for path in all {
        let Ok(text) = std::fs::read_to_string(&path) else { continue };
        for page in outside {
            let page = format!("{page}.md`");
            assert!(!text.contains(&page), "{} names `{page}", path.display());
        }
        assert!(
            !text.contains(concat!("`spec", "/")),
            "{} names a page of the specification",
            path.display()
        );
    }
}

/// Every relative link of a page leads to something.
#[test]
fn links_lead_somewhere() {
    let mut pages = Vec::new();
    files(&repository(), &["md"], &mut pages);
    for page in pages {
        let text = std::fs::read_to_string(&page).unwrap();
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let target = link.split(['#', ' ']).next().unwrap_or_default();
            let elsewhere =
                ["http://", "https://", "mailto:"].iter().any(|scheme| target.starts_with(scheme));
            if !target.is_empty() && !elsewhere {
                let there = page.parent().unwrap().join(target);
                assert!(there.exists(), "{} links to {target}", page.display());
            }
        }
    }
}

/// Every page of the documentation stands in the book's summary once, and the summary names no
/// other.
#[test]
fn every_page_is_in_the_book() {
    let docs = repository().join("docs");
    let mut pages = Vec::new();
    files(&docs, &["md"], &mut pages);
    let mut pages: Vec<PathBuf> =
        pages.iter().map(|page| page.strip_prefix(&docs).unwrap().to_owned()).collect();
    pages.retain(|page| page != Path::new("SUMMARY.md"));
    let summary = std::fs::read_to_string(docs.join("SUMMARY.md")).unwrap();
    let mut named: Vec<PathBuf> = summary
        .split("](")
        .skip(1)
        .filter_map(|rest| rest.split(')').next())
        .map(PathBuf::from)
        .collect();
    pages.sort();
    named.sort();
    assert_eq!(named, pages, "docs/SUMMARY.md names the pages on the left");
}
