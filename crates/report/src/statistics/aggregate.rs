//! Numbers over the seeds of several tasks. Scores lie in strata: one list of seeds for each task.

use super::mean;

/// The mean of the middle half: a quarter of the samples, rounded down, is left out at each end, as
/// SciPy's `trim_mean` and with it the field's `rliable` do.
#[must_use]
pub fn interquartile_mean(samples: &[f64]) -> Option<f64> {
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    let cut = sorted.len() / 4;
    mean(&sorted[cut..sorted.len() - cut])
}

/// How far scores fall short of `target` on average, those above it counting as at it (Agarwal et
/// al. 2021, section 4.3).
#[must_use]
pub fn optimality_gap(samples: &[f64], target: f64) -> Option<f64> {
    mean(&samples.iter().map(|score| (target - score).max(0.0)).collect::<Vec<_>>())
}

/// Share of scores above `threshold` (Agarwal et al. 2021, section 4.2: the run-score
/// distribution).
#[must_use]
pub fn performance_profile(samples: &[f64], threshold: f64) -> Option<f64> {
    mean(&samples.iter().map(|score| f64::from(u8::from(*score > threshold))).collect::<Vec<_>>())
}

/// Probability that a seed of `one` scores more than a seed of `other` on a task drawn at random,
/// ties counting half: the Mann-Whitney statistic of each task, divided by the number of pairs, and
/// its mean over tasks. Tasks that lack either are left out.
#[must_use]
pub fn probability_of_improvement(one: &[Vec<f64>], other: &[Vec<f64>]) -> Option<f64> {
    let tasks = one.iter().zip(other).filter(|(a, b)| !a.is_empty() && !b.is_empty());
    let wins = tasks.map(|(a, b)| {
        let pairs = a.iter().flat_map(|x| b.iter().map(move |y| (x, y)));
        let won: f64 =
            pairs.map(|(x, y)| if x > y { 1.0 } else { f64::from(u8::from(x == y)) * 0.5 }).sum();
        won / (a.len() * b.len()) as f64
    });
    mean(&wins.collect::<Vec<_>>())
}

/// Mean of the worst (largest) `share` of the samples: the conditional value at risk of a cost
/// (Rockafellar and Uryasev 2000). Where the share is no whole number of samples, the one at its
/// edge counts in part.
#[must_use]
pub fn conditional_value_at_risk(samples: &[f64], share: f64) -> Option<f64> {
    let mut sorted = samples.to_vec();
    sorted.sort_by(|a, b| b.total_cmp(a));
    let count = sorted.len() as f64 * share;
    if count <= 0.0 {
        return None;
    }
    let weighted = sorted
        .iter()
        .enumerate()
        .map(|(index, value)| value * (count - index as f64).clamp(0.0, 1.0));
    Some(weighted.sum::<f64>() / count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interquartile_means_leave_a_quarter_out_at_each_end() {
        assert_eq!(interquartile_mean(&[100.0, 1.0, 2.0, -50.0]), Some(1.5));
        // A quarter of seven, rounded down, is one.
        assert_eq!(interquartile_mean(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 100.0]), Some(3.0));
        assert_eq!((interquartile_mean(&[7.0]), interquartile_mean(&[])), (Some(7.0), None));
    }

    #[test]
    fn the_worst_tenth() {
        let costs: Vec<f64> = (1..=100).map(f64::from).collect();
        assert_eq!(conditional_value_at_risk(&costs, 0.1), Some(95.5));
        // A tenth of 15 samples is one and a half of them.
        let costs: Vec<f64> = (1..=15).map(f64::from).collect();
        assert!(
            (conditional_value_at_risk(&costs, 0.1).unwrap() - (15.0 + 0.5 * 14.0) / 1.5).abs()
                < 1e-12
        );
        assert_eq!(conditional_value_at_risk(&[4.0], 0.1), Some(4.0));
        assert_eq!(conditional_value_at_risk(&[], 0.1), None);
    }

    #[test]
    fn tasks_without_a_partner_are_left_out() {
        assert_eq!(
            probability_of_improvement(&[vec![2.0], vec![]], &[vec![1.0], vec![5.0]]),
            Some(1.0)
        );
        assert_eq!(probability_of_improvement(&[vec![]], &[vec![1.0]]), None);
    }
}
