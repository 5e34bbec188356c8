//! Return against cost: what each algorithm trades.

use super::main_results::comparable_end;
use super::{distinct, main_groups};
use crate::chart::{Ink, Spot, SpotKind as Kind, figure, scatter_panel};
use crate::document::{Block, Figure, Section, number, slug};
use crate::group::{Group, Source, algorithm_order, scenario_name, scenario_order};
use crate::statistics::Estimate;

/// A panel for each environment on which several experiments can be compared.
pub(super) fn section(groups: &[Group]) -> Section {
    let settings = main_groups(groups);
    let mut blocks = Vec::new();
    for (setting, members) in &settings {
        for level in distinct(members, |group| group.config().level) {
            let here: Vec<&Group> =
                members.iter().copied().filter(|group| group.config().level == level).collect();
            let scenarios = distinct(&here, |group| {
                (scenario_order(&group.config().scenario), group.config().scenario.clone())
            });
            let panels: Vec<_> = scenarios
                .iter()
                .filter_map(|(_, scenario)| {
                    let own: Vec<&Group> = here
                        .iter()
                        .copied()
                        .filter(|group| group.config().scenario == *scenario)
                        .collect();
                    (own.len() > 1).then(|| {
                        let budget = own[0].config().budget();
                        let axes = ("cost an episode", "return an episode");
                        scatter_panel(
                            &scenario_name(scenario),
                            axes,
                            &spots(&own),
                            budget,
                            (410.0, 290.0),
                        )
                    })
                })
                .collect();
            if panels.is_empty() {
                continue;
            }
            let mut legend: Vec<(String, Ink)> = distinct(&here, |group| {
                (algorithm_order(&group.config().algo), group.config().algo.clone())
            })
            .into_iter()
            .map(|(order, algo)| (algo, Ink::Series(order)))
            .collect();
            legend.push(("budget".into(), Ink::Budget));
            let name = if settings.len() > 1 {
                format!("pareto level {level} {setting}")
            } else {
                format!("pareto level {level}")
            };
            blocks.push(Block::Figure(Figure {
                slug: slug(&name),
                caption: format!("Level {level}; {setting}"),
                drawing: figure("", panels, 3, &legend),
            }));
        }
    }
    Section {
        slug: "pareto".into(),
        title: "Return against cost".into(),
        text: vec![
            "Large dots: means over seeds with 95 % intervals both ways; small dots: the seeds; pale squares: the paper's after 500M frames, beside runs that went at least half as far. Right of the dashed line is above the \
             budget. The thin line joins what no other beats in both return and cost."
                .into(),
        ],
        blocks,
    }
}

fn spots(groups: &[&Group]) -> Vec<Spot> {
    // Evaluations where all have one: points from two sources do not compare.
    let evaluated = groups.iter().all(|group| group.headline() == Source::Evaluation);
    let source = if evaluated { Source::Evaluation } else { Source::Training };
    let mut spots = Vec::new();
    for group in groups {
        let ink = Ink::Series(algorithm_order(&group.config().algo));
        let (returns, costs) =
            (group.samples(source, "return_mean"), group.samples(source, "cost_mean"));
        let (Some(episode_return), Some(cost)) = (Estimate::of(&returns), Estimate::of(&costs))
        else {
            continue;
        };
        let interval = |one: Estimate| one.half_width.map(|_| (one.low(), one.high()));
        let name = format!(
            "{}: return {}, cost {}",
            group.config().algo,
            number(episode_return.mean),
            number(cost.mean)
        );
        if returns.len() > 1 {
            let seeds = costs.iter().zip(&returns).map(|(x, y)| Spot {
                name: name.clone(),
                ink,
                at: (*x, *y),
                intervals: [None, None],
                kind: Kind::Seed,
            });
            spots.extend(seeds);
        }
        let intervals = [interval(cost), interval(episode_return)];
        spots.push(Spot {
            name,
            ink,
            at: (cost.mean, episode_return.mean),
            intervals,
            kind: Kind::Mean,
        });
        if let Some(paper) = comparable_end(group) {
            let name = format!(
                "{} (paper): return {}, cost {}",
                paper.algorithm,
                number(paper.episode_return),
                number(paper.cost)
            );
            spots.push(Spot {
                name,
                ink,
                at: (paper.cost, paper.episode_return),
                intervals: [None, None],
                kind: Kind::Paper,
            });
        }
    }
    spots
}
