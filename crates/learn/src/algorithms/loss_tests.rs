//! Every loss against one taken from its paper once more, in plain 64-bit arithmetic: value, and
//! gradient in the networks' outputs.
//!
//! Long because each of thirteen losses is written down a second time.

use crate::algorithms::surrogate::standardised;
use crate::algorithms::{Algorithm, Signal, cup, focops, p3o, ppo};
use crate::config::{AlgorithmKind, EnvConfig, Exploration, Preset, TrainConfig};
use crate::learning::learner::{Critic, Minibatch};
use crate::learning::loss::{Heads, Loss};
use crate::learning::metrics::Means;
use crate::learning::policy::{Policy, Taken};
use crate::networks::distribution::ActionShape;
use crate::networks::{ModelSequences, ModelShape, Sequences};
use crate::random::{Purpose, Stream};

const ROWS: usize = 24;
/// Large enough to show in comparisons.
const EXPLORATION: f64 = 0.3;

/// A minibatch of plain numbers: outputs, actions, what was known when they were taken.
struct Case {
    shape: ActionShape,
    outputs: Vec<f32>,
    old_outputs: Vec<f32>,
    actions: Vec<u8>,
    deltas: Vec<f32>,
    old_log: Vec<f32>,
    advantages: [Vec<f32>; 2],
    old_values: [Vec<f32>; 2],
    targets: [Vec<f32>; 2],
    exploration: f64,
}

impl Case {
    /// `spread` is how far the policy has moved from the one that acted.
    fn new(shape: ActionShape, spread: f64) -> Case {
        let mut stream = Stream::new(21, Purpose::Evaluation, 0, 0);
        let width = shape.parameters() + 2;
        let outputs: Vec<f32> = (0..ROWS * width).map(|_| 0.8 * stream.normal() as f32).collect();
        let mut old_outputs = Vec::new();
        let (mut actions, mut deltas, mut old_log) = (Vec::new(), Vec::new(), Vec::new());
        for row in outputs.chunks_exact(width) {
            let old: Vec<f32> = row[..shape.parameters()]
                .iter()
                .map(|value| value + (spread * stream.normal()) as f32)
                .collect();
            let (mut action, mut delta) = (vec![0; shape.sizes.len()], vec![0.0; shape.deltas]);
            old_log.push(shape.sample(&old, &mut stream, &mut action, &mut delta));
            actions.extend(action);
            deltas.extend(delta);
            old_outputs.extend(old);
        }
        let mut normals = || -> Vec<f32> { (0..ROWS).map(|_| stream.normal() as f32).collect() };
        let advantages = [normals(), normals()];
        let (old_values, targets) = ([normals(), normals()], [normals(), normals()]);
        Case {
            shape,
            outputs,
            old_outputs,
            actions,
            deltas,
            old_log,
            advantages,
            old_values,
            targets,
            exploration: EXPLORATION,
        }
    }

