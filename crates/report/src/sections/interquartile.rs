//! Inter-quartile means over environments, with stratified bootstrap intervals.

use super::{distinct, main_groups};
use crate::chart::{Bar, BarGroup, Ink, bar_panel, figure};
use crate::document::{Block, Cell, Figure, Section, Table, number, slug};
use crate::group::{Group, algorithm_order};
use crate::statistics::{Aggregate, RESAMPLES, aggregate, interquartile_mean};

pub(super) fn section(groups: &[Group]) -> Section {
    let settings = main_groups(groups);
    let mut blocks = Vec::new();
    for (setting, members) in &settings {
        let mut rows = Vec::new();
        let mut panels: [Vec<BarGroup>; 2] = [Vec::new(), Vec::new()];
        for level in distinct(members, |group| group.config().level) {
            let mut bars: [Vec<Bar>; 2] = [Vec::new(), Vec::new()];
            for (order, algo) in distinct(members, |group| (algorithm_order(&group.config().algo), group.config().algo.clone())) {
                let here: Vec<&Group> = members
                    .iter()
                    .copied()
                    .filter(|group| group.config().level == level && group.config().algo == algo)
                    .collect();
                let relative_returns = |group: &Group| match ppo_return(members, group) {
                    Some(ppo) => group.final_samples("return_mean").iter().map(|value| value / ppo).collect(),
                    None => Vec::new(),
                };
                let returns = aggregate(&strata(&here, relative_returns), interquartile_mean);
                let costs = aggregate(&strata(&here, relative_costs), interquartile_mean);
                if returns.is_none() && costs.is_none() {
                    continue;
                }
                for (bars, estimate) in bars.iter_mut().zip([returns, costs]) {
                    bars.extend(estimate.map(|e| Bar {
                        name: algo.clone(),
                        value: e.value,
                        interval: e.interval,
                        ink: Ink::Series(order),
                        pale: false,
                    }));
                }
                let strata = returns.or(costs).map_or(0, |e| e.strata);
                rows.push(vec![
                    Cell::number(f64::from(level)).with_text(level.to_string()),
                    Cell { sort: Some(order as f64), ..Cell::text(&algo) },
                    cell(returns),
                    cell(costs),
                    Cell::number(strata as f64).with_text(strata.to_string()),
                ]);
            }
            for ((panel, bars), budget) in panels.iter_mut().zip(bars).zip([None, Some(1.0)]) {
                panel.push(BarGroup { name: format!("level {level}"), bars, budget });
            }
        }
        if rows.is_empty() {
            continue;
        }
        let heads = ["level", "algorithm", "return / PPO's here", "cost / budget", "environments"].map(String::from).to_vec();
        blocks.push(Block::Table(Table { caption: setting.clone(), spans: Vec::new(), heads, rows }));
        let [returns, costs] = panels;
        let mut legend: Vec<(String, Ink)> =
            distinct(members, |group| (algorithm_order(&group.config().algo), group.config().algo.clone()))
                .into_iter()
                .map(|(order, algo)| (algo, Ink::Series(order)))
                .collect();
        legend.push(("budget".into(), Ink::Budget));
        let drawings =
            vec![bar_panel("return / PPO's here", &returns, (390.0, 220.0)), bar_panel("cost / budget", &costs, (390.0, 220.0))];
        let file = if settings.len() > 1 { slug(&format!("interquartile {setting}")) } else { "interquartile".into() };
        blocks.push(Block::Figure(Figure { slug: file, caption: setting.clone(), drawing: figure("", drawings, 2, &legend) }));
    }
    Section {
        slug: "interquartile".into(),
        title: "Inter-quartile means over environments".into(),
        text: vec![format!(
            "Each seed's final return divided by what PPO reaches here on the same environment, and its final cost divided by the \
             budget; then the mean of the middle half over all seeds and environments of a level. Intervals: 95 % of {RESAMPLES} bootstrap \
             samples that draw seeds within each environment (stratified), from a fixed random stream. Without an environment with two \
             seeds there is no interval."
        )],
        blocks,
    }
}

fn strata(groups: &[&Group], samples: impl Fn(&Group) -> Vec<f64>) -> Vec<Vec<f64>> {
    groups.iter().map(|group| samples(group)).filter(|samples| !samples.is_empty()).collect()
}

/// Mean return of PPO here, on the same environment and under the same settings.
fn ppo_return(members: &[&Group], group: &Group) -> Option<f64> {
    let same = |other: &&&Group| other.config().env == group.config().env && other.config().algo.eq_ignore_ascii_case("PPO");
    members.iter().find(same)?.final_estimate("return_mean").map(|estimate| estimate.mean).filter(|mean| *mean != 0.0)
}

fn relative_costs(group: &Group) -> Vec<f64> {
    let budget = group.config().safety_budget;
    if budget > 0.0 { group.final_samples("cost_mean").iter().map(|value| value / budget).collect() } else { Vec::new() }
}

fn cell(estimate: Option<Aggregate>) -> Cell {
    let Some(estimate) = estimate else { return Cell::text("-") };
    let interval = estimate.interval.map_or_else(String::new, |(low, high)| format!(" [{}, {}]", number(low), number(high)));
    Cell {
        text: format!("{}{interval}", number(estimate.value)),
        note: format!("n={}", estimate.n),
        sort: Some(estimate.value),
        ..Cell::default()
    }
}
