//! Reads `[[when]]`: what sets a rule off, on what conditions, and what it does.
//!
//! Long because it is one table: each event, condition and effect with its fields.

use super::fields::{Fields, own_name};
use super::mistakes::{Mistakes, excerpt, unknown};
use super::model::{MOST_COUNTERS, Names, Of, Place, Spawn, Trigger, When, Zone};
use super::read_map::known_kinds;
use super::read_parts::{amount, ground, place, range, term, zone};
use super::tree::{Node, Value};
use hasard_engine::world::{ActorKind, DamageKind};

/// Most spawns that a rule puts, and most floors and lights that it moves.
const MOST_OF_A_RULE: usize = 8;
const MOST_MOVES: usize = 16;

/// What is said of an episode beside its counters.
const OF_EVERY_EPISODE: [&str; 7] =
    ["health", "return", "cost", "length", "seed", "terminated", "truncated"];

/// The events, and what `of` names in each.
const EVENTS: [&str; 17] = [
    "start", "pickup", "damage", "death", "kill", "hit", "shot", "enter", "leave", "in", "land",
    "jump", "use", "timer", "step", "counter", "near",
];

/// What does damage, by the names of `by`.
const SOURCES: [(&str, &[DamageKind]); 6] = [
    ("floor", &[DamageKind::Sector]),
    ("bullet", &[DamageKind::Bullet]),
    ("rocket", &[DamageKind::Rocket]),
    ("blast", &[DamageKind::Splash]),
    ("barrel", &[DamageKind::Barrel]),
    ("script", &[DamageKind::Script]),
];

/// Reads all of them.
pub(super) fn whens(
    nodes: &[Node],
    zones: &[Zone],
    spawns: &mut [Spawn],
    names: &mut Names,
    mistakes: &mut Mistakes,
) -> Vec<When> {
    nodes.iter().filter_map(|node| when(node, zones, spawns, names, mistakes)).collect()
}

fn when(
    node: &Node,
    zones: &[Zone],
    spawns: &mut [Spawn],
    names: &mut Names,
    mistakes: &mut Mistakes,
) -> Option<When> {
    let before = mistakes.added();
    let mut fields = Fields::of(node, "[[when]]", mistakes);
    // A name for levels to change it by.
    if let Some((name, at)) = fields.text("name", mistakes) {
        own_name(name, at, "when", mistakes);
    }
    let trigger = trigger(&mut fields, zones, spawns, names, mistakes);
    let whole = |key, fields: &mut Fields<'_>, from, to, mistakes: &mut Mistakes| {
        fields.whole(key, from, to, mistakes).map_or(0, |number| number as i32)
    };
    let conditions = conditions(fields.node("if"), names, mistakes);
    let in_zone =
        fields.text("in", mistakes).and_then(|(name, at)| zone(name, at, zones, mistakes));
    let cooldown = whole("cooldown", &mut fields, 0, 1_000_000, mistakes) as u32;
    let once = fields.flag("once", mistakes);
    let over = fields.number("over", 0.0, 1e6, mistakes).unwrap_or(0.0);
    let flat = fields.flag("flat", mistakes);
    let reward =
        fields.node("reward").and_then(|node| amount(node, "reward", mistakes)).unwrap_or(0.0);
    let costs = costs(fields.node("cost"), names, mistakes);
    let counts = counted(fields.node("count"), "count", names, mistakes);
    let sets = counted(fields.node("set"), "set", names, mistakes);
    let hurt = whole("hurt", &mut fields, 0, 100_000, mistakes);
    let heal = whole("heal", &mut fields, 0, 100_000, mistakes);
    let end = match fields.text("end", mistakes) {
        None => false,
        Some(("goal" | "harm", _)) => true,
        Some((_, at)) => {
            mistakes.add(at, "end must be \"goal\" or \"harm\"");
            false
        }
    };
    let spawn = fields.texts("spawn", mistakes).unwrap_or_default();
    if let Some((_, at)) = spawn.get(MOST_OF_A_RULE) {
        mistakes.add(
            *at,
            format!("at most {MOST_OF_A_RULE} spawns in a rule; give a second rule the rest"),
        );
    }
    let spawn = spawn
        .into_iter()
        .take(MOST_OF_A_RULE)
        .filter_map(|(name, at)| spawn_named(name, at, spawns, mistakes))
        .collect();
    let floors = movers(fields.node("floor"), zones, mistakes);
    let lights = lights(fields.node("light"), zones, mistakes);
    let teleport: Option<Place> =
        fields.node("teleport").and_then(|node| place(node, zones, mistakes));
    // Which fields an event has is not known of one that is none.
    let trigger = trigger?;
    fields.finish(mistakes);
    let when = When {
        at: node.at,
        trigger,
        conditions,
        zone: in_zone,
        cooldown,
        once,
        over,
        flat,
        reward,
        costs,
        counts,
        sets,
        hurt,
        heal,
        end,
        spawn,
        floors,
        lights,
        teleport,
    };
    let changes = when.hurt != 0
        || when.heal != 0
        || !when.spawn.is_empty()
        || !when.floors.is_empty()
        || !when.lights.is_empty();
    if trigger == Trigger::Step && (changes || when.end || when.teleport.is_some()) {
        mistakes
            .add(node.at, "a policy step can be rewarded, cost and counted; what changes the world or ends the episode goes by event = \"timer\"");
    }
    let measured = matches!(trigger, Trigger::Damage { .. } | Trigger::Hit(_) | Trigger::Land);
    if over >= 1.0 && !measured {
        mistakes.warn(
            node.at,
            "this never happens: `over` is for the events damage, hit and land, all others have an amount of 1",
        );
    }
    let silent = !changes && !when.end && when.teleport.is_none() && when.reward == 0.0;
    // What could not be read may be what it does.
    let whole = mistakes.added() == before;
    if silent && whole && when.costs.is_empty() && when.counts.is_empty() && when.sets.is_empty() {
        mistakes.warn(
            node.at,
            "this [[when]] does nothing; give it a reward, a cost, a count or an end",
        );
    }
    Some(when)
}

