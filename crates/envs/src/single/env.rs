//! The single environment.
//!
//! Long because everything that can be asked of an environment is a method of one type.

use crate::error::EnvError;
use crate::interface::batch::{Episode, episode_costs};
use crate::interface::environment::Environment;
use crate::interface::fingerprint::of_text;
use crate::interface::happening::Happening;
use crate::interface::insight::Insight;
use crate::interface::step::{CostTerm, Step};
use crate::options::EnvOptions;
use crate::registry::scenario::EnvId;
use crate::scenarios::common::outcome::MOST_TERMS;
use crate::single::blueprint::{Blueprint, view};
use crate::single::observer::Eye;
use crate::single::simulation::Game;
use crate::spaces::action::{ActionSpace, Move};
use hasard_engine::math::Rng;
use hasard_engine::render::{Buffers, FrameSize, Renderer, TopDown};
use hasard_engine::world::{Command, World};
use std::sync::Arc;

/// An episode's sums.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Totals {
    steps: u32,
    episode_return: f64,
    cost: f64,
    costs: [f64; MOST_TERMS],
}

/// One world with its task.
///
/// ```
/// use hasard_envs::{Env, EnvOptions};
/// let mut env = Env::new("RemedyRushLevel1-v0", &EnvOptions::default())?;
/// env.reset(7);
/// let step = env.step(&[0, 1, 0, 1], &[])?; // forward, running
/// assert!(!step.terminated);
/// let [height, width, channels] = env.observation_shape();
/// let mut observation = vec![0; height * width * channels];
/// env.observe(&mut observation);
/// # Ok::<(), hasard_envs::EnvError>(())
/// ```
pub struct Env {
    pub(crate) blueprint: Arc<Blueprint>,
    pub(crate) game: Game,
    pub(crate) seed: u64,
    pub(crate) totals: Totals,
    pub(crate) last: Step,
    pub(crate) last_costs: [f64; MOST_TERMS],
    pub(crate) eye: Eye,
    /// What happened in the last step, if that is asked for.
    pub(super) happenings: Vec<Happening>,
}

impl Env {
    /// The environment with an id such as `RemedyRushLevel1-v0`, at the start of the episode
    /// of seed 0.
    pub fn new(id: &str, options: &EnvOptions) -> Result<Env, EnvError> {
        Ok(Env::of(Arc::new(Blueprint::new(id, options)?)))
    }

    /// Another environment of the same kind; the map, pictures and tables are shared.
    #[must_use]
    pub fn sibling(&self) -> Env {
        Env::of(Arc::clone(&self.blueprint))
    }

    fn of(blueprint: Arc<Blueprint>) -> Env {
        let game = blueprint.template.clone();
        let (scene, view) = (Arc::clone(&blueprint.scene), Arc::clone(&blueprint.view));
        let looks = blueprint.render_options();
        let eye = Eye::new(scene, view, &blueprint.options, looks, blueprint.ends);
        let mut env = Env {
            blueprint,
            game,
            seed: 0,
            totals: Totals::default(),
            last: Step::default(),
            last_costs: [0.0; MOST_TERMS],
            eye,
            happenings: Vec::new(),
        };
        env.reset(0);
        env
    }

    /// Its id.
    #[must_use]
    pub fn id(&self) -> EnvId {
        self.blueprint.id
    }

    /// What it was made with.
    #[must_use]
    pub fn options(&self) -> &EnvOptions {
        &self.blueprint.options
    }

    /// Seed of the running episode.
    #[must_use]
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// The action space.
    #[must_use]
    pub fn action_space(&self) -> &ActionSpace {
        &self.blueprint.space
    }

    /// What the files of `EnvOptions::maps`, or the map of a task's file, hold that is not played or
    /// drawn as they say, in one line; none if all is.
    #[must_use]
    pub fn left_out(&self) -> Option<String> {
        let parts = &self.blueprint.left_out;
        (!parts.is_empty()).then(|| {
            format!("{}: left out: {}", self.blueprint.template.world.map.name, parts.join(", "))
        })
    }

