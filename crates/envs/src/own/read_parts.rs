//! Reads what several sections have: zones, places, heights, cost terms, amounts.

use super::fields::{Fields, number, own_name, wholes};
use super::mistakes::{Mistakes, excerpt, unknown};
use super::model::{Height, Names, Place, Term, Zone};
use super::tree::{Node, Value};
use crate::scenarios::common::outcome::MOST_TERMS;

/// Farthest from the origin that anything lies, map units.
pub(super) const FARTHEST: i64 = 16_000;

/// The number of a zone.
pub(super) fn zone(name: &str, at: usize, zones: &[Zone], mistakes: &mut Mistakes) -> Option<u8> {
    let found = zones.iter().position(|zone| zone.name == name);
    if found.is_none() && zones.is_empty() {
        let name = excerpt(name);
        mistakes.add(
            at,
            format!("zone `{name}` is unknown; give its letter of the legend zone = \"{name}\""),
        );
    } else if found.is_none() {
        mistakes.add(at, unknown("zone", name, zones.iter().map(|zone| &*zone.name)));
    }
    found.map(|index| index as u8)
}

/// The same of a zone whose floor or light is to change: a rectangle has none of its own.
pub(super) fn ground(name: &str, at: usize, zones: &[Zone], mistakes: &mut Mistakes) -> Option<u8> {
    let found = zone(name, at, zones, mistakes)?;
    if zones[usize::from(found)].area.is_some() {
        mistakes.add(
            at,
            format!("zone `{name}` is a rectangle, without floor or light of its own; give its tiles a letter with zone = \"{name}\""),
        );
        return None;
    }
    Some(found)
}

/// A place: `free`, a zone, or a rectangle.
pub(super) fn place(node: &Node, zones: &[Zone], mistakes: &mut Mistakes) -> Option<Place> {
    match &node.value {
        Value::Text(text) if text == "free" => Some(Place::Free),
        Value::Text(text) => zone(text, node.at, zones, mistakes).map(Place::Zone),
        _ => rectangle(node, "a place, if it is neither \"free\" nor a zone,", mistakes)
            .map(Place::Area),
    }
}

/// A rectangle: west, south, east, north.
pub(super) fn rectangle(node: &Node, what: &str, mistakes: &mut Mistakes) -> Option<[i32; 4]> {
    let area = wholes::<4>(node, what, -FARTHEST, FARTHEST, mistakes)?;
    let [west, south, east, north] = area;
    if west >= east || south >= north {
        mistakes.add(
            node.at,
            "a rectangle is [west, south, east, north], west below east and south below north",
        );
        return None;
    }
    Some(area)
}

/// Two whole numbers, the lower one first.
pub(super) fn range(
    node: &Node,
    what: &str,
    from: i64,
    to: i64,
    mistakes: &mut Mistakes,
) -> Option<[i32; 2]> {
    let range = wholes::<2>(node, what, from, to, mistakes)?;
    if range[0] > range[1] {
        let [high, low] = range;
        mistakes
            .add(node.at, format!("[{high}, {low}]: the lower one comes first, [{low}, {high}]"));
        return None;
    }
    Some(range)
}

/// The heights of a thing: above its floor, or absolute.
pub(super) fn height(fields: &mut Fields<'_>, mistakes: &mut Mistakes) -> Height {
    let above = fields.whole("height", 0, 1024, mistakes);
    let absolute = fields.whole("z", -FARTHEST, FARTHEST, mistakes);
    match (above, absolute) {
        (Some(_), Some(_)) => {
            mistakes
                .add(fields.at, "`height` is above the floor and `z` absolute: write one of them");
            Height::Above(0)
        }
        (_, Some(z)) => Height::At(z as i32),
        (above, None) => Height::Above(above.unwrap_or(0) as i32),
    }
}

/// The number of a cost term, which may be new.
pub(super) fn term(
    name: &str,
    at: usize,
    names: &mut Names,
    mistakes: &mut Mistakes,
) -> Option<u8> {
    if let Some(index) = names.terms.iter().position(|known| known.name == name) {
        return Some(index as u8);
    }
    if !own_name(name, at, "cost term", mistakes) {
        return None;
    }
    if names.terms.len() == MOST_TERMS {
        mistakes.add(at, format!("at most {MOST_TERMS} cost terms"));
        return None;
    }
    names.terms.push(Term { name: name.to_string(), counted: true });
    Some((names.terms.len() - 1) as u8)
}

/// A number or none.
pub(super) fn amount(node: &Node, key: &str, mistakes: &mut Mistakes) -> Option<f64> {
    let found = number(node).filter(|number| number.abs() <= 1e9);
    if found.is_none() {
        mistakes.add(node.at, format!("{key} must be a number from -1e9 to 1e9"));
    }
    found
}
