//! The network on the processor against its portable twin in burn: outputs, states and gradients.

use burn::tensor::Device;
use hasard_learn::config::{Convolution, Initialisation};
use hasard_learn::networks::burn_network::BurnNetwork;
use hasard_learn::networks::cpu::network::{CpuActor, CpuLearner};
use hasard_learn::networks::{ActingNetwork, ImageShape, LearningNetwork, NetworkShape, NetworkWeights, PixelScale, Sequences};
use hasard_learn::random::{Purpose, Stream};
use std::sync::Arc;

fn shapes() -> Vec<(&'static str, NetworkShape)> {
    let original = NetworkShape { heads: vec![9, 1, 1], ..NetworkShape::default() };
    let small = NetworkShape {
        image: ImageShape { height: 11, width: 14, channels: 2 },
        convolutions: vec![
            Convolution { channels: 32, kernel: 4, stride: 2 },
            Convolution { channels: 32, kernel: 3, stride: 2 },
        ],
        dense: vec![64, 32],
        extra_inputs: 1,
        recurrent: Some(32),
        heads: vec![3, 2],
    };
    vec![
        ("original", original),
        ("overlapping kernels, extra input, two dense layers", small.clone()),
        ("feed-forward", NetworkShape { recurrent: None, ..small.clone() }),
        ("no convolution", NetworkShape { convolutions: vec![], ..small.clone() }),
        (
            "block kernels in a row",
            NetworkShape {
                convolutions: vec![
                    Convolution { channels: 32, kernel: 3, stride: 1 },
                    Convolution { channels: 32, kernel: 2, stride: 2 },
                    Convolution { channels: 64, kernel: 2, stride: 1 },
                ],
                heads: vec![40],
                ..small
            },
        ),
    ]
}

struct Case {
    pixels: PixelScale,
    observations: Vec<Vec<u8>>,
    extra: Vec<f32>,
    state: Vec<f32>,
    reset: Vec<bool>,
    steps: usize,
    lanes: usize,
}

impl Case {
    fn new(shape: &NetworkShape, steps: usize, lanes: usize) -> Case {
        let mut stream = Stream::new(11, Purpose::Evaluation, 0, 0);
        let mut normals = |count: usize| -> Vec<f32> { (0..count).map(|_| 0.3 * stream.normal() as f32).collect() };
        let (rows, pixels) = (steps * lanes, shape.image.size());
        let extra = normals(rows * shape.extra_inputs);
        let state = normals(lanes * shape.state_size());
        let shift = normals(pixels);
        let scale = (0..pixels).map(|_| (2.0 + stream.uniform() as f32) / 255.0).collect();
        let observations = (0..rows).map(|_| (0..pixels).map(|_| (stream.bits() >> 56) as u8).collect()).collect();
        let reset = (0..rows).map(|_| stream.uniform() < 0.2).collect();
        Case { pixels: PixelScale { scale, shift }, observations, extra, state, reset, steps, lanes }
    }

    fn sequences(&self) -> Sequences<'_> {
        Sequences {
            steps: self.steps,
            lanes: self.lanes,
            observations: self.observations.iter().map(Vec::as_slice).collect(),
            extra: self.extra.clone(),
            initial_state: self.state.clone(),
            reset: self.reset.clone(),
        }
    }
}

fn close(what: &str, a: &[f32], b: &[f32]) {
    assert_eq!(a.len(), b.len(), "{what}");
    let scale = b.iter().fold(1e-3f32, |m, v| m.max(v.abs()));
    for (index, (x, y)) in a.iter().zip(b).enumerate() {
        assert!((x - y).abs() <= 2e-4 * scale, "{what} {index}: {x} against {y} (largest {scale})");
    }
}

#[test]
fn outputs_and_gradients_equal_those_of_burn() {
    for (name, shape) in shapes() {
        shape.check().unwrap();
        let parameters = shape.initial_parameters(Initialisation::Uniform, 5, 0);
        let case = Case::new(&shape, 4, 5);
        let batch = case.sequences();
        let mut portable = BurnNetwork::new(&shape, &Device::flex());
        LearningNetwork::load(&mut portable, &parameters);
        portable.load_pixels(&case.pixels);
        let expected = portable.forward(&batch);
        let mut stream = Stream::new(12, Purpose::Evaluation, 0, 0);
        let seeds: Vec<f32> = (0..expected.len()).map(|_| stream.normal() as f32).collect();
        let mut expected_gradient = vec![f32::NAN; parameters.len()];
        portable.backward(&batch, &seeds, &mut expected_gradient);
        assert!(expected_gradient.iter().all(|g| g.is_finite()));
        for threads in [1, 2, 7] {
            let mut learner = CpuLearner::new(&shape, threads);
            learner.load(&parameters);
            learner.load_pixels(&case.pixels);
            // Twice, so that buffers of an earlier pass are seen not to leak into the next.
            for _ in 0..2 {
                let outputs = learner.forward(&batch);
                close(&format!("{name}: output"), &outputs, &expected);
                let mut gradient = vec![f32::NAN; parameters.len()];
                learner.backward(&batch, &seeds, &mut gradient);
                for parameter in shape.parameters() {
                    let range = parameter.range();
                    let what = format!("{name}, {threads} threads: gradient of {}", parameter.name);
                    close(&what, &gradient[range.clone()], &expected_gradient[range]);
                }
            }
        }
    }
}

#[test]
fn acting_step_by_step_equals_the_forward_pass_over_sequences() {
    for (name, shape) in shapes() {
        let parameters = shape.initial_parameters(Initialisation::Orthogonal, 6, 0);
        let case = Case::new(&shape, 3, 4);
        let mut learner = CpuLearner::new(&shape, 2);
        learner.load(&parameters);
        learner.load_pixels(&case.pixels);
        let expected = learner.forward(&case.sequences());
        let actors: [Box<dyn ActingNetwork>; 3] = [
            Box::new(CpuActor::new(&shape)),
            Box::new(BurnNetwork::new(&shape, &Device::flex())),
            Box::new(CpuActor::new(&shape)),
        ];
        for (kind, mut actor) in actors.into_iter().enumerate() {
            let plain = NetworkWeights::Plain { parameters: Arc::new(parameters.clone()), pixels: Arc::new(case.pixels.clone()) };
            // The learner's own packed weights, or those that the actor packs or uploads itself.
            actor.load(&if kind == 0 { learner.publish() } else { plain });
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
                let extra = &case.extra[rows.start * shape.extra_inputs..rows.end * shape.extra_inputs];
                actor.act(&case.observations[rows.clone()].concat(), extra, &mut state, &mut outputs);
                let expected = &expected[rows.start * shape.outputs()..rows.end * shape.outputs()];
                if kind != 1 {
                    assert_eq!(outputs, expected, "{name}: the same kernels must give the same bits");
                } else {
                    close(&format!("{name}: output"), &outputs, expected);
                }
            }
        }
    }
}
