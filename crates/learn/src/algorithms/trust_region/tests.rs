use super::*;
use crate::algorithms::small;
use crate::config::AlgorithmKind;
use crate::random::{Purpose, Stream};
use hasard_engine::simd::Simd;

/// The product against the dense Fisher matrix by its definition: the mean over samples and
/// actions of the outer product of the gradient of the log-probability, gradients by the
/// backward pass.
#[test]
fn fisher_products_equal_those_of_the_dense_matrix() {
    let config = small::config(AlgorithmKind::Trpo);
    let (mut learner, rollout) = small::learner(&config);
    // As in the middle of a run, where pixels have been seen.
    learner.absorb(&rollout).unwrap();
    let prepared = learner.prepare(&rollout);
    let mut minibatch = learner.minibatch(&prepared, &[0, 1, 2, 3]);
    let region = TrustRegion::new(&config);
    let mut origin = region.origin(&mut learner, &mut minibatch);
    let (count, width) = (origin.parameters.len(), learner.shape().action.parameters());
    let outputs = learner.policy_outputs(&mut minibatch.batch, &origin.parameters);
    let rows = outputs.len() / width;
    let mut fisher = vec![0.0f64; count * count];
    let mut add = |gradient: &[f32], weight: f64| {
        for (i, &a) in gradient.iter().enumerate().filter(|(_, a)| **a != 0.0) {
            for (j, &b) in gradient.iter().enumerate() {
                fisher[i * count + j] += weight * f64::from(a) * f64::from(b);
            }
        }
    };
    for row in 0..rows {
        let outputs = &outputs[row * width..(row + 1) * width];
        let mut gradient_of = |direction: &[f64]| {
            let _ = learner.policy_outputs(&mut minibatch.batch, &origin.parameters);
            let mut seeds = vec![0.0; rows * width];
            for (seed, value) in seeds[row * width..].iter_mut().zip(direction) {
                *seed = *value as f32;
            }
            let mut gradient = vec![0.0; count];
            learner.policy_backward(&mut minibatch.batch, &seeds, &mut gradient);
            gradient
        };
        for (first, size) in [(0, 3), (3, 2)] {
            let exp: Vec<f64> =
                outputs[first..first + size].iter().map(|&l| f64::from(l).exp()).collect();
            let p: Vec<f64> = exp.iter().map(|e| e / exp.iter().sum::<f64>()).collect();
            for action in 0..size {
                let mut direction = vec![0.0; width];
                for index in 0..size {
                    direction[first + index] = f64::from(u8::from(index == action)) - p[index];
                }
                add(&gradient_of(&direction), p[action] / rows as f64);
            }
        }
        // A normal's log-probability has gradient z/sigma in the mean and z^2 - 1 in the
        // logarithm of the deviation, whose products have the means 1/sigma^2, 2 and 0.
        let sigma = f64::from(outputs[6]).exp();
        let (mut mean, mut log) = (vec![0.0; width], vec![0.0; width]);
        (mean[5], log[6]) = (1.0 / sigma, 2.0f64.sqrt());
        add(&gradient_of(&mean), 1.0 / rows as f64);
        add(&gradient_of(&log), 1.0 / rows as f64);
    }
    let mut stream = Stream::new(4, Purpose::Evaluation, 0, 0);
    for _ in 0..3 {
        let vector: Vec<f32> = (0..count).map(|_| stream.normal() as f32).collect();
        let mut product = vec![0.0; count];
        region.fisher_times(&mut learner, &mut origin, &vector, &mut product);
        let expected: Vec<f64> = (0..count)
            .map(|i| {
                let row = &fisher[i * count..(i + 1) * count];
                let damped = 0.1 * f64::from(vector[i]);
                damped + row.iter().zip(&vector).map(|(f, v)| f * f64::from(*v)).sum::<f64>()
            })
            .collect();
        let largest = expected.iter().fold(0.0f64, |most, value| most.max(value.abs()));
        for (i, (found, expected)) in product.iter().zip(&expected).enumerate() {
            let error = (f64::from(*found) - expected).abs();
            assert!(error < 2e-3 * largest, "{i}: {found} against {expected} (largest {largest})");
        }
    }
    // And the solution of F x = b, put back in, gives b.
    let b: Vec<f32> = (0..count).map(|_| stream.normal() as f32).collect();
    let region = TrustRegion { iterations: 60, ..region };
    let x = region.solve(&mut learner, &mut origin, &b);
    let mut back = vec![0.0; count];
    region.fisher_times(&mut learner, &mut origin, &x.direction, &mut back);
    let squares =
        |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| f64::from(a - b).powi(2)).sum::<f64>();
    let (rest, all) = (squares(&back, &b), squares(&b, &vec![0.0; count]));
    assert!(rest < 1e-3 * all, "{rest} of {all}");
    assert!(squares(&back, &x.product) < 1e-3 * all, "the product that is reported");
}

