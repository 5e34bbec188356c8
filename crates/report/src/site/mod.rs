//! A small static site from a clone of the repository: the README as its face, the book, the
//! scoreboard, films. Plain HTML and one style sheet; nothing is fetched from elsewhere.
//!
//! | module | what it holds |
//! |---|---|
//! | `summary` | the book's table of contents |
//! | `render` | a Markdown page as HTML, its headings with anchors, its links as they are in the site |

mod render;
mod summary;

use crate::escape::escape;
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, percent_decode_str, utf8_percent_encode};
use render::{Links, render};
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::path::{Component, Path, PathBuf};
use summary::{Entry, entries};

/// Largest file that a page links to and that is copied.
const LARGEST: u64 = 16 << 20;
/// Pages that make the site when they are there, the first as its face.
const FACE: &str = "README.md";
const BOOK: &str = "docs/SUMMARY.md";
const SCOREBOARD: &str = "docs/results/scoreboard";
const PICTURES: &str = "docs/pictures/zoo";
const STYLE: &str = include_str!("style.css");

/// What a site is made from.
#[derive(Clone, Debug)]
pub struct Sources {
    /// The clone.
    pub root: PathBuf,
    /// Films to show beside those of the clone: .mp4 and .gif.
    pub films: Vec<PathBuf>,
}

/// What was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// The face.
    pub page: PathBuf,
    /// Pages, and files beside them.
    pub pages: usize,
    /// Files that were copied.
    pub files: usize,
    /// Links to what is not there: they are left out.
    pub lost: Vec<String>,
}

/// Writes the site into a folder.
///
/// # Errors
/// One line that names the file and the remedy.
pub fn write_site(sources: &Sources, out: &Path) -> Result<Written, String> {
    let root = &sources.root;
    for needed in [FACE, BOOK] {
        if !root.join(needed).is_file() {
            return Err(format!(
                "{}: has no {needed}; name a clone of the repository with --root",
                root.display()
            ));
        }
    }
    let summary = read(&root.join(BOOK))?;
    let mut site = Site {
        root: root.clone(),
        out: out.to_owned(),
        book: entries(&summary, "docs"),
        copied: BTreeSet::new(),
        lost: BTreeSet::new(),
    };
    let pages = site.pages()?;
    site.films(&sources.films)?;
    site.folder(SCOREBOARD)?;
    site.write("style.css", STYLE.as_bytes())?;
    Ok(Written {
        page: out.join("index.html"),
        pages: pages + 1,
        files: site.copied.len(),
        lost: site.lost.into_iter().collect(),
    })
}

struct Site {
    root: PathBuf,
    out: PathBuf,
    book: Vec<Entry>,
    copied: BTreeSet<String>,
    lost: BTreeSet<String>,
}

impl Site {
    /// Writes the face, the book and every page that they link to; gives their number.
    fn pages(&mut self) -> Result<usize, String> {
        let mut waiting: VecDeque<String> = VecDeque::from([FACE.to_owned()]);
        let chapters = self.book.iter().filter_map(|entry| entry.page.clone());
        waiting.extend(chapters.filter(|page| self.root.join(page).is_file()));
        let mut known: BTreeSet<String> = waiting.iter().cloned().collect();
        let mut number = 0;
        while let Some(page) = waiting.pop_front() {
            let text = read(&self.root.join(&page))?;
            let mut found = Found { root: &self.root, page: &page, links: BTreeMap::new() };
            let rendered = render(&text, &mut found);
            for (target, kind) in found.links {
                match kind {
                    Kind::Page if known.insert(target.clone()) => waiting.push_back(target),
                    Kind::Page => {}
                    Kind::File => self.copy(&target)?,
                    Kind::Lost => {
                        self.lost.insert(format!("{page}: {target}"));
                    }
                }
            }
            let title = rendered.title.unwrap_or_else(|| page.clone());
            let html = self.frame(&page, &title, &rendered.body);
            self.write(&html_name(&page), html.as_bytes())?;
            number += 1;
        }
        Ok(number)
    }

    /// A page of the pictures and films that move.
    fn films(&mut self, more: &[PathBuf]) -> Result<(), String> {
        let mut cards = String::new();
        let entries = std::fs::read_dir(self.root.join(PICTURES)).into_iter().flatten().flatten();
        let mut own: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
        own.sort();
        for path in own.iter().chain(more) {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let place = format!("films/{name}");
            let words = escape(&title_of(&name));
            // A browser would end the name at a `#`.
            let address = utf8_percent_encode(&name, NO_PART_OF_A_NAME);
            let shown = match path.extension().and_then(|it| it.to_str()) {
                Some("gif" | "png") => format!("<img src=\"{address}\" alt=\"{words}\">"),
                Some("mp4") => {
                    format!("<video controls loop muted playsinline src=\"{address}\"></video>")
                }
                _ => continue,
            };
            if self.copied.contains(&place) {
                let problem = "a film of this name is there already; give it another name";
                return Err(format!("{}: {problem}", path.display()));
            }
            let bytes = std::fs::read(path).map_err(|e| format!("{}: {e}", path.display()))?;
            self.write(&place, &bytes)?;
            self.copied.insert(place);
            cards += &format!("<figure>{shown}<figcaption>{words}</figcaption></figure>\n");
        }
        let body = format!(
            "<h1>Films</h1>\n<p>Agents of the zoo at their best, and every level. Green: reward. Red: cost.</p>\n<div class=\"films\">{cards}</div>"
        );
        let html = self.frame("films/index.md", "Films", &body);
        self.write("films/index.html", html.as_bytes())
    }

