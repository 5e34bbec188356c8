//! What the environments of one id and one set of options share.

use crate::error::EnvError;
use crate::interface::step::CostTerm;
use crate::maps::say_of_task;
use crate::options::EnvOptions;
use crate::registry::facts;
use crate::registry::scenario::EnvId;
use crate::scenarios::common::rules::AnyRules;
use crate::scenarios::common::spec::{Setting, misplaced};
use crate::single::lookout::Ends;
use crate::single::simulation::Game;
use crate::spaces::action::ActionSpace;
use hasard_engine::assets::Assets;
use hasard_engine::map::Map;
use hasard_engine::render::{FrameSize, RenderOptions, Scene, View};
use hasard_engine::simd::{Simd, SimdError};
use hasard_engine::world::World;
use std::sync::Arc;

/// What is the same in every episode of an environment, shared by all that are made alike.
#[derive(Debug)]
pub(crate) struct Blueprint {
    pub id: EnvId,
    pub options: EnvOptions,
    pub space: ActionSpace,
    pub cost_terms: &'static [CostTerm],
    /// Completed tics at the first observation, and at the time-out.
    pub start_tic: u32,
    pub end_tic: u32,
    /// What the map's file holds that is not played or drawn as it says.
    pub left_out: Vec<String>,
    /// The world before its first tic.
    pub template: Game,
    pub scene: Arc<Scene>,
    pub view: Arc<View>,
    /// The map's ends.
    pub ends: Ends,
}

/// Whether a world has somebody to play: else the line that names the map and the remedy.
pub(crate) fn has_start(world: &World) -> Result<(), EnvError> {
    if world.players.is_empty() {
        let why = format!("map {}: no player start; add a thing of type 1", world.map.name);
        return Err(EnvError::Map { why });
    }
    Ok(())
}

impl Blueprint {
    pub fn new(id: &str, options: &EnvOptions) -> Result<Blueprint, EnvError> {
        let id = EnvId::within(options.scenario, id)?;
        options.check()?;
        Simd::chosen().map_err(|error| EnvError::Option {
            option: "the variable HASARD_SIMD",
            given: error.given,
            allowed: SimdError::allowed(),
        })?;
        let (built_in, textures) = facts::map_source(id, options.rules, options.hard);
        let file = match (&options.map, &options.maps) {
            (None, Some(maps)) => Some(maps.level(id, options.rules, options.hard)?),
            _ => None,
        };
        let given = options.map.as_deref().or(file.as_ref().map(|file| &file.source));
        let name = file.as_ref().map_or_else(|| id.to_string(), |file| file.name.clone());
        let map = Map::build(given.unwrap_or(&built_in), &name, textures)
            .map_err(|error| EnvError::Map { why: format!("map {name}: {error}") })?;
        let rules = rules(id, options, &map)?;
        let own_assets = file.as_ref().and_then(|file| file.assets.clone());
        let as_published = own_assets.is_some();
        let scene = Scene::new(
            &map,
            own_assets.or(options.assets.clone()).unwrap_or_else(Assets::embedded),
        );
        let mut world = World::new(Arc::new(map), 0);
        // Only this scenario's published settings draw them. Worlds of our own leave them out: they
        // cost a third of a step.
        world.rockets_shed = id.scenario.rockets_shed && as_published;
        has_start(&world)?;
        rules.prepare(&mut world);
        let ends = Ends::of(&world);
        let left_out = match (file, &options.map) {
            (Some(file), _) => file.left_out,
            (None, Some(_)) => Vec::new(),
            // The folder of maps says it itself as it reads one.
            (None, None) => {
                let left_out = id.scenario.task.left_out(id.setting(options.rules, options.hard));
                say_of_task(id, &left_out);
                left_out
            }
        };
        let (start_tic, end_tic) = facts::clock(id, options.rules, options.hard);
        if start_tic >= end_tic {
            return Err(EnvError::Option {
                option: "a task's clock",
                given: format!("{start_tic} to {end_tic}"),
                allowed: "a first tic before the last".to_string(),
            });
        }
        let (whose_rules, whose_constraint) = options.actions_of();
        let space = ActionSpace::of(id, whose_rules, whose_constraint, options.full_actions);
        // Its names may come to be those of another file: these worlds stay of this one.
        let scenario = options.scenario.or(id.scenario.file.map(|_| id.scenario));
        Ok(Blueprint {
            id,
            options: EnvOptions { scenario, ..options.clone() },
            space: space.within(options.together.clone()),
            cost_terms: facts::cost_terms(id.scenario),
            start_tic,
            end_tic,
            template: Game::new(world, rules),
            left_out,
            scene: Arc::new(scene),
            view: Arc::new(view(options.size)?),
            ends,
        })
    }

    /// What every renderer of this environment draws in its own way.
    pub fn render_options(&self) -> RenderOptions {
        RenderOptions {
            green_goggles: self.template.rules.green_goggles(),
            published_depth: self.options.published_depth,
        }
    }
}

/// The tables of a frame size, or what is wrong with it.
pub(crate) fn view(size: FrameSize) -> Result<View, EnvError> {
    let allowed = "64x48 to 1920x1080".to_string();
    View::new(size).map_err(|_| EnvError::Option {
        option: "the frame size",
        given: size.to_string(),
        allowed,
    })
}

/// The rules of an environment in its map.
fn rules(id: EnvId, options: &EnvOptions, map: &Map) -> Result<AnyRules, EnvError> {
    if options.early_creatures && !id.scenario.early_creatures {
        return Err(misplaced());
    }
    let (early_creatures, test_seeds) = (options.early_creatures, options.test_seeds);
    let setting =
        Setting { early_creatures, test_seeds, ..id.setting(options.rules, options.hard) };
    if test_seeds && !id.scenario.task.has_test_seeds(setting) {
        let allowed =
            "false, except in a task with `train_seeds` in its [map.generate]".to_string();
        return Err(EnvError::Option { option: "test_seeds", given: "true".to_string(), allowed });
    }
    id.scenario.task.rules(setting, map)
}
