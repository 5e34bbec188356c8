//! Reads `[map]`: tiles drawn with letters, the map of a built-in scenario, of a file, or one made
//! anew at each reset.

use super::fields::{Fields, own_name, wholes};
use super::mistakes::{Mistakes, excerpt, unknown};
use super::model::{Idle, MOST_ZONES, MapPlan, TileKind, Zone};
use super::read_tiles::{drawn, generated};
use super::tree::{Node, Value};
use super::{map_file, textures};
use crate::Scenario;
use hasard_engine::world::ActorKind;

/// The fields of which `[map]` has one: what the map is made of.
pub(super) const SOURCES: [&str; 5] = ["ascii", "builtin", "wad", "udmf", "generate"];

/// Reads the section. Zones of tiles are added to `zones`.
pub(super) fn map(
    node: Option<&Node>,
    zones: &mut Vec<Zone>,
    mistakes: &mut Mistakes,
) -> Option<MapPlan> {
    let Some(node) = node else {
        mistakes.add(0, "there is no [map]; draw one: ascii = \"\"\"...\"\"\" with # for rock, . for ground, @ for the start");
        return None;
    };
    let mut fields = Fields::of(node, "[map]", mistakes);
    let ascii = fields.text("ascii", mistakes);
    let built_in = fields.text("builtin", mistakes);
    let wad = fields.text("wad", mistakes);
    let udmf = fields.text("udmf", mistakes);
    let [files, left_out, unread] = ["files", "left_out", "unread"].map(|name| fields.node(name));
    let beneath = map_file::Beneath { files, left_out, unread };
    let generate = fields.node("generate");
    let side = fields.whole("tile", 32, 512, mistakes).unwrap_or(64) as i32;
    let level = fields.whole("level", 1, 3, mistakes).unwrap_or(1) as u8;
    let legend = fields.node("legend");
    fields.finish(mistakes);
    let given: Vec<&str> =
        SOURCES.into_iter().filter(|source| node.get(source).is_some()).collect();
    if let [first, .., last] = given[..] {
        let all = if given.len() == 2 { "both".to_string() } else { given.len().to_string() };
        mistakes.add(
            node.at,
            format!(
                "[map] has {all}, {}, and needs one of them: keep {first} or {last}",
                given.join(" and ")
            ),
        );
        return None;
    }
    if given.is_empty() {
        mistakes.add(
            node.at,
            "[map] needs one of: ascii = \"\"\"...\"\"\", builtin = \"RemedyRush\", wad = \"x.wad#MAP01\", \
             udmf = \"x.udmf\", [map.generate]",
        );
        return None;
    }
    if let Some((name, at)) = built_in {
        let found = Scenario::ALL.into_iter().find(|scenario| scenario.name == name);
        if found.is_none() {
            mistakes.add(at, unknown("scenario", name, Scenario::ALL.map(Scenario::name)));
        }
        return found.map(|scenario| MapPlan::BuiltIn(scenario, level));
    }
    if let Some(named) = wad.or(udmf) {
        return map_file::drawn(named, &beneath, mistakes);
    }
    let mut kinds = vec![usual('#'), usual('.'), usual('@'), usual(' ')];
    if let Some(legend) = legend {
        read_legend(legend, &mut kinds, zones, mistakes);
    }
    // The start is ground like any other, where the legend says nothing of it.
    let said = legend.is_some_and(|legend| legend.get("@").is_some());
    let ground = kinds.iter().find(|kind| kind.letter == '.').cloned();
    if let (false, Some(start), Some(ground)) =
        (said, kinds.iter_mut().find(|kind| kind.letter == '@'), ground)
    {
        *start = TileKind { letter: '@', start: true, start_angle: start.start_angle, ..ground };
    }
    let tiles = match (ascii, generate) {
        (Some((text, at)), _) => drawn(text, at, side, kinds, mistakes),
        (None, Some(node)) => generated(node, side, kinds, mistakes),
        (None, None) => None,
    };
    tiles.map(MapPlan::Tiles)
}