    fn minibatch(&self) -> Minibatch<'static> {
        let empty = Sequences {
            steps: 0,
            lanes: 0,
            observations: vec![],
            extra: vec![],
            initial_state: vec![],
            reset: vec![],
            recorded: vec![],
        };
        let critic = |index: usize| Critic {
            loss_name: format!("critic {index}"),
            advantages: self.advantages[index].clone(),
            old_values: self.old_values[index].clone(),
            targets: self.targets[index].clone(),
        };
        Minibatch {
            batch: ModelSequences {
                sequences: empty,
                initial_state: vec![],
                recorded: vec![],
                privileged: vec![],
            },
            taken: Taken { actions: self.actions.clone(), deltas: self.deltas.clone() },
            old_log_probability: self.old_log.iter().map(|&log| f64::from(log)).collect(),
            old_policy: Policy::new(&self.shape, &self.old_outputs, self.shape.parameters()),
            critics: vec![critic(0), critic(1)],
            mean_costs: vec![],
            exploration_coefficient: self.exploration,
            shown: vec![],
        }
    }

    /// Value and gradient of a loss.
    fn found(&self, loss: impl Fn(&Heads, &Minibatch<'_>, &mut Means) -> Loss) -> (f64, Vec<f64>) {
        let shape = ModelShape {
            networks: vec![],
            action: self.shape.clone(),
            cost_critics: 1,
            critic_inputs: 0,
            auxiliary: 0,
        };
        let minibatch = self.minibatch();
        let heads = Heads::new(&shape, &self.outputs, shape.outputs(), &minibatch);
        let loss = loss(&heads, &minibatch, &mut Means::default());
        (loss.value, loss.gradient)
    }

    /// Holds a loss against a plain one of the outputs, whose gradient is taken by differences.
    fn compare(
        &self,
        name: &str,
        loss: impl Fn(&Heads, &Minibatch<'_>, &mut Means) -> Loss,
        plain: impl Fn(&[f64]) -> f64,
    ) {
        let (value, gradient) = self.found(loss);
        let outputs: Vec<f64> = self.outputs.iter().map(|&v| f64::from(v)).collect();
        let expected = plain(&outputs);
        assert!(
            (value - expected).abs() < 1e-9 * expected.abs().max(1.0),
            "{name}: {value} against {expected}"
        );
        let largest = gradient.iter().fold(0.0f64, |most, value| most.max(value.abs()));
        assert!(largest > 1e-4, "{name}: no gradient to compare");
        for (index, &found) in gradient.iter().enumerate() {
            let moved = |by: f64| {
                let mut outputs = outputs.clone();
                outputs[index] += by;
                plain(&outputs)
            };
            let expected = (moved(1e-6) - moved(-1e-6)) / 2e-6;
            let error = (found - expected).abs();
            assert!(
                error < 1e-6 * largest.max(0.1),
                "{name}: gradient {index}: {found} against {expected}"
            );
        }
    }

    /// The numbers of row `row`: policy outputs, value, cost value.
    fn row<'a>(&self, outputs: &'a [f64], row: usize) -> &'a [f64] {
        let width = self.shape.parameters() + 2;
        &outputs[row * width..(row + 1) * width]
    }

    fn logs(&self, row: &[f64]) -> Vec<Vec<f64>> {
        let mut first = 0;
        self.shape
            .sizes
            .iter()
            .map(|&size| {
                let logits = &row[first..first + size];
                first += size;
                let total = logits.iter().map(|l| l.exp()).sum::<f64>().ln();
                logits.iter().map(|l| l - total).collect()
            })
            .collect()
    }

    fn log_probability(&self, outputs: &[f64], index: usize) -> f64 {
        let row = self.row(outputs, index);
        let groups = self.shape.sizes.len();
        let discrete: f64 = self
            .logs(row)
            .iter()
            .enumerate()
            .map(|(g, logs)| logs[self.actions[index * groups + g] as usize])
            .sum();
        let first: usize = self.shape.sizes.iter().sum();
        let continuous: f64 = (0..self.shape.deltas)
            .map(|d| {
                let (mean, log) = (row[first + 2 * d], row[first + 2 * d + 1]);
                let draw =
                    (f64::from(self.deltas[index * self.shape.deltas + d]) - mean) / log.exp();
                -0.5 * draw * draw - log - 0.5 * std::f64::consts::TAU.ln()
            })
            .sum();
        discrete + continuous
    }

    fn ratio(&self, outputs: &[f64], index: usize) -> f64 {
        (self.log_probability(outputs, index) - f64::from(self.old_log[index])).exp()
    }

    fn mean(of: impl Fn(usize) -> f64) -> f64 {
        (0..ROWS).map(of).sum::<f64>() / ROWS as f64
    }

    fn divergence_from(&self, a: &[f64], b: &[f64]) -> f64 {
        let discrete: f64 = self
            .logs(a)
            .iter()
            .zip(self.logs(b))
            .map(|(a, b)| a.iter().zip(b).map(|(x, y)| x.exp() * (x - y)).sum::<f64>())
            .sum();
        let first: usize = self.shape.sizes.iter().sum();
        let continuous: f64 = (0..self.shape.deltas)
            .map(|d| {
                let at = first + 2 * d;
                let distance = a[at] - b[at];
                b[at + 1] - a[at + 1]
                    + ((2.0 * a[at + 1]).exp() + distance * distance)
                        / (2.0 * (2.0 * b[at + 1]).exp())
                    - 0.5
            })
            .sum();
        discrete + continuous
    }

    fn old_row(&self, index: usize) -> Vec<f64> {
        let width = self.shape.parameters();
        self.old_outputs[index * width..(index + 1) * width].iter().map(|&v| f64::from(v)).collect()
    }

    fn clipped(&self, outputs: &[f64], advantages: &[f64], clip: f64) -> f64 {
        -Case::mean(|i| {
            let ratio = self.ratio(outputs, i).clamp(0.05, 20.0);
            let a = advantages[i];
            (ratio * a).min(ratio.clamp(1.0 / (1.0 + clip), 1.0 + clip) * a)
        })
    }

    /// Exploration and value losses, the part that all losses of the first order share.
    fn rest(&self, outputs: &[f64], config: &TrainConfig) -> f64 {
        let settings = &config.learning;
        let exploration = Case::mean(|i| {
            let logs = self.logs(self.row(outputs, i));
            let entropy: f64 = logs.iter().flatten().map(|l| -l.exp() * l).sum();
            let symmetric: f64 = logs
                .iter()
                .map(|logs| {
                    let uniform = 1.0 / logs.len() as f64;
                    let there: f64 = logs.iter().map(|l| l.exp() * (l - uniform.ln())).sum();
                    let back: f64 = logs.iter().map(|l| uniform * (uniform.ln() - l)).sum();
                    0.5 * (there + back)
                })
                .sum();
            match settings.exploration {
                Exploration::Entropy => -entropy,
                Exploration::SymmetricKl => symmetric,
            }
        });
        let value = |critic: usize| {
            Case::mean(|i| {
                let row = self.row(outputs, i);
                let v = row[row.len() - 2 + critic];
                let (old, target) =
                    (f64::from(self.old_values[critic][i]), f64::from(self.targets[critic][i]));
                let clipped = old + (v - old).clamp(-settings.clip_value, settings.clip_value);
                (v - target).powi(2).max((clipped - target).powi(2))
            }) * settings.value_coefficient
        };
        self.exploration * exploration + value(0) + value(1)
    }
}

