//! The network on the processor as the rest of the crate sees it: learning on several threads, acting on one.

use std::sync::Arc;

use super::elementwise::add;
use super::pass::{Input, Pass};
use super::weights::{Backward, PackedWeights, Plan, stored_pixels};
use crate::networks::{ActingNetwork, LearningNetwork, NetworkShape, NetworkWeights, PixelScale, Sequences};

/// A network that learns on a number of threads, each with lanes of its own.
///
/// Nothing is shared between the threads but the weights; their gradients are added in the order of the lanes, so that
/// a result depends on the number of shards but never on timing.
pub struct CpuLearner {
    plan: Arc<Plan>,
    weights: Arc<PackedWeights>,
    /// Packed weights of before, whose memory is used again once no actor holds them.
    spare: Vec<Arc<PackedWeights>>,
    backward: Backward,
    pixels: Arc<PixelScale>,
    shards: Vec<Shard>,
}

#[derive(Default)]
struct Shard {
    pass: Pass,
    gradient: Vec<f32>,
    outputs: Vec<f32>,
}

/// The lanes of a shard cut out of a batch, still ordered by time, then by lane.
struct Cut<'a> {
    first: usize,
    lanes: usize,
    steps: usize,
    observations: Vec<&'a [u8]>,
    extra: Vec<f32>,
    initial_state: Vec<f32>,
    reset: Vec<bool>,
    pixels: &'a PixelScale,
}

impl<'a> Cut<'a> {
    fn new(shape: &NetworkShape, batch: &Sequences<'a>, pixels: &'a PixelScale, first: usize, lanes: usize) -> Cut<'a> {
        let mut cut = Cut {
            first,
            lanes,
            steps: batch.steps,
            observations: Vec::with_capacity(lanes * batch.steps),
            extra: Vec::new(),
            initial_state: batch.initial_state[first * shape.state_size()..(first + lanes) * shape.state_size()].to_vec(),
            reset: Vec::with_capacity(lanes * batch.steps),
            pixels,
        };
        for step in 0..batch.steps {
            let rows = step * batch.lanes + first..step * batch.lanes + first + lanes;
            cut.observations.extend_from_slice(&batch.observations[rows.clone()]);
            cut.extra.extend_from_slice(&batch.extra[rows.start * shape.extra_inputs..rows.end * shape.extra_inputs]);
            cut.reset.extend_from_slice(&batch.reset[rows]);
        }
        cut
    }

    fn input(&self) -> Input<'_> {
        Input {
            steps: self.steps,
            lanes: self.lanes,
            observations: &self.observations,
            extra: &self.extra,
            initial_state: &self.initial_state,
            reset: &self.reset,
            pixels: self.pixels,
        }
    }
}

impl CpuLearner {
    /// A learner of a checked shape on `threads` threads.
    #[must_use]
    pub fn new(shape: &NetworkShape, threads: usize) -> CpuLearner {
        CpuLearner {
            plan: Arc::new(Plan::new(shape)),
            weights: Arc::default(),
            spare: Vec::new(),
            backward: Backward::default(),
            pixels: Arc::new(PixelScale::unit(0)),
            shards: (0..threads.max(1)).map(|_| Shard::default()).collect(),
        }
    }

    /// Runs `work` for every shard, on a thread of its own but for the first.
    fn each_shard(
        &mut self,
        batch: &Sequences<'_>,
        work: impl Fn(&Plan, &PackedWeights, &Backward, &mut Shard, &Cut<'_>) + Sync,
    ) {
        let cuts = cuts(&self.plan.shape, batch, &self.pixels, self.shards.len());
        let (plan, weights, backward, work) = (&*self.plan, &*self.weights, &self.backward, &work);
        std::thread::scope(|scope| {
            let mut pairs = self.shards.iter_mut().zip(&cuts);
            let own = pairs.next();
            for (shard, cut) in pairs {
                scope.spawn(move || work(plan, weights, backward, shard, cut));
            }
            if let Some((shard, cut)) = own {
                work(plan, weights, backward, shard, cut);
            }
        });
    }
}

/// Lanes of each shard: as equal as they can be, the larger ones first.
fn lane_counts(lanes: usize, shards: usize) -> impl Iterator<Item = usize> {
    let count = shards.min(lanes).max(1);
    (0..count).map(move |shard| lanes / count + usize::from(shard < lanes % count))
}

/// A batch dealt out to shards.
fn cuts<'a>(shape: &NetworkShape, batch: &Sequences<'a>, pixels: &'a PixelScale, shards: usize) -> Vec<Cut<'a>> {
    let mut first = 0;
    lane_counts(batch.lanes, shards)
        .map(|lanes| {
            first += lanes;
            Cut::new(shape, batch, pixels, first - lanes, lanes)
        })
        .collect()
}

impl LearningNetwork for CpuLearner {
    fn shape(&self) -> &NetworkShape {
        &self.plan.shape
    }

