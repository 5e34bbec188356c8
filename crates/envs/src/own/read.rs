//! Reads the document of a setting into a [`Plan`].

use super::fields::{Fields, own_name, texts};
use super::mistakes::{Mistakes, excerpt, unknown};
use super::model::{
    Facing, Light, MOST_LIGHTS, MOST_SPAWNS, MOST_WHENS, MOST_ZONES, MapPlan, Names, Plan,
    PlayerPlan, Zone,
};
use super::read_parts::{ground, height, place, range, rectangle, term};
use super::tree::{Node, Value};
use super::{read_map, read_spawns, read_whens};
use crate::spaces::action::BUTTONS;
use hasard_engine::world::ActorKind;

/// The sections of a file.
const SECTIONS: [&str; 13] = [
    "scenario",
    "map",
    "player",
    "spawn",
    "when",
    "zones",
    "light",
    "costs",
    "end_on",
    "green_goggles",
    "rules",
    "levels",
    "hard",
];

/// Reads a document. Names of cost terms and counters are added to `names`.
pub(super) fn plan(document: &Node, names: &mut Names, mistakes: &mut Mistakes) -> Option<Plan> {
    let Value::Table(sections) = &document.value else { return None };
    for entry in sections.iter().filter(|entry| !SECTIONS.contains(&&*entry.key)) {
        mistakes.add(entry.at, unknown("section", &entry.key, SECTIONS));
    }
    let empty = Node::empty();
    let section = |name: &str| document.get(name).map_or(&empty, |entry| &entry.node);
    let mut head = Fields::of(section("scenario"), "[scenario]", mistakes);
    if document.get("scenario").is_none() {
        mistakes.add(0, "there is no [scenario]; begin with one that has a `name`");
    }
    let name = head.text("name", mistakes);
    if let Some((name, at)) = name
        && !crate::registry::scenario::is_name(name)
    {
        let rule = "it must have 1 to 40 letters and digits, a letter first, and not end in `Level` and a number";
        mistakes.add(at, format!("name `{}`: {rule}", excerpt(name)));
    }
    if let Some((name, at)) = name
        && crate::Scenario::ALL.iter().any(|own| own.name.eq_ignore_ascii_case(name))
    {
        mistakes.add(
            at,
            format!("{} is a scenario of the benchmark; call yours otherwise", excerpt(name)),
        );
    }
    if name.is_none()
        && document.get("scenario").is_some_and(|entry| entry.node.get("name").is_none())
    {
        mistakes.add(head.at, "[scenario] has no `name`; ids are made of it, MyTask-v0");
    }
    let name = name.map_or("Task", |(name, _)| name).to_string();
    let title = head.text("title", mistakes).map_or(name.clone(), |(title, _)| one_line(title));
    let summary = head.text("summary", mistakes).map_or(String::new(), |(text, _)| one_line(text));
    let tics = head.whole("tics", 1, 1_000_000, mistakes).unwrap_or(2100) as u32;
    let budget = head.number("budget", 0.0, 1e9, mistakes).unwrap_or(0.0);
    let actions = actions(head.node("actions"), mistakes);
    head.finish(mistakes);

    let mut zones = zones(section("zones"), mistakes);
    let map = read_map::map(document.get("map").map(|entry| &entry.node), &mut zones, mistakes);
    let idle = document.get("map").map_or(Vec::new(), |map| read_map::idle(&map.node));
    terms(section("costs"), names, mistakes);
    let player = player(section("player"), &zones, mistakes);
    let mut whole = Fields::of(document, "the file", mistakes);
    let spawn_nodes = whole.tables("spawn", MOST_SPAWNS, mistakes);
    let when_nodes = whole.tables("when", MOST_WHENS, mistakes);
    let light_nodes = whole.tables("light", MOST_LIGHTS, mistakes);
    let mut spawns = read_spawns::spawns(spawn_nodes, &zones, mistakes);
    let whens = read_whens::whens(when_nodes, &zones, &mut spawns, names, mistakes);
    let lights = light_nodes.iter().filter_map(|node| light(node, &zones, mistakes)).collect();
    let mut end_on = 0;
    for (term, at) in whole.texts("end_on", mistakes).unwrap_or_default() {
        match names.terms.iter().position(|known| known.name == term) {
            Some(index) => end_on |= 1 << index,
            None => mistakes
                .add(at, unknown("cost term", term, names.terms.iter().map(|known| &*known.name))),
        }
    }
    let green_goggles = whole.flag("green_goggles", mistakes);
    Some(Plan {
        name,
        title,
        summary,
        budget,
        tics,
        actions,
        map: map.unwrap_or(MapPlan::BuiltIn(crate::Scenario::RemedyRush, 1)),
        idle,
        zones,
        player,
        spawns,
        whens,
        lights,
        end_on,
        green_goggles,
    })
}

