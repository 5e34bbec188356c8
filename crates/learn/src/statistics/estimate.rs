//! A mean and its interval.

use serde::{Deserialize, Serialize};

use crate::statistics::bootstrap::bca_interval;
use crate::statistics::quantiles::t_quantile;

/// Skewness of samples beyond which their mean's interval is a bootstrap's: Student's t then covers
/// too little on the long side.
const SKEWED: f64 = 1.0;
/// Fewest samples that a bootstrap can say something from.
const FEWEST: usize = 20;
/// Share of what lies outside of the intervals on either side.
const OUTSIDE: f64 = 0.025;

/// A mean with its 95 % confidence interval: Student's t, and the bias-corrected and accelerated
/// bootstrap where at least 20 samples have a skewness beyond 1.
#[derive(Clone, Copy, PartialEq, Debug, Default, Serialize, Deserialize)]
pub struct Estimate {
    /// The mean.
    pub mean: f64,
    /// Half the width of Student's t interval, of the sample variance; 0 for one value.
    pub half_width: f64,
    /// Both ends of the bootstrap's interval, where samples are skewed.
    #[serde(default)]
    pub bootstrap: Option<[f64; 2]>,
}

impl Estimate {
    /// The estimate from samples; 0 from none.
    #[must_use]
    pub fn of(values: impl IntoIterator<Item = f64>) -> Estimate {
        let values: Vec<f64> = values.into_iter().collect();
        let (mean, error) = mean_and_error(&values);
        let half_width = if values.len() > 1 {
            t_quantile(1.0 - OUTSIDE, values.len() - 1) * error
        } else {
            0.0
        };
        let bootstrap = is_skewed(&values).then(|| bca_interval(&values, [OUTSIDE, 1.0 - OUTSIDE]));
        Estimate { mean, half_width, bootstrap }
    }

    /// Lower end of the interval.
    #[must_use]
    pub fn low(&self) -> f64 {
        self.bootstrap.map_or(self.mean - self.half_width, |[low, _]| low)
    }

    /// Upper end of the interval.
    #[must_use]
    pub fn high(&self) -> f64 {
        self.bootstrap.map_or(self.mean + self.half_width, |[_, high]| high)
    }
}

/// The point that the mean of what samples stand for exceeds with no more than this probability: by
/// Student's t, or by the bootstrap, as in an [`Estimate`]. Infinite for fewer than two samples.
#[must_use]
pub fn upper_bound(values: &[f64], outside: f64) -> f64 {
    if values.len() < 2 {
        return f64::INFINITY;
    }
    if is_skewed(values) {
        return bca_interval(values, [outside, 1.0 - outside])[1];
    }
    let (mean, error) = mean_and_error(values);
    mean + t_quantile(1.0 - outside, values.len() - 1) * error
}

/// The mean, and its standard error of the sample variance.
fn mean_and_error(values: &[f64]) -> (f64, f64) {
    let (mean, variance) = mean_and_variance(values);
    (mean, (variance / values.len().max(1) as f64).sqrt())
}

/// The mean, and the unbiased variance of samples; 0 of fewer than two.
fn mean_and_variance(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n.max(1.0);
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (mean, if n > 1.0 { squares / (n - 1.0) } else { 0.0 })
}

/// The unbiased standard deviation of samples; 0 of fewer than two.
#[must_use]
pub fn deviation(values: &[f64]) -> f64 {
    mean_and_variance(values).1.sqrt()
}

fn is_skewed(values: &[f64]) -> bool {
    values.len() >= FEWEST && skewness(values).abs() > SKEWED
}

/// The third standardised moment of samples; 0 where all are alike.
#[must_use]
pub fn skewness(values: &[f64]) -> f64 {
    if values.iter().all(|value| *value == values[0]) {
        return 0.0;
    }
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n.max(1.0);
    let moment = |power: i32| {
        values.iter().map(|value| (value - mean).powi(power)).sum::<f64>() / n.max(1.0)
    };
    let variance = moment(2);
    if variance > 0.0 { moment(3) / (variance * variance.sqrt()) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected: `scipy.stats.t.interval(0.95, n - 1, mean, scipy.stats.sem(values))` of
    /// scipy 1.17.1. Of two values, 20 and 40, it is 30 +- 12.7062 * 10 = 127.06, where 1.96
    /// standard errors would be 19.6.
    #[test]
    fn half_widths_are_students() {
        let two = Estimate::of([20.0, 40.0]);
        assert!((two.half_width - 127.06204736174695).abs() < 1e-9, "{two:?}");
        let five = Estimate::of([3.0, 4.5, 5.0, 6.25, 9.0]);
        assert!(
            (five.mean - 5.55).abs() < 1e-12 && (five.half_width - 2.797190936191063).abs() < 1e-9,
            "{five:?}"
        );
        assert_eq!(
            (two.low(), two.high(), two.bootstrap),
            (30.0 - two.half_width, 30.0 + two.half_width, None)
        );
        assert_eq!((Estimate::of([7.0]).half_width, Estimate::of([]).mean), (0.0, 0.0));
        // One-sided, at a hundredth: scipy.stats.t.ppf(0.99, 4) standard errors above the mean.
        assert!((upper_bound(&[3.0, 4.5, 5.0, 6.25, 9.0], 0.01) - 9.324944893532669).abs() < 1e-9);
        assert_eq!(upper_bound(&[3.0], 0.01), f64::INFINITY);
    }

    /// Ninety-five episodes without cost and five of 40: `scipy.stats.skew` is 4.129483. The
    /// bootstrap's interval leans to the side of the tail, and never leaves what costs can be;
    /// Student's does on the other.
    #[test]
    fn skewed_costs_have_a_bootstraps_interval() {
        let rare: Vec<f64> = (0..100).map(|one| if one % 20 == 0 { 40.0 } else { 0.0 }).collect();
        assert!((skewness(&rare) - 4.129483209670112).abs() < 1e-9);
        let all = Estimate::of(rare.iter().copied());
        let [low, high] = all.bootstrap.unwrap();
        assert_eq!((all.mean, all.low(), all.high()), (2.0, low, high));
        assert!(low > 0.0 && high - 2.0 > 2.0 - low && high > 2.0 + all.half_width, "{all:?}");
        assert!(upper_bound(&rare, 0.005) > high);
        assert_eq!(
            Estimate::of(rare[..19].iter().copied()).bootstrap,
            None,
            "too few for a bootstrap"
        );
        // Episodes that all end at the same depth: a run's state could not be read again for an
        // interval that was no number.
        let same = Estimate::of([243.6; 32]);
        assert!(same.bootstrap.is_none() && same.half_width < 1e-9, "{same:?}");
    }
}
