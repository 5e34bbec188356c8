//! What a file says that can never happen.

use super::mistakes::Mistakes;
use super::model::{GenerateKind, MapPlan, Names, Of, Plan, TileKind, Trigger, When, Zone};
use hasard_engine::world::{ActorFlags, ActorKind};

/// Warns of what happens in none of the settings.
pub(super) fn warn(plans: &[Plan], names: &Names, mistakes: &mut Mistakes) {
    let Some(first) = plans.first() else { return };
    for (index, when) in first.whens.iter().enumerate() {
        let possible =
            |plan: &Plan| plan.whens.get(index).is_some_and(|when| can_happen(plan, when));
        if !plans.iter().any(possible) {
            mistakes.warn(when.at, format!("this never happens: {}", why(first, names, when)));
        }
    }
    warn_of_conditions(plans, names, mistakes);
    let starts = |plan: &Plan| match &plan.map {
        MapPlan::Tiles(tiles) => {
            let mut here = tiles.tiles.iter().map(|tile| &tiles.kinds[usize::from(*tile)]);
            // On a map that is made anew the agent appears anywhere.
            let anywhere = plan.player.place.is_some() || tiles.generate.is_some();
            anywhere || here.any(|kind| kind.start && !kind.rock)
        }
        MapPlan::BuiltIn(..) | MapPlan::Drawn(_) => true,
    };
    if !plans.iter().all(starts) {
        mistakes.warn(
            0,
            "no tile is a start: the agent stands in the south-west; draw an @, or write [player] in = \"free\"",
        );
    }
    for idle in first.idle.iter().filter(|idle| plans.iter().all(|plan| plan.idle.contains(idle))) {
        let (field, instead) = (&idle.field, idle.instead);
        mistakes.warn(idle.at, format!("`{field}` has no effect here: it is for {instead}"));
    }
    warn_of_low_ceilings(plans, mistakes);
    for (index, spawn) in first.spawns.iter().enumerate() {
        let used = |plan: &Plan| {
            let spawn = plan
                .spawns
                .get(index)
                .is_some_and(|spawn| spawn.count > 0 || (spawn.every > 0 && spawn.each > 0));
            spawn
                || plan
                    .whens
                    .iter()
                    .any(|when| when.spawn.iter().any(|named| usize::from(*named) == index))
        };
        let idle = |plan: &Plan| plan.spawns.get(index).and_then(|spawn| spawn.idle);
        if let Some((key, at)) = idle(first).filter(|_| plans.iter().all(|one| idle(one).is_some()))
        {
            mistakes.warn(
                at,
                format!("`{key}` has no effect without `every`, the tics between two supplies"),
            );
        }
        if !plans.iter().any(used) {
            mistakes.warn(
                spawn.at,
                "nothing of this [[spawn]] ever appears: its count is 0, it has no `every`, and no [[when]] calls it",
            );
        }
    }
    if !plans.iter().any(|plan| plan.whens.iter().any(|when| when.reward != 0.0)) {
        mistakes.warn(0, "no [[when]] gives a reward: there is nothing to learn");
    }
    warn_of_costs(plans, names, mistakes);
}

/// Warns of cost terms that stay 0, and of a budget that nothing takes from.
fn warn_of_costs(plans: &[Plan], names: &Names, mistakes: &mut Mistakes) {
    let whens = || plans.iter().flat_map(|plan| &plan.whens);
    for (index, term) in names.terms.iter().enumerate() {
        let own = |cost: &&(u8, f64)| usize::from(cost.0) == index;
        let charges: Vec<&(u8, f64)> = whens().flat_map(|when| &when.costs).filter(own).collect();
        let name = &term.name;
        if charges.is_empty() {
            mistakes.warn(0, format!("cost term {name} is charged by no [[when]]"));
        } else if charges.iter().all(|(_, amount)| *amount == 0.0) {
            mistakes
                .warn(0, format!("cost term {name} is always 0: that is what [[when]] charges"));
        }
    }
    let budget = plans.iter().map(|plan| plan.budget).fold(0.0, f64::max);
    if names.terms.is_empty() && budget > 0.0 {
        mistakes.warn(
            0,
            format!("no [[when]] charges a cost: every episode keeps the budget of {budget}"),
        );
    }
}

