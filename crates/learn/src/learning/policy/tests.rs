use super::*;
use crate::random::{Purpose, Stream};

fn shape() -> ActionShape {
    ActionShape { sizes: vec![3, 2], deltas: 2 }
}

fn policy(rows: &[f64]) -> Policy {
    Policy::from_rows(&shape(), rows.to_vec())
}

/// Recorded numbers, computed in double precision from the definitions.
#[test]
fn divergence_from_uniform_and_entropy_equal_the_recorded_numbers() {
    for (logits, divergence, entropy) in [
        (vec![1.0, 0.0, -1.0], 0.287_605_191, 0.832_395_582),
        (vec![0.5, -0.5], 0.115_529_289, 0.582_203_109),
    ] {
        let shape = ActionShape { sizes: vec![logits.len()], deltas: 0 };
        let policy = Policy::from_rows(&shape, logits);
        assert!((policy.symmetric_divergence_from_uniform().mean() - divergence).abs() < 1e-9);
        assert!((policy.entropy().mean() - entropy).abs() < 1e-9);
    }
}

/// Each closed form of a gradient against central differences of the number itself, within
/// bounds and beyond.
#[test]
fn slopes_equal_differences() {
    let mut stream = Stream::new(5, Purpose::Evaluation, 0, 0);
    let width = shape().parameters();
    let count = 6;
    let mut rows: Vec<f64> = (0..count * width).map(|_| stream.normal()).collect();
    // A deviation above the largest: it does not matter by how much.
    rows[width - 1] = 12.0;
    let old = policy(&(0..count * width).map(|_| stream.normal()).collect::<Vec<_>>());
    let taken = Taken {
        actions: (0..count * 2).map(|index| (index % 2) as u8).collect(),
        deltas: (0..count * 2).map(|_| stream.normal() as f32).collect(),
    };
    type Number<'a> = &'a dyn Fn(&Policy) -> Column;
    let numbers: [(&str, Number); 7] = [
        ("divergence seen from another", &|policy| policy.divergence_seen_from(&old)),
        ("log-probability", &|policy| policy.log_probability(&taken)),
        ("entropy", &Policy::entropy),
        ("divergence from uniform", &Policy::symmetric_divergence_from_uniform),
        ("divergence", &|policy| policy.divergence(&old)),
        ("ratio", &|policy| {
            policy.log_probability(&taken).map(|row, log| (log + row as f64 * 0.1).exp())
        }),
        ("clipped", &|policy| policy.entropy().map(|_, entropy| entropy.clamp(0.0, 4.0).square())),
    ];
    let h = 1e-5;
    for (name, number) in numbers {
        let column = number(&policy(&rows));
        for (index, row) in (0..count * width).map(|index| (index, index / width)) {
            let moved = |by: f64| {
                let mut rows = rows.clone();
                rows[index] += by;
                number(&policy(&rows)).values[row]
            };
            let expected = (moved(h) - moved(-h)) / (2.0 * h);
            let found = column.slopes[index];
            let rounding = 4.0 * f64::EPSILON * column.values[row].abs() / h;
            let error = (found - expected).abs();
            assert!(
                error < 1e-6 * expected.abs().max(1.0) + rounding,
                "{name} {index}: {found} against {expected}"
            );
        }
    }
}

/// The Fisher matrix is the mean, under the distribution, of the outer product of the gradient
/// of the log-probability.
#[test]
fn fisher_products_follow_the_definition() {
    let shape = ActionShape { sizes: vec![3], deltas: 1 };
    let row = [0.3, -0.7, 1.1, 0.4, -0.5];
    let policy = Policy::from_rows(&shape, row.to_vec());
    let vector = [0.5f32, -1.0, 0.25, 2.0, -0.75];
    let mut expected = [0.0; 5];
    // A choice and a delta over a fine grid, weighted by their probability.
    let step = 0.01;
    for choice in 0..3u8 {
        for index in -1000..1000 {
            let taken =
                Taken { actions: vec![choice], deltas: vec![(f64::from(index) * step) as f32] };
            let log = policy.log_probability(&taken);
            let product: f64 =
                log.slopes.iter().zip(vector).map(|(slope, v)| slope * f64::from(v)).sum();
            for (sum, slope) in expected.iter_mut().zip(&log.slopes) {
                *sum += log.values[0].exp() * step * slope * product;
            }
        }
    }
    for (found, expected) in policy.fisher_times(&vector).iter().zip(expected) {
        assert!((f64::from(*found) - expected).abs() < 1e-5, "{found} against {expected}");
    }
}

/// Divergences by their definition, as sums and as an integral over a fine grid.
#[test]
fn divergences_follow_their_definition() {
    let shape = ActionShape { sizes: vec![3], deltas: 1 };
    let (a, b) = ([0.3, -0.7, 1.1, 0.4, -0.5], [0.1, 0.2, -0.3, -0.2, 0.3]);
    let (p, q) = (Policy::from_rows(&shape, a.to_vec()), Policy::from_rows(&shape, b.to_vec()));
    let log = |row: &[f64], delta: f64| -> Vec<f64> {
        let total: f64 = row[..3].iter().map(|l| l.exp()).sum();
        let mut logs: Vec<f64> = row[..3].iter().map(|l| l - total.ln()).collect();
        let draw = (delta - row[3]) / row[4].exp();
        logs.push(-0.5 * draw * draw - row[4] - LOG_ROOT_TAU);
        logs
    };
    let (discrete_p, discrete_q) = (log(&a, 0.0), log(&b, 0.0));
    let mut expected: f64 =
        (0..3).map(|i| discrete_p[i].exp() * (discrete_p[i] - discrete_q[i])).sum();
    let step = 1e-3;
    for index in -20_000..20_000 {
        let x = f64::from(index) * step;
        let (lp, lq) = (log(&a, x)[3], log(&b, x)[3]);
        expected += lp.exp() * (lp - lq) * step;
    }
    assert!((p.divergence(&q).mean() - expected).abs() < 1e-8);
    assert!(p.divergence(&p).mean().abs() < 1e-12);
    assert!((q.divergence_seen_from(&p).mean() - expected).abs() < 1e-8);
}