fn discrete() -> ActionShape {
    ActionShape { sizes: vec![3, 2, 2], deltas: 0 }
}

fn config(algorithm: AlgorithmKind, preset: Preset) -> TrainConfig {
    TrainConfig::plain(algorithm, preset, EnvConfig::new("test"))
}

fn signal(episode_cost: f64) -> Signal {
    Signal::steady(episode_cost, 5.0, 525.0)
}

/// PPO's equations 7 (the clipped surrogate; 1 - epsilon is 1 / (1 + epsilon) here, as in the
/// benchmark's code) and 9 (with the losses of the values and of exploration).
#[test]
fn ppo_and_its_value_and_exploration_losses() {
    for (preset, exploration, spread) in [
        (Preset::Paper, Exploration::SymmetricKl, 0.3),
        (Preset::Released, Exploration::SymmetricKl, 0.3),
        (Preset::Paper, Exploration::Entropy, 3.0),
    ] {
        let mut config = config(AlgorithmKind::PpoLag, preset);
        config.learning.exploration = exploration;
        let case = Case::new(discrete(), spread);
        let advantages = standardised(&case.advantages[0], &config.learning);
        case.compare(
            "PPO",
            |heads, batch, means| ppo::loss(&advantages, heads, batch, &config.learning, means),
            |outputs| {
                case.clipped(outputs, &advantages, config.learning.clip_ratio)
                    + case.rest(outputs, &config)
            },
        );
    }
}

#[test]
fn ppo_with_continuous_parts() {
    let config = config(AlgorithmKind::Ppo, Preset::Paper);
    let mut case = Case::new(ActionShape { sizes: vec![3], deltas: 2 }, 0.1);
    case.exploration = 0.0;
    let advantages = standardised(&case.advantages[0], &config.learning);
    case.compare(
        "PPO with normals",
        |heads, batch, means| ppo::loss(&advantages, heads, batch, &config.learning, means),
        |outputs| {
            case.clipped(outputs, &advantages, config.learning.clip_ratio)
                + case.rest(outputs, &config)
        },
    );
}

