//! Folders stand in an order, and each imports only from those before it: read from the paths that
//! the sources name.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A tree of modules whose first level stands in an order: where its sources are, the path that
/// names it, and the order.
struct House {
    sources: &'static str,
    path: &'static str,
    order: &'static [&'static str],
}

const HOUSES: [House; 3] = [
    House {
        sources: "crates/engine/src",
        path: "crate",
        order: &["math", "simd", "map", "wad", "assets", "world", "render"],
    },
    House {
        sources: "crates/engine/src/render",
        path: "crate::render",
        order: &[
            "blocks",
            "colour",
            "textures",
            "scene",
            "view",
            "buffers",
            "published_depth",
            "patch",
            "walls",
            "planes",
            "sprites",
            "overlay",
            "output",
            "automap",
            "scratch",
            "renderer",
        ],
    },
    House {
        sources: "crates/learn/src",
        path: "crate",
        order: &[
            "error",
            "random",
            "threads",
            "statistics",
            "config",
            "team",
            "networks",
            "sampling",
            "learning",
            "algorithms",
            "runs",
        ],
    },
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// All sources below a folder, as paths from it.
fn sources(folder: &Path, below: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<_> =
        std::fs::read_dir(folder.join(below)).expect("the folder is there").flatten().collect();
    entries.sort_by_key(std::fs::DirEntry::file_name);
    for entry in entries {
        let path = below.join(entry.file_name());
        if entry.path().is_dir() {
            sources(folder, &path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// Whether a file holds tests alone, which may look at anything.
fn is_tests(path: &Path) -> bool {
    path.file_stem().is_some_and(|stem| {
        stem.to_string_lossy().ends_with("tests") || stem == "mutation" || stem == "small"
    })
}

/// The source without comments and without its module of tests.
fn code(text: &str) -> String {
    let end = text
        .find("\n#[cfg(test)]\nmod tests {")
        .or_else(|| text.find("\n#[cfg(all(test"))
        .unwrap_or(text.len());
    text[..end]
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .collect::<Vec<_>>()
        .join("\n")
}

/// What follows `path::` wherever the code names it: chains of modules, as far as they are written
/// as a chain or as lists of chains.
fn named(code: &str, path: &str) -> BTreeSet<Vec<String>> {
    let prefix = format!("{path}::");
    let mut found = BTreeSet::new();
    for (at, _) in code.match_indices(&prefix) {
        if !code[..at].ends_with(|c| is_of_name(c) || c == ':') {
            chains(&code[at + prefix.len()..], &[], &mut found);
        }
    }
    found
}

fn is_of_name(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

/// The chains that the text begins with, each behind `before`; what is left of the text.
fn chains<'a>(text: &'a str, before: &[String], found: &mut BTreeSet<Vec<String>>) -> &'a str {
    if let Some(mut list) = text.strip_prefix('{') {
        loop {
            list = chains(list.trim_start(), before, found).trim_start();
            match list.strip_prefix(',') {
                Some(rest) => list = rest,
                None => return list.strip_prefix('}').unwrap_or(list),
            }
        }
    }
    let end = text.find(|c| !is_of_name(c)).unwrap_or(text.len());
    let chain: Vec<String> =
        before.iter().cloned().chain((end > 0).then(|| text[..end].to_string())).collect();
    match text[end..].strip_prefix("::") {
        Some(rest) if end > 0 => chains(rest, &chain, found),
        _ => {
            found.insert(chain);
            // Such as `as other`.
            let rest = &text[end..];
            &rest[rest.find([',', '}', ';', '\n']).unwrap_or(rest.len())..]
        }
    }
}

#[test]
fn folders_import_only_from_those_before_them() {
    for House { sources: folder, path, order } in &HOUSES {
        let folder = root().join(folder);
        let mut files = Vec::new();
        sources(&folder, Path::new(""), &mut files);
        let place = |name: &str| order.iter().position(|known| *known == name);
        let mut checked = 0;
        for file in files.iter().filter(|file| !is_tests(file)) {
            let first =
                file.iter().next().expect("a file has a name").to_string_lossy().replace(".rs", "");
            let Some(own) = place(&first) else {
                assert!(
                    ["mod", "lib"].contains(&first.as_str()) || is_tests(file),
                    "{file:?} has no place in the order of {path}"
                );
                continue;
            };
            let text = std::fs::read_to_string(folder.join(file)).expect("the source is text");
            for chain in named(&code(&text), path) {
                if let Some(other) = chain.first().and_then(|first| place(first)) {
                    assert!(
                        other <= own,
                        "{}: {path}::{} comes after it",
                        folder.join(file).display(),
                        chain.join("::")
                    );
                    checked += 1;
                }
            }
        }
        assert!(checked > 50, "only {checked} imports were found under {path}");
    }
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    HOUSES[1..].iter().for_each(no_circle_in);
}

fn no_circle_in(House { sources: folder, path, .. }: &House) {
    let folder = root().join(folder);
    let mut files = Vec::new();
    sources(&folder, Path::new(""), &mut files);
    let module = |file: &Path| {
        let name = file.with_extension("").to_string_lossy().replace('\\', "/");
        name.strip_suffix("/mod").map_or(name.clone(), str::to_string)
    };
    let all: BTreeSet<String> = files.iter().map(|file| module(file)).collect();
    let mut arrows: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for file in files.iter().filter(|file| !is_tests(file) && module(file) != "mod") {
        let text = std::fs::read_to_string(folder.join(file)).expect("the source is text");
        let own = module(file);
        for mut chain in named(&code(&text), path) {
            while !chain.is_empty() && !all.contains(&chain.join("/")) {
                chain.pop();
            }
            let other = chain.join("/");
            if !chain.is_empty() && other != own {
                arrows.entry(own.clone()).or_default().insert(other);
            }
        }
    }
    // What imports nothing that is left can be taken away, until nothing is left but circles.
    loop {
        let before = arrows.len();
        let left: BTreeSet<String> = arrows.keys().cloned().collect();
        arrows.retain(|_, to| to.iter().any(|other| left.contains(other)));
        if arrows.len() == before {
            break;
        }
    }
    assert!(arrows.is_empty(), "circles among {:?}", arrows.keys());
}

#[test]
fn no_folder_of_the_renderer_is_a_heap() {
    fn check(folder: &Path) {
        let entries: Vec<_> =
            std::fs::read_dir(folder).expect("the folder is there").flatten().collect();
        let files = entries.iter().filter(|entry| entry.path().is_file()).count();
        assert!(files <= 17, "{} holds {files} files", folder.display());
        entries.iter().filter(|entry| entry.path().is_dir()).for_each(|entry| check(&entry.path()));
    }
    check(&root().join("crates/engine/src/render"));
}
