//! Our curves and the paper's at equal frames.

use super::setting;
use crate::curve::Curve;
use crate::document::{Cell, Table, frames, number};
use crate::group::{Group, scenario_name};
use crate::published::published_curve;
use crate::statistics::Estimate;

/// Moments of training that are compared, in millions of frames.
const MOMENTS: [f64; 6] = [1.0, 5.0, 10.0, 30.0, 100.0, 500.0];

/// Return @ cost of each experiment and of the paper's at the moments that both reached; `None` if
/// there is no such pair.
pub(super) fn table(groups: &[Group]) -> Option<Table> {
    let pairs: Vec<(&Group, [Curve; 4])> = groups
        .iter()
        .filter_map(|group| {
            let paper = |metric| published_curve(group.config(), metric);
            let (returns, costs) = (paper("return")?, paper("cost")?);
            Some((
                group,
                [Curve::of(group, "return_mean"), Curve::of(group, "cost_mean"), returns, costs],
            ))
        })
        .collect();
    let reached = |moment: f64| pairs.iter().any(|(_, curves)| at(&curves[0], moment).is_some());
    let moments: Vec<f64> = MOMENTS
        .into_iter()
        .map(|millions| millions * 1e6)
        .filter(|moment| reached(*moment))
        .collect();
    if moments.is_empty() {
        return None;
    }
    let rows = pairs.iter().map(|(group, [returns, costs, paper_returns, paper_costs])| {
        let config = group.config();
        let mut row = vec![
            Cell::text(scenario_name(&config.scenario)),
            Cell::number(f64::from(config.level)).with_text(config.level.to_string()),
            Cell::text(&config.algo),
            Cell::text(setting(group)),
        ];
        for &moment in &moments {
            let ours = pair(at(returns, moment), at(costs, moment));
            // Beside nothing of ours the paper's value would compare with nothing.
            let theirs = pair(at(paper_returns, moment), at(paper_costs, moment));
            let theirs = if ours.text == "-" { ours.clone() } else { theirs };
            row.extend([ours, Cell { pale: true, ..theirs }]);
        }
        row
    });
    let mut spans = vec![(String::new(), 4)];
    spans.extend(moments.iter().map(|moment| (format!("{} frames", frames(*moment)), 2)));
    let mut heads = ["scenario", "level", "algorithm", "options"].map(String::from).to_vec();
    heads.extend(moments.iter().flat_map(|_| ["here".to_owned(), "paper".to_owned()]));
    let caption =
        "At equal frames: return @ cost, means over recent training episodes and seeds".to_owned();
    Some(Table { caption, spans, heads, rows: rows.collect() }.folded(&["level", "options"]))
}

/// A curve's value; a run's (and the paper's) last point counts where it ends within a hundredth of
/// the moment.
fn at(curve: &Curve, moment: f64) -> Option<Estimate> {
    let last = curve.mean.last()?;
    curve
        .at(moment)
        .or_else(|| (last.frames <= moment && last.frames >= moment * 0.99).then_some(last.value))
}

fn pair(episode_return: Option<Estimate>, cost: Option<Estimate>) -> Cell {
    match (episode_return, cost) {
        (Some(r), Some(c)) => {
            let half = |one: Estimate| {
                one.half_width.map_or_else(String::new, |half| format!(" ± {}", number(half)))
            };
            let text = format!("{} @ {}", number(r.mean), number(c.mean));
            let title = format!(
                "return {}{}, cost {}{}, n={}",
                number(r.mean),
                half(r),
                number(c.mean),
                half(c),
                r.n
            );
            Cell { sort: Some(r.mean), title, ..Cell::text(text) }
        }
        _ => Cell { text: "-".into(), pale: true, ..Cell::default() },
    }
}
