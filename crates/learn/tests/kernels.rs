//! The network on the processor against itself, bit by bit: families of kernels, numbers of
//! threads, recorded and repeated forward passes. (`twins.rs` holds it against others.)

mod trajectories;

use hasard_engine::simd::Simd;
use hasard_learn::config::Convolution;
use hasard_learn::networks::cpu::network::{CpuActor, CpuLearner};
use hasard_learn::networks::{
    ActingNetwork, LearningNetwork, NetworkShape, PixelScale, Place, RecordedLane, Recording,
    Sequences,
};
use std::io::Write;
use trajectories::{normals, small_shapes};

fn shapes() -> Vec<(&'static str, NetworkShape)> {
    let mut shapes = small_shapes();
    let one_row = NetworkShape {
        convolutions: vec![
            Convolution { channels: 32, kernel: 4, stride: 2 },
            Convolution { channels: 32, kernel: 4, stride: 2 },
        ],
        dense: vec![32],
        ..shapes[0].1.clone()
    };
    shapes.push(("one row of blocks", one_row));
    shapes
}

/// A network's weights, and trajectories for it.
struct Case {
    shape: NetworkShape,
    parameters: Vec<f32>,
    batch: trajectories::Case,
    /// What the outputs are weighed with in the number whose gradient is taken.
    weights: Vec<f32>,
}

impl Case {
    fn new(shape: &NetworkShape, steps: usize, lanes: usize) -> Case {
        let parameters =
            normals(shape.parameter_count(), 1).iter().map(|value| 0.1 * value).collect();
        let weights = normals(steps * lanes * shape.outputs(), 2);
        Case {
            shape: shape.clone(),
            parameters,
            batch: trajectories::Case::new(shape, steps, lanes),
            weights,
        }
    }

