//! Reads `[[spawn]]`.

use super::fields::{Fields, own_name};
use super::mistakes::Mistakes;
use super::model::{Goal, Place, Spawn, Zone};
use super::read_map::actor;
use super::read_parts::{height, place, zone};
use super::tree::{Node, Value};
use hasard_engine::world::{ActorFlags, ActorKind};

/// Reads all of them.
pub(super) fn spawns(nodes: &[Node], zones: &[Zone], mistakes: &mut Mistakes) -> Vec<Spawn> {
    let mut spawns: Vec<Spawn> = nodes.iter().map(|node| spawn(node, zones, mistakes)).collect();
    for index in 0..spawns.len() {
        let name = spawns[index].name.clone();
        if name.is_some() && spawns[..index].iter().any(|other| other.name == name) {
            mistakes.add(
                spawns[index].at,
                format!("two [[spawn]] are called {}", name.unwrap_or_default()),
            );
        }
        // Kinds that several tables put down are marked where one of them comes back or is counted.
        let shared = |other: &Spawn| {
            other
                .kinds
                .iter()
                .any(|(kind, _)| spawns[index].kinds.iter().any(|(own, _)| own == kind))
        };
        let others = spawns.iter().enumerate().any(|(at, other)| at != index && shared(other));
        let one = &mut spawns[index];
        one.marked = others && (one.respawn.is_some() || one.marked);
    }
    spawns
}

fn spawn(node: &Node, zones: &[Zone], mistakes: &mut Mistakes) -> Spawn {
    let mut fields = Fields::of(node, "[[spawn]]", mistakes);
    let name =
        fields.text("name", mistakes).filter(|(name, at)| own_name(name, *at, "spawn", mistakes));
    if let Some((name, at)) = name
        && ActorKind::from_class_name(name).is_some()
    {
        mistakes.add(at, format!("`{name}` is a kind of thing; call the spawn otherwise"));
    }
    let kinds = match fields.node("kind") {
        None => {
            mistakes.add(node.at, "[[spawn]] needs a kind, such as kind = \"HealthBonus\"");
            Vec::new()
        }
        Some(node) => kinds(node, mistakes),
    };
    let whole = |key, fields: &mut Fields<'_>, from, to, mistakes: &mut Mistakes| {
        fields.whole(key, from, to, mistakes).map(|number| number as u32)
    };
    let every = whole("every", &mut fields, 0, 1_000_000, mistakes).unwrap_or(0);
    let count = whole("count", &mut fields, 0, 500, mistakes).unwrap_or(u32::from(every == 0));
    let first = whole("first", &mut fields, 0, 1_000_000, mistakes).unwrap_or(every);
    let each = whole("each", &mut fields, 0, 100, mistakes).unwrap_or(1);
    let idle = ["first", "each"]
        .into_iter()
        .find_map(|key| fields.place_of(key).map(|at| (key, at)))
        .filter(|_| every == 0);
    let place =
        fields.node("in").and_then(|node| place(node, zones, mistakes)).unwrap_or(Place::Free);
    let height = height(&mut fields, mistakes);
    let rock = fields.flag("rock", mistakes);
    let respawn = match fields.node("respawn").map(|node| &node.value) {
        None | Some(Value::Bool(false)) => None,
        Some(_) => whole("respawn", &mut fields, 0, 1_000_000, mistakes),
    };
    let counted = fields.place_of("most").is_some();
    let most = whole("most", &mut fields, 1, 1000, mistakes).unwrap_or(500);
    let health = fields.whole("health", 1, 100_000, mistakes).map(|points| points as i32);
    let speed = fields.whole("speed", 0, 40, mistakes).map(|speed| speed as i32);
    let goal = goal(&mut fields, zones, mistakes);
    let monsters = kinds.iter().all(|(kind, _)| kind.info().flags.any(ActorFlags::MONSTER));
    if !monsters && (goal != Goal::None || speed.is_some()) {
        mistakes.add(
            node.at,
            "`goal`, `patrol` and `speed` are for monsters; this thing lies where it is",
        );
    }
    let shot_at = |(kind, _): &(ActorKind, u32)| kind.info().flags.any(ActorFlags::SHOOTABLE);
    if let Some(at) = fields.place_of("health").filter(|_| !kinds.iter().any(shot_at)) {
        mistakes.warn(at, "`health` has no effect: nothing of this [[spawn]] can be shot");
    }
    fields.finish(mistakes);
    Spawn {
        name: name.map(|(name, _)| name.to_string()),
        at: node.at,
        kinds,
        count,
        every,
        first,
        each,
        idle,
        place,
        height,
        rock,
        respawn,
        most,
        health,
        speed,
        goal,
        // Its own are counted.
        marked: counted,
    }
}

/// A kind, or kinds by weight.
fn kinds(node: &Node, mistakes: &mut Mistakes) -> Vec<(ActorKind, u32)> {
    match &node.value {
        Value::Text(name) => {
            actor(name, node.at, mistakes).into_iter().map(|kind| (kind, 1)).collect()
        }
        Value::Table(entries) if !entries.is_empty() && entries.len() <= 32 => entries
            .iter()
            .filter_map(|entry| {
                let kind = actor(&entry.key, entry.at, mistakes)?;
                match entry.node.value {
                    Value::Whole(weight) if (1..=1_000_000).contains(&weight) => {
                        Some((kind, weight as u32))
                    }
                    _ => {
                        mistakes.add(
                            entry.node.at,
                            "a weight must be a whole number from 1 to 1000000",
                        );
                        None
                    }
                }
            })
            .collect(),
        _ => {
            mistakes.add(
                node.at,
                "kind must be a name, or names with weights: { HealthBonus = 3, Stimpack = 1 }",
            );
            Vec::new()
        }
    }
}

fn goal(fields: &mut Fields<'_>, zones: &[Zone], mistakes: &mut Mistakes) -> Goal {
    let patrol = fields.texts("patrol", mistakes).unwrap_or_default();
    if let Some((_, at)) = patrol.get(16) {
        mistakes.add(*at, "a patrol has at most 16 zones");
    }
    let patrol: Vec<u8> = patrol
        .into_iter()
        .filter_map(|(name, at)| zone(name, at, zones, mistakes))
        .take(16)
        .collect();
    match fields.text("goal", mistakes) {
        Some((_, at)) if !patrol.is_empty() => {
            mistakes.add(at, "a monster has a goal or a patrol; leave one out");
            Goal::Patrol(patrol)
        }
        None if !patrol.is_empty() => Goal::Patrol(patrol),
        None => Goal::None,
        Some(("wander", _)) => Goal::Wander,
        Some(("chase", _)) => Goal::Chase,
        Some((_, at)) => {
            mistakes.add(at, "goal must be \"wander\" or \"chase\"; for a patrol write patrol = [\"one_zone\", \"another\"]");
            Goal::None
        }
    }
}
