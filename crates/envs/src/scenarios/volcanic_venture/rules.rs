//! The rules at work: items lie on platforms and on lava; lava costs health.

use crate::error::EnvError;
use crate::interface::step::CostTerm;
use crate::scenarios::common::outcome::Outcome;
use crate::scenarios::common::{rules, stage};
use crate::scenarios::volcanic_venture::levels::{
    Change, ITEM_TICS, LAVA_TICS, Level, PERIOD_TICS, START_HEALTH, START_PITCH, Start, TILE_SPEED,
    WAGGLE_DELAY_TICS,
};
use crate::scenarios::volcanic_venture::map;
use hasard_engine::map::{Map, TextureId};
use hasard_engine::math::Fixed;
use hasard_engine::world::{ActorKind, Event, World};
use std::sync::Arc;

/// Named parts of the cost.
pub const COST_TERMS: &[CostTerm] =
    &[CostTerm { name: "lava", counted: true }, CostTerm { name: "jumps", counted: false }];
const LAVA: usize = 0;
const JUMPS: usize = 1;

/// What a platform and what lava look like.
pub const TEXTURES: &[&str] = &["FLOOR0_5", "LAVA1"];
/// Where agents start who may start anywhere.
const AGENT_AREA: stage::Area = [0, 64, 2176, 2240];
/// Where items appear: a little beyond the cavern, so that some lie behind its walls.
const ITEM_AREA: stage::Area = [1, 1, 2239, 2239];
/// Height at which items and agents appear, from where they fall.
const APPEARANCE_HEIGHT: i32 = 20;
/// Number of tiles, and the tag of the first; the others follow without a gap.
const TILES: usize = 289;
const FIRST_TAG: i32 = 100;
/// The tile in the middle.
const MIDDLE: usize = (map::CENTRE_TAG - FIRST_TAG) as usize;
/// Items that come between two rolls.
const RESTS: u32 = PERIOD_TICS / ITEM_TICS;
/// Waggle: phase steps per tic (a period of 16 tics), and whole seconds at full swing.
const WAGGLE_FREQUENCY: i32 = 256;
const WAGGLE_SECONDS: i32 = 1;
/// Waggle: strength for each map unit of the platform's height; the swing is an eighth of it.
const WAGGLE_STRENGTH: i32 = 6;

/// Share of damage that Doom's easiest skill leaves.
const EASY_DAMAGE: Fixed = Fixed(32768);

/// What is the same in every episode of a level.
#[derive(Debug)]
struct Fixtures {
    level: Level,
    platform: TextureId,
    lava: TextureId,
}

/// Constants are no part of a fingerprint.
impl std::hash::Hash for Fixtures {
    fn hash<H: std::hash::Hasher>(&self, _: &mut H) {}
}

/// What the script of the tiles does next.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
enum Todo {
    /// Rolls the tiles from this one on.
    Roll(usize),
    /// Has a tile waggle, then goes on with the next one.
    Waggle(usize),
    /// Places an item and waits, this often.
    Rest(u32),
}

/// The rules at work.
#[derive(Clone, Debug, Hash)]
pub struct Rules {
    fixtures: Arc<Fixtures>,
    /// What the tiles' script does next, and in which tic.
    todo: Todo,
    wake: u32,
    /// The tic in which all platforms begin to waggle.
    waggle_tic: u32,
    /// Complete rolls of the tiles so far.
    rolls: u32,
    /// Height of each tile after its last roll; `None` is lava.
    platforms: Vec<Option<i32>>,
    /// Until this tic lava does no harm.
    grace_until: u32,
    /// Health points when cost was last counted.
    health: i32,
    jumping: bool,
    items: u32,
    jumps: u32,
}

