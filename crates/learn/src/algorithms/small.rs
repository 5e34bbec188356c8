//! A small learner and a rollout of noise, for tests.

use crate::config::{AlgorithmKind, EnvConfig, Preset, TrainConfig};
use crate::learning::learner::Learner;
use crate::learning::policy::{Policy, Taken};
use crate::networks::device::ComputeDevice;
use crate::networks::distribution::ActionShape;
use crate::networks::{ImageShape, ModelShape};
use crate::random::{Purpose, Stream};
use crate::sampling::auxiliary::Auxiliary;
use crate::sampling::rollout::{Part, Rollout};
use hasard_engine::simd::Simd;

/// Steps and lanes of the rollout.
pub const STEPS: usize = 3;
pub const LANES: usize = 4;

/// Settings of a recurrent network of some thousand parameters.
pub fn config(algorithm: AlgorithmKind) -> TrainConfig {
    let mut config = TrainConfig::plain(algorithm, Preset::Paper, EnvConfig::new("test"));
    config.network.convolutions = vec![];
    config.network.dense = vec![32];
    config.network.recurrent = Some(32);
    config.learning.threads = 1;
    config.learning.minibatches = 1;
    config.algorithm_settings.fisher_fraction = 1.0;
    config
}

/// A learner, and a rollout whose actions its own distribution drew.
pub fn learner(config: &TrainConfig) -> (Learner, Rollout) {
    learner_on(Simd::PLAIN, config)
}

/// The same by other kernels.
pub fn learner_on(kernels: Simd, config: &TrainConfig) -> (Learner, Rollout) {
    let image = ImageShape { height: 2, width: 3, channels: 1 };
    let action = ActionShape { sizes: vec![3, 2], deltas: 1 };
    let cost_critics =
        if config.algorithm.has_cost_critics() { config.constraints.len() } else { 0 };
    let auxiliary = Auxiliary::new(config);
    let shape = ModelShape::new(image, action, cost_critics, 0, &config.network)
        .and_then(|shape| shape.with_auxiliary(auxiliary.outputs()))
        .unwrap();
    let learner = Learner::new(config, &shape, &ComputeDevice::Processor(kernels));
    let mut stream = Stream::new(3, Purpose::Evaluation, 0, 0);
    let mut part = Part { initial_state: shape.zero_state(LANES), ..Part::default() };
    part.prepare(&shape, STEPS, LANES, 1, config.constraints.len());
    part.frames.iter_mut().flatten().for_each(|pixel| *pixel = (stream.bits() >> 56) as u8);
    for values in [&mut part.outputs, &mut part.rewards, &mut part.costs, &mut part.deltas] {
        values.iter_mut().for_each(|value| *value = stream.normal() as f32);
    }
    for (index, action) in part.actions.iter_mut().enumerate() {
        *action = (stream.uniform() * shape.action.sizes[index % 2] as f64) as u8;
    }
    let taken = Taken { actions: part.actions.clone(), deltas: part.deltas.clone() };
    let rows = &part.outputs[..STEPS * LANES * shape.outputs()];
    let logs = Policy::new(&shape.action, rows, shape.outputs()).log_probability(&taken).values;
    part.log_probabilities = logs.iter().map(|&log| log as f32).collect();
    let what = auxiliary.insight();
    let cells = auxiliary.targets(what, &vec![0; what.bytes()]).count();
    part.shown = (0..STEPS * LANES * cells).map(|cell| (cell * 5 % 8) as u8).collect();
    (learner, Rollout { parts: vec![part] })
}
