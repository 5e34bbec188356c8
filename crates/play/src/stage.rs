//! An environment shown tic by tic.

use crate::PlayError;
use hasard_engine::world::World;
use hasard_envs::{Env, EnvOptions, Step};

/// An environment whose agent acts every `frame_skip` tics while an audience sees every tic.
///
/// Two environments of the same episode run side by side: the one that counts, stepped as the task says, and one that is
/// stepped tic by tic with the same action held, for the eye. Worlds are deterministic, so both are always at the same
/// place at the end of a step; rewards and costs come from the first alone.
pub struct Stage {
    env: Env,
    shown: Env,
    /// Tics of the step in progress that were shown; 0 between steps.
    tics: u32,
    actions: Vec<u8>,
    deltas: Vec<f32>,
    last: Step,
}

impl Stage {
    /// The environment with an id, at the start of the episode of seed 0.
    ///
    /// # Errors
    /// When the id or an option is unknown.
    pub fn new(id: &str, options: &EnvOptions) -> Result<Stage, PlayError> {
        let env = Env::new(id, options)?;
        let shown = Env::new(id, &EnvOptions { frame_skip: 1, frame_stack: 1, ..options.clone() })?;
        let space = env.action_space();
        let (actions, deltas) = (vec![0; space.groups.len()], vec![0.0; space.deltas.len()]);
        Ok(Stage { env, shown, tics: 0, actions, deltas, last: Step::default() })
    }

    /// Starts the episode of a seed.
    pub fn reset(&mut self, seed: u64) {
        self.env.reset(seed);
        self.shown.reset(seed);
        self.tics = 0;
        self.last = Step::default();
    }

    /// Whether the agent is to act now: at the first tic of a step.
    #[must_use]
    pub fn wants_action(&self) -> bool {
        self.tics == 0 && !self.ended()
    }

    /// Whether the episode is over.
    #[must_use]
    pub fn ended(&self) -> bool {
        self.last.ended()
    }

    /// Chooses the action of the step that begins.
    ///
    /// # Errors
    /// When the action is not in the action space.
    pub fn act(&mut self, actions: &[u8], deltas: &[f32]) -> Result<(), PlayError> {
        self.env.action_space().check(0, actions, deltas)?;
        self.actions.copy_from_slice(actions);
        self.deltas.copy_from_slice(deltas);
        Ok(())
    }

    /// Goes on by a tic. At the end of a step, gives what the step brought.
    pub fn tic(&mut self) -> Option<Step> {
        if self.ended() {
            return None;
        }
        let shown = self.shown.step(&self.actions, &self.deltas);
        self.tics += 1;
        if self.tics < self.env.options().frame_skip && !shown.ended() {
            return None;
        }
        self.tics = 0;
        self.last = self.env.step(&self.actions, &self.deltas);
        Some(self.last)
    }

    /// The environment that counts: returns, costs, statistics, as of the last whole step.
    #[must_use]
    pub fn env(&self) -> &Env {
        &self.env
    }

    /// The world as of the last tic.
    #[must_use]
    pub fn world(&self) -> &World {
        self.shown.world()
    }
}
