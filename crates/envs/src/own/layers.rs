//! The document of one level: what the file says, with what `[levels.N]`, `[hard]` and
//! `[rules.NAME]` change of it.

use super::mistakes::{Mistakes, excerpt, unknown};
use super::read_map::SOURCES;
use super::tree::{Entry, Node, Value};
use crate::RuleSet;
use crate::scenarios::Setting;

/// The keys of conditional layers.
const LAYERS: [&str; 3] = ["rules", "levels", "hard"];

/// What the levels of a task share: ids are made of the name, a task is listed with one title and
/// summary, and a budget is a scenario's.
const SHARED: [&str; 4] = ["name", "title", "summary", "budget"];

/// Notes the layers that hold in no setting, and what a layer changes of what all levels share.
/// `levels` is the number of levels, `around` the keys of the layers around this one.
pub(super) fn check(
    root: &Node,
    layer: &Node,
    levels: u8,
    around: &[&str],
    mistakes: &mut Mistakes,
) {
    let Value::Table(entries) = &layer.value else { return };
    for entry in entries {
        let key = &*entry.key;
        for field in SHARED.into_iter().filter(|_| !around.is_empty()) {
            let said = match key.strip_prefix("scenario") {
                Some("") => entry.node.get(field),
                Some(path) => (path.strip_prefix('.') == Some(field)).then_some(entry),
                None => None,
            };
            let of_all = root.get("scenario").and_then(|head| head.node.get(field));
            let other = |said: &&Entry| match field {
                "budget" => around.iter().any(|layer| *layer != "rules"),
                _ => said.node.text() != of_all.and_then(|one| one.node.text()),
            };
            if let Some(said) = said.filter(other) {
                let message = match field {
                    "budget" => "a task has one budget for all levels, and 0 under [hard]; write it in [scenario], or in [rules.NAME]".into(),
                    _ => format!("a task has one {field}, in [scenario]; leave it out here"),
                };
                mistakes.add(said.at, message);
            }
        }
        if !LAYERS.contains(&key) {
            continue;
        }
        if around.contains(&key) {
            mistakes.add(
                entry.at,
                format!("[{key}] within [{key}]: once says it all; write it at the top"),
            );
            continue;
        }
        let around = [around, &[key]].concat();
        match (&entry.node.value, key) {
            (_, "hard") => check(root, &entry.node, levels, &around, mistakes),
            (Value::Table(layers), _) => {
                for layer in layers {
                    let name = &*layer.key;
                    let known = RuleSet::ALL.map(RuleSet::name);
                    if key == "rules" && !known.contains(&name) {
                        mistakes.add(layer.at, unknown("rules", name, known));
                    } else if key == "levels"
                        && !(1..=levels.max(1)).any(|level| level.to_string() == name)
                    {
                        let name = excerpt(name);
                        mistakes.add(
                            layer.at,
                            format!(
                                "level {name}: the levels are 1 to {}; a [levels.N] at the top adds one",
                                levels.max(1)
                            ),
                        );
                    }
                    check(root, &layer.node, levels, &around, mistakes);
                }
            }
            _ => mistakes.add(
                entry.at,
                format!("[{key}] must be a table of tables, not {}", entry.node.what()),
            ),
        }
    }
}

/// The places of a text outside all layers: what holds in every setting that no layer changes.
pub(super) fn places_outside(root: &Node) -> Vec<usize> {
    let Value::Table(entries) = &root.value else { return Vec::new() };
    let outside = entries.iter().filter(|entry| !LAYERS.contains(&&*entry.key));
    outside.flat_map(|entry| [vec![entry.at], entry.node.places()].concat()).collect()
}

/// The document of a setting. Layers within layers count after those around them: `[levels.2.hard]`
/// after `[levels.2]` and `[hard]`.
pub(super) fn document(root: &Node, setting: Setting, mistakes: &mut Mistakes) -> Node {
    let mut layers: Vec<(usize, &Node)> = Vec::new();
    collect(root, setting, 0, &mut layers);
    layers.sort_by_key(|(depth, _)| *depth);
    let mut document = Node { value: Value::Table(Vec::new()), at: root.at };
    for (depth, layer) in layers {
        let Value::Table(entries) = &layer.value else {
            mistakes.add(layer.at, format!("write a table here, not {}", layer.what()));
            continue;
        };
        for entry in entries.iter().filter(|entry| !LAYERS.contains(&&*entry.key)) {
            if depth == 0 {
                put(&mut document, entry.clone());
            } else {
                leave_other_maps(&mut document, entry);
                change(&mut document, entry, mistakes);
            }
        }
    }
    document
}