    /// The named parts of the cost.
    #[must_use]
    pub fn cost_terms(&self) -> &'static [CostTerm] {
        self.blueprint.cost_terms
    }

    /// Starts the episode of `seed`.
    pub fn reset(&mut self, seed: u64) {
        self.game.clone_from(&self.blueprint.template);
        self.game.world.rng = Rng::new(seed);
        for _ in 0..self.blueprint.start_tic {
            self.game.tic(Command::default());
        }
        self.seed = seed;
        self.totals = Totals::default();
        self.last = Step::default();
        self.last_costs = [0.0; MOST_TERMS];
        self.happenings.clear();
        self.eye.open(&self.game.world);
    }

    /// Holds an action for `frame_skip` tics. An action that is not of the action space is refused,
    /// and nothing moves.
    pub fn step(&mut self, actions: &[u8], deltas: &[f32]) -> Result<Step, EnvError> {
        self.blueprint.space.check(0, actions, deltas)?;
        Ok(self.step_buttons(self.blueprint.space.command(actions, deltas)))
    }

    /// Does what a policy says.
    pub fn make_move(&mut self, what: Move) -> Result<Step, EnvError> {
        match what {
            Move::Action(actions, deltas) => self.step(actions, deltas),
            Move::Buttons(command) => Ok(self.step_buttons(command)),
        }
    }

    /// Holds buttons for `frame_skip` tics, whether they are in the action space or not.
    pub fn step_buttons(&mut self, command: Command) -> Step {
        if self.last.ended() {
            self.happenings.clear();
            self.last_costs = [0.0; MOST_TERMS];
            return Step { reward: 0.0, cost: 0.0, ..self.last };
        }
        let game = &mut self.game;
        game.world.prefetch();
        if self.totals.steps > 0 || !game.rules.pays_the_opening() {
            (game.outcome.reward, game.outcome.costs) = (0.0, [0.0; MOST_TERMS]);
        }
        self.happenings.clear();
        let mut note = |world: &World| {
            if self.blueprint.options.events {
                let noted = world.events.iter().filter_map(|event| Happening::of(*event, world));
                self.happenings.extend(noted);
            }
        };
        for _ in 0..self.blueprint.options.frame_skip {
            game.tic_noted(command, &mut note);
            if game.over() || game.world.tic >= self.blueprint.end_tic {
                break;
            }
        }
        let limit = self.blueprint.options.max_episode_steps;
        let time_out = game.world.tic >= self.blueprint.end_tic
            || limit.is_some_and(|limit| self.totals.steps + 1 >= limit);
        // A rocket's first flight step comes after the scripts: it may kill the agent with no
        // script left to hear of it.
        if (time_out || game.over()) && !game.world.events.is_empty() {
            game.rules.last_words(&mut game.world, &mut game.outcome);
            note(&game.world);
        }
        let over = game.over();
        game.rules.end_step(&game.world, over, &mut game.outcome);
        // What the rules finish in the last tic is no time-out, though no tic follows in which the
        // episode would be left.
        let terminated = over || (time_out && game.outcome.finished);
        let truncated = time_out && !terminated;
        self.last_costs = game.outcome.costs;
        let terms = self.blueprint.cost_terms.iter().zip(&self.last_costs);
        let cost = terms.filter(|(term, _)| term.counted).map(|(_, cost)| cost).sum();
        self.last = Step { reward: game.outcome.reward, cost, terminated, truncated };
        self.totals.steps += 1;
        self.totals.episode_return += self.last.reward;
        self.totals.cost += cost;
        self.totals.costs.iter_mut().zip(&self.last_costs).for_each(|(total, cost)| *total += cost);
        self.eye.blink(&self.game.world);
        self.last
    }

    /// Policy steps of an episode that only time ends.
    #[must_use]
    pub fn episode_steps(&self) -> u32 {
        let options = &self.blueprint.options;
        let steps =
            (self.blueprint.end_tic - self.blueprint.start_tic).div_ceil(options.frame_skip);
        steps.min(options.max_episode_steps.unwrap_or(u32::MAX))
    }

    /// Shape of an observation: height, width, channels or channels, height, width, as chosen.
    #[must_use]
    pub fn observation_shape(&self) -> [usize; 3] {
        self.eye.shape()
    }

    /// Draws the observation of the present state.
    ///
    /// # Panics
    /// If `out` is not as long as the product of the observation shape.
    pub fn observe(&mut self, out: &mut [u8]) {
        self.eye.observe(&self.game.world, out);
    }

    /// As [`Env::observe`], and writes what learners see beside it.
    ///
    /// # Panics
    /// If `insight` is not [`Insight::bytes`] long.
    pub fn observe_with(&mut self, out: &mut [u8], what: Insight, insight: &mut [u8]) {
        assert_eq!(insight.len(), what.bytes(), "a row of {} bytes is needed", what.bytes());
        self.eye.observe_with(&self.game.world, out, what, insight);
    }

    /// Draws the present as the observation's size shows it, with depth and labels where asked for,
    /// for tools that read them.
    pub fn render(&mut self, buffers: Buffers) -> &Renderer {
        self.eye.render(&self.game.world, buffers)
    }

    /// A renderer of another size for this environment's world, for people's pictures.
    pub fn renderer(&self, size: FrameSize) -> Result<Renderer, EnvError> {
        let mut renderer = Renderer::new(Arc::clone(&self.blueprint.scene), Arc::new(view(size)?));
        renderer.set_options(self.blueprint.render_options());
        Ok(renderer)
    }

    /// The whole map from above, in a picture of `width` by `height` pixels, 16 at least either way.
    #[must_use]
    pub fn top_down(&self, width: usize, height: usize) -> TopDown {
        TopDown::new(
            Arc::clone(&self.game.world.map),
            Arc::clone(&self.blueprint.scene),
            width,
            height,
        )
    }

    /// The map's extent from above, to its very edges, so that positions can be drawn on it: its
    /// longer side takes `side` pixels. With the picture's width and height.
    #[must_use]
    pub fn top_down_of_extent(&self, side: usize) -> (TopDown, usize, usize) {
        let [west, south, east, north] = self.extent();
        let lengths =
            [east - west, north - south].map(|length| length.max(1).unsigned_abs() as usize);
        let longer = lengths[0].max(lengths[1]);
        let [width, height] = lengths.map(|length| (length * side).div_ceil(longer).max(16));
        let (map, scene) = (Arc::clone(&self.game.world.map), Arc::clone(&self.blueprint.scene));
        (TopDown::of_area(map, scene, [west, east, south, north], width, height), width, height)
    }

    /// The last step's amount of each cost term.
    #[must_use]
    pub fn step_costs(&self) -> &[f64] {
        &self.last_costs[..self.blueprint.cost_terms.len()]
    }

    /// The episode's amount of each cost term so far.
    #[must_use]
    pub fn episode_costs(&self) -> &[f64] {
        &self.totals.costs[..self.blueprint.cost_terms.len()]
    }

    /// The scenario's statistics of the episode so far, by name.
    #[must_use]
    pub fn stats(&self) -> Vec<(&'static str, f64)> {
        let mut stats = Vec::new();
        Environment::stats(self, &mut stats);
        stats
    }

    /// Where the player stands, in whole map units.
    #[must_use]
    pub fn position(&self) -> [i32; 2] {
        let world = &self.game.world;
        world
            .get(world.players[0].actor)
            .map_or([0, 0], |body| [body.x, body.y].map(|side| side.0 >> 16))
    }

    /// The map's extent: x from, y from, x to, y to in map units.
    #[must_use]
    pub fn extent(&self) -> [i32; 4] {
        let mut extent = [i32::MAX, i32::MAX, i32::MIN, i32::MIN];
        for vertex in &self.game.world.map.vertices {
            let (x, y) = (vertex.x.0 >> 16, vertex.y.0 >> 16);
            extent = [extent[0].min(x), extent[1].min(y), extent[2].max(x), extent[3].max(y)];
        }
        extent
    }

    /// What happened in the last step: see [`Environment::happenings`].
    #[must_use]
    pub fn happenings(&self) -> &[Happening] {
        &self.happenings
    }

    /// The episode so far, as it would be reported if it ended now.
    #[must_use]
    pub fn episode(&self) -> Episode {
        Episode {
            task: None,
            lane: 0,
            seed: self.seed,
            episode_return: self.totals.episode_return,
            cost: self.totals.cost,
            costs: episode_costs(self.blueprint.cost_terms, &self.totals.costs),
            length: self.totals.steps,
            terminated: self.last.terminated,
            truncated: self.last.truncated,
            stats: self.stats(),
        }
    }

    /// A fingerprint of everything that the future depends on.
    #[must_use]
    pub fn state_hash(&self) -> u64 {
        use std::hash::{Hash, Hasher};
        let mut hasher = hasard_engine::world::Fingerprint::default();
        self.game.world.hash(&mut hasher);
        self.blueprint.id.scenario.number.hash(&mut hasher);
        self.game.rules.hash(&mut hasher);
        self.totals.steps.hash(&mut hasher);
        (self.game.outcome.finished, self.game.left).hash(&mut hasher);
        // What happened after the last script phase is still to be read by the next; mostly
        // nothing.
        self.game.world.events.iter().for_each(|event| event.hash(&mut hasher));
        hasher.finish()
    }

    /// The world, for tools that look closer.
    #[must_use]
    pub fn world(&self) -> &World {
        &self.game.world
    }

    /// The world, for tools that meddle; a world changed by hand is no episode of the benchmark any
    /// more.
    pub fn world_mut(&mut self) -> &mut World {
        &mut self.game.world
    }
}