/// P3O's exact penalty: kappa * max(0, E[max(r A_C, clip(r) A_C)] + excess), added to PPO's loss
/// (equation 13 of the paper). A8: the authors standardise A_C, and so the excess, which stands in
/// its unit, is divided by the same deviation; per step of an episode of 525 it is (J_C - d) / 525.
/// Values are fed as critics give them, with a deviation that is neither 1 nor that of the rewards.
/// The released code leaves out the clip and the division, and has a kappa of 1.
#[test]
fn p3o_counts_advantage_and_excess_in_one_unit() {
    for preset in [Preset::Paper, Preset::Released, Preset::Tables] {
        for (cost, scale) in
            [(400.0, 1.0), (400.0, 0.05), (8.0, 0.05), (8.0, 7.0), (0.0, 7.0), (0.0, 0.001)]
        {
            let config = config(AlgorithmKind::P3o, preset);
            let p3o = p3o::P3o::new(&config);
            let mut case = Case::new(discrete(), 0.3);
            case.advantages[1].iter_mut().for_each(|value| *value = *value * scale + 3.0 * scale);
            let advantages = standardised(&case.advantages[0], &config.learning);
            let raw: Vec<f64> = case.advantages[1].iter().map(|&value| f64::from(value)).collect();
            let mean = raw.iter().sum::<f64>() / ROWS as f64;
            let sigma = (raw.iter().map(|value| (value - mean).powi(2)).sum::<f64>()
                / (ROWS as f64 - 1.0))
                .sqrt();
            let signals = [signal(cost)];
            let clip = config.learning.clip_ratio;
            let penalty = |outputs: &[f64]| {
                // The whole in raw units, then divided once by sigma: the unit must not matter to
                // where the penalty begins.
                let expected = Case::mean(|i| {
                    let (ratio, a) = (case.ratio(outputs, i), raw[i] - mean);
                    let clipped = ratio.clamp(1.0 / (1.0 + clip), 1.0 + clip);
                    if preset == Preset::Paper { (ratio * a).max(clipped * a) } else { ratio * a }
                });
                let excess = (cost - 5.0) / 525.0;
                match preset {
                    Preset::Paper => 20.0 / sigma * (expected + excess).max(0.0),
                    _ => (expected / sigma + excess).max(0.0),
                }
            };
            case.compare(
                &format!("P3O {preset}, cost {cost}, scale {scale}"),
                |heads, batch, means| p3o.loss(&advantages, &signals, heads, batch, means),
                |outputs| {
                    case.clipped(outputs, &advantages, clip)
                        + case.rest(outputs, &config)
                        + penalty(outputs)
                },
            );
        }
    }
}

/// Where costs are all but absent their advantages are the critic's noise. With a floor the penalty's
/// gradient is the paper's divided by the floor, which goes to 0 with the noise.
#[test]
fn p3o_does_not_blow_up_noise() {
    let size = |scale: f32, floor: f64| {
        let mut config = config(AlgorithmKind::P3o, Preset::Paper);
        config.learning.advantage_floor = floor;
        let p3o = p3o::P3o::new(&config);
        let mut case = Case::new(discrete(), 0.3);
        case.advantages[1].iter_mut().for_each(|value| *value *= scale);
        let none = vec![0.0; ROWS];
        let with = |cost| {
            case.found(|heads, batch, means| p3o.loss(&none, &[signal(cost)], heads, batch, means))
                .1
        };
        // Far below the budget there is no penalty: the difference is its gradient.
        let (on, off) = (with(50.0), with(-1e9));
        on.iter().zip(&off).map(|(on, off)| (on - off).powi(2)).sum::<f64>().sqrt()
    };
    let noise = 1e-4;
    assert!((size(noise, 0.0) / size(1.0, 0.0) - 1.0).abs() < 1e-3);
    let ratio = size(noise, 0.01) / size(2.0 * noise, 0.01);
    assert!((ratio - 0.5).abs() < 1e-3, "{ratio}");
    assert!(size(noise, 0.01) < 0.05 * size(noise, 0.0));
}

/// FOCOPS' corollary 1 with the indicator of its algorithm 1: samples beyond the trust region do
/// not count.
#[test]
fn focops_counts_near_samples_alone() {
    let config = config(AlgorithmKind::Focops, Preset::Paper);
    let focops = focops::Focops::new(&config);
    let case = Case::new(discrete(), 0.15);
    let advantages = standardised(&case.advantages[0], &config.learning);
    let at: Vec<f64> = case.outputs.iter().map(|&v| f64::from(v)).collect();
    let near: Vec<bool> = (0..ROWS)
        .map(|i| case.divergence_from(case.row(&at, i), &case.old_row(i)) <= 0.02)
        .collect();
    assert!(near.contains(&true) && near.contains(&false), "samples of both kinds");
    case.compare(
        "FOCOPS",
        |heads, batch, means| focops.loss(&advantages, heads, batch, means),
        |outputs| {
            let policy = Case::mean(|i| {
                let divergence = case.divergence_from(case.row(outputs, i), &case.old_row(i));
                let gain = case.ratio(outputs, i) * advantages[i] / 1.5;
                if near[i] { divergence - gain } else { 0.0 }
            });
            policy + case.rest(outputs, &config)
        },
    );
}

