//! What is wrong with what a batch of worlds is given, found before any world moves.

use super::chosen::{Chosen, Restart};
use super::lane_state::LaneState;
use super::options::VecOptions;
use crate::{ActionSpace, Batch, CostTerm, EnvError};

/// What the lanes of a batch have in common, and how the batch was made.
pub(super) struct Shape {
    pub space: ActionSpace,
    pub observation: [usize; 3],
    pub cost_terms: &'static [CostTerm],
    pub statistics: Vec<&'static str>,
    pub options: VecOptions,
    /// Fingerprint of each lane's environment.
    pub envs: Vec<u64>,
}

impl Shape {
    pub(super) fn check_lengths(&self, lanes: usize, batch: &Batch) -> Result<(), EnvError> {
        let pixels: usize = self.observation.iter().product();
        let statistics = if self.options.statistics { self.statistics.len() } else { 0 };
        for (field, given, needed) in [
            ("actions", batch.actions.len(), lanes * self.space.groups.len()),
            ("deltas", batch.deltas.len(), lanes * self.space.deltas.len()),
            ("observations", batch.observations.len(), lanes * pixels),
            ("rewards", batch.rewards.len(), lanes),
            ("costs", batch.costs.len(), lanes),
            ("cost_terms", batch.cost_terms.len(), lanes * self.cost_terms.len()),
            ("statistics", batch.statistics.len(), lanes * statistics),
            ("positions", batch.positions.len(), lanes),
            ("insight", batch.insight.len(), lanes * self.options.insight.bytes()),
            ("terminated", batch.terminated.len(), lanes),
            ("truncated", batch.truncated.len(), lanes),
        ] {
            if given != needed {
                return Err(EnvError::BatchSize { field, given, needed });
            }
        }
        Ok(())
    }

    /// Whether each lane's action lies in the action space; a wrong one is named with its lane of
    /// the whole.
    pub(super) fn check_actions(&self, batch: &Batch, lanes: &Chosen) -> Result<(), EnvError> {
        let (groups, continuous) = (self.space.groups.len(), self.space.deltas.len());
        for index in 0..lanes.count() {
            let actions =
                batch.actions.get(index * groups..(index + 1) * groups).unwrap_or_default();
            let deltas =
                batch.deltas.get(index * continuous..(index + 1) * continuous).unwrap_or_default();
            self.space.check(lanes.lane(index), actions, deltas)?;
        }
        Ok(())
    }

    /// Whether lanes exist and none is named twice.
    pub(super) fn check_lanes(&self, lanes: &[usize]) -> Result<(), EnvError> {
        let mut seen = vec![false; self.options.lanes];
        for &lane in lanes {
            let refused = |allowed| {
                Err(EnvError::Option { option: "a lane to step", given: lane.to_string(), allowed })
            };
            match seen.get_mut(lane) {
                None => {
                    return refused(format!(
                        "less than {}, the number of lanes",
                        self.options.lanes
                    ));
                }
                Some(true) => return refused("named once".to_string()),
                Some(seen) => *seen = true,
            }
        }
        Ok(())
    }

    pub(super) fn check_restarts(&self, how: &[Restart]) -> Result<(), EnvError> {
        self.one_of_each_lane("the number of lanes to restart", how.len())
    }

    pub(super) fn check_states(&self, states: &[LaneState]) -> Result<(), EnvError> {
        self.one_of_each_lane("the number of saved lanes", states.len())?;
        for (lane, (state, &env)) in states.iter().zip(&self.envs).enumerate() {
            if state.env != 0 && env != 0 && state.env != env {
                let why = format!(
                    "lane {lane} was saved from another environment, or from one made with other options; restore it in one made alike"
                );
                return Err(EnvError::Saved { why });
            }
        }
        states
            .iter()
            .enumerate()
            .try_for_each(|(lane, state)| state.check(lane, &self.space).map(|_| ()))
    }

    fn one_of_each_lane(&self, option: &'static str, given: usize) -> Result<(), EnvError> {
        if given == self.options.lanes {
            return Ok(());
        }
        let allowed = format!("{}, one of each lane", self.options.lanes);
        Err(EnvError::Option { option, given: given.to_string(), allowed })
    }

    pub(super) fn check_group(&self, group: usize) -> Result<(), EnvError> {
        if group < self.options.groups {
            return Ok(());
        }
        let allowed = format!("less than {}, the number of groups", self.options.groups);
        Err(EnvError::Option { option: "the group", given: group.to_string(), allowed })
    }
}
