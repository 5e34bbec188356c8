//! A world: everything that changes during an episode, as plain data. `Clone` is a snapshot.
//!
//! One tic is [`World::run_thinkers`] (players, then actors, then sector movers), the caller's
//! script phase, then [`World::finish_tic`] (what was created during the tic is run once, and time
//! advances): the order of work of ViZDoom, with the scripts in the caller's hands.
//!
//! `tables` says what things are, `parts` what a world is made of, `state` is the whole; the other
//! folders are what happens to it.

// Physics and pixels are whole numbers: a floating-point operation here is a mistake.
#![cfg_attr(not(test), deny(clippy::float_arithmetic))]

mod combat;
mod effects;
mod monsters;
mod motion;
mod parts;
mod player;
mod sectors;
mod state;
mod tables;
mod tic;

pub use combat::explosion::BLAST;
pub use motion::collision::{Move, Position, approximate_distance};
pub use parts::actor::{Actor, ActorId};
pub use parts::command::{Buttons, Command};
pub use parts::event::Event;
pub use parts::face::{Face, FaceState};
pub use parts::hands::{Hands, WeaponState};
pub use parts::player::{Player, PlayerSprite, SPAWN_FREEZE_TICS};
pub use parts::sector::{Busy, SectorDamage, SectorState};
pub use parts::soot::Soot;
pub use parts::trail::{Chance, Lots, SQUARES, Shade, Shed, Square, Trail};
pub use player::inventory::{BLUE_SKULL, YELLOW_CARD};
pub use player::think::PITCH_DOWN;
pub use state::fingerprint::Fingerprint;
pub use state::world::World;
pub use tables::heading::Heading;
pub use tables::info::{ActorFlags, ActorInfo};
pub use tables::kinds::{ActorKind, DamageKind, Weapon};
pub use tables::states::{
    Action, Animation, Frame, OPAQUE, Phase, Picture, Then, animation, is_timed,
};
pub use tables::weapons::ammo;
