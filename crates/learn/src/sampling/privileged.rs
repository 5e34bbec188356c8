//! What critics see and the policy does not.

use hasard_envs::Insight;
use hasard_envs::insight::{STATE, THINGS};

use crate::config::{CriticInput, TrainConfig};

/// The numbers of a run's privileged inputs. Critics see 0 for all of them where an agent acts
/// without: the time and the costs of an episode's start, nothing in view.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Privileged {
    inputs: Vec<CriticInput>,
    /// Of the reward's returns, and of those of the costs where they have another.
    discounts: Vec<f64>,
    episode_steps: u32,
    budgets: Vec<f64>,
}

/// Largest size of a number: that of all inputs of the networks.
const LARGEST: f64 = 5.0;

impl Privileged {
    /// What a run's critics see.
    #[must_use]
    pub fn new(config: &TrainConfig) -> Privileged {
        // Where the discount grows, the last one: a number that moved would be another input.
        let learning = &config.learning;
        let last = learning.final_gamma.unwrap_or(learning.gamma);
        Privileged {
            inputs: learning.critic_inputs.clone(),
            discounts: std::iter::once(last).chain(learning.cost_gamma).collect(),
            episode_steps: config.episode_steps,
            budgets: config.constraints.iter().map(|constraint| constraint.budget).collect(),
        }
    }

    /// Numbers of a row.
    #[must_use]
    pub fn count(&self) -> usize {
        let one = |input: &CriticInput| match input {
            CriticInput::TimeLeft => self.discounts.len(),
            CriticInput::BudgetSpent => self.budgets.len(),
            CriticInput::Health | CriticInput::Ammunition => 1,
            CriticInput::Position => 7,
            CriticInput::InView => 2 * THINGS,
        };
        self.inputs.iter().map(one).sum()
    }

    /// What the worlds have to show for them.
    #[must_use]
    pub fn insight(&self) -> Insight {
        let any = |some: &[CriticInput]| self.inputs.iter().any(|input| some.contains(input));
        Insight {
            state: any(&[CriticInput::Health, CriticInput::Ammunition, CriticInput::Position]),
            in_view: any(&[CriticInput::InView]),
            ..Insight::default()
        }
    }

    /// Writes the row of an episode that has had `age` steps, and the cost of each constraint, in
    /// a world of which `shown` is what it shows by `what`.
    pub fn write(&self, age: u32, spent: &[f64], what: Insight, shown: &[u8], mut row: &mut [f32]) {
        let [state, in_view, ..] = what.places();
        let state: [u8; STATE] = shown[state].try_into().unwrap_or_default();
        for input in &self.inputs {
            let count;
            match input {
                CriticInput::TimeLeft => {
                    count = self.discounts.len();
                    for (number, &gamma) in row.iter_mut().zip(&self.discounts) {
                        *number = (self.share_left(age, gamma) - 1.0) as f32;
                    }
                }
                CriticInput::BudgetSpent => {
                    count = self.budgets.len();
                    for ((number, &spent), &budget) in row.iter_mut().zip(spent).zip(&self.budgets)
                    {
                        // No budget is less than one event.
                        *number = (spent / budget.max(1.0)).clamp(-LARGEST, LARGEST) as f32;
                    }
                }
                CriticInput::Health => {
                    count = 1;
                    row[0] = (f32::from(state[0]) - 100.0) / 100.0;
                }
                CriticInput::Ammunition => {
                    count = 1;
                    row[0] = f32::from(state[1]) / 100.0;
                }
                CriticInput::Position => {
                    count = 7;
                    row[..count].copy_from_slice(&position(state));
                }
                CriticInput::InView => {
                    count = 2 * THINGS;
                    for (number, &byte) in row.iter_mut().zip(&shown[in_view.clone()]) {
                        *number = f32::from(byte) / 255.0;
                    }
                }
            }
            row = std::mem::take(&mut row).split_at_mut(count).1;
        }
    }

    /// The share that is left of an episode's time, each step discounted: what something that comes
    /// at a steady rate is still worth, in units of what it is worth at the start.
    fn share_left(&self, age: u32, gamma: f64) -> f64 {
        let left = |age: u32| {
            let steps = f64::from(self.episode_steps.saturating_sub(age));
            if gamma < 1.0 { (1.0 - libm::pow(gamma, steps)) / (1.0 - gamma) } else { steps }
        };
        left(age) / left(0).max(1.0)
    }
}

