//! Some trajectories of a rollout, ready for a loss.

use crate::learning::policy::{Policy, Taken};
use crate::networks::{ModelSequences, ModelShape};

/// What a critic has to learn, and what it says about the actions taken; a number a row.
#[derive(Clone, Debug)]
pub struct Critic {
    /// Name of its loss.
    pub loss_name: String,
    /// Advantages in raw units.
    pub advantages: Vec<f32>,
    /// Values when the actions were taken.
    pub old_values: Vec<f32>,
    /// Targets of the values.
    pub targets: Vec<f32>,
}

/// Some trajectories of a prepared rollout, ready for a loss. Rows are ordered by time, then by
/// lane.
pub struct Minibatch<'a> {
    /// What the networks read.
    pub batch: ModelSequences<'a>,
    /// Actions taken.
    pub taken: Taken,
    /// Logarithm of their probabilities when they were taken.
    pub old_log_probability: Vec<f64>,
    /// Policy when they were taken.
    pub old_policy: Policy,
    /// The critic of the reward, and those of the costs.
    pub critics: Vec<Critic>,
    /// Mean cost of each constraint per step.
    pub mean_costs: Vec<f64>,
    /// Weight of the exploration loss at present.
    pub exploration_coefficient: f64,
    /// What the pictures show, for a network that predicts it: as many classes a row.
    pub shown: Vec<u8>,
}

impl<'a> Minibatch<'a> {
    /// Some of its trajectories.
    #[must_use]
    pub fn of_lanes(&self, shape: &ModelShape, lanes: &[usize]) -> Minibatch<'a> {
        let rows: Vec<usize> = self.batch.sequences.rows_of(lanes).collect();
        let pick = |values: &[f32]| -> Vec<f32> { rows.iter().map(|&row| values[row]).collect() };
        let critic = |critic: &Critic| Critic {
            loss_name: critic.loss_name.clone(),
            advantages: pick(&critic.advantages),
            old_values: pick(&critic.old_values),
            targets: pick(&critic.targets),
        };
        let (count, deltas) = (shape.action.sizes.len(), shape.action.deltas);
        Minibatch {
            batch: self.batch.of_lanes(shape, lanes),
            taken: Taken {
                actions: rows
                    .iter()
                    .flat_map(|row| &self.taken.actions[row * count..(row + 1) * count])
                    .copied()
                    .collect(),
                deltas: rows
                    .iter()
                    .flat_map(|row| &self.taken.deltas[row * deltas..(row + 1) * deltas])
                    .copied()
                    .collect(),
            },
            old_log_probability: rows.iter().map(|&row| self.old_log_probability[row]).collect(),
            old_policy: self.old_policy.of_rows(rows.iter().copied()),
            critics: self.critics.iter().map(critic).collect(),
            mean_costs: self.mean_costs.clone(),
            exploration_coefficient: self.exploration_coefficient,
            shown: {
                let cells = self.shown.len() / self.batch.sequences.rows().max(1);
                let of = |&row: &usize| &self.shown[row * cells..(row + 1) * cells];
                rows.iter().flat_map(of).copied().collect()
            },
        }
    }

    /// Raw advantages of the reward.
    #[must_use]
    pub fn advantages(&self) -> &[f32] {
        &self.critics[0].advantages
    }

    /// The critics of the costs.
    #[must_use]
    pub fn costs(&self) -> &[Critic] {
        &self.critics[1..]
    }
}
