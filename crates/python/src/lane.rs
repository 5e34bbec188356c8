//! An environment that its batch steps and its owner looks at.

use hasard_envs::{ActionSpace, CostTerm, Env, Environment, Episode, Happening, Step};
use std::sync::{Arc, Mutex, MutexGuard};

/// An environment shared between a batch, which steps it, and the object that Python holds, which
/// draws and names its present between steps. Nobody ever waits for the lock: a step and a look
/// never overlap.
pub struct SharedEnv {
    env: Arc<Mutex<Env>>,
    space: ActionSpace,
    shape: [usize; 3],
    terms: &'static [CostTerm],
    costs: Vec<f64>,
    happenings: Vec<Happening>,
}

impl SharedEnv {
    pub fn new(env: Env) -> SharedEnv {
        let (space, shape, terms) =
            (env.action_space().clone(), env.observation_shape(), env.cost_terms());
        SharedEnv {
            env: Arc::new(Mutex::new(env)),
            space,
            shape,
            terms,
            costs: vec![0.0; terms.len()],
            happenings: Vec::new(),
        }
    }

    /// The environment, for callers that look at it.
    pub fn handle(&self) -> Arc<Mutex<Env>> {
        Arc::clone(&self.env)
    }

    fn lock(&self) -> MutexGuard<'_, Env> {
        lock(&self.env)
    }
}

/// The environment behind a handle. After a panic the batch is closed, so that its state no longer
/// matters.
pub fn lock(env: &Mutex<Env>) -> MutexGuard<'_, Env> {
    env.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

impl Environment for SharedEnv {
    fn action_space(&self) -> &ActionSpace {
        &self.space
    }

    fn observation_shape(&self) -> [usize; 3] {
        self.shape
    }

    fn cost_terms(&self) -> &'static [CostTerm] {
        self.terms
    }

    fn reset(&mut self, seed: u64) {
        self.lock().reset(seed);
        self.costs.fill(0.0);
        self.happenings.clear();
    }

    fn step(&mut self, actions: &[u8], deltas: &[f32]) -> Step {
        let mut env = lock(&self.env);
        let step = Environment::step(&mut *env, actions, deltas);
        self.costs.copy_from_slice(env.step_costs());
        self.happenings.clear();
        self.happenings.extend_from_slice(env.happenings());
        step
    }

    fn step_costs(&self) -> &[f64] {
        &self.costs
    }

    fn observe(&mut self, out: &mut [u8]) {
        self.lock().observe(out);
    }

    fn position(&self) -> [i32; 2] {
        self.lock().position()
    }

    fn extent(&self) -> Option<[i32; 4]> {
        Some(self.lock().extent())
    }

    fn stats(&self, stats: &mut Vec<(&'static str, f64)>) {
        Environment::stats(&*self.lock(), stats);
    }

    fn happenings(&self) -> &[Happening] {
        &self.happenings
    }

    fn episode(&self) -> Episode {
        self.lock().episode()
    }
}