    fn sequences(&self) -> Sequences<'_> {
        self.batch.sequences()
    }

    fn learner(&self, kernels: Simd, threads: usize) -> CpuLearner {
        let mut learner = CpuLearner::new(kernels, &self.shape, threads);
        learner.load(&self.parameters);
        learner.load_pixels(&self.batch.pixels);
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
        for kernels in Simd::all() {
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
    let fused: Vec<Simd> =
        Simd::available().into_iter().filter(|&kernels| kernels != Simd::PLAIN).collect();
    for (name, shape) in shapes() {
        let case = Case::new(&shape, 3, 4);
        let results: Vec<_> = fused
            .iter()
            .map(|&kernels| case.gradient(&mut case.learner(kernels, 1), &case.sequences()))
            .collect();
        assert!(results.windows(2).all(|pair| pair[0] == pair[1]), "{name}");
    }
}

/// What factors of 8 bits may lose: outputs and the gradient of every block of parameters, as
/// vectors, within 3 % of those of numbers of 32 bits, but not the same. Where pixels are pooled,
/// another of two that are nearly as large may be taken.
#[test]
fn products_in_bfloat16_give_nearly_the_same_gradients() {
    for (rounding, (name, shape)) in bfloat16()
        .into_iter()
        .flat_map(|kernels| shapes().into_iter().map(move |shape| (kernels, shape)))
    {
        let case = Case::new(&shape, 6, 8);
        let [(outputs, gradient), (other_outputs, other_gradient)] = [Simd::widest(), rounding]
            .map(|kernels| case.gradient(&mut case.learner(kernels, 1), &case.sequences()));
        let apart = |a: &[f32], b: &[f32]| {
            let norm = |values: &mut dyn Iterator<Item = f64>| {
                values.map(|value| value * value).sum::<f64>().sqrt()
            };
            let difference = norm(&mut a.iter().zip(b).map(|(a, b)| f64::from(*a) - f64::from(*b)));
            difference / norm(&mut a.iter().map(|&a| f64::from(a)))
        };
        let outputs_apart = apart(&outputs, &other_outputs);
        assert!(outputs_apart > 0.0 && outputs_apart < 0.03, "{name}: outputs {outputs_apart}");
        for parameter in shape.parameters() {
            let (a, b) = (&gradient[parameter.range()], &other_gradient[parameter.range()]);
            let gradients_apart = apart(a, b);
            let most = if shape.residual.is_empty() { 0.03 } else { 0.4 };
            assert!(gradients_apart < most, "{name}: {} {gradients_apart}", parameter.name);
        }
    }
}

/// Acting step by step in two groups of lanes, as samplers do, gives the bits of a pass over whole
/// trajectories, and what was recorded on the way gives the same gradient as repeating the pass.
/// Other weights or statistics of pixels are noticed.
#[test]
fn recordings_replace_the_forward_pass_bit_by_bit() {
    for (name, shape) in shapes() {
        let case = Case::new(&shape, 5, 6);
        for kernels in Simd::all() {
            let mut learner = case.learner(kernels, 2);
            let plain = case.gradient(&mut learner, &case.sequences());
            let (recording, acted) = case.act(&learner, kernels);
            assert!(acted == plain.0, "{name}, {kernels}: acting gives other outputs");
            let mut batch = case.sequences();
            batch.recorded = (0..case.batch.lanes)
                .map(|lane| RecordedLane { recording: &recording, lane })
                .collect();
            // Observations that would give other outputs show that the pass is not repeated.
            let blank = vec![0; shape.image.size()];
            let mut blind = batch.clone();
            blind.observations.fill(&blank);
            assert!(
                learner.forward(&blind) == plain.0,
                "{name}, {kernels}: the recording is not used"
            );
            assert!(case.gradient(&mut learner, &batch) == plain, "{name}, {kernels}");

            learner.load(&case.parameters.iter().map(|v| v * 0.5).collect::<Vec<_>>());
            let other = case.gradient(&mut learner, &case.sequences());
            assert!(
                case.gradient(&mut learner, &batch) == other && other != plain,
                "{name}: stale weights"
            );
            learner.load(&case.parameters);
            learner.load_pixels(&PixelScale::unit(shape.image.size()));
            let other = case.gradient(&mut learner, &case.sequences());
            assert!(
                case.gradient(&mut learner, &batch) == other && other != plain,
                "{name}: stale statistics"
            );
        }
    }
}

impl Case {
    /// Acts through the batch with a learner's weights; the recording and the output rows.
    fn act(&self, learner: &CpuLearner, kernels: Simd) -> (Recording, Vec<f32>) {
        let (mut actor, mut recording) =
            (CpuActor::new(kernels, &self.shape), Recording::default());
        actor.load(&learner.publish());
        let (units, width, extra) =
            (self.shape.state_size(), self.shape.outputs(), self.shape.extra_inputs);
        let (mut state, mut rows) =
            (self.batch.state.clone(), vec![0.0; self.batch.steps * self.batch.lanes * width]);
        for step in 0..self.batch.steps {
            for lanes in [0..self.batch.lanes / 3, self.batch.lanes / 3..self.batch.lanes] {
                let own =
                    step * self.batch.lanes + lanes.start..step * self.batch.lanes + lanes.end;
                for lane in
                    lanes.clone().filter(|lane| self.batch.reset[step * self.batch.lanes + lane])
                {
                    state[lane * units..(lane + 1) * units].fill(0.0);
                }
                let place = Place {
                    recording: &mut recording,
                    steps: self.batch.steps,
                    all_lanes: self.batch.lanes,
                    step,
                    lanes: lanes.clone(),
                };
                actor.act(
                    &self.batch.observations[own.clone()].concat(),
                    &self.batch.extra[own.start * extra..own.end * extra],
                    &mut state[lanes.start * units..lanes.end * units],
                    &mut rows[own.start * width..own.end * width],
                    Some(place),
                );
            }
        }
        (recording, rows)
    }
}

/// The families of bfloat16, or a word that this processor has none.
fn bfloat16() -> Vec<Simd> {
    let kernels = Simd::bfloat16();
    if kernels.is_empty() {
        // Past the capture of the test runner: ./check counts it.
        let _ = writeln!(std::io::stderr(), "skipped: this processor has no products in bfloat16");
    }
    kernels
}
