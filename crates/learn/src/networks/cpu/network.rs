//! The network on the processor as the rest of the crate sees it: learning on several threads,
//! acting on one.

use std::sync::Arc;

use crate::networks::cpu::backward::RowGradients;
use crate::networks::cpu::forward::{Forward, Input};
use crate::networks::cpu::gradient::{Finished, ParameterGradients};
use crate::networks::cpu::tape::{Tape, TapeLane};
use crate::networks::cpu::weights::{Backward, PackedWeights, Plan, stored_pixels};
use crate::networks::{
    ActingNetwork, LearningNetwork, NetworkShape, NetworkWeights, PixelScale, Place, RecordedLane,
    Sequences,
};
use crate::threads::{Piece, deal, in_parallel, pieces};
use hasard_engine::simd::Simd;

/// A network that learns on a number of threads. Its results do not depend on the number.
pub struct CpuLearner {
    plan: Arc<Plan>,
    weights: Arc<PackedWeights>,
    /// Packed weights of before, whose memory is used again once no actor holds them.
    spare: Vec<Arc<PackedWeights>>,
    backward: Backward,
    pixels: Arc<PixelScale>,
    /// What each thread works in.
    forwards: Vec<Forward>,
    /// Forward passes of the last batch, their lanes one after the other; unused when all of it was
    /// recorded.
    passes: Vec<Tape>,
    /// The last forward pass was found in recordings.
    recorded: bool,
    rows: Vec<RowGradients>,
    parameters: ParameterGradients,
}

impl CpuLearner {
    /// A learner of a checked shape on `threads` threads.
    #[must_use]
    pub fn new(kernels: Simd, shape: &NetworkShape, threads: usize) -> CpuLearner {
        CpuLearner {
            plan: Arc::new(Plan::new(kernels, shape)),
            weights: Arc::default(),
            spare: Vec::new(),
            backward: Backward::default(),
            pixels: Arc::new(PixelScale::unit(0)),
            forwards: std::iter::repeat_with(Forward::default).take(threads.max(1)).collect(),
            passes: Vec::new(),
            recorded: false,
            rows: Vec::new(),
            parameters: ParameterGradients::default(),
        }
    }

    /// Where the activations of each lane of the last forward pass are.
    fn tapes<'a>(&'a self, batch: &'a Sequences<'_>) -> Vec<TapeLane<'a>> {
        if self.recorded {
            return batch
                .recorded
                .iter()
                .map(|lane| TapeLane { tape: &lane.recording.tape, lane: lane.lane })
                .collect();
        }
        let lanes = self
            .passes
            .iter()
            .flat_map(|tape| (0..tape.lanes).map(move |lane| TapeLane { tape, lane }));
        lanes.collect()
    }
}

/// Rows of a batch, which it has by time, ordered by lane.
fn by_lane<T: Copy>(batch: &Sequences<'_>, values: &[T], width: usize) -> Vec<T> {
    let mut ordered = Vec::with_capacity(values.len());
    for lane in 0..batch.lanes {
        for step in 0..batch.steps {
            let row = step * batch.lanes + lane;
            ordered.extend_from_slice(&values[row * width..(row + 1) * width]);
        }
    }
    ordered
}

impl LearningNetwork for CpuLearner {
    fn shape(&self) -> &NetworkShape {
        &self.plan.shape
    }

    fn load(&mut self, parameters: &[f32]) {
        let free = self.spare.iter().position(|spare| Arc::strong_count(spare) == 1);
        let mut fresh = free.map_or_else(Arc::default, |index| self.spare.swap_remove(index));
        let packed = Arc::get_mut(&mut fresh).expect("nobody else holds it");
        let work: Vec<Piece<'_, Forward>> = packed.loading(&self.plan, parameters);
        in_parallel(
            &mut self.forwards,
            work.into_iter().chain(self.backward.loading(&self.plan, parameters)),
        );
        self.spare.push(std::mem::replace(&mut self.weights, fresh));
    }

    fn load_pixels(&mut self, pixels: &PixelScale) {
        self.pixels = Arc::new(stored_pixels(&self.plan, pixels));
    }

    fn publish(&self) -> NetworkWeights {
        NetworkWeights::Packed {
            weights: Arc::clone(&self.weights),
            pixels: Arc::clone(&self.pixels),
        }
    }

