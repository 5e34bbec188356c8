//! Stratified bootstrap intervals.

/// A number over tasks and seeds with its 95 % bootstrap interval.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Aggregate {
    /// The number of all samples.
    pub value: f64,
    /// Interval; `None` if a stratum holds a single sample, whose spread resampling cannot show.
    pub interval: Option<(f64, f64)>,
    /// Number of samples.
    pub n: usize,
    /// Number of strata (environments).
    pub strata: usize,
}

/// Resamples that a bootstrap draws.
pub const RESAMPLES: usize = 2000;

/// A statistic over strata of samples (environments of seeds). The interval is the percentile
/// interval of [`RESAMPLES`] bootstrap samples, each drawing seeds with replacement within every
/// stratum. The stream is fixed, so that the same runs give the same report.
#[must_use]
pub fn aggregate(
    strata: &[Vec<f64>],
    statistic: impl Fn(&[f64]) -> Option<f64>,
) -> Option<Aggregate> {
    aggregate_pair(strata, &[], |one, _| statistic(&one.concat()))
}

/// Several statistics of the same strata, from the same bootstrap samples.
#[must_use]
pub fn aggregates(
    strata: &[Vec<f64>],
    statistics: impl Fn(&[f64]) -> Option<Vec<f64>>,
) -> Option<Vec<Aggregate>> {
    resampled(strata, &[], |one, _| statistics(&one.concat()))
}

/// A statistic of two sets of strata, both resampled.
#[must_use]
pub fn aggregate_pair(
    one: &[Vec<f64>],
    other: &[Vec<f64>],
    statistic: impl Fn(&[Vec<f64>], &[Vec<f64>]) -> Option<f64>,
) -> Option<Aggregate> {
    resampled(one, other, |a, b| statistic(a, b).map(|value| vec![value]))?.pop()
}

fn resampled(
    one: &[Vec<f64>],
    other: &[Vec<f64>],
    statistics: impl Fn(&[Vec<f64>], &[Vec<f64>]) -> Option<Vec<f64>>,
) -> Option<Vec<Aggregate>> {
    let values = statistics(one, other)?;
    let n = one.iter().map(Vec::len).sum();
    let filled = one.iter().filter(|stratum| !stratum.is_empty()).count();
    let mut draws: Vec<Vec<f64>> = vec![Vec::new(); values.len()];
    if one.iter().chain(other).all(|stratum| stratum.len() != 1) {
        let mut stream = 0x5EED_u64;
        let mut draw = |strata: &[Vec<f64>]| -> Vec<Vec<f64>> {
            let resample = |stratum: &Vec<f64>| {
                stratum
                    .iter()
                    .map(|_| stratum[(next(&mut stream) % stratum.len() as u64) as usize])
                    .collect()
            };
            strata.iter().map(resample).collect()
        };
        for _ in 0..RESAMPLES {
            let (a, b) = (draw(one), draw(other));
            let drawn = statistics(&a, &b).unwrap_or_else(|| values.clone());
            draws.iter_mut().zip(drawn).for_each(|(own, value)| own.push(value));
        }
    }
    let estimate = |(value, mut draws): (f64, Vec<f64>)| {
        draws.sort_by(f64::total_cmp);
        let interval =
            (!draws.is_empty()).then(|| (quantile(&draws, 0.025), quantile(&draws, 0.975)));
        Aggregate { value, interval, n, strata: filled }
    };
    Some(values.into_iter().zip(draws).map(estimate).collect())
}

/// A quantile of sorted samples, linear between neighbours.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let at = share * (sorted.len() - 1) as f64;
    let (low, high) = (sorted[at.floor() as usize], sorted[at.ceil() as usize]);
    low + (high - low) * at.fract()
}

/// SplitMix64, the project's random stream.
pub(super) fn next(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::super::interquartile_mean;
    use super::*;

    #[test]
    fn the_bootstrap_is_repeatable_stratified_and_about_right() {
        let strata: Vec<Vec<f64>> =
            (0..6).map(|task| (0..5).map(|seed| f64::from(task * 10 + seed)).collect()).collect();
        let first = aggregate(&strata, interquartile_mean).unwrap();
        assert_eq!(Some(first), aggregate(&strata, interquartile_mean));
        let (low, high) = first.interval.unwrap();
        assert!(low < first.value && first.value < high);
        // Strata differ by tens; were they pooled, the interval would be many units wide instead of
        // about two.
        assert!(high - low < 3.0, "{low}..{high}");
        assert_eq!((first.n, first.strata), (30, 6));
        for single in [[vec![1.0], vec![2.0]], [vec![1.0], vec![2.0, 3.0]]] {
            assert_eq!(aggregate(&single, interquartile_mean).unwrap().interval, None);
        }
        assert!(
            aggregate(&[vec![], vec![2.0, 3.0]], interquartile_mean).unwrap().interval.is_some()
        );
        assert_eq!(aggregate(&[], interquartile_mean), None);
    }

    /// Of a hundred values that are nearly normal the interval is Student's, mean +- 1.984 s / 10.
    #[test]
    fn intervals_are_of_95_percent() {
        let mut stream = 5;
        let mut uniform = || (next(&mut stream) >> 11) as f64 / (1u64 << 53) as f64;
        let values: Vec<f64> = (0..100).map(|_| (0..12).map(|_| uniform()).sum()).collect();
        let mean = |values: &[f64]| Some(values.iter().sum::<f64>() / values.len() as f64);
        let found = aggregate(std::slice::from_ref(&values), mean).unwrap();
        let square = |value: &f64| (value - found.value).powi(2);
        let half = 1.984 * (values.iter().map(square).sum::<f64>() / 99.0).sqrt() / 10.0;
        let (low, high) = found.interval.unwrap();
        for own in [found.value - low, high - found.value] {
            assert!((0.9..1.1).contains(&(own / half)), "{own} beside {half}");
        }
    }
}
