//! The numbers that each setting may be, whatever the others are.

use crate::config::TrainConfig;
use crate::config::numbers::{Shown, range, refuse};
use crate::error::LearnError;

/// Multipliers and what moves them stay below: far beyond all that is of use, far from what single
/// precision holds. Short sweeps raise the rates of multipliers a thousand times and more.
const HUGE: f64 = 1e9;

impl TrainConfig {
    /// Refuses whole numbers out of their range.
    pub(super) fn check_counts(&self) -> Result<(), LearnError> {
        let (sampling, learning) = (&self.sampling, &self.learning);
        let settings = &self.algorithm_settings;
        for (name, given, most) in [
            ("the number of worlds", sampling.lanes, 65_536),
            ("the rollout length", sampling.rollout, 4096),
            ("the number of samplers", sampling.samplers, 256),
            ("the number of groups", sampling.groups, 256),
            ("the number of accumulated rollouts", sampling.accumulated, 64),
            ("the number of epochs", learning.epochs, 1000),
            ("the number of minibatches", learning.minibatches, sampling.lanes),
            ("the number of learner threads", learning.threads, 256),
            ("the number of kept checkpoints", self.reporting.keep, 1000),
            ("the window of episodes", self.reporting.window, 100_000),
            ("the episodes of an evaluation", self.evaluation.episodes, 100_000),
            ("the confirming episodes", self.confirming_episodes(), 100_000),
            ("the steps of the longest episode", self.episode_steps as usize, 100_000),
            ("the delay of the PID controller", settings.pid_delay, 100_000),
            ("the conjugate-gradient iterations", settings.conjugate_iterations, 1000),
            ("the steps of the critics", settings.critic_steps, 100_000),
            ("the samples of a critic's step", settings.critic_batch.unwrap_or(1), 1 << 24),
            ("the recurrence", learning.recurrence.unwrap_or(1), 4096),
            ("the tries of the line search", settings.line_search_steps, 1000),
            ("evaluation.candidates", self.evaluation.candidates, 1000),
        ] {
            if !(1..=most).contains(&given) {
                return refuse(name, &given, &format!("1 to {most}"));
            }
        }
        Ok(())
    }

