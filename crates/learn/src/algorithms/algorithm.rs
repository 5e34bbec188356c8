//! What an algorithm is: what it does with what the worlds brought.

use serde_json::Value;

use crate::algorithms::multiplier::Multipliers;
use crate::algorithms::signal::{Signal, Signals};
use crate::config::MultiplierUpdate;
use crate::error::LearnError;
use crate::learning::epochs::Epochs;
use crate::learning::learner::{Learner, Prepared};
use crate::learning::metrics::Means;
use crate::learning::minibatch::Minibatch;
use crate::learning::policy::Policy;

/// An algorithm: what it does with what the worlds brought.
pub trait Algorithm: Send {
    /// Learns from a rollout.
    fn learn(
        &mut self,
        learner: &mut Learner,
        rollout: &Prepared<'_>,
        epochs: &Epochs,
        signals: &Signals<'_>,
        means: &mut Means,
    ) -> Result<(), LearnError> {
        learn_in_epochs(self, learner, rollout, epochs, signals, means)
    }

    /// Improves the policy and the critics on a minibatch. `signals` is empty while no episode has
    /// ended yet.
    fn update(
        &mut self,
        learner: &mut Learner,
        minibatch: &mut Minibatch<'_>,
        signals: &[Signal],
        means: &mut Means,
    ) -> Result<(), LearnError>;

    /// Its multipliers, if it has some: all that the next update depends on beside the networks.
    fn weights(&self) -> Option<&Multipliers> {
        None
    }

    /// The same, to be moved.
    fn weights_mut(&mut self) -> Option<&mut Multipliers> {
        None
    }

    /// Moves what hangs on the costs of the constraints: once a rollout or once a minibatch.
    fn constrain(&mut self, signals: &[Signal]) {
        if let Some(weights) = self.weights_mut() {
            weights.update(signals);
        }
    }

    /// Multiplier or penalty of each constraint; empty for algorithms without.
    fn multipliers(&self) -> Vec<f64> {
        self.weights().map_or_else(Vec::new, Multipliers::values)
    }

    /// Its multipliers for a checkpoint.
    fn save(&self) -> Value {
        self.weights()
            .map_or(Value::Null, |weights| serde_json::to_value(weights).unwrap_or_default())
    }

    /// Goes on from a saved state.
    fn load(&mut self, state: &Value) -> Result<(), serde_json::Error> {
        if let Some(weights) = self.weights_mut() {
            if weights.take_over_damped(state) {
                return Ok(());
            }
            let saved: Multipliers = serde_json::from_value(state.clone())?;
            if !saved.is_like(weights) {
                return Err(serde::de::Error::custom(
                    "they are another algorithm's, or of another number of constraints",
                ));
            }
            *weights = saved;
        }
        Ok(())
    }
}

/// Goes through a rollout minibatch by minibatch, and moves the multipliers when the settings say
/// so.
pub(super) fn learn_in_epochs<A: Algorithm + ?Sized>(
    algorithm: &mut A,
    learner: &mut Learner,
    rollout: &Prepared<'_>,
    epochs: &Epochs,
    signals: &Signals<'_>,
    means: &mut Means,
) -> Result<(), LearnError> {
    let moves = learner.config.algorithm_settings.multiplier_update;
    if moves == MultiplierUpdate::Rollout {
        algorithm.constrain(&signals(&rollout.mean_costs));
    }
    let made =
        go_through(learner, rollout, None, epochs, means, |learner, rollout, lanes, means| {
            let mut minibatch = learner.minibatch(rollout, lanes);
            let signals = signals(&minibatch.mean_costs);
            if moves == MultiplierUpdate::Minibatch {
                algorithm.constrain(&signals);
            }
            algorithm.update(learner, &mut minibatch, &signals, means)?;
            if moves == MultiplierUpdate::AfterMinibatch {
                algorithm.constrain(&signals);
            }
            Ok(())
        })?;
    means.add("epochs", f64::from(made));
    Ok(())
}

/// Makes the epochs over a rollout, until the policy has moved as far as it may: the mean
/// divergence of the whole rollout after an epoch, from a policy or else from the one that acted,
/// is beyond the target. Returns how many were made.
pub(super) fn go_through(
    learner: &mut Learner,
    rollout: &Prepared<'_>,
    from: Option<&Policy>,
    epochs: &Epochs,
    means: &mut Means,
    mut update: impl FnMut(&mut Learner, &Prepared<'_>, &[usize], &mut Means) -> Result<(), LearnError>,
) -> Result<u32, LearnError> {
    let (mut made, mut anew) = (0, None);
    for epoch in 0..epochs.count {
        if epoch > 0 && learner.config.learning.recompute_advantages {
            anew = Some(learner.prepare_anew(rollout));
        }
        let rollout = anew.as_ref().unwrap_or(rollout);
        for lanes in &epochs.minibatches(epoch) {
            update(learner, rollout, lanes, means)?;
        }
        made += 1;
        if epoch + 1 < epochs.count && epochs.end_at(|| learner.divergence(rollout, from)) {
            break;
        }
    }
    Ok(made)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algorithms::{ppo, small};
    use crate::config::AlgorithmKind;

    /// A16. Algorithm 1 of FOCOPS ends its passes when the mean divergence over the batch, of the
    /// policy as it is after the pass, is beyond delta; here it is KL(pi_k, pi), that of every
    /// algorithm's `target_kl`, which equals FOCOPS' KL(pi, pi_k) to second order. Divergences after
    /// 1, 2, ... passes are taken from runs of so many; a target between those of two passes ends at
    /// the later of them, one pass before what was noted ahead of each step would.
    #[test]
    fn passes_end_by_the_divergence_after_them() {
        let run = |epochs: usize, target: Option<f64>| {
            let mut config = small::config(AlgorithmKind::Ppo);
            (config.learning.epochs, config.learning.target_kl) = (epochs, target);
            config.learning.rate = 3e-3;
            let (mut learner, rollout) = small::learner(&config);
            let prepared = learner.prepare(&rollout);
            let mut means = Means::default();
            let mut ppo = ppo::Ppo::new(&config);
            ppo.learn(
                &mut learner,
                &prepared,
                &Epochs::new(&config, 0, small::LANES),
                &|_| vec![],
                &mut means,
            )
            .unwrap();
            let mut minibatch = learner.minibatch(&prepared, &[0, 1, 2, 3]);
            let old = minibatch.old_policy.clone();
            (means.get("epochs").unwrap(), old.divergence(&learner.policy(&mut minibatch)).mean())
        };
        let after: Vec<f64> = (1..=4).map(|epochs| run(epochs, None).1).collect();
        assert!(after.windows(2).all(|two| two[0] < two[1]), "{after:?}");
        for passes in 2..=4 {
            let target = (after[passes - 2] + after[passes - 1]) / 2.0;
            assert_eq!(
                run(10, Some(target)),
                (passes as f64, after[passes - 1]),
                "target {target} of {after:?}"
            );
        }
    }
}