    fn forward(&mut self, batch: &Sequences<'_>) -> Vec<f32> {
        let (steps, lanes) = (batch.steps, batch.lanes);
        let usable = |lane: &RecordedLane<'_>| {
            lane.recording.holds(&self.weights, &self.pixels) && lane.recording.tape.steps == steps
        };
        self.recorded = batch.recorded.len() == lanes && batch.recorded.iter().all(usable);
        if !self.recorded {
            let shape = &self.plan.shape;
            let (units, extra_inputs) = (shape.state_size(), shape.extra_inputs);
            let observations = by_lane(batch, &batch.observations, 1);
            let (extra, reset) =
                (by_lane(batch, &batch.extra, extra_inputs), by_lane(batch, &batch.reset, 1));
            let dealt = deal(lanes, pieces(self.forwards.len()));
            self.passes.resize_with(dealt.clone().count(), Default::default);
            let (plan, weights, pixels) = (&*self.plan, &*self.weights, &*self.pixels);
            let work = self.passes.iter_mut().zip(dealt).map(|(tape, lanes)| {
                let rows = lanes.start * steps..lanes.end * steps;
                let input = Input {
                    observations: &observations[rows.clone()],
                    extra: &extra[rows.start * extra_inputs..rows.end * extra_inputs],
                    state: &batch.initial_state[lanes.start * units..lanes.end * units],
                    reset: &reset[rows],
                    pixels,
                };
                move |forward: &mut Forward| {
                    tape.prepare(plan, steps, lanes.len());
                    forward.run(plan, weights, &input, 0..steps, 0..lanes.len(), tape);
                }
            });
            in_parallel(&mut self.forwards, work);
        }
        let (outputs, padded) = (self.plan.shape.outputs(), self.plan.padded_outputs);
        let mut all = vec![0.0; batch.rows() * outputs];
        for (lane, tape) in self.tapes(batch).into_iter().enumerate() {
            for (step, row) in tape.of(&tape.tape.outputs, padded).chunks_exact(padded).enumerate()
            {
                all[(step * lanes + lane) * outputs..][..outputs].copy_from_slice(&row[..outputs]);
            }
        }
        all
    }

    fn backward(&mut self, batch: &Sequences<'_>, output_gradient: &[f32], gradient: &mut [f32]) {
        let (plan, steps) = (Arc::clone(&self.plan), batch.steps);
        let (outputs, padded) = (plan.shape.outputs(), plan.padded_outputs);
        let (observations, reset) =
            (by_lane(batch, &batch.observations, 1), by_lane(batch, &batch.reset, 1));
        let output_gradient = by_lane(batch, output_gradient, outputs);
        let (mut rows, mut parameters) =
            (std::mem::take(&mut self.rows), std::mem::take(&mut self.parameters));
        let lanes = self.tapes(batch);
        let threads = self.forwards.len();
        let dealt = deal(batch.lanes, pieces(threads));
        rows.resize_with(dealt.clone().count(), Default::default);
        let work = rows.iter_mut().zip(dealt).map(|(rows, own)| {
            let (plan, back, lanes) = (&*plan, &self.backward, &lanes[own.clone()]);
            let reset = &reset[own.start * steps..own.end * steps];
            let from = &output_gradient[own.start * steps * outputs..own.end * steps * outputs];
            move |_: &mut ()| {
                rows.outputs.clear();
                rows.outputs.resize(own.len() * steps * padded, 0.0);
                for (to, from) in
                    rows.outputs.chunks_exact_mut(padded).zip(from.chunks_exact(outputs))
                {
                    to[..outputs].copy_from_slice(from);
                }
                rows.run(plan, back, lanes, reset);
            }
        });
        in_parallel(&mut vec![(); threads], work);
        let dealt: Vec<&RowGradients> = rows.iter().collect();
        let (weights, pixels) = (&*self.weights, &*self.pixels);
        let finished =
            Finished { lanes: &lanes, observations: &observations, weights, pixels, rows: &dealt };
        parameters.run(&plan, &self.backward, &finished, threads, gradient);
        (self.rows, self.parameters) = (rows, parameters);
    }
}

/// A network that acts, on the thread that calls it.
pub struct CpuActor {
    plan: Arc<Plan>,
    weights: Arc<PackedWeights>,
    pixels: Arc<PixelScale>,
    forward: Forward,
    /// What is computed without a recording.
    tape: Tape,
}

impl CpuActor {
    /// An actor of a checked shape.
    #[must_use]
    pub fn new(kernels: Simd, shape: &NetworkShape) -> CpuActor {
        CpuActor {
            plan: Arc::new(Plan::new(kernels, shape)),
            weights: Arc::default(),
            pixels: Arc::new(PixelScale::unit(0)),
            forward: Forward::default(),
            tape: Tape::default(),
        }
    }
}

impl ActingNetwork for CpuActor {
    fn load(&mut self, weights: &NetworkWeights) {
        match weights {
            NetworkWeights::Packed { weights, pixels } => {
                (self.weights, self.pixels) = (Arc::clone(weights), Arc::clone(pixels));
            }
            NetworkWeights::Plain { parameters, pixels } => {
                let mut packed = PackedWeights::default();
                packed.load(&self.plan, parameters);
                self.weights = Arc::new(packed);
                self.pixels = Arc::new(stored_pixels(&self.plan, pixels));
            }
        }
    }

    fn act(
        &mut self,
        observations: &[u8],
        extra: &[f32],
        state: &mut [f32],
        outputs: &mut [f32],
        place: Option<Place<'_>>,
    ) {
        let plan = &*self.plan;
        let observations: Vec<&[u8]> = observations.chunks_exact(plan.shape.image.size()).collect();
        let input =
            Input { observations: &observations, extra, state, reset: &[], pixels: &self.pixels };
        let (tape, step, lanes) = match place {
            Some(place) => {
                place.recording.note(&self.weights, &self.pixels);
                place.recording.tape.prepare(plan, place.steps, place.all_lanes);
                (&mut place.recording.tape, place.step, place.lanes)
            }
            None => {
                self.tape.prepare(plan, 1, observations.len());
                (&mut self.tape, 0, 0..observations.len())
            }
        };
        self.forward.run(plan, &self.weights, &input, step..step + 1, lanes.clone(), tape);
        let (width, padded, steps) = (plan.shape.outputs(), plan.padded_outputs, tape.steps);
        for (lane, to) in lanes.zip(outputs.chunks_exact_mut(width)) {
            let row = lane * steps + step;
            to.copy_from_slice(&tape.outputs[row * padded..row * padded + width]);
        }
        if plan.shape.recurrent.is_some() {
            state.copy_from_slice(self.forward.final_state());
        }
    }
}