/// What a map says that has no effect, since it is of another kind.
pub(super) fn idle(map: &Node) -> Vec<Idle> {
    let Some(source) = SOURCES.into_iter().find(|source| map.get(source).is_some()) else {
        return Vec::new();
    };
    let of_tiles = ("`ascii` and [map.generate]", &["ascii", "generate"][..]);
    let of_built_in = ("`builtin`", &["builtin"][..]);
    let mut found = Vec::new();
    for (key, (instead, sources)) in
        [("tile", of_tiles), ("legend", of_tiles), ("level", of_built_in)]
    {
        if let Some(entry) = map.get(key).filter(|_| !sources.contains(&source)) {
            found.push(Idle { field: key.to_string(), at: entry.at, instead });
        }
    }
    if let ("generate", Some(Value::Table(letters))) =
        (source, map.get("legend").map(|legend| &legend.node.value))
    {
        let liked = |key: &str| {
            letters
                .iter()
                .any(|other| other.node.get("like").and_then(|like| like.node.text()) == Some(key))
        };
        let instead = "maps that are drawn; one that is made anew is of the letters . and #";
        let others = letters.iter().filter(|one| !matches!(&*one.key, "." | "#"));
        found.extend(others.filter(|one| !liked(&one.key)).map(|one| Idle {
            field: one.key.clone(),
            at: one.at,
            instead,
        }));
    }
    found
}

/// What a letter is that the legend does not say otherwise of.
fn usual(letter: char) -> TileKind {
    TileKind {
        letter,
        rock: matches!(letter, '#' | ' '),
        floor: [0, 0],
        ceiling: 128,
        light: 192,
        floor_texture: "FLAT5_5",
        ceiling_texture: "FLAT19",
        wall: (letter == '#').then_some("BIGSTON3"),
        step: "BIGSTON3",
        zone: None,
        damage: None,
        start: letter == '@',
        start_angle: 90,
        thing: None,
        waggle: None,
    }
}

fn read_legend(
    legend: &Node,
    kinds: &mut Vec<TileKind>,
    zones: &mut Vec<Zone>,
    mistakes: &mut Mistakes,
) {
    let Value::Table(entries) = &legend.value else {
        mistakes.add(legend.at, "[map.legend] must be a table of letters");
        return;
    };
    for entry in entries {
        let mut letters = entry.key.chars();
        let (Some(letter), None) = (letters.next(), letters.next()) else {
            mistakes.add(
                entry.at,
                format!("legend `{}`: a single letter stands for a tile", excerpt(&entry.key)),
            );
            continue;
        };
        if kinds.len() >= 64 {
            mistakes.add(entry.at, "at most 60 letters");
            return;
        }
        let kind = tile_kind(letter, &entry.node, kinds, zones, mistakes);
        kinds.retain(|known| known.letter != letter);
        kinds.push(kind);
    }
}

