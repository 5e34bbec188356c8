//! A tree of modules and who imports whom, read from the text of its sources.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Who imports whom, by the paths of modules: `render/walls/seg`.
pub type Arrows = BTreeMap<String, BTreeSet<String>>;

/// What each folder re-exports.
type Exports<'a> = BTreeMap<&'a str, BTreeSet<Vec<String>>>;

/// The sources of a crate by module; the crate's own is the empty one. Files of tests are left out,
/// as they may look at anything.
#[derive(Default)]
pub struct Tree {
    sources: BTreeMap<String, Source>,
}

/// A file's text, and whether it is the `mod.rs` of a folder.
struct Source {
    text: String,
    is_folder: bool,
}

impl Tree {
    /// The sources of a crate below its folder `src`.
    pub fn read(src: &Path) -> Tree {
        let mut tree = Tree::default();
        let mut folders = vec![src.to_path_buf()];
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(&folder).expect("the folder is there").flatten() {
                let path = entry.path();
                if path.is_dir() {
                    folders.push(path);
                } else if path.extension().is_some_and(|extension| extension == "rs") {
                    let below = path.strip_prefix(src).expect("it lies below");
                    let text = std::fs::read_to_string(&path).expect("the source is text");
                    tree.add(&below.to_string_lossy().replace('\\', "/"), &text);
                }
            }
        }
        tree
    }

    /// Adds a file by its path below `src`.
    pub fn add(&mut self, file: &str, text: &str) {
        let path = file.strip_suffix(".rs").unwrap_or(file);
        let name = path.rsplit('/').next().unwrap_or(path);
        if name.ends_with("tests") || ["main", "mutation", "small"].contains(&name) {
            return;
        }
        let is_folder = ["mod", "lib"].contains(&name);
        let module = if is_folder { parent(path) } else { path.to_string() };
        self.sources.insert(module, Source { text: code(text), is_folder });
    }

    /// Every import as an arrow from the file that names to the file that defines: what a folder
    /// re-exports is followed to where it comes from.
    pub fn arrows(&self) -> Arrows {
        let mut arrows = Arrows::new();
        let folders = self.sources.iter().filter(|(_, source)| source.is_folder);
        let exports: Exports = folders
            .map(|(module, source)| (module.as_str(), self.named_in(module, source, true)))
            .collect();
        for (module, source) in &self.sources {
            for path in self.named_in(module, source, false) {
                let defining = self.defining(&path, &exports, 0);
                if defining != *module {
                    arrows.entry(module.clone()).or_default().insert(defining);
                }
            }
        }
        arrows
    }

    /// The modules of a folder, itself left out.
    pub fn below<'a>(&'a self, folder: &'a str) -> impl Iterator<Item = &'a str> {
        self.sources
            .keys()
            .map(String::as_str)
            .filter(move |module| within(module, folder).is_some())
    }

    /// The paths from the crate's root that a file names: of a folder's `mod.rs` either what it
    /// re-exports or the rest.
    fn named_in(&self, module: &str, source: &Source, exports: bool) -> BTreeSet<Vec<String>> {
        let here: Vec<String> =
            module.split('/').filter(|s| !s.is_empty()).map(str::to_string).collect();
        let above = here[..here.len().saturating_sub(1)].to_vec();
        let (uses, rest) = statements(&source.text);
        let mut found = BTreeSet::new();
        let mut add = |text: &str, prefix: &str, base: &[String]| {
            for (at, _) in text.match_indices(prefix) {
                if !text[..at].ends_with(|c| is_of_name(c) || c == ':') {
                    chains(&text[at + prefix.len()..], base, &mut found);
                }
            }
        };
        let children: Vec<&str> = self
            .below(module)
            .filter_map(|other| within(other, module).filter(|rest| !rest.contains('/')))
            .collect();
        let mut add_all = |text: &str| {
            add(text, "crate::", &[]);
            add(text, "super::", &above);
            if source.is_folder {
                add(text, "self::", &here);
                for child in &children {
                    let base: Vec<String> =
                        here.iter().cloned().chain([child.to_string()]).collect();
                    add(text, &format!("{child}::"), &base);
                }
            }
        };
        for statement in uses {
            // A `mod.rs` re-exports by `pub use`; what it uses itself, its children may import too.
            let is_export = source.is_folder && statement.starts_with("pub");
            if is_export == exports || (exports && source.is_folder) {
                add_all(&statement);
            }
        }
        if !exports {
            add_all(&rest);
        }
        found
    }

    /// The module that defines what a path from the crate's root names.
    fn defining(&self, path: &[String], exports: &Exports, depth: usize) -> String {
        let mut module = String::new();
        for (i, name) in path.iter().enumerate() {
            let child = if module.is_empty() { name.clone() } else { format!("{module}/{name}") };
            if self.sources.contains_key(&child) {
                module = child;
                continue;
            }
            let Some(exported) = exports.get(module.as_str()) else { break };
            let found =
                exported.iter().find(|chain| chain.last() == Some(name) && chain[..] != path[..=i]);
            if let Some(chain) = found.filter(|_| depth < 8) {
                let whole: Vec<String> = chain.iter().chain(&path[i + 1..]).cloned().collect();
                return self.defining(&whole, exports, depth + 1);
            }
            break;
        }
        module
    }
}