/// Place and height, each from -1 at one end of the map to 1 at the other; sine and cosine of the
/// heading; speed over the ground and upward, about 1 at a run.
fn position([_, _, x, y, z, heading, speed, upward]: [u8; STATE]) -> [f32; 7] {
    let place = |byte: u8| f32::from(byte) / 127.5 - 1.0;
    let turn = f64::from(heading) * std::f64::consts::TAU / 256.0;
    let (sine, cosine) = (libm::sin(turn) as f32, libm::cos(turn) as f32);
    let (speed, upward) = (f32::from(speed) / 64.0, (f32::from(upward) - 128.0) / 32.0);
    [place(x), place(y), place(z), sine, cosine, speed, upward]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{AlgorithmKind, EnvConfig, Preset};

    /// A11. A cost of c at every step until the limit T is worth c (1 - gamma^(T - t)) / (1 -
    /// gamma) at step t (the sum of a geometric series): a value of that form is linear in the
    /// input, under the discount of rewards, the last one of a schedule, and under that of costs.
    #[test]
    fn a_steady_cost_is_linear_in_the_time_left() {
        for (gamma, final_gamma, cost_gamma) in [
            (0.99, None, None),
            (0.9, None, None),
            (1.0, None, None),
            (0.97, Some(0.99), None),
            (0.97, None, Some(1.0)),
        ] {
            let mut config =
                TrainConfig::plain(AlgorithmKind::PpoLag, Preset::Paper, EnvConfig::new("test"));
            config.learning.gamma = gamma;
            (config.learning.final_gamma, config.learning.cost_gamma) = (final_gamma, cost_gamma);
            config.learning.critic_inputs = vec![CriticInput::TimeLeft];
            let privileged = Privileged::new(&config);
            let discounts: Vec<f64> =
                std::iter::once(final_gamma.unwrap_or(gamma)).chain(cost_gamma).collect();
            assert_eq!(privileged.count(), discounts.len());
            let steps = config.episode_steps;
            for age in [0, 1, 100, 400, 524, 525] {
                let mut seen = vec![9.0; discounts.len()];
                privileged.write(age, &[], Insight::default(), &[], &mut seen);
                for (gamma, seen) in discounts.iter().zip(&seen) {
                    let to_come = |age: u32| {
                        (0..steps - age).map(|step| 0.3 * gamma.powi(step as i32)).sum::<f64>()
                    };
                    let value = to_come(0) * (1.0 + f64::from(*seen));
                    assert!(
                        (value - to_come(age)).abs() < 1e-4 * to_come(0),
                        "gamma {gamma}, step {age}: {value}"
                    );
                }
            }
        }
    }

    #[test]
    fn each_constraint_has_its_own_number_in_units_of_its_budget() {
        let mut config =
            TrainConfig::plain(AlgorithmKind::PpoLag, Preset::Paper, EnvConfig::new("test"));
        config.constraints = [50.0, 4.0, 0.0]
            .map(|budget| crate::config::Constraint { term: None, budget })
            .to_vec();
        config.learning.critic_inputs = vec![CriticInput::BudgetSpent, CriticInput::TimeLeft];
        let privileged = Privileged::new(&config);
        assert_eq!(privileged.count(), 4);
        let mut row = [9.0; 4];
        privileged.write(0, &[25.0, 1e9, 3.0], Insight::default(), &[], &mut row);
        assert_eq!(row, [0.5, 5.0, 3.0, 0.0]);
    }

    /// By hand: 150 health points are half more than at the start; 20 rounds; in the west, in the
    /// middle, on top, looking north (a quarter turn), at 16 map units a tic, falling 16; of
    /// medicine a quarter of the picture (the root of a quarter is a half), touched.
    #[test]
    fn what_the_world_shows_becomes_numbers_of_about_one() {
        let mut config =
            TrainConfig::plain(AlgorithmKind::PpoLag, Preset::Paper, EnvConfig::new("test"));
        config.learning.critic_inputs = vec![
            CriticInput::Ammunition,
            CriticInput::InView,
            CriticInput::Health,
            CriticInput::Position,
        ];
        let privileged = Privileged::new(&config);
        // More is shown than critics see, as where depth is predicted.
        let what = Insight { depth: true, ..privileged.insight() };
        assert!(what.state && what.in_view && privileged.count() == 29);
        let mut shown = vec![77; what.bytes()];
        shown[..STATE].copy_from_slice(&[150, 20, 0, 127, 255, 64, 64, 96]);
        shown[STATE..STATE + 2 * THINGS].fill(0);
        shown[STATE..STATE + 2].copy_from_slice(&[127, 255]);
        let mut row = [9.0; 29];
        privileged.write(3, &[0.0], what, &shown, &mut row);
        let expected =
            [&[0.2, 0.498, 1.0][..], &[0.0; 18], &[0.5, -1.0, -0.004, 1.0, 1.0, 0.0, 1.0, -1.0]]
                .concat();
        for (found, expected) in row.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-3, "{row:?}");
        }
    }
}
