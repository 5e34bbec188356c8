//! The presets: the settings of the HASARD paper (ICLR 2025, appendix on hyper-parameters) where it is consistent, those of its
//! released code, and quick ones of our own.

use crate::config::{
    AlgorithmConfig, AlgorithmKind, Constraint, ConstraintStatistic, EnvConfig, EvaluationConfig, Exploration, LearningConfig,
    NetworkConfig, Preset, ReportingConfig, ReturnNormaliser, SamplingConfig, TrainConfig,
};
use crate::config::{Convolution, Initialisation, RecurrentCell, second_order};
use hasard_envs::Scenario;

/// Tics of the longest episode.
const EPISODE_TICS: u32 = 2100;

impl TrainConfig {
    /// As [`TrainConfig::new`] for worlds that are in no registry, such as those of tests.
    #[must_use]
    pub fn plain(algorithm: AlgorithmKind, preset: Preset, env: EnvConfig) -> TrainConfig {
        let released = preset == Preset::Released;
        let cores = std::thread::available_parallelism().map_or(1, usize::from).min(16);
        let episode_steps = (EPISODE_TICS / env.frame_skip.max(1)).max(1);
        let scenario = env.scenario();
        let separate = algorithm.separates_networks();
        // As their papers have it: ten passes over minibatches of 64 steps. The benchmark's own algorithms pass once over all.
        let repeats = matches!(algorithm, AlgorithmKind::Focops | AlgorithmKind::Cup | AlgorithmKind::Ipo);
        let mut config = TrainConfig {
            version: env!("CARGO_PKG_VERSION").into(),
            algorithm,
            preset,
            seed: 1,
            frames: 500_000_000,
            curriculum: Vec::new(),
            device: "cpu".into(),
            episode_steps,
            constraints: vec![Constraint { term: None, budget: 0.0 }],
            budget_share: 1.0,
            constraint_statistic: if released { ConstraintStatistic::StepMean } else { ConstraintStatistic::EpisodeMean },
            network: NetworkConfig {
                convolutions: vec![
                    Convolution { channels: 32, kernel: 8, stride: 4 },
                    Convolution { channels: 64, kernel: 4, stride: 2 },
                    Convolution { channels: 128, kernel: 3, stride: 2 },
                ],
                residual: vec![],
                dense: if released { vec![512] } else { vec![512, 512] },
                recurrent: Some(512),
                cell: RecurrentCell::Gru,
                separate,
                initialisation: match (released, separate) {
                    (false, _) => Initialisation::Orthogonal,
                    (true, false) => Initialisation::OrthogonalHeads,
                    (true, true) => Initialisation::Uniform,
                },
            },
            sampling: SamplingConfig {
                lanes: 32,
                rollout: 32,
                samplers: cores,
                world_threads: 0,
                groups: 1,
                spread_out: true,
                synchronous: true,
                accumulated: 2,
                max_policy_lag: 1000,
            },
            learning: LearningConfig {
                epochs: if repeats { 10 } else { 1 },
                minibatches: if repeats { 16 } else { 1 },
                recurrence: None,
                gamma: 0.99,
                gae_lambda: 0.95,
                rate: 1e-4,
                final_rate: None,
                adam_betas: (0.9, 0.999),
                adam_epsilon: if released && separate { 1e-8 } else { 1e-6 },
                // FOCOPS stops there, and CUP's code is built on its.
                target_kl: (repeats && algorithm != AlgorithmKind::Ipo).then_some(0.02),
                critic_rate: None,
                cost_gamma: None,
                max_gradient_norm: 4.0,
                clip_ratio: 0.1,
                clip_value: if released { 0.2 } else { 1.0 },
                value_coefficient: 0.5,
                exploration: Exploration::SymmetricKl,
                exploration_coefficient: 0.001,
                final_exploration_coefficient: None,
                normaliser: ReturnNormaliser::Running,
                normaliser_horizon: 100_000.0,
                bootstrap_time_outs: !released,
                bootstrap_cost_time_outs: None,
                critic_inputs: vec![],
                reuse_forward: true,
                threads: cores,
                portable: false,
            },
            algorithm_settings: AlgorithmConfig {
                penalty_scale: if released && scenario == Some(Scenario::ArmamentBurden) { 0.1 } else { 1.0 },
                multiplier_initial: 0.0,
                multiplier_rate: 0.01,
                multiplier_damping: 0.0,
                multiplier_reference_budget: None,
                pid_gains: (0.1, 0.01, 0.01),
                pid_initial: 0.001,
                pid_decay: 0.95,
                pid_delay: 10,
                p3o_kappa: if released { 1.0 } else { 20.0 },
                p3o_clipped: !released,
                saute_gamma: 0.9999,
                saute_unsafe_reward: match scenario {
                    Some(Scenario::ArmamentBurden) => -0.005,
                    Some(Scenario::RemedyRush) => -0.025,
                    Some(Scenario::CollateralDamage) => -0.1,
                    Some(Scenario::PrecipicePlunge) => -0.7,
                    Some(Scenario::VolcanicVenture | Scenario::DetonatorsDilemma) | None => -0.01,
                },
                saute_visible: !released,
                saute_horizon: f64::from(if released { EPISODE_TICS } else { episode_steps }),
                trust_radius: 0.01,
                conjugate_iterations: 10,
                fisher_fraction: if released { 1.0 } else { 0.1 },
                fisher_damping: 0.1,
                critic_steps: 1,
                critic_batch: None,
                line_search_steps: 5,
                line_search_factor: 0.5,
                trpo_consistent: !released,
                focops_eta: 0.02,
                focops_temperature: 1.5,
                multiplier_limit: matches!(algorithm, AlgorithmKind::Focops | AlgorithmKind::Cup).then_some(2.0),
                ipo_kappa: 0.01,
                ipo_limit: 1.0,
            },
            evaluation: EvaluationConfig::default(),
            changes: Vec::new(),
            reporting: ReportingConfig { report_seconds: 10.0, checkpoint_seconds: 120.0, keep: 2, window: 100 },
            env,
        };
        if preset == Preset::Quick {
            quicken(&mut config);
        }
        if separate && !released {
            second_order::gather_more(&mut config);
        }
        config
    }
}

