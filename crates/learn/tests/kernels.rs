//! The network on the processor against itself, bit by bit: families of kernels, numbers of threads, recorded and repeated
//! forward passes. (`twins.rs` holds it against others.)

use hasard_learn::config::Convolution;
use hasard_learn::networks::cpu::network::{CpuActor, CpuLearner};
use hasard_learn::networks::cpu::simd::Kernels;
use hasard_learn::networks::{
    ActingNetwork, ImageShape, LearningNetwork, NetworkShape, PixelScale, Place, RecordedLane, Recording, Sequences,
};
use hasard_learn::random::{Purpose, Stream};

fn shapes() -> Vec<(&'static str, NetworkShape)> {
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
                ..small.clone()
            },
        ),
        (
            "one row of blocks",
            NetworkShape {
                convolutions: vec![
                    Convolution { channels: 32, kernel: 4, stride: 2 },
                    Convolution { channels: 32, kernel: 4, stride: 2 },
                ],
                dense: vec![32],
                ..small
            },
        ),
    ]
}

/// Weights, and a batch with resets in the middle.
struct Case {
    shape: NetworkShape,
    parameters: Vec<f32>,
    pixels: PixelScale,
    observations: Vec<Vec<u8>>,
    extra: Vec<f32>,
    state: Vec<f32>,
    reset: Vec<bool>,
    steps: usize,
    lanes: usize,
    /// What the outputs are weighed with in the number whose gradient is taken.
    weights: Vec<f32>,
}

impl Case {
    fn new(shape: &NetworkShape, steps: usize, lanes: usize) -> Case {
        let mut stream = Stream::new(11, Purpose::Evaluation, 0, 0);
        let mut normals = |count: usize, scale: f32| -> Vec<f32> { (0..count).map(|_| scale * stream.normal() as f32).collect() };
        let (rows, pixels) = (steps * lanes, shape.image.size());
        let parameters = normals(shape.parameter_count(), 0.1);
        let (extra, state) = (normals(rows * shape.extra_inputs, 0.3), normals(lanes * shape.state_size(), 0.3));
        let (shift, weights) = (normals(pixels, 0.3), normals(rows * shape.outputs(), 1.0));
        let scale = (0..pixels).map(|_| (2.0 + stream.uniform() as f32) / 255.0).collect();
        let observations = (0..rows).map(|_| (0..pixels).map(|_| (stream.bits() >> 56) as u8).collect()).collect();
        let reset = (0..rows).map(|_| stream.uniform() < 0.2).collect();
        let pixels = PixelScale { scale, shift };
        Case { shape: shape.clone(), parameters, pixels, observations, extra, state, reset, steps, lanes, weights }
    }

    fn sequences(&self) -> Sequences<'_> {
        Sequences {
            steps: self.steps,
            lanes: self.lanes,
            observations: self.observations.iter().map(Vec::as_slice).collect(),
            extra: self.extra.clone(),
            initial_state: self.state.clone(),
            reset: self.reset.clone(),
            recorded: Vec::new(),
        }
    }

    fn learner(&self, kernels: Kernels, threads: usize) -> CpuLearner {
        let mut learner = CpuLearner::new(kernels, &self.shape, threads);
        learner.load(&self.parameters);
        learner.load_pixels(&self.pixels);
        learner
    }

    fn gradient(&self, learner: &mut CpuLearner, batch: &Sequences<'_>) -> (Vec<f32>, Vec<f32>) {
        let outputs = learner.forward(batch);
        let mut gradient = vec![f32::NAN; self.parameters.len()];
        learner.backward(batch, &self.weights, &mut gradient);
        (outputs, gradient)
    }
}

/// More threads than lanes, and numbers that divide nothing.
#[test]
fn no_number_of_threads_changes_a_bit() {
    for (name, shape) in shapes() {
        let case = Case::new(&shape, 4, 7);
        for kernels in Kernels::available() {
            let one = case.gradient(&mut case.learner(kernels, 1), &case.sequences());
            for threads in [2, 3, 7, 40] {
                let many = case.gradient(&mut case.learner(kernels, threads), &case.sequences());
                assert!(one == many, "{name}: {threads} threads, {kernels}");
            }
        }
    }
}

