//! Different tasks in one batch: each lane's environment behind the actions, cost terms and
//! statistics that all of them have together.
//!
//! A button that a task does not have does nothing there. In a step's numbers a cost term that it
//! does not have costs nothing, and a statistic that it does not have is 0; its episodes report
//! their own terms and statistics alone. So a lane's episodes are those of its task, seed by seed.
//!
//! Beside the terms of the tasks there is an uncounted one of each task's id: what the task costs
//! as a whole, for a budget of its own.

use crate::own::intern;
use crate::{
    ActionGroup, ActionSpace, CostTerm, Env, EnvError, EnvId, EnvOptions, Environment, Episode,
    EpisodeCost, Happening, Insight, Step,
};
use std::sync::{Arc, Mutex, PoisonError};

/// One of the tasks of a mixed batch.
#[derive(Clone, PartialEq, Debug)]
pub struct MixedTask {
    /// Which environment.
    pub id: EnvId,
    /// The map's extent: x from, y from, x to, y to in map units.
    pub extent: [i32; 4],
    /// Policy steps of an episode that only time ends.
    pub episode_steps: u32,
    /// For each choice of each sub-action of the batch's space, one after the other, whether it
    /// does something here: to press nothing always does.
    pub mask: Vec<bool>,
}

/// What the tasks of a batch have together, and how each sees it.
#[derive(Clone, Debug)]
pub struct Mixture {
    parts: Vec<Arc<Part>>,
}

/// A task's way into the batch.
#[derive(Debug)]
struct Part {
    task: MixedTask,
    /// The task's id, and the place of the term that has it as its name.
    name: &'static str,
    whole_cost: usize,
    space: ActionSpace,
    terms: &'static [CostTerm],
    statistics: Vec<&'static str>,
    /// Of each own sub-action: the batch's sub-action, and the own choice for each choice of it.
    choices: Vec<(usize, Vec<u8>)>,
    /// Of each own continuous sub-action: the batch's.
    deltas: Vec<usize>,
    /// Of each own cost term and each own statistic: the batch's.
    own_terms: Vec<usize>,
    own_statistics: Vec<usize>,
}

impl Mixture {
    /// The mixture of some environments, all made with the same options.
    ///
    /// # Errors
    /// Names two tasks that use one name for a cost term that counts in one of them alone; an option
    /// in which they differ; or says that there are none.
    pub fn of(envs: &[Env]) -> Result<Mixture, EnvError> {
        let Some(first) = envs.first() else {
            let (given, allowed) = ("0".to_string(), "1 or more".to_string());
            return Err(EnvError::Option { option: "the number of tasks", given, allowed });
        };
        for (lane, env) in envs.iter().enumerate() {
            if let Some(what) = first.options().difference(env.options()) {
                return Err(EnvError::Unlike { lane, what });
            }
        }
        let space = ActionSpace::joined(envs.iter().map(|env| env.action_space().clone()));
        let ids: Vec<EnvId> = envs.iter().map(Env::id).collect();
        let terms = Mixture::cost_terms(&ids)?;
        let mut statistics: Vec<&'static str> = Vec::new();
        for name in envs.iter().flat_map(Environment::stat_names) {
            if !statistics.contains(&name) {
                statistics.push(name);
            }
        }
        let part = |env: &Env| {
            let own = env.action_space();
            let choices: Vec<_> = own.groups.iter().map(|group| route(&space, group)).collect();
            let place = |name: &str| statistics.iter().position(|known| *known == name);
            let name = intern(&env.id().to_string());
            let whole_cost = terms.iter().position(|term| term.name == name);
            let task = MixedTask {
                id: env.id(),
                extent: env.extent(),
                episode_steps: env.episode_steps(),
                mask: mask(&space, own),
            };
            Arc::new(Part {
                task,
                name,
                whole_cost: whole_cost.expect("each task has a term of its id"),
                space: space.clone(),
                terms,
                statistics: statistics.clone(),
                choices,
                deltas: places(&own.deltas, &space.deltas),
                own_terms: places(env.cost_terms(), terms),
                own_statistics: env.stat_names().into_iter().filter_map(place).collect(),
            })
        };
        Ok(Mixture { parts: envs.iter().map(part).collect() })
    }

    /// The cost terms of a mixture of environments: those of each, then an uncounted one for each
    /// id, what that task costs as a whole.
    ///
    /// # Errors
    /// Names two tasks that use one name for a cost term that counts in one of them alone.
    pub fn cost_terms(ids: &[EnvId]) -> Result<&'static [CostTerm], EnvError> {
        joined_terms(ids)
    }

    /// The tasks, in the order given.
    #[must_use]
    pub fn tasks(&self) -> Vec<MixedTask> {
        self.parts.iter().map(|part| part.task.clone()).collect()
    }

    /// Number of tasks.
    pub(super) const fn count(&self) -> usize {
        self.parts.len()
    }

    /// Which task a lane of this number has: they take turns, so that neither the batch's width
    /// nor the number of processes changes what a lane plays.
    #[must_use]
    pub fn task_of(&self, number: u64) -> usize {
        (number % self.parts.len() as u64) as usize
    }

    /// An environment of a task, as a lane of the mixture.
    #[must_use]
    pub fn lane(&self, task: usize, env: Box<dyn Environment>) -> Box<dyn Environment> {
        let part = Arc::clone(&self.parts[task]);
        let (own_actions, own_deltas) = (vec![0; part.choices.len()], vec![0.0; part.deltas.len()]);
        let costs = vec![0.0; part.terms.len()];
        Box::new(MixedLane { part, env, own_actions, own_deltas, costs })
    }
}