/// Settings that learn within minutes.
fn quicken(config: &mut TrainConfig) {
    config.frames = 10_000_000;
    // A fifth of the arithmetic of the original's network: three times the frames in the same time, and no less learned from
    // each (docs/tried/quick_network.md).
    config.network.convolutions = vec![
        Convolution { channels: 32, kernel: 8, stride: 6 },
        Convolution { channels: 32, kernel: 3, stride: 2 },
        Convolution { channels: 32, kernel: 3, stride: 2 },
    ];
    config.network.dense = vec![256];
    config.network.recurrent = Some(256);
    config.learning.rate = 5e-4;
    config.learning.final_rate = Some(1e-4);
    config.learning.exploration_coefficient = 0.003;
    // A trust region is made for one step a rollout.
    let passes = if config.algorithm.separates_networks() { 1 } else { 2 };
    config.learning.epochs = passes;
    config.learning.minibatches = passes;
    // It would spare one pass in four.
    config.learning.reuse_forward = false;
    // Damped, the multiplier no longer circles; and what it lags behind a policy that grows better at earning is taken off the
    // budget beforehand. docs/tried/multiplier_rate.md has the numbers.
    // FOCOPS and CUP move theirs once a rollout, not once a minibatch of each pass.
    let once = matches!(config.algorithm, AlgorithmKind::Focops | AlgorithmKind::Cup);
    config.algorithm_settings.multiplier_rate = if once { 0.04 } else { 0.01 };
    config.algorithm_settings.multiplier_damping = 1.5;
    config.algorithm_settings.multiplier_reference_budget = Some(45.0);
    config.algorithm_settings.pid_gains = (1.5, 0.01, 0.0);
    config.algorithm_settings.pid_decay = 0.0;
    config.budget_share = 0.9;
    config.reporting.report_seconds = 5.0;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_follow_the_table_of_decisions() {
        let make = |algorithm, preset| TrainConfig::new(algorithm, preset, EnvConfig::new("ArmamentBurdenLevel1-v0")).unwrap();
        let (paper, released) = (make(AlgorithmKind::PpoLag, Preset::Paper), make(AlgorithmKind::PpoLag, Preset::Released));
        assert_eq!((paper.network.dense.len(), released.network.dense.len()), (2, 1));
        assert_eq!((paper.learning.clip_value, released.learning.clip_value), (1.0, 0.2));
        assert_eq!(paper.network.initialisation, Initialisation::Orthogonal);
        assert_eq!(released.network.initialisation, Initialisation::OrthogonalHeads);
        assert!(paper.learning.bootstrap_time_outs && !released.learning.bootstrap_time_outs);
        assert_eq!(released.constraint_statistic, ConstraintStatistic::StepMean);
        assert_eq!(paper.constraints[0].budget, 50.0);
        assert_eq!(make(AlgorithmKind::PpoCost, Preset::Released).algorithm_settings.penalty_scale, 0.1);
        assert_eq!(make(AlgorithmKind::Trpo, Preset::Released).learning.adam_epsilon, 1e-8);
        // A6: the released code takes its Fisher products over the whole minibatch.
        assert_eq!(make(AlgorithmKind::Trpo, Preset::Released).algorithm_settings.fisher_fraction, 1.0);
        let quick = make(AlgorithmKind::PpoLag, Preset::Quick);
        assert_eq!((paper.budget_share, quick.budget_share), (1.0, 0.9));
        for plain in [&paper, &released] {
            assert_eq!((plain.algorithm_settings.multiplier_damping, plain.budget_share), (0.0, 1.0));
        }
        let text = serde_json::to_string(&paper).unwrap();
        assert_eq!(serde_json::from_str::<TrainConfig>(&text).unwrap(), paper);
    }
}