/// CUP's projection: KL(pi, pi_halfway) + multiplier * (1 - gamma lambda) / (1 - gamma) * E[pi /
/// pi_k A_C], the second problem of its algorithm 1 with the constraint moved into the objective.
/// A3: the critics learn in it too, for it moves the trunk that they share.
#[test]
fn cup_projects_from_the_policy_halfway() {
    let config = config(AlgorithmKind::Cup, Preset::Paper);
    let mut cup = cup::Cup::new(&config);
    (0..300).for_each(|_| cup.constrain(&[signal(60.0)]));
    let multiplier = cup.multipliers()[0];
    assert!(multiplier > 0.1);
    let (mut case, other) = (Case::new(discrete(), 0.3), Case::new(discrete(), 1.5));
    case.exploration = 0.0;
    let width = case.shape.parameters();
    let halfway = Policy::new(&case.shape, &other.old_outputs, width);
    let mean = case.advantages[1].iter().map(|&a| f64::from(a)).sum::<f64>() / ROWS as f64;
    case.compare(
        "CUP",
        |heads, batch, means| cup.projection(&halfway, heads, batch, means),
        |outputs| {
            let coefficient = (1.0 - 0.99 * 0.95) / (1.0 - 0.99);
            let projection = Case::mean(|i| {
                case.divergence_from(case.row(outputs, i), &other.old_row(i))
                    + multiplier
                        * coefficient
                        * case.ratio(outputs, i)
                        * (f64::from(case.advantages[1][i]) - mean)
            });
            projection + case.rest(outputs, &config)
        },
    );
}

/// FOCOPS draws the policy to pi*, proportional to pi_k exp((A - nu A_C) / lambda) (theorem 1): its
/// loss over all actions of a state, each as often as pi_k takes it, has the gradient of KL(pi,
/// pi*) itself, which is taken here from pi* written out.
#[test]
fn focops_goes_to_the_best_policy_of_the_trust_region() {
    let mut config = config(AlgorithmKind::Focops, Preset::Paper);
    config.algorithm_settings.focops_eta = 1e9;
    let focops = focops::Focops::new(&config);
    let shape = ActionShape { sizes: vec![5], deltas: 0 };
    let logits = [0.4f32, -0.3, 0.2, 0.9, -0.1];
    let gains = [1.0, -0.5, 0.25, 0.0, -0.75];
    let mut case = Case::new(shape, 0.0);
    case.exploration = 0.0;
    // One state, acted in by the uniform policy: every action once.
    let row: Vec<f32> = logits.iter().copied().chain([0.0, 0.0]).collect();
    (case.outputs, case.old_outputs) = (row.repeat(5), vec![0.0; 25]);
    (case.actions, case.deltas, case.old_log) = ((0..5).collect(), vec![], vec![-(5f32.ln()); 5]);
    for values in case.advantages.iter_mut().chain(&mut case.old_values).chain(&mut case.targets) {
        values.truncate(5);
    }
    // The critics' columns have losses of their own.
    let (_, gradient) = case.found(|heads, batch, means| focops.loss(&gains, heads, batch, means));
    let divergence = |logits: &[f64]| {
        let p: Vec<f64> =
            logits.iter().map(|l| l.exp() / logits.iter().map(|l| l.exp()).sum::<f64>()).collect();
        let best: Vec<f64> = gains.iter().map(|gain| (gain / 1.5f64).exp() / 5.0).collect();
        let total: f64 = best.iter().sum();
        p.iter().zip(&best).map(|(p, best)| p * (p / (best / total)).ln()).sum::<f64>()
    };
    for index in 0..5 {
        let moved = |by: f64| {
            let mut logits = logits.map(f64::from);
            logits[index] += by;
            divergence(&logits)
        };
        let expected = (moved(1e-6) - moved(-1e-6)) / 2e-6;
        let found: f64 = (0..5).map(|row| gradient[row * 7 + index]).sum();
        assert!((found - expected).abs() < 1e-7, "logit {index}: {found} against {expected}");
    }
}
