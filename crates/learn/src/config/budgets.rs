//! The budgets that environments have of themselves.

use crate::config::{AlgorithmKind, Constraint, EnvConfig};
use crate::error::LearnError;

/// Most constraints of a run.
pub(super) const MOST_CONSTRAINTS: usize = 32;

/// The budgets that an environment has of itself: one on its cost. Each of several tasks has its
/// own, but for algorithms that know a single cost: there the smallest holds for all.
pub(super) fn usual_constraints(
    algorithm: AlgorithmKind,
    env: &EnvConfig,
) -> Result<Vec<Constraint>, LearnError> {
    let rules = env.rule_set()?;
    let mut all: Vec<Constraint> = Vec::new();
    for task in env.tasks() {
        let budget = task.env_id()?.safety_budget(rules, env.hard);
        let term = env.is_mixed().then_some(task.id);
        if !all.iter().any(|known| known.term == term) {
            all.push(Constraint { term, budget });
        }
    }
    if env.is_mixed() && algorithm.knows_one_cost() {
        let budget = all.iter().map(|one| one.budget).fold(f64::INFINITY, f64::min);
        all = vec![Constraint { term: None, budget }];
    }
    Ok(all)
}
