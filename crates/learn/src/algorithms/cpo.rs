//! CPO: constrained policy optimisation (Achiam et al. 2017, arXiv 1705.10528), for one constraint.
//!
//! Every step solves a small problem exactly: the best move for the reward within the trust region and, to first order,
//! within the budget; or, where no move can reach the budget, the move that lowers the cost fastest. A line search then
//! verifies reward, cost and divergence. With several constraints the one furthest above its budget rules the step.

use super::surrogate::{centred, standardised};
use super::trust_region::{TrustRegion, dot, note, plus, train_critics};
use super::{Algorithm, Signal};
use crate::config::TrainConfig;
use crate::error::LearnError;
use crate::learning::learner::{Learner, Minibatch};
use crate::learning::loss::{Heads, Loss};
use crate::learning::metrics::Means;

/// Constrained policy optimisation.
pub struct Cpo {
    region: TrustRegion,
    gamma: f64,
}

impl Cpo {
    /// CPO with a run's settings.
    #[must_use]
    pub fn new(config: &TrainConfig) -> Cpo {
        Cpo { region: TrustRegion::new(config), gamma: config.learning.gamma }
    }
}

/// The step's problem in the plane of the two gradients g (of what is minimised) and b (of the cost), all products by the
/// inverse of the Fisher matrix H: q = g'g, r = g'b, s = b'b; `excess` is the cost above budget.
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
    /// The minimiser of g'x subject to excess + b'x <= 0 and x'Hx / 2 <= radius (the paper's theorem 2).
    fn solve(&self) -> Weights {
        let Plane { q, r, s, excess: c, radius } = *self;
        let free = Weights { reward: (2.0 * radius / q.max(1e-12)).sqrt(), cost: 0.0, recovery: false };
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
        // The edge of the budget crosses the trust region. The dual is maximised over the two stretches of its
        // multiplier lambda on which that of the cost, nu = max(0, (lambda c + r) / s), is positive or zero. (Signs: g is
        // minimised here, so a move -H^-1 g that lowers the cost has r > 0.)
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
        // With c = 0 the sign of r alone says which stretch there is.
        let lambda = if c.abs() <= 1e-12 {
            if r < 0.0 { bounded } else { unbounded }
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
        let worst = (0..signals.len()).max_by(|&a, &b| relative(&signals[a]).total_cmp(&relative(&signals[b])));
        let advantages = standardised(minibatch.advantages());
        let costs = centred(&minibatch.costs()[worst.unwrap_or(0)].advantages);
        let reward_loss = |heads: &Heads| -> Loss { heads.mean([&heads.ratio], |row, [ratio]| -(ratio * advantages[row])) };
        let cost_loss = |heads: &Heads| -> Loss { heads.mean([&heads.ratio], |row, [ratio]| ratio * costs[row]) };
        let region = &self.region;
        let origin = region.origin(learner, minibatch);
        let (reward_before, cost_before) = (reward_loss(&origin.heads), cost_loss(&origin.heads));
        let g = region.gradient(learner, minibatch, &origin, &reward_before);
        let b = region.gradient(learner, minibatch, &origin, &cost_before);
        let (x, y) = (region.solve(learner, minibatch, &origin, &g), region.solve(learner, minibatch, &origin, &b));
        // The surrogate's unit is a discounted step; an episode's excess is brought to it as in P3O.
        let excess = worst.map_or(-1.0, |index| (1.0 - self.gamma) * signals[index].episode_excess());
        let plane = Plane { q: dot(&g, &x), r: dot(&g, &y), s: dot(&b, &y), excess, radius: region.radius };
        let weights = plane.solve();
        means.add("policy_loss", reward_before.value);
        means.add("recovery", f64::from(u8::from(weights.recovery)));
        let zero = vec![0.0; x.len()];
        let step = plus(&plus(&zero, -weights.reward, &x), -weights.cost, &y);
        let allowed = (-excess).max(0.0);
        let share = region.search(learner, minibatch, &origin, &step, |heads, divergence| {
            let (reward, cost) = (reward_loss(heads).value, cost_loss(heads).value);
            // While above the budget the reward may fall; the cost may rise by what is left of the budget, no more.
            (excess > 0.0 || reward <= reward_before.value)
                && cost - cost_before.value <= allowed
                && divergence <= 1.5 * region.radius
        });
        note(learner, minibatch, share, means);
        let critics = 1 + learner.shape().cost_critics;
        train_critics(learner, minibatch, critics, means)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The closed form against a search over the whole plane of steps (the Fisher matrix taken as the identity).
    #[test]
    fn steps_solve_the_constrained_problem() {
        let radius = 0.02;
        for (g, b) in [([1.0, 0.5], [0.3, -1.0]), ([1.0, 0.0], [-0.8, 0.6]), ([0.2, 0.1], [-1.0, -0.4])] {
            for excess in [-1.0, -0.1, -0.02, 0.0, 0.02, 0.1, 1.0f64] {
                let product = |u: [f64; 2], v: [f64; 2]| u[0] * v[0] + u[1] * v[1];
                let plane = Plane { q: product(g, g), r: product(g, b), s: product(b, b), excess, radius };
                let weights = plane.solve();
                let x = [0, 1].map(|i| -weights.reward * g[i] - weights.cost * b[i]);
                assert!(product(x, x) / 2.0 <= radius * 1.0001, "{plane:?}: outside of the trust region");
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
                    assert!(product(b, x) <= least_cost + 1e-3, "{plane:?}: not the fastest way back");
                } else {
                    assert!(excess + product(b, x) <= 1e-6, "{plane:?}: beyond the budget");
                    assert!(product(g, x) <= best + 2e-3, "{plane:?}: {} against {best}", product(g, x));
                }
            }
        }
    }
}
