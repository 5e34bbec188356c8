//! A phase of the critics apart (Cobbe et al. 2021, arXiv 2009.04416): after every so many rollouts
//! further passes train the critics, and so what they share with the policy, while the policy is
//! held where it is by its divergence from what it was (the paper's equations 2 and 4).
//!
//! The paper keeps all rollouts since the last phase for it; here it goes through the latest alone,
//! whose pictures are at hand. Its targets are those of the rollout.

use crate::config::TrainConfig;
use crate::error::LearnError;
use crate::learning::epochs::Epochs;
use crate::learning::learner::{Learner, Minibatch, Prepared};
use crate::learning::loss::{Heads, Loss};
use crate::learning::metrics::Means;
use crate::learning::policy::Policy;

/// The passes of the critics, if the rollout is one that they come after; it is the run's
/// `rollouts`th, counted from 0.
pub fn value_phase(
    config: &TrainConfig,
    learner: &mut Learner,
    rollout: &Prepared<'_>,
    rollouts: u64,
    means: &mut Means,
) -> Result<(), LearnError> {
    let learning = &config.learning;
    if !learning.value_phase.is_some_and(|every| (rollouts + 1).is_multiple_of(every)) {
        return Ok(());
    }
    let (steps, count) = (rollout.rollout.trajectory_steps(), rollout.rollout.trajectories());
    let all: Vec<usize> = (0..count).collect();
    let before = learner.policy(&mut learner.minibatch(rollout, &all));
    let epochs = Epochs::of_values(config, rollouts, count);
    let networks = learner.shape().networks.len();
    let clone = learning.value_phase_clone;
    // Not by `go_through`, which may estimate targets anew.
    for some in (0..epochs.count).flat_map(|epoch| epochs.minibatches(epoch)) {
        let rows = (0..steps).flat_map(|step| some.iter().map(move |number| step * count + number));
        let before = before.of_rows(rows);
        let mut minibatch = learner.minibatch(rollout, &some);
        let mut noted = Means::default();
        learner.descend_networks(
            0..networks,
            0,
            &mut minibatch,
            |heads, batch, means| loss(&before, clone, heads, batch, means),
            &mut noted,
        )?;
        for name in ["value_phase_loss", "value_phase_divergence"] {
            noted.get(name).into_iter().for_each(|value| means.add(name, value));
        }
    }
    means.add("value_phase_epochs", epochs.count as f64);
    Ok(())
}

/// Half the squared error of every critic, and the divergence of the policy from what it was.
fn loss(
    before: &Policy,
    clone: f64,
    heads: &Heads,
    batch: &Minibatch<'_>,
    means: &mut Means,
) -> Loss {
    let divergence = heads.mean_of(&heads.policy.divergence_seen_from(before));
    means.add("value_phase_divergence", divergence.value);
    let errors = heads.values.iter().zip(&batch.critics).map(|(value, critic)| {
        heads.mean([value], |row, [value]| (value - f64::from(critic.targets[row])).square() * 0.5)
    });
    let errors = errors.reduce(|sum, loss| sum + loss).expect("the reward has a critic");
    means.add("value_phase_loss", errors.value);
    errors + divergence * clone
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algorithms::small;
    use crate::config::AlgorithmKind;

    /// The joint objective of the paper, L = 1/2 E[(V - V_targ)^2] + beta E[KL(old, new)], of each
    /// critic: after the phase critics are nearer to their targets, and the policy is nearer to
    /// what it was than by the same passes without the second term.
    #[test]
    fn critics_come_nearer_and_the_policy_stays() {
        let run = |clone: f64, passes: usize| {
            let mut config = small::config(AlgorithmKind::PpoLag);
            config.learning.value_phase = Some(2);
            config.learning.value_phase_passes = passes;
            config.learning.value_phase_clone = clone;
            config.learning.rate = 1e-3;
            config.check_value_phase().unwrap();
            let (mut learner, rollout) = small::learner(&config);
            let prepared = learner.prepare(&rollout);
            let all: Vec<usize> = (0..small::LANES).collect();
            let before = learner.policy(&mut learner.minibatch(&prepared, &all));
            let mut means = Means::default();
            let first = learner.parameters.clone();
            value_phase(&config, &mut learner, &prepared, 0, &mut means).unwrap();
            assert_eq!(learner.parameters, first, "not after the first rollout");
            value_phase(&config, &mut learner, &prepared, 1, &mut means).unwrap();
            assert_ne!(learner.parameters, first);
            let after = learner.policy(&mut learner.minibatch(&prepared, &all));
            let mut last = Means::default();
            config.learning.value_phase_passes = 1;
            value_phase(&config, &mut learner, &prepared, 1, &mut last).unwrap();
            let error = last.get("value_phase_loss").unwrap();
            (error, before.divergence(&after).mean(), means.get("value_phase_epochs").unwrap())
        };
        let ((one, ..), (error, near, passes)) = (run(1.0, 1), run(1.0, 40));
        let (_, far, _) = run(0.0, 40);
        assert_eq!(passes, 40.0);
        assert!(error < 0.8 * one, "{error} after 40 passes, {one} after one");
        assert!(near < 0.5 * far && far > 1e-5, "{near} with the second term, {far} without");
    }

    /// V_targ of the paper's equation 2 is that of the rollout, also where passes of the policy
    /// estimate theirs anew.
    #[test]
    fn its_targets_are_those_of_the_rollout() {
        let after = |anew: bool| {
            let mut config = small::config(AlgorithmKind::PpoLag);
            config.learning.value_phase = Some(1);
            config.learning.value_phase_passes = 3;
            config.learning.recompute_advantages = anew;
            let (mut learner, rollout) = small::learner(&config);
            let prepared = learner.prepare(&rollout);
            value_phase(&config, &mut learner, &prepared, 0, &mut Means::default()).unwrap();
            learner.parameters
        };
        assert_eq!(after(true), after(false));
    }
}
