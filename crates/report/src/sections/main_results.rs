//! The paper's main tables and bars.

use super::marks::{Final, marks};
use super::{distinct, main_groups};
use crate::chart::{Bar, BarGroup, Ink, bar_panel, figure};
use crate::document::{Block, Cell, Figure, Section, Table, slug};
use crate::group::{Group, Source, algorithm_order, scenario_name, scenario_order};
use crate::published::{Published, published};
use crate::run::{Constraint, Kept};
use crate::statistics::Estimate;

/// Tables of return and cost, a level each, with the paper's values below ours; and the same as
/// bars.
pub(super) fn section(groups: &[Group]) -> Section {
    let settings = main_groups(groups);
    let mut blocks = Vec::new();
    for (setting, members) in &settings {
        for level in distinct(members, |group| group.config().level) {
            let members: Vec<&Group> =
                members.iter().copied().filter(|group| group.config().level == level).collect();
            let source = source_of(&members);
            // A table of evaluations has no rows for what was not evaluated.
            let has = |source| -> Vec<&Group> {
                let own = members
                    .iter()
                    .copied()
                    .filter(|group| !group.samples(source, "return_mean").is_empty());
                own.collect()
            };
            blocks.push(Block::Table(table(&has(source), level, setting, source)));
            // Bars of a few evaluated ones among many would hide the others.
            let all_evaluated = members.iter().all(|group| group.headline() == Source::Evaluation);
            let drawn = if all_evaluated { Source::Evaluation } else { Source::Training };
            blocks.push(Block::Figure(bars(&members, level, setting, settings.len() > 1, drawn)));
            if source == Source::Evaluation {
                blocks.push(Block::Table(table(&members, level, setting, Source::Training)));
            }
        }
    }
    Section {
        slug: "main".into(),
        title: "Results".into(),
        text: vec![
            "First what the selected checkpoints return and cost in closing episodes, which training has not seen; second what the \
             learning policies did at the end of training (the mean over the last ten points, as in the paper). Green ground: the upper \
             end of the cost's interval over seeds is within the budget; green letters: only its mean is. Bold: the best return among \
             those on green ground, or if there are none among those within by their mean, and every other that cannot be distinguished from it (Welch's test, 5 %; with single seeds the best alone). \
             Where none is within, the least cost is bold."
                .into(),
        ],
        blocks,
    }
}

/// Evaluation where any of them was evaluated.
pub(super) fn source_of(members: &[&Group]) -> Source {
    let evaluated = members.iter().any(|group| group.headline() == Source::Evaluation);
    if evaluated { Source::Evaluation } else { Source::Training }
}

/// Cells of return and cost of several experiments on one environment, marked against its budget.
pub(super) fn marked_cells(members: &[&Group], source: Source) -> Vec<(Cell, Cell)> {
    let finals: Vec<Final> = members
        .iter()
        .map(|group| Final {
            returns: group.samples(source, "return_mean"),
            costs: group.samples(source, "cost_mean"),
            kept: group.kept(source),
        })
        .collect();
    let marks = marks(&finals);
    members
        .iter()
        .zip(finals)
        .zip(marks)
        .map(|((group, last), (return_mark, cost_mark))| {
            let mut return_cell = Cell::estimate(Estimate::of(&last.returns), &last.returns);
            let mut cost_cell = cost_cell(group, source);
            return_cell.mark = return_mark;
            cost_cell.mark = cost_mark;
            if !group.finished() && !last.returns.is_empty() {
                return_cell.text += " ‡";
                let asked = group.config().frames.map(crate::document::frames).unwrap_or_default();
                return_cell.title += &format!(
                    "; unfinished: {} of {asked} frames",
                    crate::document::frames(group.frames_span().0)
                );
            }
            if let Some(first) = group.extended_from().filter(|_| !last.returns.is_empty()) {
                return_cell.text += " †";
                return_cell.title += &format!(
                    "; went on beyond its first target of {} frames",
                    crate::document::frames(first)
                );
            }
            (return_cell, cost_cell)
        })
        .collect()
}