/// Arrows within a folder against the order of what lies in it, each as one line; and what lies in
/// it without a place in the order.
pub fn against_the_order(
    tree: &Tree,
    arrows: &Arrows,
    folder: &str,
    order: &[&str],
) -> Vec<String> {
    let first = |module: &str| {
        within(module, folder).map(|rest| rest.split('/').next().unwrap_or(rest).to_string())
    };
    let place =
        |module: &str| order.iter().position(|known| Some(*known) == first(module).as_deref());
    let mut wrong: Vec<String> = tree
        .below(folder)
        .filter(|module| place(module).is_none())
        .map(|module| format!("{module} has no place in the order of {folder:?}"))
        .collect();
    for (from, all) in arrows {
        for to in all {
            if let (Some(own), Some(other)) = (place(from), place(to))
                && other > own
            {
                wrong.push(format!("{from} imports {to}, which comes after it"));
            }
        }
    }
    wrong
}

/// The modules of a folder that import one another in circles: what imports nothing that is left is
/// taken away until nothing changes, and so is what nothing that is left imports.
pub fn circles(arrows: &Arrows, folder: &str) -> Arrows {
    let mut left = arrows.clone();
    left.retain(|from, _| folder.is_empty() || from == folder || within(from, folder).is_some());
    loop {
        let (from, to): (BTreeSet<String>, BTreeSet<String>) =
            (left.keys().cloned().collect(), left.values().flatten().cloned().collect());
        let before = left.values().map(BTreeSet::len).sum::<usize>() + left.len();
        left.values_mut().for_each(|all| all.retain(|other| from.contains(other)));
        left.retain(|module, all| !all.is_empty() && to.contains(module));
        if left.values().map(BTreeSet::len).sum::<usize>() + left.len() == before {
            return left;
        }
    }
}

/// The path of a module from a folder that it lies in.
fn within<'a>(module: &'a str, folder: &str) -> Option<&'a str> {
    if folder.is_empty() {
        return (!module.is_empty()).then_some(module);
    }
    module.strip_prefix(folder)?.strip_prefix('/')
}

fn parent(path: &str) -> String {
    path.rfind('/').map_or(String::new(), |at| path[..at].to_string())
}

/// The source without comments and without its module of tests.
fn code(text: &str) -> String {
    let end = text
        .find("\n#[cfg(test)]\nmod tests {")
        .or_else(|| text.find("\n#[cfg(all(test"))
        .unwrap_or(text.len());
    let lines = text[..end].lines().filter(|line| !line.trim_start().starts_with("//"));
    lines.collect::<Vec<_>>().join("\n")
}

/// The `use` statements of a source, and what is left of it.
fn statements(code: &str) -> (Vec<String>, String) {
    let (mut uses, mut rest, mut open) = (Vec::new(), String::new(), None::<String>);
    for line in code.lines() {
        let start = line.trim_start();
        let begins =
            ["use ", "pub use ", "pub(crate) use "].iter().any(|way| start.starts_with(way));
        match &mut open {
            Some(statement) => statement.push_str(start),
            None if begins => open = Some(start.to_string()),
            None => {
                rest.push_str(line);
                rest.push('\n');
            }
        }
        if let Some(statement) = open.take_if(|statement| statement.ends_with(';')) {
            uses.push(statement);
        }
    }
    (uses, rest)
}

fn is_of_name(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

/// The chains of names that the text begins with, each behind `before`: written as a chain or as
/// lists of chains. What is left of the text.
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
    let name = &text[..end];
    let chain: Vec<String> = match name {
        "" | "self" => before.to_vec(),
        "super" => before[..before.len().saturating_sub(1)].to_vec(),
        _ => before.iter().cloned().chain([name.to_string()]).collect(),
    };
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
