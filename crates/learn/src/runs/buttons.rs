//! The policy of an agent whose buttons come in another order than those of the run that begins
//! with it: rule sets list the same buttons differently, and an output's place is its meaning.

use crate::config::EnvConfig;
use crate::error::LearnError;
use crate::learning::learner::Learner;
use crate::runs::checkpoint::parameter_names;
use hasard_envs::{ActionGroup, ActionSpace};

/// For each output of the run's policy, that of the agent's which presses the same button; buttons
/// that the agent does not have begin as those of its own that the run does not have, in their order.
/// Nothing if they are the same throughout, or if the groups of the two are of other sizes.
///
/// # Errors
/// When a configuration names no environment.
pub fn order(run: &EnvConfig, agent: &EnvConfig) -> Result<Option<Vec<usize>>, LearnError> {
    Ok(match (run.action_space()?, agent.action_space()?) {
        (Some(run), Some(agent)) => order_of(&run, &agent),
        _ => None,
    })
}

fn order_of(run: &ActionSpace, agent: &ActionSpace) -> Option<Vec<usize>> {
    if run.groups == agent.groups || run.groups.len() != agent.groups.len() {
        return None;
    }
    let mut first = 0;
    let mut agents = Vec::new();
    for group in &agent.groups {
        let outputs = first..first + group.buttons.len() + 1;
        first = outputs.end;
        agents.push((group, outputs));
    }
    let mut order = Vec::new();
    let mut left: Vec<_> = agents.iter().filter(|(own, _)| !run.groups.contains(own)).collect();
    for group in &run.groups {
        let known = agents.iter().find(|(own, _)| *own == group);
        let (_, outputs) = match known {
            Some(known) => known,
            None => {
                let as_many = |one: &&(&ActionGroup, _)| one.0.buttons.len() == group.buttons.len();
                let place = left.iter().position(as_many)?;
                left.remove(place)
            }
        };
        order.extend(outputs.clone());
    }
    // Continuous parts come last, and always in the same order: two numbers each.
    order.extend(first..first + 2 * run.deltas.len());
    Some(order).filter(|order| !order.is_sorted())
}

/// Puts the outputs of a learner's policy, whose weights are the agent's, in the run's order.
pub fn reorder(learner: &mut Learner, order: &[usize]) {
    let heads = parameter_names(learner.shape())
        .into_iter()
        .filter(|(name, ..)| name == "network0.head0.weight" || name == "network0.head0.bias");
    for (_, shape, range) in heads.collect::<Vec<_>>() {
        let columns = *shape.last().expect("a head has outputs");
        for row in learner.parameters[range].chunks_exact_mut(columns) {
            let before = row.to_vec();
            for (output, &from) in row.iter_mut().zip(order) {
                *output = before[from];
            }
        }
    }
    learner.replaced();
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Turn, forward, SPEED, JUMP under `paper`; turn, forward, JUMP, SPEED under `tables`.
    #[test]
    fn outputs_follow_their_buttons() {
        let env = |rules: &str, id: &str| EnvConfig {
            rules: rules.into(),
            ..EnvConfig::new(&format!("{id}Level1-v0"))
        };
        let (paper, tables) = (env("paper", "RemedyRush"), env("tables", "RemedyRush"));
        let swapped = Some(vec![0, 1, 2, 3, 4, 7, 8, 5, 6]);
        assert_eq!(order(&tables, &paper).unwrap(), swapped);
        assert_eq!(order(&paper, &paper).unwrap(), None);
        // USE takes the place of SPEED, and JUMP stays; where SPEED is the last, both change places.
        let burden = env("paper", "ArmamentBurden");
        assert_eq!(order(&burden, &paper).unwrap(), None);
        assert_eq!(order(&burden, &tables).unwrap(), swapped);
        assert_eq!(order(&env("paper", "CollateralDamage"), &paper).unwrap(), None);
        assert_eq!(order(&env("paper", "PrecipicePlunge"), &paper).unwrap(), None);
        let full = |env: &EnvConfig| EnvConfig { full_actions: true, ..env.clone() };
        let of = |env: &EnvConfig| env.action_space().unwrap().unwrap();
        let (mut turned, own) = (of(&full(&paper)), of(&full(&paper)));
        turned.groups.reverse();
        let order = order_of(&turned, &own).unwrap();
        let outputs = own.sizes().iter().sum::<usize>() + 2 * own.deltas.len();
        assert_eq!(
            order[..2],
            [outputs - 2 * own.deltas.len() - 2, outputs - 2 * own.deltas.len() - 1]
        );
        assert_eq!(order[order.len() - 1], outputs - 1);
    }
}
