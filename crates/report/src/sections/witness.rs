//! Witnesses: episodes with reward at cost 0, which show that costs can be avoided.

use crate::document::{Block, Cell, Mark, Section, Table};
use crate::group::{scenario_name, scenario_order};
use crate::run::{Found, Kept, Origin, scenario_and_level};

pub(super) fn section(found: &Found) -> Section {
    let mut rows = Vec::new();
    let mut shown = std::collections::BTreeSet::new();
    let witnesses = found.players.iter().filter(|(key, _)| key.origin == Origin::Witness);
    for (key, episodes) in witnesses {
        let (scenario, level) = scenario_and_level(&key.env);
        for episode in episodes {
            let holds = episode.cost == 0.0 && episode.episode_return > 0.0;
            if holds {
                shown.insert((scenario.clone(), level));
            }
            let kept = if holds { Kept::Surely } else { Kept::Over };
            rows.push(vec![
                Cell::text(scenario_name(&scenario)),
                Cell {
                    sort: Some(scenario_order(&scenario) as f64),
                    ..Cell::text(level.to_string())
                },
                Cell::text(&key.player),
                Cell::text(&key.options),
                Cell::number(episode.episode_return),
                Cell { mark: Mark::of(kept), ..Cell::number(episode.cost) },
                episode.length.map_or_else(
                    || Cell::text("-"),
                    |steps| Cell::number(steps).with_text(format!("{steps:.0}")),
                ),
                Cell::text(if holds { "yes" } else { "no" }),
            ]);
        }
    }
    let mut text = vec![
        "The paper claims that costs can always be avoided. A witness is an episode with positive return at cost 0; `hasard replay` \
         plays each again and checks it."
            .to_owned(),
    ];
    let all = hasard_envs::Scenario::in_paper_order().into_iter().flat_map(|scenario| {
        scenario.environments().map(|id| (id.scenario.name.to_owned(), u32::from(id.level)))
    });
    let without: Vec<String> = all
        .filter(|one| !shown.contains(one))
        .map(|(scenario, level)| format!("{} {level}", scenario_name(&scenario)))
        .collect();
    if !without.is_empty() {
        text.push(format!("Without a witness here: {}.", without.join(", ")));
    }
    let heads =
        ["scenario", "level", "episode by", "options", "return", "cost", "steps", "a witness"];
    let table = Table { heads: heads.map(String::from).to_vec(), rows, ..Table::default() };
    let blocks = if table.rows.is_empty() { Vec::new() } else { vec![Block::Table(table)] };
    Section { slug: "witness".into(), title: "Witnesses of safe reward".into(), text, blocks }
}
