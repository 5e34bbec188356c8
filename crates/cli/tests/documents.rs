//! What the repository's files say of each other: a clone has everything that they name.

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

/// What a link to a heading calls it: lower case, spaces as dashes, other signs left out.
fn marks(page: &str) -> Vec<String> {
    let mut code = false;
    let mut found: Vec<String> = Vec::new();
    for line in page.lines() {
        code ^= line.trim_start().starts_with("```");
        let text = line.trim_start_matches('#');
        if code || text.len() == line.len() || !text.starts_with(' ') {
            continue;
        }
        let mark: String = text
            .trim()
            .to_lowercase()
            .chars()
            .filter(|&letter| letter.is_alphanumeric() || " -_".contains(letter))
            .map(|letter| if letter == ' ' { '-' } else { letter })
            .collect();
        let again = found.iter().filter(|other| **other == mark).count();
        found.push(if again == 0 { mark } else { format!("{mark}-{again}") });
    }
    found
}

/// Every relative link of a page leads to something, to a heading that is there too.
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
            if elsewhere {
                continue;
            }
            let there = match target {
                "" => page.clone(),
                _ => page.parent().unwrap().join(target),
            };
            assert!(there.exists(), "{} links to {target}", page.display());
            if let Some((_, mark)) = link.split_once('#')
                && there.extension().is_some_and(|ending| ending == "md")
            {
                let marks = marks(&std::fs::read_to_string(&there).unwrap());
                assert!(marks.iter().any(|one| one == mark), "{} links to {link}", page.display());
            }
        }
    }
}

/// Places in a page's text: words of the letters of paths, with what comes before them.
fn words(text: &str) -> impl Iterator<Item = (Option<char>, &str)> {
    let inside = |letter: char| letter.is_ascii_alphanumeric() || "_./-*{},".contains(letter);
    let mut before = None;
    text.split_inclusive(move |letter| !inside(letter)).map(move |piece| {
        let last = piece.chars().last().filter(|&letter| !inside(letter));
        let word = piece.trim_end_matches(|letter| !inside(letter));
        (std::mem::replace(&mut before, last), word.trim_end_matches(['.', ',', '/']))
    })
}

/// A path that a page names is there: from the root of the repository, or, in the glossary, from
/// a crate's `src` by the crate's short name. Capitals stand for a name of the reader's own.
#[test]
fn paths_that_pages_name_exist() {
    // What the campaign writes while it runs.
    let later = ["docs/results/campaign"];
    let root = repository();
    let mut pages = Vec::new();
    files(&root, &["md"], &mut pages);
    let mut tried = 0;
    for page in pages {
        let text = std::fs::read_to_string(&page).unwrap();
        let glossary = page.ends_with("glossary.md");
        for (before, word) in words(&text) {
            let Some((head, rest)) = word.split_once('/') else { continue };
            let from_root =
                ["crates", "docs", "python", "scenarios", "tools", "zoo"].contains(&head);
            let of_a_crate = root.join("crates").join(head).join("src");
            let placed = match before {
                Some('`' | ' ' | '\n') | None if from_root => root.join(word),
                Some('`') if glossary && of_a_crate.exists() => of_a_crate.join(rest),
                _ => continue,
            };
            let ours = word.contains(char::is_uppercase) && !placed.exists();
            if ours || later.contains(&word) {
                continue;
            }
            // Of a pattern, the part before it.
            let plain: PathBuf = placed
                .components()
                .take_while(|part| !part.as_os_str().to_string_lossy().contains(['*', '{']))
                .collect();
            assert!(plain.exists(), "{} names {word}, which is not there", page.display());
            tried += 1;
        }
    }
    assert!(tried > 150, "only {tried} paths were found");
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
