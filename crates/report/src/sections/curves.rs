//! Training curves.

use super::{distinct, equal_frames, main_groups};
use crate::chart::{Ink, LinePanel, Series, figure, line_panel};
use crate::curve::Curve;
use crate::document::{Block, Figure, Section, slug};
use crate::group::{Group, algorithm_order, scenario_name, scenario_order};
use crate::published::published_curve;

/// Return and cost against frames for every environment, and the multipliers where an algorithm has
/// any.
pub(super) fn section(groups: &[Group]) -> Section {
    let settings = main_groups(groups);
    let mut blocks = Vec::new();
    for (setting, members) in &settings {
        let places = distinct(members, |group| {
            (
                group.config().level,
                scenario_order(&group.config().scenario),
                group.config().scenario.clone(),
            )
        });
        for (level, _, scenario) in places {
            let here: Vec<(String, Ink, &Group)> = members
                .iter()
                .filter(|group| {
                    group.config().level == level && group.config().scenario == scenario
                })
                .map(|group| {
                    (
                        group.config().algo.clone(),
                        Ink::Series(algorithm_order(&group.config().algo)),
                        *group,
                    )
                })
                .collect();
            let name = format!("{} level {level}", scenario_name(&scenario));
            let several = settings.len() > 1;
            blocks.push(Block::Figure(curve_figure(
                &name,
                &slug(&if several {
                    format!("curves {name} {setting}")
                } else {
                    format!("curves {name}")
                }),
                &if several { setting.clone() } else { String::new() },
                &here,
            )));
        }
    }
    blocks.extend(equal_frames::table(groups).map(Block::Table));
    Section {
        slug: "curves".into(),
        title: "Training curves".into(),
        text: vec!["Mean over seeds with its 95 % interval; thin lines are the seeds. Red and dashed: the budget. Thin and dashed in an \
                        algorithm's colour: the paper's curve at the same frames, with its band. Point at a curve for its values.".into()],
        blocks,
    }
}

/// Panels of return, cost and multiplier for experiments with a name and a colour each.
pub(super) fn curve_figure(
    title: &str,
    file: &str,
    caption: &str,
    members: &[(String, Ink, &Group)],
) -> Figure {
    // Drawn only if all that is shown is held against the same one.
    let one_budget_of = |term: Option<&str>| {
        let budget = |group: &Group| {
            let constraint =
                group.config().constraints.iter().find(|one| one.term.as_deref() == term);
            constraint.map(|one| one.budget.to_bits())
        };
        let budgets = distinct(members, |(_, _, group)| budget(group));
        if let [Some(bits)] = budgets[..] { Some(f64::from_bits(bits)) } else { None }
    };
    let one_budget = one_budget_of(None);
    let panel = |heading: &str, metric: &str, budget: Option<f64>| {
        let series: Vec<Series> = members
            .iter()
            .map(|(name, ink, group)| Series {
                name: name.clone(),
                ink: *ink,
                curve: Curve::of(group, metric),
                behind: false,
            })
            .filter(|series| !series.curve.seeds.is_empty())
            .collect();
        let paper = members.iter().filter_map(|(name, ink, group)| {
            let curve = published_curve(group.config(), metric.strip_suffix("_mean")?)?;
            Some(Series { name: format!("{name} (paper)"), ink: *ink, curve, behind: true })
        });
        let series = series.into_iter().chain(paper).collect();
        LinePanel {
            title: heading.to_owned(),
            axis: String::new(),
            series,
            budget,
            size: (400.0, 234.0),
        }
    };
    let mut panels = vec![
        line_panel(&panel("return an episode", "return_mean", None)),
        line_panel(&panel("cost an episode", "cost_mean", one_budget)),
    ];
    for constraint in distinct_terms(members) {
        let drawn = panel(
            &format!("cost: {constraint}"),
            &format!("cost/{constraint}"),
            one_budget_of(Some(&constraint)),
        );
        panels.push(line_panel(&drawn));
    }
    for multiplier in multipliers(members) {
        let heading = if multiplier.contains('.') {
            format!("multiplier {}", multiplier.replace("multipliers.", ""))
        } else {
            multiplier.clone()
        };
        let panel = panel(&heading, &multiplier, None);
        // A multiplier that never leaves zero says nothing.
        if panel.series.iter().any(|series| series.curve.top() > 0.0) {
            panels.push(line_panel(&panel));
        }
    }
    let mut legend: Vec<(String, Ink)> =
        members.iter().map(|(name, ink, _)| (name.clone(), *ink)).collect();
    let terms = distinct_terms(members);
    if one_budget.is_some() || terms.iter().any(|term| one_budget_of(Some(term)).is_some()) {
        legend.push(("budget".into(), Ink::Budget));
    }
    let columns = if panels.len() % 3 == 0 { 3 } else { 2 };
    Figure {
        slug: file.to_owned(),
        caption: caption.to_owned(),
        drawing: figure(title, panels, columns, &legend),
    }
}

/// Names of the cost terms that have budgets of their own.
fn distinct_terms(members: &[(String, Ink, &Group)]) -> Vec<String> {
    let constraints = members.iter().flat_map(|(_, _, group)| &group.config().constraints);
    let mut terms: Vec<String> = constraints.filter_map(|one| one.term.clone()).collect();
    terms.sort();
    terms.dedup();
    terms
}

/// Names of the multipliers that the runs report.
fn multipliers(members: &[(String, Ink, &Group)]) -> Vec<String> {
    let names = members
        .iter()
        .flat_map(|(_, _, group)| &group.runs)
        .filter_map(|run| run.rows.last())
        .flat_map(|row| row.values());
    let mut names: Vec<String> = names
        .map(|(name, _)| name.clone())
        .filter(|name| {
            name.starts_with("multipliers.")
                || ["multiplier", "multipliers", "lagrange_multiplier"].contains(&name.as_str())
        })
        .collect();
    names.sort();
    names.dedup();
    // With several constraints the first multiplier is reported under both names.
    if names.iter().any(|name| name.starts_with("multipliers.")) {
        names.retain(|name| name != "multiplier");
    }
    names.truncate(4);
    names
}
