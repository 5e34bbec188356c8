//! Minibatches: some trajectories of a rollout, row by row.

use crate::config::TrainConfig;
use crate::learning::minibatch::{Critic, Minibatch};
use crate::learning::policy::{Policy, Taken};
use crate::learning::targets::{Prepared, critic_name, mean_costs};
use crate::networks::{ModelSequences, ModelShape, RecordedLane, Sequences};
use crate::sampling::rollout::Rollout;

/// Some trajectories; nothing is said of exploration yet.
pub(crate) fn gather<'a>(
    prepared: &Prepared<'a>,
    shape: &ModelShape,
    config: &TrainConfig,
    trajectories: &[usize],
) -> Minibatch<'a> {
    let rollout = prepared.rollout;
    let steps = rollout.trajectory_steps();
    let mut batch = sequences(rollout, shape, trajectories, steps);
    let places: Vec<(usize, usize)> =
        trajectories.iter().map(|&number| rollout.trajectory(number)).collect();
    // Each row's step of the rollout, and its lane.
    let rows = || {
        (0..steps).flat_map(|step| places.iter().map(move |&(lane, first)| (first + step, lane)))
    };
    let (width, action) = (shape.outputs(), &shape.action);
    let (mut actions, mut deltas, mut logs, mut policy) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut shown = Vec::new();
    for (step, lane) in rows() {
        let (part, own) = rollout.find(lane);
        let row = step * part.lanes + own;
        let cells = part.shown.len() / (part.steps * part.lanes);
        shown.extend_from_slice(&part.shown[row * cells..(row + 1) * cells]);
        let (count, continuous) = (action.sizes.len(), action.deltas);
        actions.extend_from_slice(&part.actions[row * count..(row + 1) * count]);
        deltas.extend_from_slice(&part.deltas[row * continuous..(row + 1) * continuous]);
        logs.push(f64::from(part.log_probabilities[row]));
        policy.extend_from_slice(&part.outputs[row * width..row * width + action.parameters()]);
    }
    let recorded = |network: usize| -> Vec<RecordedLane<'a>> {
        let of = |&(lane, _): &(usize, usize)| {
            let (part, own) = rollout.find(lane);
            Some(RecordedLane { recording: part.recordings.get(network)?, lane: own })
        };
        places.iter().filter_map(of).collect()
    };
    batch.recorded = (0..shape.networks.len()).map(recorded).collect();
    let length = rollout.steps();
    let pick = |values: &[f32]| -> Vec<f32> {
        rows().map(|(step, lane)| values[lane * length + step]).collect()
    };
    let critic = |index: usize| Critic {
        loss_name: critic_name("value_loss", config, index),
        advantages: pick(&prepared.advantages[index]),
        old_values: pick(&prepared.old_values[index]),
        targets: pick(&prepared.targets[index]),
    };
    Minibatch {
        batch,
        taken: Taken { actions, deltas },
        old_log_probability: logs,
        old_policy: Policy::new(action, &policy, action.parameters()),
        critics: (0..prepared.advantages.len()).map(critic).collect(),
        mean_costs: mean_costs(rollout, trajectories, config.constraints.len()),
        exploration_coefficient: 0.0,
        shown,
    }
}

/// What the networks see of some trajectories in so many steps from their first, of which the last
/// may be the step after the rollout's last.
pub(crate) fn sequences<'a>(
    rollout: &'a Rollout,
    shape: &ModelShape,
    trajectories: &[usize],
    steps: usize,
) -> ModelSequences<'a> {
    let places: Vec<(usize, usize)> =
        trajectories.iter().map(|&number| rollout.trajectory(number)).collect();
    let (extra, seen) = (shape.extra_inputs(), shape.critic_inputs);
    let mut sequences = Sequences {
        steps,
        lanes: places.len(),
        observations: Vec::with_capacity(steps * places.len()),
        extra: Vec::new(),
        initial_state: Vec::new(),
        reset: Vec::with_capacity(steps * places.len()),
        recorded: Vec::new(),
    };
    let mut privileged = Vec::new();
    for step in 0..steps {
        for &(lane, first) in &places {
            let (part, own) = rollout.find(lane);
            let row = (first + step) * part.lanes + own;
            sequences.observations.push(part.frame(first + step, own));
            sequences.extra.extend_from_slice(&part.extra[row * extra..(row + 1) * extra]);
            privileged.extend_from_slice(&part.privileged[row * seen..(row + 1) * seen]);
            sequences.reset.push(step > 0 && part.done[row - part.lanes]);
        }
    }
    let state = |network: usize| -> Vec<f32> {
        let units = shape.networks[network].state_size();
        let states = trajectories.iter().map(|&one| rollout.initial_state(network, units, one));
        states.flatten().copied().collect()
    };
    let initial_state = (0..shape.networks.len()).map(state).collect();
    ModelSequences { sequences, initial_state, recorded: Vec::new(), privileged }
}