/// With rounded products the difference of two outputs is taken in float32: in bfloat16 a product
/// with a random vector had a cosine of 0.006 with the true one.
#[test]
fn rounded_products_leave_fisher_products_exact() {
    let mut config = small::config(AlgorithmKind::Trpo);
    // As wide as those of `quick`.
    (config.network.dense, config.network.recurrent) = (vec![256], Some(256));
    let product = |kernels| {
        let (mut learner, rollout) = small::learner_on(kernels, &config);
        learner.absorb(&rollout).unwrap();
        let prepared = learner.prepare(&rollout);
        let mut minibatch = learner.minibatch(&prepared, &[0, 1, 2, 3]);
        let region = TrustRegion { damping: 0.0, ..TrustRegion::new(&config) };
        let mut origin = region.origin(&mut learner, &mut minibatch);
        let count = origin.parameters.len();
        let mut stream = Stream::new(4, Purpose::Evaluation, 0, 0);
        let vector: Vec<f32> = (0..count).map(|_| stream.normal() as f32).collect();
        let mut product = vec![0.0; count];
        region.fisher_times(&mut learner, &mut origin, &vector, &mut product);
        product
    };
    let exact = product(Simd::PLAIN);
    let size = |values: &[f32]| values.iter().map(|value| f64::from(*value).powi(2)).sum::<f64>();
    for kernels in Simd::all() {
        let other = product(kernels);
        let difference: Vec<f32> = exact.iter().zip(&other).map(|(a, b)| a - b).collect();
        let error = (size(&difference) / size(&exact)).sqrt();
        assert!(error < 0.01, "{kernels}: {error}");
    }
}

/// A step along a direction, halved until it is accepted: one that raises the divergence too
/// far is shortened to one that does not, and one that nothing accepts leaves every bit as it
/// was. Parameters move by the reported share of the step.
#[test]
fn a_search_ends_in_an_accepted_step_or_where_it_began() {
    let config = small::config(AlgorithmKind::Trpo);
    let (mut learner, rollout) = small::learner(&config);
    learner.absorb(&rollout).unwrap();
    let prepared = learner.prepare(&rollout);
    let mut minibatch = learner.minibatch(&prepared, &[0, 1, 2, 3]);
    // The rollout's outputs are noise: the policy that acted is the present one here.
    let outputs = learner.policy_outputs(&mut minibatch.batch, &learner.policy_parameters());
    minibatch.old_policy =
        Policy::new(&learner.shape().action, &outputs, learner.shape().action.parameters());
    let region = TrustRegion { search_steps: 30, search_factor: 0.5, ..TrustRegion::new(&config) };
    let origin = region.origin(&mut learner, &mut minibatch);
    let step: Vec<f32> =
        (0..origin.parameters.len()).map(|index| (index as f32).sin() * 3.0).collect();
    let mut means = Means::default();
    let mut asked = Vec::new();
    region.search(&mut learner, &mut minibatch, &origin, &step, &mut means, |_, divergence| {
        asked.push(divergence);
        divergence <= 0.01
    });
    let share = means.get("step_share").unwrap();
    assert!(asked.len() > 1 && share == 0.5f64.powi(asked.len() as i32 - 1), "{asked:?}");
    assert!(asked[0] > 0.01 && *asked.last().unwrap() <= 0.01, "{asked:?}");
    let parameters = learner.policy_parameters();
    for ((now, then), step) in parameters.iter().zip(&origin.parameters).zip(&step) {
        assert!((f64::from(now - then) - share * f64::from(*step)).abs() < 1e-6);
    }
    let divergence = learner.policy(&mut minibatch);
    let divergence = minibatch.old_policy.divergence(&divergence).mean();
    assert!((divergence - asked.last().unwrap()).abs() < 1e-9, "the accepted policy acts");
    let mut means = Means::default();
    region.search(&mut learner, &mut minibatch, &origin, &step, &mut means, |_, _| false);
    assert_eq!(means.get("step_share"), Some(0.0));
    assert_eq!(learner.policy_parameters(), origin.parameters);
}

/// Schulman et al. 2015, appendix C: the step's length is such that half its quadratic form
/// with the Fisher matrix is the radius, and the line search never ends beyond it.
#[test]
fn trpo_moves_to_the_edge_of_its_region_and_not_beyond() {
    use crate::algorithms::trpo::Trpo;
    for radius in [1e-4, 1e-3, 1e-2, 1.0] {
        let mut config = small::config(AlgorithmKind::Trpo);
        config.algorithm_settings.trust_radius = radius;
        config.algorithm_settings.fisher_damping = 1e-4;
        config.algorithm_settings.conjugate_iterations = 30;
        let (mut learner, rollout) = small::learner(&config);
        learner.absorb(&rollout).unwrap();
        let prepared = learner.prepare(&rollout);
        let mut minibatch = learner.minibatch(&prepared, &[0, 1, 2, 3]);
        let outputs = learner.policy_outputs(&mut minibatch.batch, &learner.policy_parameters());
        let action = learner.shape().action.clone();
        let before = Policy::new(&action, &outputs, action.parameters());
        minibatch.old_policy = before.clone();
        let taken = &minibatch.taken;
        minibatch.old_log_probability = before.log_probability(taken).values;
        let (mixed, mut means) = (minibatch.advantages().to_vec(), Means::default());
        Trpo::new(&config).step(&mut learner, &mut minibatch, mixed, &mut means).unwrap();
        let share = means.get("step_share").unwrap();
        let divergence = before.divergence(&learner.policy(&mut minibatch)).mean();
        assert!(share > 0.0 && divergence <= radius, "radius {radius}: {divergence}");
        // With next to no damping the whole step reaches just beyond, and is halved; the
        // smaller it is, the truer is the form.
        let whole = divergence / (share * share);
        assert!(share < 1.0 && whole > radius, "radius {radius}: {whole}, {share}");
        assert!(radius > 1e-4 || whole < 1.15 * radius, "{whole}");
    }
}
