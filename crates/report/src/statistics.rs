//! The statistics of the tables and figures.
//!
//! - Means over seeds with 95 % intervals of Student's t distribution, the deviation with n - 1 in its denominator: with
//!   three to five seeds, 1.96 standard errors of the biased deviation (as the published figures use) are far too narrow.
//! - Inter-quartile means with stratified bootstrap intervals, as Agarwal et al., *Deep reinforcement learning at the
//!   edge of the statistical precipice* (NeurIPS 2021) propose for few seeds on many tasks.

/// A mean with what it rests on.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Estimate {
    /// The mean.
    pub mean: f64,
    /// Half the width of its 95 % interval; `None` for a single sample, about whose spread nothing is known.
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
        12.7062, 4.3027, 3.1824, 2.7764, 2.5706, 2.4469, 2.3646, 2.3060, 2.2622, 2.2281, 2.2010, 2.1788, 2.1604, 2.1448, 2.1314,
        2.1199, 2.1098, 2.1009, 2.0930, 2.0860, 2.0796, 2.0739, 2.0687, 2.0639, 2.0595, 2.0555, 2.0518, 2.0484, 2.0452, 2.0423,
    ];
    match degrees_of_freedom {
        0 => f64::INFINITY,
        d if d <= TABLE.len() => TABLE[d - 1],
        // The first terms of the expansion about the normal point (Cornish and Fisher): exact to four digits here.
        d => {
            let (z, d) = (1.959_964_f64, d as f64);
            z + (z.powi(3) + z) / (4.0 * d) + (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / (96.0 * d * d)
        }
    }
}

/// The mean of the middle half of the samples. Where a quarter of them is no whole number, the samples at its edge count
/// in part, so that the measure does not jump with n.
#[must_use]
pub fn interquartile_mean(samples: &[f64]) -> Option<f64> {
    if samples.is_empty() {
        return None;
    }
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len() as f64;
    let (from, to) = (n / 4.0, 3.0 * n / 4.0);
    let mut sum = 0.0;
    for (index, value) in sorted.iter().enumerate() {
        let share = ((index + 1) as f64).min(to) - (index as f64).max(from);
        sum += value * share.max(0.0);
    }
    Some(sum / (to - from))
}

/// An inter-quartile mean with its 95 % bootstrap interval.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Interquartile {
    /// The inter-quartile mean of all samples.
    pub mean: f64,
    /// Interval; `None` if no stratum holds two samples, for then resampling changes nothing.
    pub interval: Option<(f64, f64)>,
    /// Number of samples.
    pub n: usize,
    /// Number of strata (environments).
    pub strata: usize,
}

/// Resamples that a bootstrap draws.
pub const RESAMPLES: usize = 2000;

/// The inter-quartile mean over strata of samples (environments of seeds). The interval is the percentile interval of
/// [`RESAMPLES`] bootstrap samples, each drawing seeds with replacement within every stratum. The stream is fixed, so
/// that the same runs give the same report.
#[must_use]
pub fn stratified_interquartile(strata: &[Vec<f64>]) -> Option<Interquartile> {
    let all: Vec<f64> = strata.concat();
    let mean = interquartile_mean(&all)?;
    let interval = strata.iter().any(|stratum| stratum.len() > 1).then(|| {
        let mut stream = 0x5EED_u64;
        let mut draws = Vec::with_capacity(RESAMPLES);
        let mut sample = Vec::with_capacity(all.len());
        for _ in 0..RESAMPLES {
            sample.clear();
            for stratum in strata {
                for _ in stratum {
                    sample.push(stratum[(next(&mut stream) % stratum.len() as u64) as usize]);
                }
            }
            draws.push(interquartile_mean(&sample).unwrap_or(mean));
        }
        draws.sort_by(f64::total_cmp);
        (quantile(&draws, 0.025), quantile(&draws, 0.975))
    });
    Some(Interquartile { mean, interval, n: all.len(), strata: strata.iter().filter(|stratum| !stratum.is_empty()).count() })
}

/// A quantile of sorted samples, linear between neighbours.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let at = share * (sorted.len() - 1) as f64;
    let (low, high) = (sorted[at.floor() as usize], sorted[at.ceil() as usize]);
    low + (high - low) * at.fract()
}

/// SplitMix64, the project's random stream.
fn next(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_use_the_unbiased_deviation_and_students_t() {
        let estimate = Estimate::of(&[1.0, 2.0, 3.0]).unwrap();
        // Deviation 1, standard error 1 / sqrt 3, t for two degrees of freedom 4.3027.
        assert!((estimate.mean - 2.0).abs() < 1e-12 && (estimate.half_width.unwrap() - 2.484_14).abs() < 1e-4);
        assert_eq!(Estimate::of(&[5.0]), Some(Estimate { mean: 5.0, half_width: None, n: 1 }));
        assert_eq!(Estimate::of(&[]), None);
        // The expansion meets the table where they join, and known values beyond (60: 2.0003, 120: 1.9799).
        assert!((t_quantile_975(31) - 2.0395).abs() < 2e-4);
        assert!((t_quantile_975(60) - 2.0003).abs() < 1e-4);
        assert!((t_quantile_975(120) - 1.9799).abs() < 1e-4);
    }

    #[test]
    fn interquartile_means() {
        assert_eq!(interquartile_mean(&[100.0, 1.0, 2.0, -50.0]), Some(1.5));
        // Five samples: a quarter is 1.25, so the second and fourth count three quarters.
        let five = interquartile_mean(&[0.0, 1.0, 2.0, 4.0, 100.0]).unwrap();
        assert!((five - (0.75 + 2.0 + 0.75 * 4.0) / 2.5).abs() < 1e-12, "{five}");
        assert_eq!(interquartile_mean(&[7.0]), Some(7.0));
    }

    #[test]
    fn the_bootstrap_is_repeatable_stratified_and_about_right() {
        let strata: Vec<Vec<f64>> = (0..6).map(|task| (0..5).map(|seed| f64::from(task * 10 + seed)).collect()).collect();
        let first = stratified_interquartile(&strata).unwrap();
        assert_eq!(Some(first), stratified_interquartile(&strata));
        let (low, high) = first.interval.unwrap();
        assert!(low < first.mean && first.mean < high);
        // Strata differ by tens; were they pooled, the interval would be many units wide instead of about two.
        assert!(high - low < 3.0, "{low}..{high}");
        assert_eq!((first.n, first.strata), (30, 6));
        assert_eq!(stratified_interquartile(&[vec![1.0], vec![2.0]]).unwrap().interval, None);
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
