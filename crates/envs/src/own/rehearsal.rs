//! A few tics of a task that nobody has registered: what only shows in play is found before.

use super::model::Plan;
use super::program::Program;
use super::rules::{OwnRules, Unplaced};
use crate::EnvError;
use crate::scenarios::AnyRules;
use crate::single::simulation::Game;
use hasard_engine::map::{Map, MapSource};
use hasard_engine::math::Rng;
use hasard_engine::world::{Buttons, Command, World};
use std::sync::Arc;

/// Plays some tics of a plan with buttons at random, and gives what there was no room for.
pub(super) fn rehearse(
    plan: &Plan,
    source: &MapSource,
    counters: usize,
    seed: u64,
    tics: u32,
) -> Result<Arc<Unplaced>, EnvError> {
    let map = Map::build(source, &plan.name, &[])
        .map_err(|error| EnvError::Map { why: error.to_string() })?;
    let program = Program::new(plan.clone(), &map, &[])?;
    let unplaced = Arc::new(Unplaced::default());
    let mut rules = OwnRules::new(Arc::new(program), counters);
    rules.unplaced = Some(Arc::clone(&unplaced));
    let rules = AnyRules::new(rules);
    let mut world = World::new(Arc::new(map), seed);
    rules.prepare(&mut world);
    let mut game = Game::new(world, rules);
    let mut random = Rng::new(seed);
    for _ in 0..tics {
        let buttons = Buttons(random.next_u64() as u32 & 0xFFFF);
        game.tic(Command { buttons, ..Command::default() });
        if game.over() {
            break;
        }
        let over = game.over();
        game.rules.end_step(&game.world, over, &mut game.outcome);
    }
    Ok(unplaced)
}