#[test]
fn the_fused_families_agree_bit_by_bit() {
    let fused: Vec<Kernels> = Kernels::available().into_iter().filter(|&kernels| kernels != Kernels::PORTABLE).collect();
    for (name, shape) in shapes() {
        let case = Case::new(&shape, 3, 4);
        let results: Vec<_> =
            fused.iter().map(|&kernels| case.gradient(&mut case.learner(kernels, 1), &case.sequences())).collect();
        assert!(results.windows(2).all(|pair| pair[0] == pair[1]), "{name}");
    }
}

/// Acting step by step in two groups of lanes, as samplers do, gives the bits of a pass over whole trajectories, and what was
/// recorded on the way gives the same gradient as repeating the pass. Other weights or statistics of pixels are noticed.
#[test]
fn recordings_replace_the_forward_pass_bit_by_bit() {
    for (name, shape) in shapes() {
        let case = Case::new(&shape, 5, 6);
        for kernels in Kernels::available() {
            let mut learner = case.learner(kernels, 2);
            let plain = case.gradient(&mut learner, &case.sequences());
            let (recording, acted) = case.act(&learner, kernels);
            assert!(acted == plain.0, "{name}, {kernels}: acting gives other outputs");
            let mut batch = case.sequences();
            batch.recorded = (0..case.lanes).map(|lane| RecordedLane { recording: &recording, lane }).collect();
            // Observations that would give other outputs show that the pass is not repeated.
            let blank = vec![0; shape.image.size()];
            let mut blind = batch.clone();
            blind.observations.fill(&blank);
            assert!(learner.forward(&blind) == plain.0, "{name}, {kernels}: the recording is not used");
            assert!(case.gradient(&mut learner, &batch) == plain, "{name}, {kernels}");

            learner.load(&case.parameters.iter().map(|v| v * 0.5).collect::<Vec<_>>());
            let other = case.gradient(&mut learner, &case.sequences());
            assert!(case.gradient(&mut learner, &batch) == other && other != plain, "{name}: stale weights");
            learner.load(&case.parameters);
            learner.load_pixels(&PixelScale::unit(shape.image.size()));
            let other = case.gradient(&mut learner, &case.sequences());
            assert!(case.gradient(&mut learner, &batch) == other && other != plain, "{name}: stale statistics");
        }
    }
}

impl Case {
    /// Acts through the batch with a learner's weights; the recording and the output rows.
    fn act(&self, learner: &CpuLearner, kernels: Kernels) -> (Recording, Vec<f32>) {
        let (mut actor, mut recording) = (CpuActor::new(kernels, &self.shape), Recording::default());
        actor.load(&learner.publish());
        let (units, width, extra) = (self.shape.state_size(), self.shape.outputs(), self.shape.extra_inputs);
        let (mut state, mut rows) = (self.state.clone(), vec![0.0; self.steps * self.lanes * width]);
        for step in 0..self.steps {
            for lanes in [0..self.lanes / 3, self.lanes / 3..self.lanes] {
                let own = step * self.lanes + lanes.start..step * self.lanes + lanes.end;
                for lane in lanes.clone().filter(|lane| self.reset[step * self.lanes + lane]) {
                    state[lane * units..(lane + 1) * units].fill(0.0);
                }
                let place =
                    Place { recording: &mut recording, steps: self.steps, all_lanes: self.lanes, step, lanes: lanes.clone() };
                actor.act(
                    &self.observations[own.clone()].concat(),
                    &self.extra[own.start * extra..own.end * extra],
                    &mut state[lanes.start * units..lanes.end * units],
                    &mut rows[own.start * width..own.end * width],
                    Some(place),
                );
            }
        }
        (recording, rows)
    }
}