    /// Refuses other numbers out of their range, and what is no number.
    pub(super) fn check_numbers(&self) -> Result<(), LearnError> {
        let (learning, settings) = (&self.learning, &self.algorithm_settings);
        let (proportional, integral, derivative) = settings.pid_gains;
        for (name, given, low, high) in [
            ("gamma", learning.gamma, 0.0, 1.0),
            ("the final gamma", learning.final_gamma.unwrap_or(0.0), 0.0, 1.0),
            ("lambda of the advantages", learning.gae_lambda, 0.0, 1.0),
            ("the final lambda", learning.final_gae_lambda.unwrap_or(0.0), 0.0, 1.0),
            ("learning.advantage_floor", learning.advantage_floor, 0.0, f64::MAX),
            ("the learning rate", learning.rate, 0.0, 10.0),
            ("the final learning rate", learning.final_rate.unwrap_or(0.0), 0.0, 10.0),
            ("the target divergence", learning.target_kl.unwrap_or(0.0), 0.0, f64::MAX),
            ("the learning rate of the critics", learning.critic_rate.unwrap_or(0.0), 0.0, 10.0),
            ("the samples that PopArt remembers", learning.normaliser_horizon, 1.0, f64::MAX),
            ("gamma of the costs", learning.cost_gamma.unwrap_or(0.0), 0.0, 1.0),
            (
                "the final exploration coefficient",
                learning.final_exploration_coefficient.unwrap_or(0.0),
                0.0,
                1e3,
            ),
            ("the largest multiplier", settings.multiplier_limit.unwrap_or(0.0), 0.0, f64::MAX),
            ("the share of the Fisher matrix", settings.fisher_fraction, 0.0, 1.0),
            ("the largest gradient norm", learning.max_gradient_norm, 0.0, f64::MAX),
            ("the ratio clip", learning.clip_ratio, 0.0, 10.0),
            ("the value clip", learning.clip_value, 0.0, f64::MAX),
            ("the exploration coefficient", learning.exploration_coefficient, 0.0, 1e3),
            ("the seconds between reports", self.reporting.report_seconds, 0.0, f64::MAX),
            ("the seconds between checkpoints", self.reporting.checkpoint_seconds, 0.0, f64::MAX),
            ("learning.auxiliary_depth", learning.auxiliary_depth, 0.0, 1e3),
            ("learning.auxiliary_labels", learning.auxiliary_labels, 0.0, 1e3),
            ("network.policy_scale", self.network.policy_scale, 0.0, 10.0),
            ("the share of the budget", self.budget_share, 0.0, 2.0),
            ("budget_margin", self.budget_margin, 0.0, 1e3),
            ("the rate of the multiplier", settings.multiplier_rate, 0.0, HUGE),
            (
                "the reference budget of the PID",
                settings.pid_reference_budget.unwrap_or(0.0),
                0.0,
                f64::MAX,
            ),
            ("the decay of the PID's averages", settings.pid_decay, 0.0, 1.0),
            ("the weight of P3O's penalty", settings.p3o_kappa, 0.0, f64::MAX),
            ("the weight of IPO's barrier", settings.ipo_kappa, 0.0, f64::MAX),
            ("IPO's largest penalty", settings.ipo_limit, 0.0, f64::MAX),
            ("the penalty scale", settings.penalty_scale, 0.0, f64::MAX),
            ("learning.value_coefficient", learning.value_coefficient, 0.0, 1e6),
            ("learning.muon_scale", learning.muon_scale, 0.0, 1e3),
            // Anything smaller is 0 in single precision, and a step is divided by it.
            ("learning.adam_epsilon", learning.adam_epsilon, 1e-30, 1.0),
            ("algorithm_settings.multiplier_initial", settings.multiplier_initial, 0.0, HUGE),
            ("the first of algorithm_settings.pid_gains", proportional, 0.0, HUGE),
            ("the second of algorithm_settings.pid_gains", integral, 0.0, HUGE),
            ("the third of algorithm_settings.pid_gains", derivative, 0.0, HUGE),
            ("algorithm_settings.pid_initial", settings.pid_initial, 0.0, HUGE),
            ("algorithm_settings.saute_unsafe_reward", settings.saute_unsafe_reward, -1e6, 1e6),
            ("algorithm_settings.fisher_damping", settings.fisher_damping, 0.0, f64::MAX),
            ("algorithm_settings.focops_eta", settings.focops_eta, 0.0, f64::MAX),
        ] {
            if !(low..=high).contains(&given) {
                return refuse(name, &Shown(given), &range(low, high));
            }
        }
        // Those whose range ends just short of a number.
        let between = |given: f64| given > 0.0 && given < 1.0;
        let decay = |given: f64| (0.0..1.0).contains(&given);
        let above = |given: f64| given > 0.0 && given.is_finite();
        let (first, second) = learning.adam_betas;
        for (name, given, may_be, allowed) in [
            ("the first of learning.adam_betas", first, decay(first), "at least 0 and below 1"),
            ("the second of learning.adam_betas", second, decay(second), "at least 0 and below 1"),
            (
                "algorithm_settings.trust_radius",
                settings.trust_radius,
                above(settings.trust_radius),
                "a number above 0",
            ),
            (
                "algorithm_settings.line_search_factor",
                settings.line_search_factor,
                between(settings.line_search_factor),
                "above 0 and below 1",
            ),
            (
                "algorithm_settings.focops_temperature",
                settings.focops_temperature,
                above(settings.focops_temperature),
                "a number above 0",
            ),
            (
                "algorithm_settings.saute_gamma",
                settings.saute_gamma,
                above(settings.saute_gamma) && settings.saute_gamma <= 1.0,
                "above 0 and at most 1",
            ),
            (
                "algorithm_settings.saute_horizon",
                settings.saute_horizon,
                above(settings.saute_horizon),
                "a number above 0",
            ),
        ] {
            if !may_be {
                return refuse(name, &Shown(given), allowed);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