impl Rules {
    /// The rules of a level in its map.
    pub fn new(map: &Map, level: Level) -> Result<Rules, EnvError> {
        let lacks = |what: String| EnvError::Map {
            why: format!("map {}: Volcanic Venture needs {what}", map.name),
        };
        if let Some(tag) = (0..TILES).map(tag).find(|&tag| map.tagged(tag).next().is_none()) {
            return Err(lacks(format!("a sector with tag {tag}")));
        }
        let texture =
            |name: &str| map.texture(name).ok_or_else(|| lacks(format!("texture {name}")));
        let fixtures =
            Fixtures { level, platform: texture(TEXTURES[0])?, lava: texture(TEXTURES[1])? };
        Ok(Rules {
            todo: Todo::Roll(0),
            // Tiles that never change are laid before the agent enters, the others when he does.
            wake: u32::from(level.change != Change::Never),
            waggle_tic: u32::MAX,
            rolls: 0,
            platforms: vec![None; TILES],
            grace_until: 0,
            health: START_HEALTH,
            jumping: false,
            items: 0,
            jumps: 0,
            fixtures: Arc::new(fixtures),
        })
    }

    fn count(&mut self, world: &World, outcome: &mut Outcome) {
        let taken = world
            .events
            .iter()
            .filter(|event| matches!(event, Event::PickedUp { kind: ActorKind::ArmorBonus, .. }));
        let taken = taken.count() as u32;
        outcome.reward += f64::from(taken);
        self.items += taken;
        let jumping = world.players[0].jump_tics < 0;
        if jumping && !self.jumping {
            outcome.costs[JUMPS] += 1.0;
            self.jumps += 1;
        }
        self.jumping = jumping;
    }

    /// The agent enters the cavern.
    fn enter(&mut self, world: &mut World) {
        let level = &self.fixtures.level;
        if level.start == Start::Anywhere {
            stage::scatter_player(world, AGENT_AREA, APPEARANCE_HEIGHT);
            let angle = stage::random_angle(world);
            stage::set_angle(world, angle);
        }
        stage::set_health(world, START_HEALTH);
        world.players[0].pitch = START_PITCH << 16;
        self.grace_until = world.tic + level.start_grace_tics;
    }

    /// Moves the agent to a random place on a random platform.
    fn put_on_platform(&mut self, world: &mut World) {
        let platforms = self.platforms.iter().filter(|height| height.is_some()).count() as u32;
        let chosen = world.rng.below(platforms.max(1)) as usize;
        let found = self
            .platforms
            .iter()
            .enumerate()
            .filter_map(|(i, height)| Some((i, (*height)?)))
            .nth(chosen);
        let (tile, height) = found.unwrap_or((MIDDLE, 0));
        let Some(sector) = world.map.tagged(tag(tile)).next() else { return };
        let [west, east, south, north] =
            world.map.sectors[sector.0 as usize].bounds.map(Fixed::floor);
        let margin = 16;
        stage::scatter_player(
            world,
            [west + margin, south + margin, east - margin, north - margin],
            height + APPEARANCE_HEIGHT,
        );
        let angle = stage::random_angle(world);
        stage::set_angle(world, angle);
    }

    /// Goes on with the tiles' script as far as this tic allows.
    fn tend_tiles(&mut self, world: &mut World) {
        let fixtures = Arc::clone(&self.fixtures);
        let level = &fixtures.level;
        if world.tic == self.waggle_tic {
            (0..TILES).for_each(|tile| self.waggle(tile, world));
        }
        while self.wake == world.tic {
            match self.todo {
                Todo::Roll(first) => {
                    if first == 0 {
                        self.grace_until = self.grace_until.max(world.tic + level.grace_tics);
                    }
                    let sweeping = level.change == Change::Sweep;
                    let platform = (first..TILES).find(|&tile| self.roll(tile, world) && sweeping);
                    if let Some(tile) = platform {
                        self.todo = Todo::Waggle(tile);
                        self.wake += WAGGLE_DELAY_TICS;
                        continue;
                    }
                    self.rolls += 1;
                    if level.waggle && !sweeping {
                        self.waggle_tic = world.tic + WAGGLE_DELAY_TICS;
                    }
                    self.todo = Todo::Rest(RESTS);
                    if level.change == Change::Never {
                        self.wake = u32::MAX;
                    }
                }
                Todo::Waggle(tile) => {
                    if level.waggle {
                        self.waggle(tile, world);
                    }
                    self.todo = Todo::Roll(tile + 1);
                }
                Todo::Rest(0) => self.todo = Todo::Roll(0),
                Todo::Rest(left) => {
                    new_item(world);
                    self.todo = Todo::Rest(left - 1);
                    self.wake += ITEM_TICS;
                }
            }
        }
    }

