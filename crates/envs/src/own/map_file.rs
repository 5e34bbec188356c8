//! Maps in files of their own: `wad = "x.wad#MAP01"` and `udmf = "x.udmf"`. The map is laid beneath
//! the scenario's text, as `[map.files]`, when the file is read: so a run, an agent and an episode
//! keep it with the rest, and the hash is of both.

use super::mistakes::{Mistakes, excerpt};
use super::model::{DrawnMap, MapPlan};
use super::tree::{self, Node, Value};
use crate::maps::files::read as read_map_file;
use crate::maps::folder::FURTHER_PLAYERS;
use hasard_engine::map::udmf;
use hasard_engine::wad::Wad;
use std::path::Path;
use std::sync::Arc;

/// The map of a WAD whose name is not said.
const FIRST_MAP: &str = "MAP01";

/// Longest map that is laid beneath a text, bytes of UDMF.
const LARGEST_MAP: usize = 8 << 20;

/// Most letters of a list of what a map leaves out.
const LONGEST_LIST: usize = 2000;

/// A task's text with the maps that it names.
pub(super) struct WithMaps {
    /// Says, as `[map.unread]`, of each map that cannot be read why not.
    pub text: String,
    /// The same of the first of them, in one line.
    pub wrong: Option<String>,
}

/// A text with the maps that it names, which lie in `folder` or where their paths lead from there.
pub(super) fn with_maps(text: String, folder: &Path) -> WithMaps {
    // What is wrong with the text is for its reader to say, with line and column.
    let mut mistakes = Mistakes::new(&text);
    let root = tree::parse(&text, &mut mistakes);
    let mut named = Vec::new();
    find(&root, &mut named);
    let is_laid = root.get("map").is_some_and(|map| map.node.get("files").is_some());
    if named.is_empty() || is_laid {
        return WithMaps { text, wrong: None };
    }
    let mut whole = format!("{}\n\n[map.files]\n", text.trim_end());
    let (mut left_out, mut unread, mut wrong) = (String::new(), String::new(), None);
    for (key, place) in named {
        let name = quoted(place);
        match read_place(key, place, folder) {
            Ok((written, parts)) => {
                whole += &format!("{name} = '''\n{written}'''\n");
                if !parts.is_empty() {
                    left_out += &format!("{name} = \"{}\"\n", parts.join(", "));
                }
            }
            Err(why) => {
                let why = format!("[map] {key} = \"{}\": {why}", excerpt(place));
                unread += &format!("{name} = {}\n", quoted(&why));
                wrong.get_or_insert(why);
            }
        }
    }
    if !unread.is_empty() {
        whole += &format!("\n[map.unread]\n{unread}");
    }
    // The map is written without what is not played, so the text keeps the list of it.
    if !left_out.is_empty() {
        whole += &format!("\n[map.left_out]\n{left_out}");
    }
    // An inline table takes no more fields.
    let mut laid = Mistakes::new(&whole);
    tree::parse(&whole, &mut laid);
    if laid.any() && !mistakes.any() {
        let why = "a map in { } cannot name a file; write [map] on a line of its own, and its fields below";
        return WithMaps { text, wrong: Some(why.to_string()) };
    }
    WithMaps { text: whole, wrong }
}

/// A text as TOML writes it in quotes.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for letter in text.chars() {
        match letter {
            '\\' | '"' => quoted.extend(['\\', letter]),
            letter if letter.is_control() => quoted += &format!("\\u{:04X}", letter as u32),
            letter => quoted.push(letter),
        }
    }
    quoted + "\""
}

/// The files that the `map` tables of a text name, each once.
fn find<'a>(node: &'a Node, named: &mut Vec<(&'static str, &'a str)>) {
    let Value::Table(entries) = &node.value else { return };
    for entry in entries {
        if entry.key == "map" {
            for key in ["wad", "udmf"] {
                let place = entry.node.get(key).and_then(|entry| entry.node.text());
                let place = place.filter(|place| !is_inline(place) && !place.contains('\n'));
                named.extend(place.map(|place| (key, place)).filter(|one| !named.contains(one)));
            }
        }
        find(&entry.node, named);
    }
}

/// The map at a place, written as UDMF, and what of it is left out.
fn read_place(key: &str, place: &str, folder: &Path) -> Result<(String, Vec<String>), String> {
    let wrong = |error: &dyn std::fmt::Display| error.to_string();
    let (path, name) = match place.rsplit_once('#') {
        Some((path, name)) if key == "wad" => (path, name),
        _ => (place, FIRST_MAP),
    };
    let bytes = read_map_file(&folder.join(path))
        .map_err(|error| format!("{error}; the path leads from the folder of the task's file"))?;
    let wad;
    let map_text = if key == "wad" {
        wad = Wad::read(&bytes).map_err(|error| wrong(&error))?;
        wad.map_text(name).map_err(|error| wrong(&error))?
    } else {
        &bytes
    };
    let source = udmf::read(map_text).map_err(|error| wrong(&error))?;
    let written = udmf::write(&source);
    if written.len() > LARGEST_MAP || written.contains("'''") {
        return Err("larger than the 8 MiB that a task's map may have".to_string());
    }
    Ok((written, source.left_out()))
}

/// Whether a text is a map itself rather than the path of one.
fn is_inline(text: &str) -> bool {
    text.contains('{')
}

/// What was laid beneath a text, by the names of the maps.
pub(super) struct Beneath<'a> {
    pub files: Option<&'a Node>,
    /// What each of them leaves out.
    pub left_out: Option<&'a Node>,
    /// Why others could not be read.
    pub unread: Option<&'a Node>,
}

/// The plan of a map that `named` says the place of, or is.
pub(super) fn drawn(
    (named, at): (&str, usize),
    beneath: &Beneath,
    mistakes: &mut Mistakes,
) -> Option<MapPlan> {
    let Beneath { files, left_out: lists, unread } = *beneath;
    let inline = is_inline(named).then_some(named);
    if let Some(why) = unread.and_then(|unread| unread.get(named)?.node.text()) {
        mistakes.add(at, why);
        return None;
    }
    let Some(text) = inline.or_else(|| files?.get(named)?.node.text()) else {
        mistakes.add(
            at,
            format!("the map \"{}\" is in another file: give the task as a file beside it, or its UDMF text here", excerpt(named)),
        );
        return None;
    };
    match udmf::read(text.as_bytes()) {
        Ok(mut source) => {
            source.things.retain(|thing| !FURTHER_PLAYERS.contains(&thing.kind));
            let list = lists.filter(|_| inline.is_none()).and_then(|lists| lists.get(named));
            // The list may be by anyone and goes to the terminal.
            let kept = list.and_then(|list| list.node.text()).map(|text| {
                text.chars().filter(|letter| !letter.is_control()).take(LONGEST_LIST).collect()
            });
            let left_out = kept.map_or_else(|| source.left_out(), |text| vec![text]);
            if !left_out.is_empty() {
                mistakes.warn(at, format!("left out: {}", left_out.join(", ")));
            }
            Some(MapPlan::Drawn(Arc::new(DrawnMap { source, left_out })))
        }
        Err(error) => {
            mistakes.add(at, format!("this map cannot be read: {error}"));
            None
        }
    }
}
