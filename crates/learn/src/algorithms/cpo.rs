//! CPO: constrained policy optimisation (Achiam et al. 2017, arXiv 1705.10528), for one constraint.
//!
//! Every step solves a small problem exactly: the best move for the reward within the trust region
//! and, to first order, within the budget; or, where no move can reach the budget, the move that
//! lowers the cost fastest. A line search then verifies reward, cost and divergence. With several
//! constraints the one furthest above its budget rules the step.

use crate::algorithms::surrogate::{standardised, standardised_by};
use crate::algorithms::trust_region::{TrustRegion, train_critics};
use crate::algorithms::{Algorithm, Signal};
use crate::config::{LearningConfig, TrainConfig};
use crate::error::LearnError;
use crate::learning::learner::{Learner, Minibatch};
use crate::learning::loss::{Heads, Loss};
use crate::learning::metrics::Means;

/// Constrained policy optimisation.
pub struct Cpo {
    settings: LearningConfig,
    region: TrustRegion,
}

impl Cpo {
    /// CPO with a run's settings.
    #[must_use]
    pub fn new(config: &TrainConfig) -> Cpo {
        Cpo { settings: config.learning.clone(), region: TrustRegion::new(config) }
    }
}

/// The cost above budget in the unit of the cost's surrogate, which is a mean over steps: an
/// episode's cost changes by that mean's change times the steps that episodes have at present, not
/// those of the longest possible one. (The paper's constraint, equation 10, is on discounted costs,
/// whose surrogate is scaled by 1 / (1 - gamma), the steps that discounting leaves of an endless
/// episode; the budgets here are on sums that are not discounted.)
fn surrogate_excess(signal: &Signal) -> f64 {
    signal.surrogate_excess()
}

/// The step's problem in the plane of the two gradients g (of what is minimised) and b (of the
/// cost), all products by the inverse of the Fisher matrix H: q = g'g, r = g'b, s = b'b; `excess`
/// is the cost above budget.
#[derive(Clone, Copy, Debug)]
struct Plane {
    q: f64,
    r: f64,
    s: f64,
    excess: f64,
    radius: f64,
}

/// A step `-(reward * H^-1 g + cost * H^-1 b)`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Weights {
    reward: f64,
    cost: f64,
    /// The step only recovers the budget.
    recovery: bool,
}

impl Plane {
    /// The minimiser of g'x subject to excess + b'x <= 0 and x'Hx / 2 <= radius (the paper's
    /// theorem 2).
    fn solve(&self) -> Weights {
        let Plane { q, r, s, excess: c, radius } = *self;
        let free =
            Weights { reward: (2.0 * radius / q.max(1e-12)).sqrt(), cost: 0.0, recovery: false };
        if s < 1e-8 {
            // The cost does not depend on the policy here: nothing can be done about it.
            return free;
        }
        let room = 2.0 * radius - c * c / s;
        if c < 0.0 && room < 0.0 {
            // The whole trust region is within the budget.
            return free;
        }
        if c > 0.0 && room < 0.0 {
            // None of it is.
            return Weights { reward: 0.0, cost: (2.0 * radius / s).sqrt(), recovery: true };
        }
        // The edge of the budget crosses the trust region. The dual is maximised over the two
        // stretches of its multiplier lambda on which that of the cost, nu = max(0, (lambda c - r)
        // / s), is positive or zero. (Signs: g is minimised here, so a move -H^-1 g that lowers the
        // cost has r > 0; the paper's r has the other sign.)
        let a = (q - r * r / s).max(0.0);
        let (bounded, unbounded) = ((a / room.max(1e-12)).sqrt(), (q / (2.0 * radius)).sqrt());
        let nu = |lambda: f64| ((lambda * c - r) / s).max(0.0);
        let edge = if c.abs() > 1e-12 { r / c } else { f64::INFINITY };
        let active = |lambda: f64| lambda * c - r > 0.0;
        // Projects a lambda onto the stretch where the constraint is active, or where it is not.
        let project = |lambda: f64, want: bool| {
            if active(lambda) == want {
                lambda.max(0.0)
            } else if edge.is_finite() {
                edge.max(0.0)
            } else {
                lambda.max(0.0)
            }
        };
        let value_active = |lambda: f64| -0.5 * (a / lambda.max(1e-12) + lambda * room) - r * c / s;
        let value_free = |lambda: f64| -0.5 * (q / lambda.max(1e-12) + 2.0 * lambda * radius);
        let (on, off) = (project(bounded, true), project(unbounded, false));
        // With c = 0 the sign of r alone says which stretch there is; within the budget and with a
        // move that lowers the cost there is none where it binds.
        let lambda = if c.abs() <= 1e-12 {
            if r < 0.0 { bounded } else { unbounded }
        } else if c < 0.0 && r >= 0.0 {
            off
        } else if value_active(on) >= value_free(off) {
            on
        } else {
            off
        }
        .max(1e-8);
        Weights { reward: 1.0 / lambda, cost: nu(lambda) / lambda, recovery: false }
    }
}