fn tile_kind(
    letter: char,
    node: &Node,
    kinds: &[TileKind],
    zones: &mut Vec<Zone>,
    mistakes: &mut Mistakes,
) -> TileKind {
    let mut fields = Fields::of(node, "a letter of the legend", mistakes);
    let known = kinds.iter().find(|known| known.letter == letter).cloned();
    let mut kind = known.unwrap_or_else(|| TileKind { letter, ..usual('.') });
    if let Some((like, at)) = fields.text("like", mistakes) {
        let base = kinds.iter().find(|known| like.chars().eq([known.letter]));
        match base {
            Some(base) => kind = TileKind { letter, ..base.clone() },
            None => mistakes.add(
                at,
                format!(
                    "like = \"{}\": the legend has no such letter before this one",
                    excerpt(like)
                ),
            ),
        }
    }
    let whole = |key, fields: &mut Fields<'_>, from, to, mistakes: &mut Mistakes| {
        fields.whole(key, from, to, mistakes).map(|number| number as i32)
    };
    if let Some(node) = fields.node("floor") {
        match node.value {
            Value::Whole(height) if (-2048..=2048).contains(&height) => {
                kind.floor = [height as i32; 2]
            }
            Value::List(_) => {
                kind.floor = wholes::<2>(node, "floor", -2048, 2048, mistakes).unwrap_or(kind.floor)
            }
            _ => mistakes.add(
                node.at,
                "floor must be a height from -2048 to 2048, or [lowest, highest] for one at random",
            ),
        }
        if kind.floor[0] > kind.floor[1] {
            mistakes.add(node.at, "floor = [lowest, highest]: the lower one comes first");
            kind.floor.reverse();
        }
    }
    kind.ceiling = whole("ceiling", &mut fields, -2048, 4096, mistakes).unwrap_or(kind.ceiling);
    kind.light = whole("light", &mut fields, 0, 255, mistakes).unwrap_or(kind.light);
    for (key, place) in [
        ("floor_texture", &mut kind.floor_texture),
        ("ceiling_texture", &mut kind.ceiling_texture),
        ("step", &mut kind.step),
    ] {
        if let Some((name, at)) = fields.text(key, mistakes) {
            *place = textures::named(name, at, mistakes).unwrap_or(*place);
        }
    }
    let before = kind.wall;
    if let Some((name, at)) = fields.text("wall", mistakes) {
        kind.wall = textures::named(name, at, mistakes).or(before);
    }
    if fields.node("rock").is_some() {
        kind.rock = fields.flag("rock", mistakes);
    } else if fields.node("wall").is_some()
        && before.is_none()
        && fields.node("floor").is_none()
        && fields.node("like").is_none()
    {
        // A letter that has a wall and nothing to stand on.
        kind.rock = true;
    }
    if fields.flag("sky", mistakes) {
        kind.ceiling_texture = "F_SKY1";
    }
    if fields.node("start").is_some() {
        kind.start = fields.flag("start", mistakes);
    }
    kind.start_angle = whole("angle", &mut fields, -360, 360, mistakes).unwrap_or(kind.start_angle);
    if let Some((name, at)) = fields.text("zone", mistakes) {
        kind.zone = tile_zone(name, at, zones, mistakes);
    }
    if let Some(node) = fields.node("damage") {
        let mut damage = Fields::of(node, "damage", mistakes);
        let points = whole("points", &mut damage, 0, 10_000, mistakes).unwrap_or(1);
        let every = whole("every", &mut damage, 1, 10_000, mistakes).unwrap_or(4);
        damage.finish(mistakes);
        kind.damage = (points > 0).then_some([points, every]);
    }
    if let Some(node) = fields.node("waggle") {
        let mut waggle = Fields::of(node, "waggle", mistakes);
        let height = whole("height", &mut waggle, 0, 512, mistakes).unwrap_or(16);
        let period = whole("period", &mut waggle, 16, 4096, mistakes).unwrap_or(70);
        waggle.finish(mistakes);
        kind.waggle = (height > 0).then_some([height, period]);
    }
    if let Some((name, at)) = fields.text("thing", mistakes) {
        kind.thing = actor(name, at, mistakes);
        if kind.thing.is_some_and(|thing| thing.info().editor_number == 0) {
            mistakes.add(at, format!("no map has a {name}; put it down with [[spawn]]"));
        }
    }
    fields.finish(mistakes);
    if !kind.rock && kind.ceiling < kind.floor[1] + 1 {
        mistakes.add(
            node.at,
            format!("the ceiling ({}) must be above the floor ({}); a closed door is a floor a little below the ceiling", kind.ceiling, kind.floor[1]),
        );
    }
    kind
}

/// Whether a zone can have a name; notes why not.
pub(super) fn zone_name(name: &str, at: usize, mistakes: &mut Mistakes) -> bool {
    if name == "free" {
        mistakes.add(at, "`free` is every place that does not hurt; call the zone otherwise");
        return false;
    }
    own_name(name, at, "zone", mistakes)
}

/// The zone of that name, new if there is none.
fn tile_zone(name: &str, at: usize, zones: &mut Vec<Zone>, mistakes: &mut Mistakes) -> Option<u8> {
    if let Some(index) = zones.iter().position(|zone| zone.name == name) {
        return Some(index as u8);
    }
    if !zone_name(name, at, mistakes) {
        return None;
    }
    if zones.len() == MOST_ZONES {
        mistakes.add(at, format!("at most {MOST_ZONES} zones"));
        return None;
    }
    zones.push(Zone { name: name.to_string(), area: None, tags: None });
    Some((zones.len() - 1) as u8)
}

/// The kinds that a task may put down: not the agent, nor the places that monsters walk to.
pub(super) fn known_kinds() -> impl Iterator<Item = ActorKind> {
    ActorKind::all().filter(|kind| !matches!(kind, ActorKind::Player | ActorKind::PatrolPoint))
}

/// A kind of thing by its name.
pub(super) fn actor(name: &str, at: usize, mistakes: &mut Mistakes) -> Option<ActorKind> {
    let named = ActorKind::from_class_name(name);
    let found = known_kinds().find(|kind| named == Some(*kind));
    if found.is_none() {
        mistakes.add(at, unknown("kind of thing", name, known_kinds().map(ActorKind::class_name)));
    }
    found
}
