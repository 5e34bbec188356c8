//! A world for tests of batches.

use hasard_envs::{ActionSpace, CostTerm, Environment, Episode, EpisodeCost, RuleSet, Step};
use std::hash::{DefaultHasher, Hash, Hasher};

/// A world that is nothing but a hash of its seed and actions; its episodes end after 3 to 18 steps
/// in one of two ways.
pub struct Echo {
    space: ActionSpace,
    seed: u64,
    state: u64,
    length: u32,
    last: Step,
    sum: f64,
    /// Panics when this step is reached.
    panics_at: u32,
    /// Its episodes report their cost terms, as they must.
    pub reports_costs: bool,
}

impl Echo {
    pub fn new(panics_at: u32) -> Echo {
        Echo::in_space(
            ActionSpace::of(
                "VolcanicVentureLevel1-v0".parse().unwrap(),
                RuleSet::Paper,
                false,
                true,
            ),
            panics_at,
        )
    }
    pub fn in_space(space: ActionSpace, panics_at: u32) -> Echo {
        Echo {
            space,
            seed: 0,
            state: 0,
            length: 0,
            last: Step::default(),
            sum: 0.0,
            panics_at,
            reports_costs: true,
        }
    }
}

pub fn hash(values: impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    values.hash(&mut hasher);
    hasher.finish()
}

impl Environment for Echo {
    fn action_space(&self) -> &ActionSpace {
        &self.space
    }
    fn observation_shape(&self) -> [usize; 3] {
        [2, 3, 2]
    }
    fn cost_terms(&self) -> &'static [CostTerm] {
        &[CostTerm { name: "all", counted: true }]
    }
    fn reset(&mut self, seed: u64) {
        (self.seed, self.state, self.length, self.last) = (seed, hash(seed), 0, Step::default());
        self.sum = 0.0;
    }
    fn step(&mut self, actions: &[u8], deltas: &[f32]) -> Step {
        self.length += 1;
        assert!(self.length != self.panics_at, "asked to panic");
        let bits: Vec<u32> = deltas.iter().map(|d| d.to_bits()).collect();
        self.state = hash((self.state, actions, bits));
        let over = self.length >= 3 + (self.seed % 16) as u32;
        let cost = f64::from((self.state >> 8) as u8);
        self.last = Step {
            reward: f64::from(self.state as u8),
            cost,
            terminated: over && self.seed & 16 == 0,
            truncated: over && self.seed & 16 != 0,
        };
        self.sum += cost;
        self.last
    }
    fn step_costs(&self) -> &[f64] {
        std::slice::from_ref(&self.last.cost)
    }
    fn observe(&mut self, out: &mut [u8]) {
        for (i, byte) in out.iter_mut().enumerate() {
            *byte = (self.state >> (i % 8 * 8)) as u8;
        }
    }
    fn position(&self) -> [i32; 2] {
        [self.last.cost as i32, self.last.reward as i32]
    }
    fn episode(&self) -> Episode {
        Episode {
            task: None,
            lane: 0,
            seed: self.seed,
            episode_return: 0.0,
            cost: self.sum,
            costs: vec![
                EpisodeCost { name: "all", counted: true, cost: self.sum };
                usize::from(self.reports_costs)
            ],
            length: self.length,
            terminated: self.last.terminated,
            truncated: self.last.truncated,
            stats: Vec::new(),
        }
    }
}
