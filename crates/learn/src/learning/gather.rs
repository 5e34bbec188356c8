//! Minibatches: some trajectories of a rollout, row by row.

use crate::config::TrainConfig;
use crate::learning::minibatch::{Critic, Minibatch};
use crate::learning::policy::{Policy, Taken};
use crate::learning::targets::{Prepared, critic_name, mean_costs};
use crate::networks::{ModelSequences, ModelShape, RecordedLane, Sequences};

/// Some trajectories; nothing is said of exploration yet.
pub(crate) fn gather<'a>(
    prepared: &Prepared<'a>,
    shape: &ModelShape,
    config: &TrainConfig,
    trajectories: &[usize],
) -> Minibatch<'a> {
    let rollout = prepared.rollout;
    let steps = rollout.trajectory_steps();
    let places: Vec<(usize, usize)> =
        trajectories.iter().map(|&number| rollout.trajectory(number)).collect();
    // Each row's step of its trajectory, its step of the rollout, and its lane.
    let rows = || {
        (0..steps)
            .flat_map(|step| places.iter().map(move |&(lane, first)| (step, first + step, lane)))
    };
    let (width, action, extra) = (shape.outputs(), &shape.action, shape.extra_inputs());
    let mut sequences = Sequences {
        steps,
        lanes: places.len(),
        observations: Vec::with_capacity(steps * places.len()),
        extra: Vec::new(),
        initial_state: Vec::new(),
        reset: Vec::with_capacity(steps * places.len()),
        recorded: Vec::new(),
    };
    let (seen, mut privileged) = (shape.critic_inputs, Vec::new());
    let (mut actions, mut deltas, mut logs, mut policy) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (own_step, step, lane) in rows() {
        let (part, own) = rollout.find(lane);
        let row = step * part.lanes + own;
        sequences.observations.push(part.frame(step, own));
        sequences.extra.extend_from_slice(&part.extra[row * extra..(row + 1) * extra]);
        privileged.extend_from_slice(&part.privileged[row * seen..(row + 1) * seen]);
        sequences.reset.push(own_step > 0 && part.done[row - part.lanes]);
        let (count, continuous) = (action.sizes.len(), action.deltas);
        actions.extend_from_slice(&part.actions[row * count..(row + 1) * count]);
        deltas.extend_from_slice(&part.deltas[row * continuous..(row + 1) * continuous]);
        logs.push(f64::from(part.log_probabilities[row]));
        policy.extend_from_slice(&part.outputs[row * width..row * width + action.parameters()]);
    }
    let state = |network: usize| -> Vec<f32> {
        let units = shape.networks[network].state_size();
        trajectories
            .iter()
            .flat_map(|&number| rollout.initial_state(network, units, number))
            .copied()
            .collect()
    };
    let initial_state = (0..shape.networks.len()).map(state).collect();
    let recorded = |network: usize| -> Vec<RecordedLane<'a>> {
        let of = |&(lane, _): &(usize, usize)| {
            let (part, own) = rollout.find(lane);
            Some(RecordedLane { recording: part.recordings.get(network)?, lane: own })
        };
        places.iter().filter_map(of).collect()
    };
    let recorded = (0..shape.networks.len()).map(recorded).collect();
    let length = rollout.steps();
    let pick = |values: &[f32]| -> Vec<f32> {
        rows().map(|(_, step, lane)| values[lane * length + step]).collect()
    };
    let critic = |index: usize| Critic {
        loss_name: critic_name("value_loss", config, index),
        advantages: pick(&prepared.advantages[index]),
        old_values: pick(&prepared.old_values[index]),
        targets: pick(&prepared.targets[index]),
    };
    Minibatch {
        batch: ModelSequences { sequences, initial_state, recorded, privileged },
        taken: Taken { actions, deltas },
        old_log_probability: logs,
        old_policy: Policy::new(action, &policy, action.parameters()),
        critics: (0..prepared.advantages.len()).map(critic).collect(),
        mean_costs: mean_costs(rollout, trajectories, config.constraints.len()),
        exploration_coefficient: 0.0,
    }
}
