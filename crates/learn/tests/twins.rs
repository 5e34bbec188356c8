//! The network on the processor against its twins, outputs and gradients: a plain one by its
//! definition and, where a graphics card's feature is built in, the one in burn.

mod plain;
mod trajectories;

use hasard_engine::simd::Simd;
use hasard_learn::config::Initialisation;
use hasard_learn::networks::cpu::network::{CpuActor, CpuLearner};
use hasard_learn::networks::{ActingNetwork, LearningNetwork, NetworkShape, NetworkWeights};
use std::sync::Arc;
use trajectories::{Case, normals, small_shapes};

fn shapes() -> Vec<(&'static str, NetworkShape)> {
    let original = NetworkShape { heads: vec![9, 1, 1], ..NetworkShape::default() };
    std::iter::once(("original", original)).chain(small_shapes()).collect()
}

fn close(what: &str, a: &[f32], b: &[f32]) {
    assert_eq!(a.len(), b.len(), "{what}");
    let scale = b.iter().fold(1e-3f32, |m, v| m.max(v.abs()));
    for (index, (x, y)) in a.iter().zip(b).enumerate() {
        assert!((x - y).abs() <= 2e-4 * scale, "{what} {index}: {x} against {y} (largest {scale})");
    }
}

/// Outputs, and for every block of parameters the change of a weighted sum of them in a random
/// direction, by differences.
#[test]
fn outputs_and_gradients_equal_those_of_the_plain_network() {
    for (name, shape) in shapes() {
        shape.check().unwrap();
        let parameters = shape.initial_parameters(Initialisation::Uniform, 5, 0);
        let (steps, lanes) = if name == "original" { (2, 2) } else { (4, 5) };
        let case = Case::new(&shape, steps, lanes);
        let batch = case.sequences();
        let wide: Vec<f64> = parameters.iter().map(|&value| f64::from(value)).collect();
        let expected: Vec<f32> = plain::forward(&shape, &wide, &case.pixels, &batch)
            .iter()
            .map(|&value| value as f32)
            .collect();
        let seeds = normals(expected.len(), 1);
        let gradients = Simd::available().into_iter().map(|kernels| {
            let mut learner = CpuLearner::new(kernels, &shape, 2);
            learner.load(&parameters);
            learner.load_pixels(&case.pixels);
            close(&format!("{name}, {kernels}: output"), &learner.forward(&batch), &expected);
            let mut gradient = vec![f32::NAN; parameters.len()];
            learner.backward(&batch, &seeds, &mut gradient);
            (kernels, gradient)
        });
        let gradients: Vec<_> = gradients.collect();
        for parameter in shape.parameters() {
            let direction = normals(parameter.size(), 2 + parameter.offset as u64);
            let moved = |by: f64| -> f64 {
                let mut moved = wide.clone();
                for (value, direction) in moved[parameter.range()].iter_mut().zip(&direction) {
                    *value += by * f64::from(*direction);
                }
                let outputs = plain::forward(&shape, &moved, &case.pixels, &batch);
                outputs.iter().zip(&seeds).map(|(output, seed)| output * f64::from(*seed)).sum()
            };
            // So small that hardly any rectifier turns in between.
            let expected = (moved(1e-8) - moved(-1e-8)) / 2e-8;
            for (kernels, gradient) in &gradients {
                let own = &gradient[parameter.range()];
                let found: f64 =
                    own.iter().zip(&direction).map(|(g, d)| f64::from(*g) * f64::from(*d)).sum();
                let size = own.iter().map(|g| f64::from(*g).powi(2)).sum::<f64>().sqrt();
                let name = format!("{name}, {kernels}: {}", parameter.name);
                assert!(
                    (found - expected).abs() <= 1e-4 * size,
                    "{name} along {found}, {expected}"
                );
            }
        }
    }
}

/// The same bits from one pass to the next and for any number of threads.
#[test]
fn passes_do_not_depend_on_threads_or_on_what_was_before() {
    for (name, shape) in shapes() {
        let parameters = shape.initial_parameters(Initialisation::Uniform, 5, 0);
        let case = Case::new(&shape, 4, 5);
        let batch = case.sequences();
        let seeds = normals(batch.rows() * shape.outputs(), 1);
        let passes = [1, 2, 7].map(|threads| {
            let mut learner = CpuLearner::new(Simd::widest(), &shape, threads);
            learner.load(&parameters);
            learner.load_pixels(&case.pixels);
            [(); 2].map(|()| {
                let outputs = learner.forward(&batch);
                let mut gradient = vec![f32::NAN; parameters.len()];
                learner.backward(&batch, &seeds, &mut gradient);
                (outputs, gradient)
            })
        });
        for pass in passes.iter().flatten() {
            let bits = |values: &[f32]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
            assert!(bits(&pass.0) == bits(&passes[0][0].0), "{name}: outputs differ");
            assert!(bits(&pass.1) == bits(&passes[0][0].1), "{name}: gradients differ");
        }
    }
}

