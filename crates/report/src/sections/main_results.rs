//! The paper's main tables and bars.

use super::{distinct, main_groups};
use crate::chart::{Bar, BarGroup, Ink, bar_panel, figure};
use crate::document::{Block, Cell, Figure, Mark, Section, Table, slug};
use crate::group::{Group, algorithm_order, scenario_name, scenario_order};
use crate::published::published;

/// Tables of return and cost, a level each, with the paper's values below ours; and the same as bars.
pub(super) fn section(groups: &[Group]) -> Section {
    let settings = main_groups(groups);
    let mut blocks = Vec::new();
    for (setting, members) in &settings {
        for level in distinct(members, |group| group.config().level) {
            let members: Vec<&Group> = members.iter().copied().filter(|group| group.config().level == level).collect();
            blocks.push(Block::Table(table(&members, level, setting)));
            blocks.push(Block::Figure(bars(&members, level, setting, settings.len() > 1)));
        }
    }
    Section {
        slug: "results".into(),
        title: "Results".into(),
        text: vec![
            "Return and cost at the end of training: mean over the last ten points of each run and over the seeds. Green: within the budget. Bold: best \
             return within the budget."
                .into(),
        ],
        blocks,
    }
}

/// Cells of return and cost of several experiments on one environment, marked against its budget.
pub(super) fn marked_cells(members: &[&Group]) -> Vec<(Cell, Cell)> {
    let finals: Vec<_> = members
        .iter()
        .map(|group| (group.final_estimate("return_mean"), group.final_estimate("cost_mean"), group.within_budget()))
        .collect();
    let means: Vec<_> = finals.iter().map(|(r, c, w)| (r.map(|r| r.mean), c.map(|c| c.mean), *w == Some(true))).collect();
    let marks = marks(&means);
    members
        .iter()
        .zip(finals)
        .zip(marks)
        .map(|((group, (episode_return, cost, _)), (return_mark, cost_mark))| {
            let mut return_cell = Cell::estimate(episode_return, &group.final_samples("return_mean"));
            let mut cost_cell = Cell::estimate(cost, &group.final_samples("cost_mean"));
            return_cell.mark = return_mark;
            cost_cell.mark = cost_mark;
            if !group.finished() {
                return_cell.text += " *";
                let asked = group.config().frames.map(crate::document::frames).unwrap_or_default();
                return_cell.title +=
                    &format!("; unfinished: {} of {asked} frames", crate::document::frames(group.frames_span().0));
            }
            (return_cell, cost_cell)
        })
        .collect()
}

/// How returns and costs are marked, given return, cost and whether all budgets are kept.
fn marks(values: &[(Option<f64>, Option<f64>, bool)]) -> Vec<(Mark, Mark)> {
    let best_return = values.iter().filter(|value| value.2).filter_map(|value| value.0).max_by(f64::total_cmp);
    let least_cost = values.iter().filter_map(|value| value.1).min_by(f64::total_cmp);
    let none_within = !values.iter().any(|value| value.2);
    values
        .iter()
        .map(|value| {
            let best = value.2 && value.0 == best_return;
            let least = none_within && values.len() > 1 && value.1.is_some() && value.1 == least_cost;
            let cost_mark = match (value.2, least) {
                (true, _) => Mark::Within,
                (false, true) => Mark::Best,
                _ => Mark::None,
            };
            (if best { Mark::Best } else { Mark::None }, cost_mark)
        })
        .collect()
}