impl Algorithm for Cpo {
    fn update(
        &mut self,
        learner: &mut Learner,
        minibatch: &mut Minibatch<'_>,
        signals: &[Signal],
        means: &mut Means,
    ) -> Result<(), LearnError> {
        let relative = |signal: &Signal| signal.episode_excess() / signal.episode_budget.max(1.0);
        let worst = (0..signals.len())
            .max_by(|&a, &b| relative(&signals[a]).total_cmp(&relative(&signals[b])));
        let advantages = standardised(minibatch.advantages(), &self.settings);
        // In the unit of their own deviation, and so is the excess: theorem 2 holds in any unit,
        // and what counts as nothing below is so few of these.
        let (costs, unit) = standardised_by(&minibatch.costs()[worst.unwrap_or(0)].advantages, 0.0);
        let reward_loss = |heads: &Heads| -> Loss {
            heads.mean([&heads.ratio], |row, [ratio]| -(ratio * advantages[row]))
        };
        let cost_loss = |heads: &Heads| -> Loss {
            heads.mean([&heads.ratio], |row, [ratio]| ratio * costs[row])
        };
        let region = &self.region;
        let mut origin = region.origin(learner, minibatch);
        let (reward_before, cost_before) = (reward_loss(&origin.heads), cost_loss(&origin.heads));
        let g = region.gradient(learner, minibatch, &reward_before);
        let _ = learner.present_outputs(&mut minibatch.batch);
        let b = region.gradient(learner, minibatch, &cost_before);
        let (x, y) = (
            region.solve(learner, &mut origin, &g).direction,
            region.solve(learner, &mut origin, &b).direction,
        );
        // Nothing is known yet: as if there were no budget.
        let excess =
            worst.map_or(f64::NEG_INFINITY, |index| surrogate_excess(&signals[index]) / unit);
        let vectors = learner.vectors();
        let product = |a: &[f32], b: &[f32]| vectors.dot(a, b);
        let plane = Plane {
            q: product(&g, &x),
            r: product(&g, &y),
            s: product(&b, &y),
            excess,
            radius: region.radius,
        };
        let weights = plane.solve();
        means.add("policy_loss", reward_before.value);
        means.add("recovery", f64::from(u8::from(weights.recovery)));
        let mut step = vec![0.0; x.len()];
        vectors.add_scaled(&mut step, -weights.reward, &x);
        vectors.add_scaled(&mut step, -weights.cost, &y);
        let allowed = (-excess).max(0.0);
        region.search(learner, minibatch, &origin, &step, means, |heads, divergence| {
            let (reward, cost) = (reward_loss(heads).value, cost_loss(heads).value);
            // While above the budget the reward may fall; the cost may rise by what is left of the
            // budget, no more.
            (excess > 0.0 || reward <= reward_before.value)
                && cost - cost_before.value <= allowed
                && divergence <= 1.5 * region.radius
        });
        let critics = 1 + learner.shape().cost_critics;
        train_critics(learner, minibatch, critics, means)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One step brings an episode's cost to its budget. The task: in each of an episode's steps an
    /// action of cost 1 is taken with probability p = sigmoid(theta), and so the episode costs
    /// steps * p. The surrogate's gradient, the mean over steps of ratio * (cost - p), is p(1 - p)
    /// in theta, which the Fisher matrix is too.
    #[test]
    fn a_step_reaches_the_budget_whatever_the_length_of_episodes() {
        for (steps, cost, budget) in
            [(525.0, 55.0, 50.0), (525.0, 45.0, 50.0), (10.0, 4.2, 4.0), (2100.0, 900.0, 880.0)]
        {
            let p: f64 = cost / steps;
            let theta = libm::log(p / (1.0 - p));
            let fisher = p * (1.0 - p);
            // The reward is 1 with the action of cost 1: the best step goes to the edge of the
            // budget.
            let (g, b) = (-fisher, fisher);
            let excess = surrogate_excess(&Signal::steady(cost, budget, steps));
            let weights = Plane {
                q: g * g / fisher,
                r: g * b / fisher,
                s: b * b / fisher,
                excess,
                radius: 0.05,
            }
            .solve();
            let step = -(weights.reward * g + weights.cost * b) / fisher;
            let after = steps / (1.0 + libm::exp(-(theta + step)));
            let missed = (after - budget).abs() / (cost - budget).abs();
            assert!(
                missed < 0.1,
                "episodes of {steps} steps: from {cost} to {after}, budget {budget}"
            );
        }
    }

    /// A7. Equation 2 of the paper (Kakade and Langford 2002) without discount: an episode's cost
    /// under a new policy is the old one's plus the sum of the new policy's advantages over the
    /// episode's steps, which is its mean steps times their mean. Here every step costs 1 with
    /// probability p, and something that is not the policy ends half of the episodes early, so that
    /// an episode costs p times the mean length whatever the longest is; a step of the policy to
    /// the edge of the budget must end there.
    #[test]
    fn a_step_reaches_the_budget_where_episodes_end_early() {
        use crate::config::{EnvConfig, Preset, TrainConfig};
        let mut config = TrainConfig::plain(
            crate::config::AlgorithmKind::Cpo,
            Preset::Paper,
            EnvConfig::new("test"),
        );
        config.constraints[0].budget = 50.0;
        for (lengths, cost) in
            [([525u32, 105], 55.0), ([525, 55], 46.0), ([400, 400], 53.0), ([525, 525], 54.0)]
        {
            let mean_length = f64::from(lengths[0] + lengths[1]) / 2.0;
            let p: f64 = cost / mean_length;
            let mut watch = crate::runs::watch::Watch::new(&config);
            for length in lengths.repeat(16) {
                let episode = hasard_envs::Episode {
                    task: None,
                    lane: 0,
                    seed: 0,
                    episode_return: 0.0,
                    cost: p * f64::from(length),
                    costs: vec![],
                    length,
                    terminated: length < 525,
                    truncated: length == 525,
                    stats: vec![],
                };
                watch.add(&episode, &config.constraints).unwrap();
            }
            let alone = watch.signals(&config, 0.0, &[p])[0];
            // The mean over steps of ratio * advantage moves by p(1 - p) a unit of the logit, and
            // so does p; in half of the worlds, where the others have another task, by half of it.
            let slope = p * (1.0 - p);
            for share in [1.0, 0.5] {
                let excess = surrogate_excess(&Signal { share, ..alone });
                let (r, s) = (-slope * share, slope * share * share);
                let weights = Plane { q: slope, r, s, excess, radius: 0.05 }.solve();
                let moved = p + (weights.reward - weights.cost * share) * slope;
                assert!(!weights.recovery);
                let after = mean_length * moved;
                assert!(
                    (after - 50.0).abs() < 1e-6,
                    "episodes of {lengths:?} steps: from {cost} to {after}, budget 50"
                );
            }
        }
    }

    /// Theorem 2 in another unit: costs of a ten-thousandth, and a budget of as much less, make the
    /// same step, within the budget and above it.
    #[test]
    fn a_step_does_not_depend_on_the_unit_of_costs() {
        use crate::algorithms::small;
        use crate::config::AlgorithmKind;
        let step = |unit: f64, cost: f64| {
            let config = small::config(AlgorithmKind::Cpo);
            let (mut learner, rollout) = small::learner(&config);
            let prepared = learner.prepare(&rollout);
            let mut minibatch = learner.minibatch(&prepared, &[0, 1, 2, 3]);
            let outputs =
                learner.policy_outputs(&mut minibatch.batch, &learner.policy_parameters());
            let action = &learner.shape().action;
            minibatch.old_policy =
                crate::learning::policy::Policy::new(action, &outputs, action.parameters());
            minibatch.critics[1].advantages.iter_mut().for_each(|cost| *cost *= unit as f32);
            let signal = Signal::steady(cost * unit, 50.0 * unit, 525.0);
            let before = learner.policy_parameters();
            let mut means = Means::default();
            Cpo::new(&config).update(&mut learner, &mut minibatch, &[signal], &mut means).unwrap();
            assert!(means.get("step_share").unwrap() > 0.0, "{unit}, {cost}: stands still");
            let after = learner.policy_parameters();
            after.iter().zip(before).map(|(new, old)| new - old).collect::<Vec<f32>>()
        };
        for cost in [40.0, 49.0, 60.0, 500.0] {
            let (usual, small) = (step(1.0, cost), step(1e-4, cost));
            let size = |step: &[f32]| step.iter().map(|x| f64::from(x * x)).sum::<f64>().sqrt();
            let apart: Vec<f32> = usual.iter().zip(&small).map(|(a, b)| a - b).collect();
            assert!(size(&apart) < 1e-3 * size(&usual), "{cost}: {}", size(&apart) / size(&usual));
        }
    }

    /// The closed form against a search over the whole plane of steps (the Fisher matrix taken as
    /// the identity).
    #[test]
    fn steps_solve_the_constrained_problem() {
        let radius = 0.02;
        for (g, b) in
            [([1.0, 0.5], [0.3, -1.0]), ([1.0, 0.0], [-0.8, 0.6]), ([0.2, 0.1], [-1.0, -0.4])]
        {
            for excess in [-1.0, -0.1, -0.02, 0.0, 0.02, 0.1, 1.0f64] {
                let product = |u: [f64; 2], v: [f64; 2]| u[0] * v[0] + u[1] * v[1];
                let plane =
                    Plane { q: product(g, g), r: product(g, b), s: product(b, b), excess, radius };
                let weights = plane.solve();
                let x = [0, 1].map(|i| -weights.reward * g[i] - weights.cost * b[i]);
                assert!(
                    product(x, x) / 2.0 <= radius * 1.0001,
                    "{plane:?}: outside of the trust region"
                );
                let length = (2.0 * radius).sqrt();
                let (mut best, mut least_cost) = (f64::INFINITY, f64::INFINITY);
                for i in 0..=800 {
                    for j in 0..=100 {
                        let angle = f64::from(i) / 800.0 * std::f64::consts::TAU;
                        let size = length * f64::from(j) / 100.0;
                        let x = [size * angle.cos(), size * angle.sin()];
                        least_cost = least_cost.min(product(b, x));
                        if excess + product(b, x) <= 1e-9 {
                            best = best.min(product(g, x));
                        }
                    }
                }
                if weights.recovery {
                    assert!(best.is_infinite(), "{plane:?}: the budget could be kept");
                    assert!(
                        product(b, x) <= least_cost + 1e-3,
                        "{plane:?}: not the fastest way back"
                    );
                } else {
                    assert!(excess + product(b, x) <= 1e-6, "{plane:?}: beyond the budget");
                    assert!(
                        product(g, x) <= best + 2e-3,
                        "{plane:?}: {} against {best}",
                        product(g, x)
                    );
                }
            }
        }
    }
}