#[test]
#[cfg(feature = "graphics")]
fn outputs_and_gradients_equal_those_of_burn() {
    use hasard_learn::networks::burn_network::BurnNetwork;
    for (name, shape) in shapes() {
        let parameters = shape.initial_parameters(Initialisation::Uniform, 5, 0);
        let case = Case::new(&shape, 4, 5);
        let batch = case.sequences();
        let seeds = normals(batch.rows() * shape.outputs(), 1);
        let networks: [Box<dyn LearningNetwork>; 2] = [
            Box::new(BurnNetwork::new(&shape, &burn::tensor::Device::flex())),
            Box::new(CpuLearner::new(Simd::widest(), &shape, 2)),
        ];
        let [(there, there_gradient), (here, here_gradient)] = networks.map(|mut network| {
            network.load(&parameters);
            network.load_pixels(&case.pixels);
            let outputs = network.forward(&batch);
            let mut gradient = vec![f32::NAN; parameters.len()];
            network.backward(&batch, &seeds, &mut gradient);
            (outputs, gradient)
        });
        close(&format!("{name}: output"), &here, &there);
        for parameter in shape.parameters() {
            let range = parameter.range();
            close(
                &format!("{name}: gradient of {}", parameter.name),
                &here_gradient[range.clone()],
                &there_gradient[range],
            );
        }
    }
}

#[test]
fn acting_step_by_step_equals_the_forward_pass_over_sequences() {
    for (name, shape) in shapes() {
        let parameters = shape.initial_parameters(Initialisation::Orthogonal, 6, 0);
        let case = Case::new(&shape, 3, 4);
        let mut learner = CpuLearner::new(Simd::widest(), &shape, 2);
        learner.load(&parameters);
        learner.load_pixels(&case.pixels);
        let expected = learner.forward(&case.sequences());
        let plain = NetworkWeights::Plain {
            parameters: Arc::new(parameters.clone()),
            pixels: Arc::new(case.pixels.clone()),
        };
        // The learner's own packed weights, or those that the actor packs or uploads itself.
        let actor =
            || -> Box<dyn ActingNetwork> { Box::new(CpuActor::new(Simd::widest(), &shape)) };
        let own = [(true, learner.publish(), actor()), (true, plain.clone(), actor())];
        for (same_kernels, weights, mut actor) in own.into_iter().chain(portable(&shape, plain)) {
            actor.load(&weights);
            let mut state = case.state.clone();
            for step in 0..case.steps {
                let rows = step * case.lanes..(step + 1) * case.lanes;
                let units = shape.state_size();
                for (lane, row) in rows.clone().enumerate() {
                    if case.reset[row] {
                        state[lane * units..(lane + 1) * units].fill(0.0);
                    }
                }
                let mut outputs = vec![0.0; case.lanes * shape.outputs()];
                let extra =
                    &case.extra[rows.start * shape.extra_inputs..rows.end * shape.extra_inputs];
                actor.act(
                    &case.observations[rows.clone()].concat(),
                    extra,
                    &mut state,
                    &mut outputs,
                    None,
                );
                let expected = &expected[rows.start * shape.outputs()..rows.end * shape.outputs()];
                if same_kernels {
                    assert_eq!(
                        outputs, expected,
                        "{name}: the same kernels must give the same bits"
                    );
                } else {
                    close(&format!("{name}: output"), &outputs, expected);
                }
            }
        }
    }
}

/// The network in burn, where it is built in.
#[cfg(feature = "graphics")]
fn portable(
    shape: &NetworkShape,
    weights: NetworkWeights,
) -> Option<(bool, NetworkWeights, Box<dyn ActingNetwork>)> {
    let burn = hasard_learn::networks::burn_network::BurnNetwork::new(
        shape,
        &burn::tensor::Device::flex(),
    );
    Some((false, weights, Box::new(burn)))
}

#[cfg(not(feature = "graphics"))]
fn portable(
    _: &NetworkShape,
    _: NetworkWeights,
) -> Option<(bool, NetworkWeights, Box<dyn ActingNetwork>)> {
    None
}
