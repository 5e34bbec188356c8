//! What is bold and what is green in a table of results.

use crate::document::Mark;
use crate::run::Kept;
use crate::statistics::{differ, mean};

/// What an experiment came to: a number a seed, and how its costs stand to the budgets.
pub(super) struct Final {
    pub returns: Vec<f64>,
    pub costs: Vec<f64>,
    pub kept: Kept,
}

/// How returns and costs are marked.
pub(super) fn marks(values: &[Final]) -> Vec<(Mark, Mark)> {
    let order = |samples: &[f64]| mean(samples).unwrap_or(f64::NEG_INFINITY);
    // Those surely within come first; only if there are none, those within by their mean.
    // A single seed's interval is of its episodes and narrower than any over seeds, so beside several
    // seeds it is not sure.
    let several = values.iter().any(|value| value.returns.len() > 1);
    let kept = |value: &Final| match value.returns.len() {
        0 => None,
        1 if several => Some(value.kept.min(Kept::ByMean)),
        _ => Some(value.kept),
    };
    let surely = values.iter().any(|value| kept(value) == Some(Kept::Surely));
    let least_kept = if surely { Kept::Surely } else { Kept::ByMean };
    let eligible = |value: &Final| kept(value).is_some_and(|kept| kept >= least_kept);
    let best = values
        .iter()
        .filter(|value| eligible(value))
        .max_by(|a, b| order(&a.returns).total_cmp(&order(&b.returns)));
    let measured = || values.iter().filter(|value| !value.costs.is_empty());
    let least = measured().min_by(|a, b| order(&a.costs).total_cmp(&order(&b.costs)));
    let same = |one: &[f64], best: &[f64]| one == best || differ(one, best) == Some(false);
    values
        .iter()
        .map(|value| {
            let bold_return =
                best.is_some_and(|best| eligible(value) && same(&value.returns, &best.returns));
            let bold_cost = best.is_none()
                && values.len() > 1
                && !value.costs.is_empty()
                && least.is_some_and(|least| same(&value.costs, &least.costs));
            (
                Mark { bold: bold_return, ..Mark::default() },
                Mark { kept: value.kept, bold: bold_cost },
            )
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(returns: &[f64], costs: &[f64], kept: Kept) -> Final {
        Final { returns: returns.to_vec(), costs: costs.to_vec(), kept }
    }

    fn bold(values: &[Final]) -> Vec<(bool, bool)> {
        marks(values)
            .iter()
            .map(|(episode_return, cost)| (episode_return.bold, cost.bold))
            .collect()
    }

    #[test]
    fn bold_is_the_best_within_the_budget_and_what_cannot_be_distinguished() {
        // Within the budget the best return is bold, however much more an unsafe one earns.
        let unsafe_one = || value(&[90.0, 91.0], &[40.0, 41.0], Kept::Over);
        let values = [
            unsafe_one(),
            value(&[30.0, 30.1], &[4.0], Kept::Surely),
            value(&[35.0, 35.1], &[4.5], Kept::Surely),
        ];
        assert_eq!(bold(&values), [(false, false), (false, false), (true, false)]);
        // Three seeds that scatter: 30 and 35 are not different for sure.
        let values = [
            unsafe_one(),
            value(&[25.0, 30.0, 35.0], &[4.0], Kept::Surely),
            value(&[30.0, 35.0, 40.0], &[4.5], Kept::Surely),
        ];
        assert_eq!(bold(&values), [(false, false), (true, false), (true, false)]);
        // Within by the mean alone does not count where another is surely within.
        let values = [
            value(&[40.0, 40.1], &[4.9], Kept::ByMean),
            value(&[30.0, 30.1], &[4.0], Kept::Surely),
        ];
        assert_eq!(bold(&values), [(false, false), (true, false)]);
        // A single seed is no surer than two.
        let values = [
            value(&[2.0], &[2.4], Kept::Surely),
            value(&[3.9, 4.0], &[3.2, 3.3], Kept::ByMean),
            value(&[], &[], Kept::Unknown),
        ];
        assert_eq!(bold(&values), [(false, false), (true, false), (false, false)]);
        // None within: the least cost stands out.
        let values = [
            value(&[90.0], &[40.0], Kept::Over),
            value(&[30.0], &[14.0], Kept::Over),
            value(&[], &[], Kept::Unknown),
        ];
        assert_eq!(bold(&values), [(false, false), (false, true), (false, false)]);
        assert_eq!(bold(&[value(&[1.0], &[9.0], Kept::Over)]), [(false, false)]);
    }
}