/// Warns of places that the agent is put on and has no room to stand, and of platforms too near the
/// ceiling to walk on.
fn warn_of_low_ceilings(plans: &[Plan], mistakes: &mut Mistakes) {
    let agent = ActorKind::Player.height().floor();
    for plan in plans {
        let MapPlan::Tiles(tiles) = &plan.map else { continue };
        let here = |kind: &TileKind| {
            tiles.generate.is_some()
                || tiles.tiles.iter().any(|tile| tiles.kinds[usize::from(*tile)] == *kind)
        };
        let low = |kind: &&TileKind| {
            kind.start && !kind.rock && here(kind) && kind.ceiling - kind.floor[1] < agent
        };
        if let Some(kind) = tiles.kinds.iter().find(low) {
            mistakes.warn(
                0,
                format!(
                    "the agent is {agent} high, and there are {} from floor to ceiling at its start `{}`: it cannot move",
                    kind.ceiling - kind.floor[1],
                    kind.letter
                ),
            );
        }
        let ground = tiles.kinds.iter().find(|kind| kind.letter == '.');
        if let (Some(generate), Some(ground)) = (tiles.generate, ground)
            && generate.kind == GenerateKind::Platforms
            && generate.heights[1] + agent > ground.ceiling
        {
            mistakes.warn(
                0,
                format!(
                    "platforms of heights up to {} leave the agent, {agent} high, no room below the ceiling of {}: lower `heights`, or raise the ceiling of letter `.`",
                    generate.heights[1], ground.ceiling
                ),
            );
        }
    }
}

/// Warns of conditions on counters that nothing changes: a counter is 0 then, whatever happens.
fn warn_of_conditions(plans: &[Plan], names: &Names, mistakes: &mut Mistakes) {
    let changes = |counter: u8| {
        let of = move |(of, _): &(u8, i32)| *of == counter;
        let mut whens = plans.iter().flat_map(|plan| &plan.whens);
        whens.any(|when| when.counts.iter().any(of) || when.sets.iter().any(of))
    };
    let first = plans.first().into_iter().flat_map(|plan| &plan.whens);
    for when in first {
        for (counter, _) in when.conditions.iter().filter(|(counter, _)| !changes(*counter)) {
            let name = names.counters.get(usize::from(*counter)).map_or("", |name| name);
            mistakes.warn(
                when.at,
                format!("nothing counts {name}, so it is always 0: is its name right in `if`?"),
            );
        }
    }
}

/// Whether something of a plan sets a rule off.
fn can_happen(plan: &Plan, when: &When) -> bool {
    when.zone.is_none_or(|zone| is_somewhere(plan, zone)) && can_occur(plan, when.trigger)
}

fn can_occur(plan: &Plan, trigger: Trigger) -> bool {
    match trigger {
        Trigger::Pickup(of) => appears(plan, of, can_be_taken),
        Trigger::Kill(of) | Trigger::Hit(of) => appears(plan, of, can_be_shot),
        Trigger::Near { of, .. } => appears(plan, of, |_| true),
        Trigger::Enter(zone) | Trigger::Leave(zone) | Trigger::In(zone) => is_somewhere(plan, zone),
        Trigger::Damage { kinds: 0, zones } => harmful(plan, zones),
        Trigger::Jump => presses(plan, "JUMP"),
        Trigger::Use => presses(plan, "USE"),
        Trigger::Shot => presses(plan, "ATTACK") && is_armed(plan),
        Trigger::Timer { first, .. } => first <= plan.tics,
        Trigger::Counter { counter, .. } => {
            let counts = |(of, _): &(u8, i32)| *of == counter;
            plan.whens
                .iter()
                .any(|when| when.counts.iter().any(counts) || when.sets.iter().any(counts))
        }
        _ => true,
    }
}

fn can_be_taken(kind: ActorKind) -> bool {
    kind.info().flags.any(ActorFlags::ITEM)
}

fn can_be_shot(kind: ActorKind) -> bool {
    kind.info().flags.any(ActorFlags::SHOOTABLE)
}

/// Whether the agent has a weapon, or can come by one.
fn is_armed(plan: &Plan) -> bool {
    let all = Of { kinds: u128::MAX, spawns: 0 };
    !plan.player.weapons.is_empty() || appears(plan, all, |kind| kind.weapon().is_some())
}