/// The beginning of a text for people.
fn one_line(text: &str) -> String {
    text.chars().filter(|letter| !letter.is_control()).take(200).collect()
}

fn actions(node: Option<&Node>, mistakes: &mut Mistakes) -> Vec<Vec<&'static str>> {
    let usual = || vec![vec!["TURN_LEFT", "TURN_RIGHT"], vec!["MOVE_FORWARD"]];
    let Some(node) = node else { return usual() };
    let Value::List(groups) = &node.value else {
        mistakes.add(
            node.at,
            "actions must be a list of lists of buttons, such as [[\"TURN_LEFT\", \"TURN_RIGHT\"], [\"MOVE_FORWARD\"]]",
        );
        return usual();
    };
    if groups.is_empty() || groups.len() > 12 {
        mistakes.add(node.at, "actions must have 1 to 12 groups of buttons");
    }
    let mut found: Vec<Vec<&'static str>> = Vec::new();
    for group in groups.iter().take(12) {
        let mut buttons = Vec::new();
        let named = texts(group, "a group of buttons", mistakes);
        let none = named.is_empty();
        for (name, at) in named {
            match BUTTONS.iter().find(|(known, _)| *known == name) {
                Some((known, _))
                    if found.iter().flatten().chain(&buttons).any(|other| other == known) =>
                {
                    mistakes.add(at, format!("button {known} is there twice"));
                }
                Some((known, _)) => buttons.push(*known),
                None => mistakes
                    .add(at, unknown("button", name, BUTTONS.iter().map(|(known, _)| *known))),
            }
        }
        if none {
            mistakes.add(group.at, "a group of actions needs a button");
        } else if !buttons.is_empty() {
            found.push(buttons);
        }
    }
    if found.is_empty() { usual() } else { found }
}

fn zones(node: &Node, mistakes: &mut Mistakes) -> Vec<Zone> {
    let Value::Table(entries) = &node.value else {
        mistakes.add(node.at, "[zones] must be a table of names");
        return Vec::new();
    };
    let mut zones = Vec::new();
    for entry in entries {
        read_map::zone_name(&entry.key, entry.at, mistakes);
        let mut fields = Fields::of(&entry.node, "a zone", mistakes);
        let of_area = fields.node("area");
        let area = of_area.and_then(|node| rectangle(node, "area", mistakes));
        let of_tag = fields.node("tag").or(fields.node("tags"));
        let tag = fields.whole("tag", 1, 32_000, mistakes).map(|tag| [tag as i32; 2]);
        let tags =
            fields.node("tags").and_then(|node| range(node, "tags", 1, 32_000, mistakes)).or(tag);
        fields.finish(mistakes);
        if of_area.is_some() == of_tag.is_some() {
            mistakes.add(
                entry.at,
                "a zone is either an `area = [west, south, east, north]` or the sectors of a `tag`",
            );
        }
        zones.push(Zone { name: entry.key.clone(), area, tags });
    }
    if zones.len() > MOST_ZONES {
        mistakes.add(node.at, format!("at most {MOST_ZONES} zones"));
        zones.truncate(MOST_ZONES);
    }
    zones
}