    /// Copies a folder's files as they are.
    fn folder(&mut self, folder: &str) -> Result<(), String> {
        let entries = std::fs::read_dir(self.root.join(folder)).into_iter().flatten().flatten();
        let mut names: Vec<String> =
            entries.filter_map(|entry| entry.file_name().into_string().ok()).collect();
        names.sort();
        names.iter().try_for_each(|name| self.copy(&format!("{folder}/{name}")))
    }

    fn copy(&mut self, file: &str) -> Result<(), String> {
        if !self.copied.insert(file.to_owned()) {
            return Ok(());
        }
        let bytes =
            std::fs::read(self.root.join(file)).map_err(|error| format!("{file}: {error}"))?;
        self.write(file, &bytes)
    }

    fn write(&self, name: &str, bytes: &[u8]) -> Result<(), String> {
        let path = self.out.join(name);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)
                .map_err(|error| format!("{}: {error}", folder.display()))?;
        }
        hasard_media::files::write_whole(&path, bytes).map_err(|error| error.to_string())
    }

    /// The page around a text: the bar above, the book's contents beside it.
    fn frame(&self, page: &str, title: &str, body: &str) -> String {
        let up = "../".repeat(page.matches('/').count());
        let in_book = page.starts_with("docs/");
        let mut contents = String::new();
        for entry in self.book.iter().filter(|_| in_book) {
            let name = escape(&entry.title);
            contents += &match &entry.page {
                None => format!("<h2>{name}</h2>\n"),
                Some(target) => {
                    let here = if target == page { " aria-current=\"page\"" } else { "" };
                    let deep = if entry.depth > 0 { " class=\"deep\"" } else { "" };
                    format!("<a{deep}{here} href=\"{up}{}\">{name}</a>\n", html_name(target))
                }
            };
        }
        let side = if in_book {
            format!(
                "<details class=\"contents\" open><summary>Contents</summary><nav aria-label=\"Contents\">{contents}</nav></details>"
            )
        } else {
            String::new()
        };
        let class = if in_book { "book" } else { "plain" };
        let board = if self.root.join(SCOREBOARD).join("index.html").is_file() {
            format!("<a href=\"{up}{SCOREBOARD}/index.html\">Scoreboard</a>")
        } else {
            String::new()
        };
        format!(
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <title>{}</title>\n<link rel=\"stylesheet\" href=\"{up}style.css\">\n<link rel=\"icon\" href=\"data:,\">\n</head>\n<body class=\"{class}\">\n\
             <header><a class=\"name\" href=\"{up}index.html\">hasard</a><nav aria-label=\"Site\"><a href=\"{up}docs/index.html\">Book</a>{board}<a href=\"{up}films/index.html\">Films</a></nav></header>\n\
             {side}\n<main>\n{body}\n</main>\n</body>\n</html>\n",
            escape(title)
        )
    }
}

/// What a file's name keeps of itself in an address.
const NO_PART_OF_A_NAME: &AsciiSet =
    &NON_ALPHANUMERIC.remove(b'-').remove(b'_').remove(b'.').remove(b'~');

/// `remedy_rush.gif` as words.
fn title_of(name: &str) -> String {
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem).replace(['_', '-'], " ");
    let mut letters = stem.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

fn read(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

/// Where a page of the clone is in the site.
fn html_name(page: &str) -> String {
    if page == FACE {
        return "index.html".into();
    }
    format!("{}.html", page.strip_suffix(".md").unwrap_or(page))
}

/// What a link leads to.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Page,
    File,
    Lost,
}

/// The links of a page, as they are found.
struct Found<'a> {
    root: &'a Path,
    page: &'a str,
    links: BTreeMap<String, Kind>,
}

impl Links for Found<'_> {
    fn link(&mut self, target: &str) -> Option<String> {
        let (path, anchor) = target.split_once('#').map_or((target, None), |(p, a)| (p, Some(a)));
        let path = &*percent_decode_str(path).decode_utf8_lossy();
        let folder = Path::new(self.page).parent().unwrap_or(Path::new(""));
        let Some(place) = normal(&folder.join(path)) else {
            self.links.insert(target.to_owned(), Kind::Lost);
            return None;
        };
        let file = self.root.join(&place);
        // A folder is shown by the page in it; without one its words stay.
        let place = match file.is_dir() {
            true => {
                let names = ["index.md", "README.md"].map(|name| format!("{place}/{name}"));
                Some(names.into_iter().find(|name| self.root.join(name).is_file())?)
            }
            false => Some(place),
        };
        let small = |place: &String| {
            std::fs::metadata(self.root.join(place))
                .is_ok_and(|data| data.is_file() && data.len() <= LARGEST)
        };
        let Some(place) = place.filter(small) else {
            self.links.insert(target.to_owned(), Kind::Lost);
            return None;
        };
        let is_page = place.ends_with(".md");
        let name = if is_page { html_name(&place) } else { place.clone() };
        self.links.insert(place, if is_page { Kind::Page } else { Kind::File });
        let up = "../".repeat(self.page.matches('/').count());
        Some(format!("{up}{name}{}", anchor.map_or_else(String::new, |one| format!("#{one}"))))
    }
}

/// A path below the root without `..`; `None` where it leads out of it.
fn normal(path: &Path) -> Option<String> {
    let mut parts: Vec<String> = Vec::new();
    for part in path.components() {
        match part {
            Component::Normal(name) => parts.push(name.to_str()?.to_owned()),
            Component::CurDir => {}
            Component::ParentDir => drop(parts.pop()?),
            _ => return None,
        }
    }
    Some(parts.join("/"))
}

#[cfg(test)]
mod tests;