fn trigger(
    fields: &mut Fields<'_>,
    zones: &[Zone],
    spawns: &mut [Spawn],
    names: &mut Names,
    mistakes: &mut Mistakes,
) -> Option<Trigger> {
    let Some((event, at)) = fields.text("event", mistakes) else {
        mistakes.add(fields.at, format!("[[when]] needs an event: one of {}", EVENTS.join(", ")));
        return None;
    };
    let of = fields.texts("of", mistakes);
    let by = fields.texts("by", mistakes);
    let named = of.is_some();
    let of_zone = |mistakes: &mut Mistakes| match of.as_deref() {
        Some([(name, at)]) => zone(name, *at, zones, mistakes),
        _ => {
            mistakes.add(at, format!("event {event} needs a zone: of = \"lava\""));
            None
        }
    };
    let tics = |key, fields: &mut Fields<'_>, usual, mistakes: &mut Mistakes| {
        fields.whole(key, 0, 1_000_000, mistakes).map_or(usual, |number| number as u32)
    };
    let trigger = match event {
        "start" => Trigger::Start,
        "death" => Trigger::Death,
        "shot" => Trigger::Shot,
        "land" => Trigger::Land,
        "jump" => Trigger::Jump,
        "use" => Trigger::Use,
        "step" => Trigger::Step,
        "pickup" | "kill" | "hit" | "near" => {
            let of = of_things(of.as_deref(), event, at, spawns, mistakes);
            match event {
                "pickup" => Trigger::Pickup(of),
                "kill" => Trigger::Kill(of),
                "hit" => Trigger::Hit(of),
                _ => Trigger::Near {
                    of,
                    within: fields.whole("within", 1, 4096, mistakes).unwrap_or(64) as i32,
                },
            }
        }
        "damage" => damage(by.as_deref(), zones, mistakes),
        "enter" => Trigger::Enter(of_zone(mistakes)?),
        "leave" => Trigger::Leave(of_zone(mistakes)?),
        "in" => Trigger::In(of_zone(mistakes)?),
        "timer" => {
            let every = tics("every", fields, 0, mistakes);
            let first = tics("first", fields, every, mistakes);
            if every == 0 && first == 0 {
                mistakes.add(
                    at,
                    "event timer needs `every` or `first`, in tics, from 1: 35 are a second",
                );
            }
            Trigger::Timer { every, first }
        }
        "counter" => {
            let reaches = fields.whole("reaches", -1_000_000, 1_000_000, mistakes);
            match (of.as_deref(), reaches) {
                (Some([(name, at)]), Some(reaches)) => Trigger::Counter {
                    counter: counter(name, *at, names, mistakes)?,
                    reaches: reaches as i32,
                },
                _ => {
                    mistakes.add(
                        at,
                        "event counter needs a counter and a number: of = \"vials\", reaches = 30",
                    );
                    return None;
                }
            }
        }
        _ => {
            mistakes.add(at, unknown("event", event, EVENTS));
            return None;
        }
    };
    if named
        && matches!(
            trigger,
            Trigger::Start
                | Trigger::Death
                | Trigger::Shot
                | Trigger::Land
                | Trigger::Jump
                | Trigger::Use
                | Trigger::Timer { .. }
                | Trigger::Step
        )
    {
        mistakes.add(at, format!("event {event} is of nothing; leave `of` out"));
    }
    if let Some([(name, _), ..]) = of.as_deref()
        && event == "damage"
    {
        mistakes.add(at, format!("event damage is by something: by = \"{}\"", excerpt(name)));
    }
    if by.is_some() && event != "damage" {
        mistakes.add(at, "`by` is for event damage");
    }
    Some(trigger)
}

