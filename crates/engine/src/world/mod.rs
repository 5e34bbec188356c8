//! A world: everything that changes during an episode, as plain data. `Clone` is a snapshot.
//!
//! One tic is [`World::run_thinkers`] (players, then actors, then sector movers), the caller's
//! script phase, then [`World::finish_tic`] (what was created during the tic is run once, and time
//! advances): the order of work of ViZDoom, with the scripts in the caller's hands.
//!
//! `tables` says what things are, `state` holds what a world is; the other folders are what happens
//! to it.

// Physics and pixels are whole numbers: a floating-point operation here is a mistake.
#![cfg_attr(not(test), deny(clippy::float_arithmetic))]

mod combat;
mod effects;
mod monsters;
mod motion;
mod player;
mod sectors;
mod state;
mod tables;
mod tic;

pub use combat::explosion::BLAST;
pub use effects::soot::Soot;
pub use effects::trail::{Chance, Lots, SQUARES, Shade, Shed, Square, Trail};
pub use monsters::patrol::Heading;
pub use motion::collision::{Move, Position, approximate_distance};
pub use player::face::{Face, FaceState};
pub use player::inventory::{BLUE_SKULL, YELLOW_CARD};
pub use player::think::PITCH_DOWN;
pub use player::weapon::{Hands, WeaponState};
pub use state::actor::{Actor, ActorId, ActorKind};
pub use state::command::{Buttons, Command};
pub use state::event::{DamageKind, Event};
pub use state::fingerprint::Fingerprint;
pub use state::player::{Player, PlayerSprite, SPAWN_FREEZE_TICS, Weapon};
pub use state::sector::{Busy, SectorDamage, SectorState};
pub use state::world::World;
pub use tables::info::{ActorFlags, ActorInfo};
pub use tables::states::{
    Action, Animation, Frame, OPAQUE, Phase, Picture, Then, animation, is_timed,
};
pub use tables::weapons::ammo;
