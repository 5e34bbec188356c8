//! An environment shown tic by tic.

use crate::PlayError;
use hasard_engine::world::{Command, World};
use hasard_envs::{Env, EnvOptions, Snapshot, Step};

/// An environment whose agent acts every `frame_skip` tics while an audience sees every tic.
///
/// Two environments of the same episode run side by side: the one that counts, stepped as the task
/// says, and one that is stepped tic by tic with the same action held, for the eye. Worlds are
/// deterministic, so both are always at the same place at the end of a step; rewards, costs and
/// what the agent sees come from the first alone.
pub struct Stage {
    env: Env,
    shown: Env,
    /// Tics of the step in progress that were shown; 0 between steps.
    tics: u32,
    /// What is pressed during the step in progress.
    command: Command,
    last: Step,
}

/// A moment of a stage, to come back to.
#[derive(Clone, Debug)]
pub struct Moment {
    env: Snapshot,
    shown: Snapshot,
    tics: u32,
    command: Command,
    last: Step,
}

impl Stage {
    /// The environment with an id, at the start of the episode of seed 0.
    ///
    /// # Errors
    /// When the id or an option is unknown.
    pub fn new(id: &str, options: &EnvOptions) -> Result<Stage, PlayError> {
        Stage::shown_as(id, options, options)
    }

    /// The same, drawn for the audience as `looks` says (its pictures, depth and colours) and for
    /// the agent as `options` says.
    ///
    /// # Errors
    /// As [`Stage::new`].
    pub fn shown_as(
        id: &str,
        options: &EnvOptions,
        looks: &EnvOptions,
    ) -> Result<Stage, PlayError> {
        let shown = EnvOptions {
            frame_skip: 1,
            frame_stack: 1,
            // Maps that come with an IWAD are drawn with theirs.
            assets: looks.assets.clone(),
            published_depth: looks.published_depth,
            published_colours: looks.published_colours,
            ..options.clone()
        };
        let (env, shown) = (Env::new(id, options)?, Env::new(id, &shown)?);
        Ok(Stage { env, shown, tics: 0, command: Command::default(), last: Step::default() })
    }

    /// Another stage of the same kind, at the start of the episode of seed 0; map, pictures and
    /// tables are shared.
    #[must_use]
    pub fn sibling(&self) -> Stage {
        let (env, shown) = (self.env.sibling(), self.shown.sibling());
        Stage { env, shown, tics: 0, command: Command::default(), last: Step::default() }
    }

    /// Starts the episode of a seed.
    pub fn reset(&mut self, seed: u64) {
        self.env.reset(seed);
        self.shown.reset(seed);
        self.tics = 0;
        self.command = Command::default();
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
        self.command = self.env.action_space().command(actions, deltas);
        Ok(())
    }

    /// Chooses buttons for the step that begins, in the action space or not.
    pub fn press(&mut self, command: Command) {
        self.command = command;
    }

    /// Goes on by a tic. At the end of a step, gives what the step brought.
    pub fn tic(&mut self) -> Option<Step> {
        if self.ended() {
            return None;
        }
        let shown = self.shown.step_buttons(self.command);
        self.tics += 1;
        if self.tics < self.env.options().frame_skip && !shown.ended() {
            return None;
        }
        self.tics = 0;
        self.last = self.env.step_buttons(self.command);
        Some(self.last)
    }

    /// The present moment: the tic within the step, too.
    #[must_use]
    pub fn moment(&self) -> Moment {
        let (env, shown) = (self.env.snapshot(), self.shown.snapshot());
        Moment { env, shown, tics: self.tics, command: self.command, last: self.last }
    }

    /// Comes back to a moment of this stage.
    ///
    /// # Errors
    /// When it is of a stage that was made otherwise; nothing changes then.
    pub fn come_back(&mut self, moment: &Moment) -> Result<(), PlayError> {
        self.env.restore(&moment.env)?;
        self.shown.restore(&moment.shown)?;
        (self.tics, self.command, self.last) = (moment.tics, moment.command, moment.last);
        Ok(())
    }

    /// Writes what the agent sees: the observation of the environment that counts.
    ///
    /// # Panics
    /// If `out` is not as long as the product of the observation shape.
    pub fn observe(&mut self, out: &mut [u8]) {
        self.env.observe(out);
    }

    /// The environment that counts: returns, costs, statistics, as of the last whole step.
    #[must_use]
    pub fn env(&self) -> &Env {
        &self.env
    }

    /// The environment that is shown, as of the last tic: only for drawing it.
    pub(crate) fn shown(&self) -> &Env {
        &self.shown
    }

    /// The world as of the last tic.
    #[must_use]
    pub fn world(&self) -> &World {
        self.shown.world()
    }
}