/// The layers that hold in a setting, each with how deep it is.
fn collect<'n>(
    layer: &'n Node,
    setting: Setting,
    depth: usize,
    layers: &mut Vec<(usize, &'n Node)>,
) {
    layers.push((depth, layer));
    let within = [
        layer.get("rules").and_then(|rules| rules.node.get(setting.rules.name())),
        layer.get("levels").and_then(|levels| levels.node.get(&setting.level.to_string())),
        layer.get("hard").filter(|_| setting.hard),
    ];
    for entry in within.into_iter().flatten() {
        collect(&entry.node, setting, depth + 1, layers);
    }
}

/// A layer that says what the map is made of says it in place of what the file says: a drawing
/// gives way to a maze.
fn leave_other_maps(document: &mut Node, entry: &Entry) {
    let says = |source: &str| match entry.key.strip_prefix("map") {
        Some("") => entry.node.get(source).is_some(),
        Some(path) => {
            path.strip_prefix('.').and_then(|path| path.split('.').next()) == Some(source)
        }
        None => false,
    };
    if !SOURCES.into_iter().any(says) {
        return;
    }
    let Value::Table(sections) = &mut document.value else { return };
    let map = sections.iter_mut().find(|section| section.key == "map");
    if let Some(Value::Table(fields)) = map.map(|map| &mut map.node.value) {
        fields.retain(|field| !SOURCES.contains(&&*field.key) || says(&field.key));
    }
}

/// Sets an entry of a table.
fn put(table: &mut Node, entry: Entry) {
    let Value::Table(entries) = &mut table.value else { return };
    entries.retain(|known| known.key != entry.key);
    entries.push(entry);
}

/// Applies what a layer says: tables change field by field, everything else is replaced. A key in
/// quotes may be a path, `"spawn.vials.count"`, and items of lists go by their name or number.
fn change(target: &mut Node, entry: &Entry, mistakes: &mut Mistakes) {
    let path: Vec<&str> =
        if entry.key.len() > 2 { entry.key.split('.').collect() } else { vec![&entry.key] };
    descend(target, &path, entry, mistakes);
}

fn descend(target: &mut Node, path: &[&str], entry: &Entry, mistakes: &mut Mistakes) {
    let [key, rest @ ..] = path else { return };
    match &mut target.value {
        Value::Table(entries) => {
            let known = entries.iter().position(|known| known.key == *key);
            let index = known.unwrap_or_else(|| {
                entries.push(Entry {
                    key: (*key).to_string(),
                    at: entry.at,
                    node: Node { at: entry.at, ..Node::empty() },
                });
                entries.len() - 1
            });
            let place = &mut entries[index].node;
            if rest.is_empty() {
                set(place, known.is_some(), entry, mistakes)
            } else {
                descend(place, rest, entry, mistakes)
            }
        }
        Value::List(items) => {
            let named =
                |item: &Node| item.get("name").and_then(|name| name.node.text().map(str::to_owned));
            let by_number = || key.parse().ok().filter(|index| *index < items.len());
            let Some(index) = items
                .iter()
                .position(|item| named(item).as_deref() == Some(*key))
                .or_else(by_number)
            else {
                let names: Vec<String> = items.iter().filter_map(named).collect();
                let known = if names.is_empty() {
                    "give it a `name`".to_string()
                } else {
                    format!("named are {}", names.join(", "))
                };
                mistakes.add(
                    entry.at,
                    format!("there is no item `{}` to change; {known}", excerpt(key)),
                );
                return;
            };
            let place = &mut items[index];
            if rest.is_empty() {
                set(place, true, entry, mistakes)
            } else {
                descend(place, rest, entry, mistakes)
            }
        }
        _ => {
            mistakes.add(entry.at, format!("`{}` is within a value that is no table", excerpt(key)))
        }
    }
}

fn set(place: &mut Node, known: bool, entry: &Entry, mistakes: &mut Mistakes) {
    match (&place.value, &entry.node.value) {
        (Value::Table(_) | Value::List(_), Value::Table(within)) if known => {
            within.iter().for_each(|entry| change(place, entry, mistakes));
        }
        _ => *place = entry.node.clone(),
    }
}