/// The costs that an experiment's budgets hold: the whole cost, or each constrained term by its name.
pub(super) fn cost_cell(group: &Group, source: Source) -> Cell {
    let of = |metric: &str| {
        let samples = group.samples(source, metric);
        Cell::estimate(Estimate::of(&samples), &samples)
    };
    let constraints = &group.config().constraints;
    if constraints.iter().all(|one| one.term.is_none()) {
        return of("cost_mean");
    }
    let named = constraints.iter().map(|one| (one, of(&one.metric())));
    let named: Vec<(&Constraint, Cell)> = named.collect();
    let text = named.iter().map(|(one, cell)| one.named(&cell.text));
    let note = named.iter().map(|(_, cell)| cell.note.clone()).min().unwrap_or_default();
    Cell { note, ..Cell::text(text.collect::<Vec<_>>().join(", ")) }
}

fn table(members: &[&Group], level: u32, setting: &str, source: Source) -> Table {
    let scenarios = distinct(members, |group| {
        (scenario_order(&group.config().scenario), group.config().scenario.clone())
    });
    let algorithms = distinct(members, |group| {
        (algorithm_order(&group.config().algo), group.config().algo.clone())
    });
    let mut rows: Vec<Vec<Cell>> = Vec::new();
    for (_, algo) in &algorithms {
        rows.push(vec![Cell { sort: Some(algorithm_order(algo) as f64), ..Cell::text(algo) }]);
        rows.push(vec![Cell {
            text: format!("{algo} (paper)"),
            sort: Some(algorithm_order(algo) as f64 + 0.5),
            pale: true,
            ..Cell::default()
        }]);
    }
    for (_, scenario) in &scenarios {
        let here: Vec<&Group> =
            members.iter().copied().filter(|group| group.config().scenario == *scenario).collect();
        let of = |algo: &str| here.iter().position(|group| group.config().algo == algo);
        let cells = marked_cells(&here, source);
        let papers: Vec<_> = here.iter().map(|group| published(group.config())).collect();
        // The paper prints means alone: within is what its own tables call so.
        let paper_values: Vec<Final> = here
            .iter()
            .zip(&papers)
            .map(|(group, paper)| Final {
                returns: paper.map(|p| p.episode_return).into_iter().collect(),
                costs: paper.map(|p| p.cost).into_iter().collect(),
                kept: paper.map_or(Kept::Unknown, |p| {
                    if p.cost <= group.config().safety_budget { Kept::ByMean } else { Kept::Over }
                }),
            })
            .collect();
        let paper_marks = marks(&paper_values);
        for (row, (_, algo)) in algorithms.iter().enumerate() {
            let missing = || Cell { text: "-".into(), pale: true, ..Cell::default() };
            let (mut ours, mut theirs) = ((missing(), missing()), (missing(), missing()));
            if let Some(at) = of(algo) {
                ours = cells[at].clone();
                let note = papers[at].map(|paper| paper.note()).unwrap_or_default();
                let cell = |value: &[f64], mark| {
                    value.first().map_or_else(missing, |v| Cell {
                        pale: true,
                        mark,
                        title: note.clone(),
                        ..Cell::number(*v)
                    })
                };
                let value = &paper_values[at];
                theirs = (
                    cell(&value.returns, paper_marks[at].0),
                    cell(&value.costs, paper_marks[at].1),
                );
            }
            rows[2 * row].extend([ours.0, ours.1]);
            rows[2 * row + 1].extend([theirs.0, theirs.1]);
        }
    }
    rows.retain(|row| row[1..].iter().any(|cell| cell.text != "-"));
    let mut heads = vec!["algorithm".to_owned()];
    let mut spans = vec![(String::new(), 1)];
    for (_, scenario) in &scenarios {
        let here = members.iter().filter(|group| group.config().scenario == *scenario);
        let budgets = distinct(&here.collect::<Vec<_>>(), |group| budget_label(group));
        spans.push((format!("{} (budget {})", scenario_name(scenario), budgets.join(" / ")), 2));
        heads.extend(["return".into(), "cost".into()]);
    }
    // If every value rests on as many seeds, saying so once is enough.
    let notes = distinct(
        &rows.iter().flatten().filter(|cell| !cell.note.is_empty()).collect::<Vec<_>>(),
        |cell| cell.note.clone(),
    );
    let mut caption = format!("Level {level}, {}; {setting}", source_name(source));
    if let [note] = &notes[..] {
        caption += &format!("; {note} {}", if note == "n=1" { "seed" } else { "seeds" });
        rows.iter_mut().flatten().for_each(|cell| cell.note.clear());
    }
    if rows.iter().any(|row| row[0].text.ends_with("(paper)")) {
        caption += "; the paper's at the end of training, after 500M frames";
    }
    if rows.iter().flatten().any(|cell| cell.text.contains('‡')) {
        caption += "; ‡ not every run has finished";
    }
    if rows.iter().flatten().any(|cell| cell.text.ends_with('†')) {
        caption += "; † went on beyond the frames that its schedules were made for";
    }
    Table { caption, spans, heads, rows }
}