fn table(members: &[&Group], level: u32, setting: &str) -> Table {
    let scenarios = distinct(members, |group| (scenario_order(&group.config().scenario), group.config().scenario.clone()));
    let algorithms = distinct(members, |group| (algorithm_order(&group.config().algo), group.config().algo.clone()));
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
        let here: Vec<&Group> = members.iter().copied().filter(|group| group.config().scenario == *scenario).collect();
        let of = |algo: &str| here.iter().position(|group| group.config().algo == algo);
        let cells = marked_cells(&here);
        let papers: Vec<_> = here.iter().map(|group| published(group.config())).collect();
        let paper_values: Vec<_> = here
            .iter()
            .zip(&papers)
            .map(|(group, paper)| {
                let cost = paper.map(|p| p.cost);
                (paper.map(|p| p.episode_return), cost, cost.is_some_and(|cost| cost <= group.config().safety_budget))
            })
            .collect();
        let paper_marks = marks(&paper_values);
        for (row, (_, algo)) in algorithms.iter().enumerate() {
            let missing = || Cell { text: "-".into(), pale: true, ..Cell::default() };
            let (mut ours, mut theirs) = ((missing(), missing()), (missing(), missing()));
            if let Some(at) = of(algo) {
                ours = cells[at].clone();
                let note = papers[at].map(|paper| paper.note()).unwrap_or_default();
                let cell = |value: Option<f64>, mark| {
                    value.map_or_else(missing, |v| Cell { pale: true, mark, title: note.clone(), ..Cell::number(v) })
                };
                theirs = (cell(paper_values[at].0, paper_marks[at].0), cell(paper_values[at].1, paper_marks[at].1));
            }
            rows[2 * row].extend([ours.0, ours.1]);
            rows[2 * row + 1].extend([theirs.0, theirs.1]);
        }
    }
    rows.retain(|row| row[1..].iter().any(|cell| cell.text != "-"));
    let mut heads = vec!["algorithm".to_owned()];
    let mut spans = vec![(String::new(), 1)];
    for (_, scenario) in &scenarios {
        let budgets = distinct(members, |group| (group.config().scenario != *scenario, group.config().safety_budget.to_bits()));
        let budget = f64::from_bits(budgets[0].1);
        spans.push((format!("{} (budget {budget})", scenario_name(scenario)), 2));
        heads.extend(["return".into(), "cost".into()]);
    }
    // If every value rests on as many seeds, saying so once is enough.
    let notes =
        distinct(&rows.iter().flatten().filter(|cell| !cell.note.is_empty()).collect::<Vec<_>>(), |cell| cell.note.clone());
    let mut caption = format!("Level {level}; {setting}");
    if let [note] = &notes[..] {
        caption += &format!("; {note} {}", if note == "n=1" { "seed" } else { "seeds" });
        rows.iter_mut().flatten().for_each(|cell| cell.note.clear());
    }
    if rows.iter().flatten().any(|cell| cell.text.ends_with('*')) {
        caption += "; * not every run has finished";
    }
    Table { caption, spans, heads, rows }
}

fn bars(members: &[&Group], level: u32, setting: &str, several_settings: bool) -> Figure {
    let scenarios = distinct(members, |group| (scenario_order(&group.config().scenario), group.config().scenario.clone()));
    let mut panels = Vec::new();
    for (_, scenario) in &scenarios {
        let here: Vec<&Group> = members.iter().copied().filter(|group| group.config().scenario == *scenario).collect();
        for metric in ["return", "cost"] {
            let groups: Vec<BarGroup> = here
                .iter()
                .map(|group| {
                    let ink = Ink::Series(algorithm_order(&group.config().algo));
                    let mut bars = Vec::new();
                    if let Some(estimate) = group.final_estimate(&format!("{metric}_mean")) {
                        let interval = estimate.half_width.map(|_| (estimate.low(), estimate.high()));
                        bars.push(Bar { name: "here".into(), value: estimate.mean, interval, ink, pale: false });
                    }
                    let paper = published(group.config()).map(|p| if metric == "cost" { p.cost } else { p.episode_return });
                    bars.extend(paper.map(|value| Bar { name: "paper".into(), value, interval: None, ink, pale: true }));
                    let budget = group.config().budget().filter(|_| metric == "cost");
                    BarGroup { name: group.config().algo.clone(), bars, budget }
                })
                .collect();
            panels.push(bar_panel(&format!("{} {metric}", scenario_name(scenario)), &groups, (306.0, 180.0)));
        }
    }
    let name = if several_settings { format!("results level {level} {setting}") } else { format!("results level {level}") };
    Figure {
        slug: slug(&name),
        caption: format!("Level {level}; {setting}. Full colour: here; pale: the paper after 500M frames. Dashed: the budget."),
        drawing: figure("", panels, 4, &[]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_those_of_the_paper() {
        // Within the budget the best return is bold, however much more an unsafe one earns.
        let values = [(Some(90.0), Some(40.0), false), (Some(30.0), Some(4.0), true), (Some(35.0), Some(5.0), true)];
        assert_eq!(marks(&values), [(Mark::None, Mark::None), (Mark::None, Mark::Within), (Mark::Best, Mark::Within)]);
        // None within: the least cost stands out.
        let values = [(Some(90.0), Some(40.0), false), (Some(30.0), Some(14.0), false), (None, None, false)];
        assert_eq!(marks(&values), [(Mark::None, Mark::None), (Mark::None, Mark::Best), (Mark::None, Mark::None)]);
        assert_eq!(marks(&[(Some(1.0), Some(9.0), false)]), [(Mark::None, Mark::None)]);
    }
}
