//! What a file says of one setting, read and checked: numbers in place of names. Nothing is looked
//! up by name while a world runs.

use hasard_engine::world::{ActorKind, Weapon};

/// Most of each, so that a file is bounded in memory and time.
pub(super) const MOST_ZONES: usize = 32;
pub(super) const MOST_SPAWNS: usize = 64;
pub(super) const MOST_WHENS: usize = 128;
pub(super) const MOST_COUNTERS: usize = 32;
pub(super) const MOST_LIGHTS: usize = 32;

/// The names that levels share, numbered by their first appearance.
#[derive(Clone, Debug, Default)]
pub(super) struct Names {
    pub terms: Vec<Term>,
    pub counters: Vec<String>,
}

/// A cost term.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Term {
    pub name: String,
    pub counted: bool,
}

/// A setting's whole task.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    pub name: String,
    pub title: String,
    pub summary: String,
    pub budget: f64,
    pub tics: u32,
    pub actions: Vec<Vec<&'static str>>,
    pub map: MapPlan,
    /// What `[map]` says that its kind of map does not ask for.
    pub idle: Vec<Idle>,
    pub zones: Vec<Zone>,
    pub player: PlayerPlan,
    pub spawns: Vec<Spawn>,
    pub whens: Vec<When>,
    pub lights: Vec<Light>,
    /// Cost terms whose amounts end the episode, a bit each.
    pub end_on: u32,
    pub green_goggles: bool,
}

/// A field of a map without effect.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Idle {
    pub field: String,
    pub at: usize,
    /// Where it has one.
    pub instead: &'static str,
}

/// Where the world comes from.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum MapPlan {
    Tiles(Tiles),
    /// That of a built-in scenario at a level.
    BuiltIn(crate::Scenario, u8),
    /// That of a WAD or of a UDMF text.
    Drawn(std::sync::Arc<DrawnMap>),
}

/// A map of a WAD or of a UDMF text.
#[derive(PartialEq, Debug)]
pub(super) struct DrawnMap {
    pub source: hasard_engine::map::MapSource,
    /// What its file holds that is not played as it says.
    pub left_out: Vec<String>,
}

/// A map of square tiles.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Tiles {
    /// Side of a tile, map units.
    pub side: i32,
    pub columns: usize,
    pub rows: usize,
    /// The kind of each tile, row by row from the south-west; an index into `kinds`.
    pub tiles: Vec<u8>,
    pub kinds: Vec<TileKind>,
    /// The tiles are closed and opened at each reset.
    pub generate: Option<Generate>,
}

/// What the tiles of a letter are.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TileKind {
    pub letter: char,
    pub rock: bool,
    /// Lowest and highest floor: drawn anew for each tile at each reset where they differ.
    pub floor: [i32; 2],
    pub ceiling: i32,
    pub light: i32,
    pub floor_texture: &'static str,
    pub ceiling_texture: &'static str,
    /// Of rock: how it looks. Of ground: walls around it where the rock says nothing.
    pub wall: Option<&'static str>,
    pub step: &'static str,
    pub zone: Option<u8>,
    /// Points and tics between.
    pub damage: Option<[i32; 2]>,
    pub start: bool,
    pub start_angle: i32,
    pub thing: Option<ActorKind>,
    /// Height and period of a swinging floor.
    pub waggle: Option<[i32; 2]>,
}

/// How a map is made anew at each reset.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Generate {
    pub kind: GenerateKind,
    /// Share of tiles that become columns or platforms, of 1000.
    pub share: u32,
    /// Side of a room, tiles.
    pub room: u32,
    /// Ends of corridors that are opened, of 1000: a maze without any has one way alone.
    pub loops: u32,
    /// Lowest and highest platform.
    pub heights: [i32; 2],
    /// Different levels in training, 0 for as many as there are seeds.
    pub train_seeds: u32,
}

/// The kinds of generated maps.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum GenerateKind {
    Maze,
    Rooms,
    Columns,
    Platforms,
}

/// A part of the map with a name.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Zone {
    pub name: String,
    /// A rectangle: west, south, east, north.
    pub area: Option<[i32; 4]>,
    /// Sectors with tags from the first to the last.
    pub tags: Option<[i32; 2]>,
}