/// What a table's numbers are of.
pub(super) fn source_name(source: Source) -> &'static str {
    match source {
        Source::Evaluation => "evaluation of the selected checkpoints",
        Source::Training => "end of training",
    }
}

/// The budgets of all constraints of an experiment.
pub(super) fn budget_label(group: &Group) -> String {
    group.config().constraints.iter().map(Constraint::label).collect::<Vec<_>>().join(", ")
}

/// The published cell of an experiment that went at least half as far: beside a bar of a short run
/// the paper's bar of 500 million frames would mislead.
pub(super) fn comparable_end(group: &Group) -> Option<&'static Published> {
    published(group.config()).filter(|paper| group.frames_span().1 >= 0.5 * paper.frames())
}

fn bars(
    members: &[&Group],
    level: u32,
    setting: &str,
    several_settings: bool,
    source: Source,
) -> Figure {
    let scenarios = distinct(members, |group| {
        (scenario_order(&group.config().scenario), group.config().scenario.clone())
    });
    let mut panels = Vec::new();
    for (_, scenario) in &scenarios {
        let here: Vec<&Group> =
            members.iter().copied().filter(|group| group.config().scenario == *scenario).collect();
        for metric in ["return", "cost"] {
            let groups: Vec<BarGroup> = here
                .iter()
                .map(|group| {
                    let ink = Ink::Series(algorithm_order(&group.config().algo));
                    let mut bars = Vec::new();
                    if let Some(estimate) = group.estimate(source, &format!("{metric}_mean")) {
                        let interval =
                            estimate.half_width.map(|_| (estimate.low(), estimate.high()));
                        bars.push(Bar {
                            name: "here".into(),
                            value: estimate.mean,
                            interval,
                            ink,
                            pale: false,
                        });
                    }
                    let paper = comparable_end(group)
                        .map(|p| if metric == "cost" { p.cost } else { p.episode_return });
                    bars.extend(paper.map(|value| Bar {
                        name: "paper".into(),
                        value,
                        interval: None,
                        ink,
                        pale: true,
                    }));
                    let budget = group.config().budget().filter(|_| metric == "cost");
                    BarGroup { name: group.config().algo.clone(), bars, budget }
                })
                .collect();
            panels.push(bar_panel(
                &format!("{} {metric}", scenario_name(scenario)),
                &groups,
                (306.0, 180.0),
            ));
        }
    }
    let name = if several_settings {
        format!("results level {level} {setting}")
    } else {
        format!("results level {level}")
    };
    Figure {
        slug: slug(&name),
        caption: {
            let paper = match members.iter().any(|group| comparable_end(group).is_some()) {
                true => " Full colour: here; pale: the paper's end, at 500M frames.",
                false => "",
            };
            let budget = if members.iter().any(|group| group.config().budget().is_some()) {
                " Dashed: the budget."
            } else {
                ""
            };
            format!("Level {level}, {}; {setting}.{paper}{budget}", source_name(source))
        },
        drawing: figure("", panels, 4, &[]),
    }
}
