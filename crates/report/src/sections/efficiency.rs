//! How fast runs learned, beside the paper's figures.

use super::setting;
use crate::document::{Block, Cell, Section, Table, count, frames};
use crate::group::{Group, scenario_name};
use crate::published::published_figure;
use crate::run::Run;
use crate::statistics::Estimate;

pub(super) fn section(groups: &[Group]) -> Section {
    let per_second = |run: &Run, what: fn(&Run) -> Option<f64>| {
        let seconds = run.total("wall_s").filter(|seconds| *seconds > 0.0)?;
        what(run).map(|number| number / seconds)
    };
    let cell = |samples: Vec<f64>| Cell {
        note: String::new(),
        ..Cell::estimate(Estimate::of(&samples), &samples)
    };
    let mut rows: Vec<Vec<Cell>> = groups
        .iter()
        .filter(|group| group.runs.iter().any(|run| run.frames_per_second().is_some()))
        .map(|group| {
            let config = group.config();
            let rates = |what: fn(&Run) -> Option<f64>| {
                group.runs.iter().filter_map(|run| per_second(run, what)).collect()
            };
            let threads: Vec<f64> =
                group.runs.iter().filter_map(|run| run.total("threads")).collect();
            let hours: Vec<f64> = group
                .runs
                .iter()
                .filter_map(|run| run.total("wall_s"))
                .map(|s| s / 3600.0)
                .collect();
            let machine =
                threads.first().map_or_else(|| "-".into(), |n| count(*n as usize, "thread"));
            vec![
                Cell::text(scenario_name(&config.scenario)),
                Cell::number(f64::from(config.level)).with_text(config.level.to_string()),
                Cell::text(&config.algo),
                Cell::text(setting(group)),
                Cell::text(machine),
                Cell::number(group.frames_span().1).with_text(frames(group.frames_span().1)),
                cell(hours),
                cell(rates(|run| Some(run.frames()))),
                cell(rates(|run| run.total("updates"))),
            ]
        })
        .collect();
    if !rows.is_empty() {
        let paper = |who: &str, scenario: &str, algorithm: &str, prefix: &str| {
            let figure = |name: &str| published_figure(&format!("{prefix}{name}_per_second"));
            let value = |value: Option<f64>| {
                value.map_or_else(|| Cell::text("-"), |v| Cell { pale: true, ..Cell::number(v) })
            };
            let pale = |text: &str| Cell { pale: true, ..Cell::text(text) };
            vec![
                pale(scenario),
                pale("1"),
                pale(algorithm),
                pale(who),
                pale("72 cores, A100"),
                pale("-"),
                value(Some(2.0)),
                value(figure("frames")),
                value(figure("updates")),
            ]
        };
        rows.push(paper("the paper", "Volcanic Venture", "PPOLag", ""));
        rows.push(paper(
            "Safety-Gymnasium in the paper",
            "SafetyPointGoal1",
            "PPOLag",
            "safety_gymnasium_",
        ));
    }
    let heads = [
        "scenario",
        "level",
        "algorithm",
        "options",
        "machine",
        "frames",
        "hours",
        "frames/s",
        "updates/s",
    ];
    let table = Table { heads: heads.map(String::from).to_vec(), rows, ..Table::default() };
    Section {
        slug: "efficiency".into(),
        title: "Efficiency".into(),
        text: vec![
            "Frames (four a step) and updates a second over whole runs, evaluations and reports included: means over seeds. The paper's \
             figures are of two hours on 72 cores with a graphics card."
                .into(),
        ],
        blocks: if table.rows.is_empty() { Vec::new() } else { vec![Block::Table(table.folded(&["machine", "level"]))] },
    }
}