    fn load(&mut self, parameters: &[f32]) {
        let free = self.spare.iter().position(|spare| Arc::strong_count(spare) == 1);
        let mut fresh = free.map_or_else(Arc::default, |index| self.spare.swap_remove(index));
        let packed = Arc::get_mut(&mut fresh).expect("nobody else holds it");
        let plan = &self.plan;
        if self.shards.len() > 1 {
            let backward = &mut self.backward;
            std::thread::scope(|scope| {
                scope.spawn(|| backward.load(plan, parameters));
                packed.load(plan, parameters);
            });
        } else {
            self.backward.load(plan, parameters);
            packed.load(plan, parameters);
        }
        self.spare.push(std::mem::replace(&mut self.weights, fresh));
    }

    fn load_pixels(&mut self, pixels: &PixelScale) {
        self.pixels = Arc::new(stored_pixels(&self.plan, pixels));
    }

    fn publish(&self) -> NetworkWeights {
        NetworkWeights::Packed { weights: Arc::clone(&self.weights), pixels: Arc::clone(&self.pixels) }
    }

    fn forward(&mut self, batch: &Sequences<'_>) -> Vec<f32> {
        self.each_shard(batch, |plan, weights, _, shard, cut| {
            let (outputs, padded) = (plan.shape.outputs(), plan.padded_outputs);
            let rows = shard.pass.forward(plan, weights, &cut.input());
            shard.outputs.clear();
            for row in rows.chunks_exact(padded).take(cut.steps * cut.lanes) {
                shard.outputs.extend_from_slice(&row[..outputs]);
            }
        });
        let outputs = self.plan.shape.outputs();
        let mut all = vec![0.0; batch.rows() * outputs];
        let mut first = 0;
        for (shard, lanes) in self.shards.iter().zip(lane_counts(batch.lanes, self.shards.len())) {
            for (step, rows) in shard.outputs.chunks_exact(lanes * outputs).enumerate() {
                let start = (step * batch.lanes + first) * outputs;
                all[start..start + rows.len()].copy_from_slice(rows);
            }
            first += lanes;
        }
        all
    }

    fn backward(&mut self, batch: &Sequences<'_>, output_gradient: &[f32], gradient: &mut [f32]) {
        let length = gradient.len();
        self.each_shard(batch, |plan, _, backward, shard, cut| {
            let outputs = plan.shape.outputs();
            let mut own = Vec::with_capacity(cut.steps * cut.lanes * outputs);
            for step in 0..cut.steps {
                let start = (step * batch.lanes + cut.first) * outputs;
                own.extend_from_slice(&output_gradient[start..start + cut.lanes * outputs]);
            }
            shard.gradient.clear();
            shard.gradient.resize(length, 0.0);
            shard.pass.backward(plan, backward, &cut.input(), &own, &mut shard.gradient);
        });
        let used = self.shards.len().min(batch.lanes).max(1);
        gradient.copy_from_slice(&self.shards[0].gradient);
        for shard in &self.shards[1..used] {
            add(gradient, &shard.gradient);
        }
    }
}

/// A network that acts, on the thread that calls it.
pub struct CpuActor {
    plan: Arc<Plan>,
    weights: Arc<PackedWeights>,
    pixels: Arc<PixelScale>,
    pass: Pass,
}

impl CpuActor {
    /// An actor of a checked shape.
    #[must_use]
    pub fn new(shape: &NetworkShape) -> CpuActor {
        CpuActor {
            plan: Arc::new(Plan::new(shape)),
            weights: Arc::default(),
            pixels: Arc::new(PixelScale::unit(0)),
            pass: Pass::default(),
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

    fn act(&mut self, observations: &[u8], extra: &[f32], state: &mut [f32], outputs: &mut [f32]) {
        let shape = &self.plan.shape;
        let observations: Vec<&[u8]> = observations.chunks_exact(shape.image.size()).collect();
        let lanes = observations.len();
        let input =
            Input { steps: 1, lanes, observations: &observations, extra, initial_state: state, reset: &[], pixels: &self.pixels };
        let rows = self.pass.forward(&self.plan, &self.weights, &input);
        let width = shape.outputs();
        for (to, from) in outputs.chunks_exact_mut(width).zip(rows.chunks_exact(self.plan.padded_outputs)) {
            to.copy_from_slice(&from[..width]);
        }
        if let Some(units) = shape.recurrent {
            state.copy_from_slice(self.pass.final_state(units, lanes));
        }
    }
}