/// A place to put something.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Place {
    /// Anywhere that does not hurt.
    Free,
    Zone(u8),
    /// West, south, east, north.
    Area([i32; 4]),
}

/// A height to put something at.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Height {
    Above(i32),
    At(i32),
}

/// Which way the agent looks at the start.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Facing {
    Map,
    Random,
    Degrees(i32),
}

/// The agent at the start.
#[derive(Clone, Debug)]
pub(super) struct PlayerPlan {
    pub at: usize,
    pub place: Option<Place>,
    pub height: Height,
    pub facing: Facing,
    pub health: i32,
    pub armor: i32,
    pub weapons: Vec<Weapon>,
    pub ammo: [Option<i32>; 4],
    pub speed: f64,
}

/// What a monster does.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Goal {
    /// Stands.
    None,
    /// To one random place after the other.
    Wander,
    /// After the agent.
    Chase,
    /// From zone to zone, and again from the first.
    Patrol(Vec<u8>),
}

/// Things that appear.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Spawn {
    pub name: Option<String>,
    pub at: usize,
    /// Kinds by weight.
    pub kinds: Vec<(ActorKind, u32)>,
    pub count: u32,
    /// Tics between supplies, 0 for none; the tic of the first; how many each brings.
    pub every: u32,
    pub first: u32,
    pub each: u32,
    /// A field about supplies, and where it stands, though there are none.
    pub idle: Option<(&'static str, usize)>,
    pub place: Place,
    pub height: Height,
    /// Inside rock too.
    pub rock: bool,
    /// Tics after which what was taken or killed comes back.
    pub respawn: Option<u32>,
    /// No more than so many at a time.
    pub most: u32,
    pub health: Option<i32>,
    pub speed: Option<i32>,
    pub goal: Goal,
    /// Its things are marked among others of their kind: somebody asks for them by name, or they come
    /// back.
    pub marked: bool,
}

/// Kinds, a bit each, and spawns, a bit each.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct Of {
    pub kinds: u128,
    pub spawns: u64,
}

/// What sets a rule off.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Trigger {
    Start,
    Pickup(Of),
    /// Bits of [`hasard_engine::world::DamageKind`]; the zone where the agent stands, for floors.
    Damage {
        kinds: u32,
        zones: u32,
    },
    Death,
    Kill(Of),
    Hit(Of),
    Shot,
    Enter(u8),
    Leave(u8),
    In(u8),
    Land,
    Jump,
    Use,
    Timer {
        every: u32,
        first: u32,
    },
    Step,
    Counter {
        counter: u8,
        reaches: i32,
    },
    Near {
        of: Of,
        within: i32,
    },
}

/// A rule: what happens when something happens.
#[derive(Clone, Debug)]
pub(super) struct When {
    pub at: usize,
    pub trigger: Trigger,
    /// Counters within bounds.
    pub conditions: Vec<(u8, [i32; 2])>,
    /// The agent stands here.
    pub zone: Option<u8>,
    /// Tics before it can happen again, and whether only once an episode.
    pub cooldown: u32,
    pub once: bool,
    /// As much of the amount is free.
    pub over: f64,
    /// Reward and costs do not grow with the amount.
    pub flat: bool,
    pub reward: f64,
    pub costs: Vec<(u8, f64)>,
    pub counts: Vec<(u8, i32)>,
    pub sets: Vec<(u8, i32)>,
    pub hurt: i32,
    pub heal: i32,
    pub end: bool,
    pub spawn: Vec<u8>,
    /// Zone, height, eighths of a map unit a tic.
    pub floors: Vec<(u8, i32, i32)>,
    /// Zone, level.
    pub lights: Vec<(u8, i32)>,
    pub teleport: Option<Place>,
}

/// Lights that change by themselves.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Light {
    pub zone: u8,
    pub bright: i32,
    pub dark: i32,
    pub bright_tics: i32,
    pub dark_tics: i32,
    /// Glows up and down rather than switching.
    pub glow: bool,
}
