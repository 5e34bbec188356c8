//! The statistics of the tables and figures.
//!
//! - Means over seeds with 95 % intervals of Student's t distribution, the deviation with n - 1 in
//!   its denominator: with three to five seeds, 1.96 standard errors of the biased deviation (as
//!   the published figures use) are far too narrow.
//! - Inter-quartile mean, optimality gap, probability of improvement and performance profile with
//!   stratified bootstrap intervals, as Agarwal et al., *Deep reinforcement learning at the edge of
//!   the statistical precipice* (NeurIPS 2021) propose for few seeds on many tasks;
//!   `tests/rliable.rs` holds them against that paper's own library.

mod aggregate;
mod bootstrap;
mod feasible;

pub use aggregate::{
    conditional_value_at_risk, interquartile_mean, optimality_gap, performance_profile,
    probability_of_improvement,
};
pub use bootstrap::{Aggregate, RESAMPLES, aggregate, aggregate_pair, aggregates};
pub use feasible::{cost_ratio, feasible_scores, normalised};

/// A mean with what it rests on.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Estimate {
    /// The mean.
    pub mean: f64,
    /// Half the width of its 95 % interval; `None` for a single sample, about whose spread nothing
    /// is known.
    pub half_width: Option<f64>,
    /// Number of samples (seeds, episodes).
    pub n: usize,
}

impl Estimate {
    /// The mean of samples; `None` if there are none.
    #[must_use]
    pub fn of(samples: &[f64]) -> Option<Estimate> {
        let n = samples.len();
        let mean = mean(samples)?;
        let half_width = (n > 1).then(|| {
            let squares: f64 = samples.iter().map(|sample| (sample - mean).powi(2)).sum();
            t_quantile_975(n - 1) * (squares / (n - 1) as f64).sqrt() / (n as f64).sqrt()
        });
        Some(Estimate { mean, half_width, n })
    }

    /// Lower end of the interval, or the mean.
    #[must_use]
    pub fn low(&self) -> f64 {
        self.mean - self.half_width.unwrap_or(0.0)
    }

    /// Upper end of the interval, or the mean.
    #[must_use]
    pub fn high(&self) -> f64 {
        self.mean + self.half_width.unwrap_or(0.0)
    }
}

/// The plain mean; `None` of nothing.
#[must_use]
pub fn mean(samples: &[f64]) -> Option<f64> {
    (!samples.is_empty()).then(|| samples.iter().sum::<f64>() / samples.len() as f64)
}

/// The 97.5 % point of Student's t distribution.
#[must_use]
pub fn t_quantile_975(degrees_of_freedom: usize) -> f64 {
    const TABLE: [f64; 30] = [
        12.7062, 4.3027, 3.1824, 2.7764, 2.5706, 2.4469, 2.3646, 2.3060, 2.2622, 2.2281, 2.2010,
        2.1788, 2.1604, 2.1448, 2.1314, 2.1199, 2.1098, 2.1009, 2.0930, 2.0860, 2.0796, 2.0739,
        2.0687, 2.0639, 2.0595, 2.0555, 2.0518, 2.0484, 2.0452, 2.0423,
    ];
    match degrees_of_freedom {
        0 => f64::INFINITY,
        d if d <= TABLE.len() => TABLE[d - 1],
        // The first terms of the expansion about the normal point (Cornish and Fisher): exact to
        // four digits here.
        d => {
            let (z, d) = (1.959_964_f64, d as f64);
            z + (z.powi(3) + z) / (4.0 * d)
                + (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / (96.0 * d * d)
        }
    }
}

/// Whether two means differ by more than chance would make them (Welch's test, two-sided, 5 %);
/// `None` where one of them rests on a single sample. The degrees of freedom are rounded down, to
/// the careful side.
#[must_use]
pub fn differ(one: &[f64], other: &[f64]) -> Option<bool> {
    let spread = |samples: &[f64]| {
        let n = samples.len() as f64;
        let mean = mean(samples)?;
        let squares: f64 = samples.iter().map(|sample| (sample - mean).powi(2)).sum();
        (n > 1.0).then(|| (mean, squares / (n - 1.0) / n, n))
    };
    let ((a, va, na), (b, vb, nb)) = (spread(one)?, spread(other)?);
    let variance = va + vb;
    if variance == 0.0 {
        return Some(a != b);
    }
    let freedom = variance * variance / (va * va / (na - 1.0) + vb * vb / (nb - 1.0));
    Some((a - b).abs() > t_quantile_975((freedom.floor() as usize).max(1)) * variance.sqrt())
}

#[cfg(test)]
mod tests {
    use super::bootstrap::next;
    use super::*;

    #[test]
    fn intervals_use_the_unbiased_deviation_and_students_t() {
        let estimate = Estimate::of(&[1.0, 2.0, 3.0]).unwrap();
        // Deviation 1, standard error 1 / sqrt 3, t for two degrees of freedom 4.3027.
        assert!(
            (estimate.mean - 2.0).abs() < 1e-12
                && (estimate.half_width.unwrap() - 2.484_14).abs() < 1e-4
        );
        assert_eq!(Estimate::of(&[5.0]), Some(Estimate { mean: 5.0, half_width: None, n: 1 }));
        assert_eq!(Estimate::of(&[]), None);
        // The expansion meets the table where they join, and known values beyond (60: 2.0003,
        // 120: 1.9799).
        assert!((t_quantile_975(31) - 2.0395).abs() < 2e-4);
        assert!((t_quantile_975(60) - 2.0003).abs() < 1e-4);
        assert!((t_quantile_975(120) - 1.9799).abs() < 1e-4);
    }

    #[test]
    fn means_differ_by_welchs_test() {
        // Means 2 and 4, standard errors 1/sqrt 3 each: t = 2 / 0.8165 = 2.449 with 4 degrees of
        // freedom, whose 97.5 % point is 2.776; with means 2 and 5 it is 3.674.
        assert_eq!(differ(&[1.0, 2.0, 3.0], &[3.0, 4.0, 5.0]), Some(false));
        assert_eq!(differ(&[1.0, 2.0, 3.0], &[4.0, 5.0, 6.0]), Some(true));
        assert_eq!((differ(&[1.0], &[4.0, 5.0]), differ(&[], &[1.0])), (None, None));
        assert_eq!(
            (differ(&[1.0, 1.0], &[1.0, 1.0]), differ(&[1.0, 1.0], &[2.0, 2.0])),
            (Some(false), Some(true))
        );
    }

    #[test]
    fn a_95_percent_interval_holds_the_mean_about_95_times_in_100() {
        let mut stream = 1u64;
        let mut uniform = || (next(&mut stream) >> 11) as f64 / (1u64 << 53) as f64;
        let mut held = 0;
        for _ in 0..2000 {
            // A sum of twelve uniforms is nearly normal, with mean 6.
            let samples: Vec<f64> = (0..4).map(|_| (0..12).map(|_| uniform()).sum()).collect();
            let estimate = Estimate::of(&samples).unwrap();
            held += usize::from(estimate.low() < 6.0 && 6.0 < estimate.high());
        }
        assert!((1860..=1940).contains(&held), "{held} of 2000");
    }
}