/// Things by kind or by the name of their spawn; all where nothing is said.
fn of_things(
    of: Option<&[(&str, usize)]>,
    event: &str,
    at: usize,
    spawns: &mut [Spawn],
    mistakes: &mut Mistakes,
) -> Of {
    let Some(of) = of else {
        if event == "pickup" || event == "near" {
            mistakes.add(
                at,
                format!(
                    "event {event} needs things: of = \"HealthBonus\", or the name of a [[spawn]]"
                ),
            );
        }
        return Of { kinds: u128::MAX, spawns: 0 };
    };
    let mut found = Of::default();
    for (name, at) in of {
        if let Some(index) = spawns.iter().position(|spawn| spawn.name.as_deref() == Some(*name)) {
            spawns[index].marked = true;
            found.spawns |= 1 << index;
        } else if let Some(kind) = ActorKind::from_class_name(name) {
            found.kinds |= 1 << kind as u32;
        } else {
            let mut known: Vec<&str> =
                spawns.iter().filter_map(|spawn| spawn.name.as_deref()).collect();
            known_kinds().for_each(|kind| known.push(kind.class_name()));
            mistakes.add(*at, unknown("thing", name, known));
        }
    }
    found
}

fn damage(by: Option<&[(&str, usize)]>, zones: &[Zone], mistakes: &mut Mistakes) -> Trigger {
    let Some(by) = by else { return Trigger::Damage { kinds: u32::MAX, zones: 0 } };
    let (mut kinds, mut places) = (0, 0);
    for (name, at) in by {
        let zone = zones.iter().position(|zone| zone.name == *name);
        // Files from before the names were those of Python say `rule`; their zones keep their names.
        let source = if *name == "rule" { "script" } else { name };
        let is_source = !(*name == "script" && zone.is_some());
        let found = SOURCES.iter().find(|(known, _)| is_source && *known == source);
        if let Some((_, found)) = found {
            found.iter().for_each(|kind| kinds |= 1 << *kind as u32);
        } else if let Some(index) = zone {
            places |= 1 << index;
        } else {
            let known = zones.iter().map(|zone| &*zone.name).chain(SOURCES.map(|(known, _)| known));
            mistakes.add(*at, unknown("source of damage", name, known));
        }
    }
    Trigger::Damage { kinds, zones: places }
}

fn spawn_named(name: &str, at: usize, spawns: &[Spawn], mistakes: &mut Mistakes) -> Option<u8> {
    let found = spawns.iter().position(|spawn| spawn.name.as_deref() == Some(name));
    if found.is_none() {
        mistakes.add(
            at,
            unknown("spawn", name, spawns.iter().filter_map(|spawn| spawn.name.as_deref())),
        );
    }
    found.map(|index| index as u8)
}

/// The number of a counter, which may be new.
fn counter(name: &str, at: usize, names: &mut Names, mistakes: &mut Mistakes) -> Option<u8> {
    if let Some(index) = names.counters.iter().position(|known| known == name) {
        return Some(index as u8);
    }
    if !own_name(name, at, "counter", mistakes) {
        return None;
    }
    if OF_EVERY_EPISODE.contains(&name) || name.starts_with("cost_") {
        mistakes.add(
            at,
            format!("`{name}` is said of every episode already; call the counter otherwise"),
        );
        return None;
    }
    if names.counters.len() == MOST_COUNTERS {
        mistakes.add(at, format!("at most {MOST_COUNTERS} counters"));
        return None;
    }
    names.counters.push(name.to_string());
    Some((names.counters.len() - 1) as u8)
}

/// `count = "vials"`, `count = ["vials", "all"]` or `count = { vials = 2 }`.
fn counted(
    node: Option<&Node>,
    key: &str,
    names: &mut Names,
    mistakes: &mut Mistakes,
) -> Vec<(u8, i32)> {
    let Some(node) = node else { return Vec::new() };
    match &node.value {
        Value::Table(entries) => entries
            .iter()
            .filter_map(|entry| match entry.node.value {
                Value::Whole(number) if number.abs() <= 1_000_000 => {
                    counter(&entry.key, entry.at, names, mistakes)
                        .map(|counter| (counter, number as i32))
                }
                _ => {
                    mistakes.add(entry.node.at, format!("{key} takes whole numbers up to 1000000"));
                    None
                }
            })
            .collect(),
        _ if key == "set" => {
            mistakes.add(node.at, "set takes counters and numbers: set = { keys = 0 }");
            Vec::new()
        }
        _ => super::fields::texts(node, key, mistakes)
            .into_iter()
            .filter_map(|(name, at)| counter(name, at, names, mistakes).map(|counter| (counter, 1)))
            .collect(),
    }
}