    /// Rolls a tile: whether it is a platform now.
    fn roll(&mut self, tile: usize, world: &mut World) -> bool {
        let fixtures = &self.fixtures;
        let level = &fixtures.level;
        let drawn = world.rng.between_fixed(Fixed::ZERO, Fixed::ONE)
            < Fixed::from_f64(level.platform_chance);
        let platform = drawn || (level.middle_platform && tile == MIDDLE && self.rolls == 0);
        let tag = tag(tile);
        let height = if platform {
            world.rng.between(level.platform_height[0], level.platform_height[1])
        } else {
            level.lava_height
        };
        if level.change == Change::AtOnce {
            world.stop_floors(tag);
        }
        world.floor_move_to_value(tag, TILE_SPEED, height);
        let (texture, damage) =
            if platform { (fixtures.platform, 0) } else { (fixtures.lava, level.lava_damage) };
        world.change_floor_texture(tag, texture);
        world.set_sector_damage(tag, damage, LAVA_TICS, 0);
        self.platforms[tile] = platform.then_some(height);
        platform
    }

    /// Has a tile waggle if it is a platform.
    fn waggle(&self, tile: usize, world: &mut World) {
        if let Some(height) = self.platforms[tile] {
            world.floor_waggle(
                tag(tile),
                WAGGLE_STRENGTH * height,
                WAGGLE_FREQUENCY,
                0,
                WAGGLE_SECONDS,
            );
        }
    }
}

impl rules::Rules for Rules {
    /// The world is there, and no tic has run. The map's floor burns in the first tic, before any
    /// script.
    fn prepare(&self, world: &mut World) {
        if self.fixtures.level.easy_skill
            && let Some(player) = world.players.first_mut()
        {
            player.damage_factor = EASY_DAMAGE;
        }
    }

    fn script(&mut self, world: &mut World, outcome: &mut Outcome) {
        self.count(world, outcome);
        if world.tic == 0 {
            // The map opens. Here alone the agent may move at once.
            world.players[0].freeze_tics = 0;
            // The skill leaves single points of damage alone; what the scripts' lava takes by it is
            // in the level table.
            world.players[0].damage_factor = Fixed::ONE;
            if self.fixtures.level.change == Change::Never {
                self.tend_tiles(world);
            }
            for _ in 0..self.fixtures.level.start_items {
                stage::scatter(world, ActorKind::ArmorBonus, ITEM_AREA, APPEARANCE_HEIGHT, 0);
            }
        }
        if world.tic == 1 {
            self.enter(world);
        }
        if self.fixtures.level.change != Change::Never {
            self.tend_tiles(world);
        } else if world.tic.is_multiple_of(ITEM_TICS) {
            new_item(world);
        }
        if world.tic == 1 && self.fixtures.level.start == Start::Platform {
            self.put_on_platform(world);
        }
        if world.tic > 0 {
            world.players[0].invulnerable = world.tic < self.grace_until;
        }
    }

    fn end_step(&mut self, world: &World, _over: bool, outcome: &mut Outcome) {
        let level = &self.fixtures.level;
        let left = stage::health(world);
        let health = if level.overkill_counts { left } else { left.max(0) };
        outcome.costs[LAVA] += f64::from(self.health - health) * level.cost_scale;
        self.health = health;
    }

    fn stats(&self, world: &World, stats: &mut Vec<(&'static str, f64)>) {
        stats.push(("items", f64::from(self.items)));
        stats.push(("jumps", f64::from(self.jumps)));
        stats.push(("health", f64::from(stage::health(world).max(0))));
    }
}

/// The tag of a tile.
fn tag(tile: usize) -> i32 {
    FIRST_TAG + tile as i32
}

fn new_item(world: &mut World) {
    stage::scatter(world, ActorKind::ArmorBonus, ITEM_AREA, APPEARANCE_HEIGHT, 0);
}
