//! What critics see and the policy does not.

use crate::config::{CriticInput, TrainConfig};

/// The numbers of a run's privileged inputs. All of them are 0 at an episode's start, which is what
/// critics see of agents that act without them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Privileged {
    inputs: Vec<CriticInput>,
    gamma: f64,
    episode_steps: u32,
    budgets: Vec<f64>,
}

/// Largest size of a number: that of all inputs of the networks.
const LARGEST: f64 = 5.0;

impl Privileged {
    /// What a run's critics see.
    #[must_use]
    pub fn new(config: &TrainConfig) -> Privileged {
        Privileged {
            inputs: config.learning.critic_inputs.clone(),
            gamma: config.learning.gamma,
            episode_steps: config.episode_steps,
            budgets: config.constraints.iter().map(|constraint| constraint.budget).collect(),
        }
    }

    /// Numbers of a row.
    #[must_use]
    pub fn count(&self) -> usize {
        let one = |input: &CriticInput| match input {
            CriticInput::TimeLeft => 1,
            CriticInput::BudgetSpent => self.budgets.len(),
        };
        self.inputs.iter().map(one).sum()
    }

    /// Writes the row of an episode that has had `age` steps, and the cost of each constraint.
    pub fn write(&self, age: u32, spent: &[f64], mut row: &mut [f32]) {
        for input in &self.inputs {
            let count;
            match input {
                CriticInput::TimeLeft => {
                    count = 1;
                    row[0] = (self.share_left(age) - 1.0) as f32;
                }
                CriticInput::BudgetSpent => {
                    count = self.budgets.len();
                    for ((number, &spent), &budget) in row.iter_mut().zip(spent).zip(&self.budgets)
                    {
                        // No budget is less than one event.
                        *number = (spent / budget.max(1.0)).clamp(-LARGEST, LARGEST) as f32;
                    }
                }
            }
            row = std::mem::take(&mut row).split_at_mut(count).1;
        }
    }

    /// The share that is left of an episode's time, each step discounted: what something that comes
    /// at a steady rate is still worth, in units of what it is worth at the start.
    fn share_left(&self, age: u32) -> f64 {
        let left = |age: u32| {
            let steps = f64::from(self.episode_steps.saturating_sub(age));
            if self.gamma < 1.0 {
                (1.0 - libm::pow(self.gamma, steps)) / (1.0 - self.gamma)
            } else {
                steps
            }
        };
        left(age) / left(0).max(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{AlgorithmKind, EnvConfig, Preset};

    /// A11. A cost of c at every step until the limit T is worth c (1 - gamma^(T - t)) / (1 -
    /// gamma) at step t (the sum of a geometric series): a value of that form is linear in the
    /// input.
    #[test]
    fn a_steady_cost_is_linear_in_the_time_left() {
        for gamma in [0.99, 0.9, 1.0] {
            let mut config =
                TrainConfig::plain(AlgorithmKind::PpoLag, Preset::Paper, EnvConfig::new("test"));
            config.learning.gamma = gamma;
            config.learning.critic_inputs = vec![CriticInput::TimeLeft];
            let privileged = Privileged::new(&config);
            let steps = config.episode_steps;
            let to_come =
                |age: u32| (0..steps - age).map(|step| 0.3 * gamma.powi(step as i32)).sum::<f64>();
            for age in [0, 1, 100, 400, 524, 525] {
                let mut seen = [9.0];
                privileged.write(age, &[], &mut seen);
                let value = to_come(0) * (1.0 + f64::from(seen[0]));
                assert!(
                    (value - to_come(age)).abs() < 1e-4 * to_come(0),
                    "gamma {gamma}, step {age}: {value}"
                );
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
        privileged.write(0, &[25.0, 1e9, 3.0], &mut row);
        assert_eq!(row, [0.5, 5.0, 3.0, 0.0]);
    }
}
