//! Points of the normal distribution and of Student's t.

/// The argument at which an increasing function reaches a value, between two bounds. Halved until
/// no number lies between.
fn invert(rising: impl Fn(f64) -> f64, value: f64, mut low: f64, mut high: f64) -> f64 {
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if rising(middle) < value { low = middle } else { high = middle }
    }
}

/// The probability that a standard normal value is no larger.
#[must_use]
pub fn normal_probability(value: f64) -> f64 {
    0.5 * libm::erfc(-value / std::f64::consts::SQRT_2)
}

/// The point that a standard normal value does not exceed with this probability.
#[must_use]
pub fn normal_quantile(probability: f64) -> f64 {
    match probability {
        p if p <= 0.0 => f64::NEG_INFINITY,
        p if p >= 1.0 => f64::INFINITY,
        // The lower half is computed without loss of digits; the upper one mirrors it.
        p if p > 0.5 => -normal_quantile(1.0 - p),
        p => invert(normal_probability, p, -40.0, 0.0),
    }
}

/// The regularised incomplete beta function, by its continued fraction (Abramowitz and
/// Stegun 26.5.8, evaluated by Lentz's method), for `x` below the mean of the distribution, where
/// the fraction converges fast.
fn beta_fraction(a: f64, b: f64, x: f64) -> f64 {
    const TINY: f64 = 1e-300;
    let kept = |value: f64| if value.abs() < TINY { TINY } else { value };
    let mut d = 1.0 / kept(1.0 - (a + b) * x / (a + 1.0));
    let (mut c, mut fraction) = (1.0, d);
    for step in 1..500 {
        let m = f64::from(step);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        let mut change = 1.0;
        for term in [even, odd] {
            d = 1.0 / kept(1.0 + term * d);
            c = kept(1.0 + term / c);
            change = d * c;
            fraction *= change;
        }
        if (change - 1.0).abs() < 1e-16 {
            break;
        }
    }
    let log = a * libm::log(x) + b * libm::log1p(-x) + libm::lgamma(a + b)
        - libm::lgamma(a)
        - libm::lgamma(b);
    libm::exp(log) * fraction / a
}

/// The regularised incomplete beta function.
fn beta_probability(a: f64, b: f64, x: f64) -> f64 {
    match x {
        x if x <= 0.0 => 0.0,
        x if x >= 1.0 => 1.0,
        x if x < (a + 1.0) / (a + b + 2.0) => beta_fraction(a, b, x),
        x => 1.0 - beta_fraction(b, a, 1.0 - x),
    }
}

/// The point that a value of Student's t distribution does not exceed with this probability (at
/// least one half).
#[must_use]
pub fn t_quantile(probability: f64, degrees_of_freedom: usize) -> f64 {
    if degrees_of_freedom == 0 || probability >= 1.0 {
        return f64::INFINITY;
    }
    let n = degrees_of_freedom as f64;
    // Both tails beyond t have the probability I_x(n/2, 1/2) at x = n / (n + t^2) (Abramowitz and
    // Stegun 26.7.1).
    let inside = |t: f64| 1.0 - 0.5 * beta_probability(0.5 * n, 0.5, n / (n + t * t));
    let mut most = 1.0;
    while inside(most) < probability && most < 1e15 {
        most *= 2.0;
    }
    invert(inside, probability.max(0.5), 0.0, most)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected: `scipy.stats.t.ppf(p, n)` and `scipy.stats.norm.ppf(p)` of scipy 1.17.1.
    #[test]
    fn points_are_those_of_scipy() {
        let expected: &[(f64, usize, f64)] = &[
            (0.975, 1, 12.706204736174694),
            (0.975, 2, 4.302652729749462),
            (0.975, 4, 2.7764451051977934),
            (0.975, 9, 2.262157162798205),
            (0.975, 31, 2.039513446396408),
            (0.975, 99, 1.9842169515864174),
            (0.995, 99, 2.626405457280827),
            (0.99875, 99, 3.102616799226479),
            (0.995, 3, 5.840909309733355),
            (0.9, 12, 1.356217334023205),
        ];
        for &(p, n, point) in expected {
            let own = t_quantile(p, n);
            assert!((own / point - 1.0).abs() < 1e-9, "t({p}, {n}) = {own}, not {point}");
        }
        let expected: &[(f64, f64)] = &[
            (0.001, -3.090232306167813),
            (0.025, -1.9599639845400545),
            (0.5, 0.0),
            (0.84, 0.994457883209753),
            (0.975, 1.959963984540054),
            (0.9999, 3.719016485455709),
        ];
        for &(p, point) in expected {
            assert!((normal_quantile(p) - point).abs() < 1e-9, "{p}");
        }
        assert_eq!(t_quantile(0.975, 0), f64::INFINITY);
        assert!(t_quantile(0.5, 7).abs() < 1e-9);
    }
}