/// `if = { keys = 2 }` or `if = { keys = [2, 5] }`.
fn conditions(
    node: Option<&Node>,
    names: &mut Names,
    mistakes: &mut Mistakes,
) -> Vec<(u8, [i32; 2])> {
    let Some(node) = node else { return Vec::new() };
    let Value::Table(entries) = &node.value else {
        mistakes.add(
            node.at,
            "if takes counters: if = { keys = 2 }, or if = { keys = [2, 5] } for 2 to 5",
        );
        return Vec::new();
    };
    let mut found = Vec::new();
    for entry in entries {
        let bounds = match &entry.node.value {
            Value::Whole(number) if number.abs() <= 1_000_000 => Some([*number as i32; 2]),
            _ => range(
                &entry.node,
                "a condition, if no single number,",
                -1_000_000,
                1_000_000,
                mistakes,
            ),
        };
        if let (Some(counter), Some(bounds)) =
            (counter(&entry.key, entry.at, names, mistakes), bounds)
        {
            found.push((counter, bounds));
        }
    }
    found
}

fn costs(node: Option<&Node>, names: &mut Names, mistakes: &mut Mistakes) -> Vec<(u8, f64)> {
    let Some(node) = node else { return Vec::new() };
    let mut found = Vec::new();
    match &node.value {
        Value::Table(entries) => {
            for entry in entries {
                let number = amount(&entry.node, "a cost", mistakes);
                if number.is_some_and(|cost| cost < 0.0) {
                    mistakes.add(entry.node.at, "a cost must be a number from 0");
                }
                let number = number.filter(|cost| *cost >= 0.0);
                if let (Some(term), Some(number)) =
                    (term(&entry.key, entry.at, names, mistakes), number)
                {
                    found.push((term, number));
                }
            }
        }
        _ => mistakes.add(node.at, "a cost has a name: cost.lava = 1.0, or cost = { lava = 1.0 }"),
    }
    found
}

/// `floor = { of = "door", to = -64, speed = 16 }`, or a list of such.
fn movers(node: Option<&Node>, zones: &[Zone], mistakes: &mut Mistakes) -> Vec<(u8, i32, i32)> {
    at_most(node, "floor", mistakes);
    each(node, |node| {
        let mut fields = Fields::of(node, "floor", mistakes);
        let named = fields.text("of", mistakes);
        let place = named.and_then(|(name, at)| ground(name, at, zones, mistakes));
        let to = fields.whole("to", -2048, 2048, mistakes);
        let speed = fields.whole("speed", 1, 1024, mistakes).unwrap_or(16);
        if to.is_none() || named.is_none() {
            mistakes.add(
                node.at,
                "floor needs a zone and a height: floor = { of = \"door\", to = -64 }",
            );
        }
        fields.finish(mistakes);
        Some((place?, to? as i32, speed as i32))
    })
}

/// `light = { of = "hall", to = 0 }`, or a list of such.
fn lights(node: Option<&Node>, zones: &[Zone], mistakes: &mut Mistakes) -> Vec<(u8, i32)> {
    at_most(node, "light", mistakes);
    each(node, |node| {
        let mut fields = Fields::of(node, "light", mistakes);
        let named = fields.text("of", mistakes);
        let place = named.and_then(|(name, at)| ground(name, at, zones, mistakes));
        let to = fields.whole("to", 0, 255, mistakes);
        if to.is_none() || named.is_none() {
            mistakes
                .add(node.at, "light needs a zone and a level: light = { of = \"hall\", to = 0 }");
        }
        fields.finish(mistakes);
        Some((place?, to? as i32))
    })
}

/// Refuses a longer list than a rule can have.
fn at_most(node: Option<&Node>, key: &str, mistakes: &mut Mistakes) {
    if let Some(Node { value: Value::List(items), at, .. }) = node
        && items.len() > MOST_MOVES
    {
        let problem = format!(
            "`{key}` has {} entries, a rule at most {MOST_MOVES}; give a second rule the rest",
            items.len()
        );
        mistakes.add(*at, problem);
    }
}

fn each<T>(node: Option<&Node>, read: impl FnMut(&Node) -> Option<T>) -> Vec<T> {
    match node.map(|node| (&node.value, node)) {
        None => Vec::new(),
        Some((Value::List(items), _)) => items.iter().take(MOST_MOVES).filter_map(read).collect(),
        Some((_, node)) => std::iter::once(node).filter_map(read).collect(),
    }
}