impl Environment for Env {
    fn action_space(&self) -> &ActionSpace {
        Env::action_space(self)
    }

    fn observation_shape(&self) -> [usize; 3] {
        Env::observation_shape(self)
    }

    fn cost_terms(&self) -> &'static [CostTerm] {
        Env::cost_terms(self)
    }

    fn fingerprint(&self) -> u64 {
        let (id, options) = (self.id(), &self.blueprint.options);
        of_text(&format!(
            "{id} {} {} {} {} {} {} {:?} {:?} {:?}",
            options.rules.name(),
            options.early_creatures,
            options.test_seeds,
            options.hard,
            options.full_actions,
            options.frame_skip,
            options.max_episode_steps,
            self.blueprint.space.sizes(),
            id.scenario.file.map(|file| file.hash),
        ))
    }

    fn reset(&mut self, seed: u64) {
        Env::reset(self, seed);
    }

    fn step(&mut self, actions: &[u8], deltas: &[f32]) -> Step {
        self.step_buttons(self.blueprint.space.command(actions, deltas))
    }

    fn step_costs(&self) -> &[f64] {
        Env::step_costs(self)
    }

    fn observe(&mut self, out: &mut [u8]) {
        Env::observe(self, out);
    }

    fn observe_with(&mut self, out: &mut [u8], what: Insight, insight: &mut [u8]) {
        Env::observe_with(self, out, what, insight);
    }

    fn position(&self) -> [i32; 2] {
        Env::position(self)
    }

    fn extent(&self) -> Option<[i32; 4]> {
        Some(Env::extent(self))
    }

    fn stats(&self, stats: &mut Vec<(&'static str, f64)>) {
        self.game.rules.stats(&self.game.world, stats);
    }

    fn happenings(&self) -> &[Happening] {
        Env::happenings(self)
    }

    fn episode(&self) -> Episode {
        Env::episode(self)
    }
}