/// The environments of ids joined by commas: one, or those of a mixture.
pub(super) fn environments(ids: &str, options: &EnvOptions) -> Result<Vec<Env>, EnvError> {
    let mut options = options.clone();
    if ids.contains(',') {
        // The batch lays the tasks' own spaces out together.
        options.together = None;
    }
    ids.split(',').map(|id| Env::new(id.trim(), &options)).collect()
}

/// The sub-action of a space that has a group's buttons, and which of the group's choices each of
/// its choices is.
fn route(space: &ActionSpace, group: &ActionGroup) -> (usize, Vec<u8>) {
    let has = |name: &str| group.buttons.iter().position(|(own, _)| *own == name);
    let place = space
        .groups
        .iter()
        .position(|joined| joined.buttons.iter().any(|(name, _)| has(name).is_some()))
        .expect("the union has every task's buttons");
    let own =
        space.groups[place].buttons.iter().map(|(name, _)| has(name).map_or(0, |i| i as u8 + 1));
    (place, std::iter::once(0).chain(own).collect())
}

fn mask(space: &ActionSpace, own: &ActionSpace) -> Vec<bool> {
    let has =
        |name: &str| own.groups.iter().flat_map(|group| &group.buttons).any(|(n, _)| *n == name);
    let group = |group: &ActionGroup| {
        let buttons: Vec<bool> = group.buttons.iter().map(|(name, _)| has(name)).collect();
        std::iter::once(true).chain(buttons)
    };
    space.groups.iter().flat_map(group).collect()
}

/// Where each of `these` stands among `all`.
fn places<T: PartialEq>(these: &[T], all: &[T]) -> Vec<usize> {
    these
        .iter()
        .map(|one| all.iter().position(|other| other == one).expect("the union has every part"))
        .collect()
}

fn joined_terms(ids: &[EnvId]) -> Result<&'static [CostTerm], EnvError> {
    let mut terms: Vec<CostTerm> = Vec::new();
    for id in ids {
        for term in id.scenario.cost_terms() {
            match terms.iter().find(|known| known.name == term.name) {
                None => terms.push(*term),
                Some(known) if known.counted == term.counted => {}
                Some(_) => {
                    return Err(EnvError::Option {
                        option: "a mixed batch",
                        given: format!("the cost term `{}` of {id}", term.name),
                        allowed: "a name that counts in all of its tasks or in none".to_string(),
                    });
                }
            }
        }
    }
    for id in ids {
        let whole = CostTerm { name: intern(&id.to_string()), counted: false };
        if !terms.contains(&whole) {
            terms.push(whole);
        }
    }
    Ok(kept(terms))
}

/// The same terms, for as long as the program runs; each list is kept once.
fn kept(terms: Vec<CostTerm>) -> &'static [CostTerm] {
    static KEPT: Mutex<Vec<&'static [CostTerm]>> = Mutex::new(Vec::new());
    let mut lists = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = lists.iter().find(|known| ***known == *terms) {
        return known;
    }
    let list: &'static [CostTerm] = Box::leak(terms.into_boxed_slice());
    lists.push(list);
    list
}

/// A lane of a mixed batch.
struct MixedLane {
    part: Arc<Part>,
    env: Box<dyn Environment>,
    own_actions: Vec<u8>,
    own_deltas: Vec<f32>,
    costs: Vec<f64>,
}

impl MixedLane {
    fn lay_out_costs(&mut self, whole: f64) {
        self.costs.fill(0.0);
        self.costs[self.part.whole_cost] = whole;
        for (&place, &cost) in self.part.own_terms.iter().zip(self.env.step_costs()) {
            self.costs[place] = cost;
        }
    }
}

impl Environment for MixedLane {
    fn action_space(&self) -> &ActionSpace {
        &self.part.space
    }

    fn observation_shape(&self) -> [usize; 3] {
        self.env.observation_shape()
    }

    fn cost_terms(&self) -> &'static [CostTerm] {
        self.part.terms
    }

    fn fingerprint(&self) -> u64 {
        self.env.fingerprint()
    }

    fn reset(&mut self, seed: u64) {
        self.env.reset(seed);
        self.costs.fill(0.0);
    }

    fn step(&mut self, actions: &[u8], deltas: &[f32]) -> Step {
        for ((place, own), chosen) in self.part.choices.iter().zip(&mut self.own_actions) {
            *chosen = own[usize::from(actions[*place])];
        }
        for (&place, delta) in self.part.deltas.iter().zip(&mut self.own_deltas) {
            *delta = deltas[place];
        }
        let step = self.env.step(&self.own_actions, &self.own_deltas);
        self.lay_out_costs(step.cost);
        step
    }

    fn step_costs(&self) -> &[f64] {
        &self.costs
    }

    fn observe(&mut self, out: &mut [u8]) {
        self.env.observe(out);
    }

    fn observe_with(&mut self, out: &mut [u8], what: Insight, insight: &mut [u8]) {
        self.env.observe_with(out, what, insight);
    }

    fn position(&self) -> [i32; 2] {
        self.env.position()
    }

    /// None: the places of different maps have no extent together.
    fn extent(&self) -> Option<[i32; 4]> {
        None
    }

    fn stats(&self, stats: &mut Vec<(&'static str, f64)>) {
        let begin = stats.len();
        stats.extend(self.part.statistics.iter().map(|name| (*name, 0.0)));
        let end = stats.len();
        self.env.stats(stats);
        for (index, &place) in self.part.own_statistics.iter().enumerate() {
            stats[begin + place].1 = stats[end + index].1;
        }
        stats.truncate(end);
    }

    fn happenings(&self) -> &[Happening] {
        self.env.happenings()
    }

    fn episode(&self) -> Episode {
        let mut own = self.env.episode();
        let cost = own.cost;
        own.costs.push(EpisodeCost { name: self.part.name, counted: false, cost });
        Episode { task: Some(self.part.name), ..own }
    }
}