fn terms(node: &Node, names: &mut Names, mistakes: &mut Mistakes) {
    let Value::Table(entries) = &node.value else {
        mistakes.add(node.at, "[costs] must be a table of cost terms");
        return;
    };
    for entry in entries {
        let mut fields = Fields::of(&entry.node, "a cost term", mistakes);
        let counted = fields.node("counted").is_none() || fields.flag("counted", mistakes);
        fields.finish(mistakes);
        if let Some(index) = term(&entry.key, entry.at, names, mistakes) {
            names.terms[usize::from(index)].counted = counted;
        }
    }
}

fn player(node: &Node, zones: &[Zone], mistakes: &mut Mistakes) -> PlayerPlan {
    let mut fields = Fields::of(node, "[player]", mistakes);
    let place = fields.node("in").and_then(|node| place(node, zones, mistakes));
    for key in ["height", "z"] {
        if let Some(at) = fields.place_of(key).filter(|_| place.is_none()) {
            mistakes
                .warn(at, format!("`{key}` has no effect without `in`, where the agent appears"));
        }
    }
    let height = height(&mut fields, mistakes);
    let facing = match fields.node("angle") {
        None => {
            if place.is_some() {
                Facing::Random
            } else {
                Facing::Map
            }
        }
        Some(node) => match &node.value {
            Value::Whole(degrees) if (-360..=360).contains(degrees) => {
                Facing::Degrees(*degrees as i32)
            }
            Value::Text(text) if text == "random" => Facing::Random,
            _ => {
                mistakes.add(node.at, "angle must be \"random\" or degrees, 0 east and 90 north");
                Facing::Map
            }
        },
    };
    let health = fields.whole("health", 1, 100_000, mistakes).unwrap_or(100) as i32;
    let armor = fields.whole("armor", 0, 200, mistakes).unwrap_or(0) as i32;
    let speed = fields.number("speed", 0.0, 4.0, mistakes).unwrap_or(1.0);
    let mut weapons = Vec::new();
    for (name, at) in fields.texts("weapons", mistakes).unwrap_or_default() {
        match ActorKind::from_class_name(name).and_then(ActorKind::weapon) {
            Some(weapon) => weapons.push(weapon),
            None => {
                let known = ActorKind::all()
                    .filter(|kind| kind.weapon().is_some())
                    .map(ActorKind::class_name);
                mistakes.add(at, unknown("weapon", name, known));
            }
        }
    }
    let mut ammo = [None; 4];
    if let Some(node) = fields.node("ammo") {
        let mut kinds = Fields::of(node, "ammo", mistakes);
        use hasard_engine::world::ammo as types;
        for (name, which) in [
            ("clips", types::CLIP),
            ("shells", types::SHELL),
            ("rockets", types::ROCKET),
            ("cells", types::CELL),
        ] {
            ammo[which] = kinds.whole(name, 0, 10_000, mistakes).map(|amount| amount as i32);
        }
        kinds.finish(mistakes);
    }
    fields.finish(mistakes);
    PlayerPlan { at: node.at, place, height, facing, health, armor, weapons, ammo, speed }
}

fn light(node: &Node, zones: &[Zone], mistakes: &mut Mistakes) -> Option<Light> {
    let mut fields = Fields::of(node, "[[light]]", mistakes);
    if let Some((name, at)) = fields.text("name", mistakes) {
        own_name(name, at, "light", mistakes);
    }
    let zone = match fields.text("in", mistakes) {
        Some((name, at)) => ground(name, at, zones, mistakes),
        None => {
            mistakes.add(node.at, "[[light]] needs a zone: in = \"yard\"");
            None
        }
    };
    let level = |number: Option<i64>, usual| number.map_or(usual, |number| number as i32);
    let bright = level(fields.whole("bright", 0, 255, mistakes), 255);
    let dark = level(fields.whole("dark", 0, 255, mistakes), 0);
    let bright_tics = level(fields.whole("bright_tics", 1, 10_000, mistakes), 35);
    let dark_tics = level(fields.whole("dark_tics", 1, 10_000, mistakes), 35);
    let glow = fields.flag("glow", mistakes);
    let off = fields.flag("off", mistakes);
    fields.finish(mistakes);
    zone.filter(|_| !off).map(|zone| Light { zone, bright, dark, bright_tics, dark_tics, glow })
}
