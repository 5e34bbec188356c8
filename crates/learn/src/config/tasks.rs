//! What several tasks of one run cannot have, and how many worlds each constraint has.

use std::fmt;

use crate::config::train_config::TrainConfig;
use crate::config::{Constraint, ConstraintStatistic, EnvConfig};
use crate::error::LearnError;

impl TrainConfig {
    /// Refuses what several tasks cannot have.
    pub(super) fn check_tasks(&self) -> Result<(), LearnError> {
        let tasks = self.env.tasks().len();
        let refuse = |name: &str, given: &dyn fmt::Display, allowed: String| {
            Err(LearnError::Config(format!(
                "{name} cannot be {given} with {tasks} tasks; it must be {allowed}"
            )))
        };
        for (name, given) in [
            ("the number of worlds", self.sampling.lanes),
            ("the episodes of an evaluation", self.evaluation.episodes),
            ("the confirming episodes", self.confirming_episodes()),
        ] {
            if given < tasks {
                return refuse(name, &given, format!("at least {tasks}"));
            }
        }
        if self.constraint_statistic == ConstraintStatistic::StepMean {
            let allowed = "episode-mean, which keeps tasks apart".to_string();
            return refuse("the constraint statistic", &self.constraint_statistic, allowed);
        }
        if !self.curriculum.is_empty() {
            return refuse("a curriculum", &"set", "of the levels of one scenario".to_string());
        }
        Ok(())
    }

    /// How many worlds have each constraint: all, or those of the tasks whose episodes report its
    /// term.
    #[must_use]
    pub fn lanes_under_constraints(&self) -> Vec<usize> {
        let tasks = self.env.tasks();
        let has = |task: &EnvConfig, term: &Option<String>| {
            term.as_ref().is_none_or(|name| {
                tasks.len() == 1
                    || *name == task.id
                    || task.scenario().is_none_or(|scenario| {
                        scenario.cost_terms().iter().any(|term| term.name == name)
                    })
            })
        };
        let lanes = |constraint: &Constraint| {
            let own: Vec<bool> = tasks.iter().map(|task| has(task, &constraint.term)).collect();
            (0..self.sampling.lanes).filter(|lane| own[lane % own.len()]).count()
        };
        self.constraints.iter().map(lanes).collect()
    }
}