fn why(plan: &Plan, names: &Names, when: &When) -> String {
    let nowhere = |zone: u8| match plan.zones.get(usize::from(zone)) {
        Some(Zone { name, area: Some(_), .. }) => {
            format!("zone {name} is a rectangle without ground; the map's south-west is [0, 0]")
        }
        zone => format!("no tile is of zone {}", zone.map_or("", |zone| &zone.name)),
    };
    if let Some(zone) = when.zone.filter(|zone| !is_somewhere(plan, *zone)) {
        return nowhere(zone);
    }
    let there = |of: Of| appears(plan, of, |_| true);
    match when.trigger {
        Trigger::Enter(of) | Trigger::Leave(of) | Trigger::In(of) => nowhere(of),
        Trigger::Damage { .. } => {
            "no floor of that zone does damage; give its letter damage = { points = 1, every = 4 }"
                .to_string()
        }
        Trigger::Counter { counter, .. } => {
            format!(
                "nothing counts {}",
                names.counters.get(usize::from(counter)).map_or("", |name| name)
            )
        }
        Trigger::Jump => "no action is JUMP".to_string(),
        Trigger::Use => "no action is USE".to_string(),
        Trigger::Shot if presses(plan, "ATTACK") => {
            "the agent has no weapon; write [player] weapons = [\"Pistol\"]".to_string()
        }
        Trigger::Shot => "no action is ATTACK".to_string(),
        Trigger::Timer { first, .. } => {
            format!("its first time is tic {first}, and an episode has {}", plan.tics)
        }
        Trigger::Pickup(of) if there(of) => {
            "nobody can pick up such a thing; name another in `of`".to_string()
        }
        Trigger::Kill(of) | Trigger::Hit(of) if there(of) => {
            "nobody can shoot such a thing; name another in `of`".to_string()
        }
        _ => "no such thing ever appears; put one down with [[spawn]] or the legend's `thing`"
            .to_string(),
    }
}

/// Whether any of some things that are `able` ever is in the world.
fn appears(plan: &Plan, of: Of, able: fn(ActorKind) -> bool) -> bool {
    let asked = |kind: ActorKind| of.kinds >> (kind as u32) & 1 == 1 && able(kind);
    let spawned = plan.spawns.iter().enumerate().any(|(index, spawn)| {
        let called = plan
            .whens
            .iter()
            .any(|when| when.spawn.iter().any(|named| usize::from(*named) == index));
        let there = spawn.count > 0 || spawn.every > 0 || called;
        let named = of.spawns >> index & 1 == 1;
        there && spawn.kinds.iter().any(|(kind, _)| asked(*kind) || named && able(*kind))
    });
    let drawn = match &plan.map {
        MapPlan::Tiles(tiles) => {
            tiles.kinds.iter().filter(|kind| !kind.rock).filter_map(|kind| kind.thing).any(asked)
        }
        // What stands in it is not looked up.
        MapPlan::BuiltIn(..) | MapPlan::Drawn(_) => ActorKind::all().any(asked),
    };
    spawned || drawn
}

fn is_somewhere(plan: &Plan, zone: u8) -> bool {
    let own = &plan.zones[usize::from(zone)];
    match (&plan.map, own.area) {
        (MapPlan::Tiles(tiles), Some(area)) => tiles.has_ground_in(area),
        (MapPlan::Tiles(tiles), None) if own.tags.is_none() => tiles.tiles.iter().any(|tile| {
            let kind = &tiles.kinds[usize::from(*tile)];
            kind.zone == Some(zone) && !kind.rock
        }),
        _ => true,
    }
}

fn harmful(plan: &Plan, zones: u32) -> bool {
    // What lies below a rectangle is not looked up.
    let rectangle =
        plan.zones.iter().enumerate().any(|(zone, of)| zones >> zone & 1 == 1 && of.area.is_some());
    rectangle
        || match &plan.map {
            MapPlan::Tiles(tiles) => tiles.tiles.iter().any(|tile| {
                let kind = &tiles.kinds[usize::from(*tile)];
                !kind.rock
                    && kind.damage.is_some()
                    && kind.zone.is_some_and(|zone| zones >> zone & 1 == 1)
            }),
            MapPlan::BuiltIn(..) | MapPlan::Drawn(_) => true,
        }
}

/// Whether a button is among the actions.
fn presses(plan: &Plan, button: &str) -> bool {
    plan.actions.iter().flatten().any(|name| *name == button)
}

#[cfg(test)]
mod tests;
