//! A world: everything that changes during an episode, as plain data. `Clone` is a snapshot.
//!
//! One tic is [`World::run_thinkers`] (players, then actors, then sector movers), the caller's script phase, then
//! [`World::finish_tic`] (what was created during the tic is run once, and time advances): the order of work of the
//! original engine, with the scripts in the caller's hands.

mod actor;
mod actor_info;
mod command;
mod event;
mod patrol;
mod player;
mod sector;
mod states;

pub use actor::{Actor, ActorId, ActorKind};
pub use actor_info::{ActorFlags, ActorInfo};
pub use command::{Buttons, Command};
pub use event::{DamageKind, Event};
pub use patrol::Heading;
pub use player::{Player, PlayerSprite, Weapon};
pub use sector::{SectorDamage, SectorState};
pub use states::{Action, Animation, Frame, Phase, Picture, Then, animation, is_timed};

use crate::map::Map;
use crate::math::Rng;
use std::sync::Arc;

/// The whole state of one running map.
#[derive(Clone)]
pub struct World {
    /// The map, shared by every world that uses it.
    pub map: Arc<Map>,
    /// What changes of each sector, by [`SectorId`](crate::map::SectorId).
    pub sectors: Vec<SectorState>,
    /// Actor slots; removed actors leave a free slot ([`Actor::removed`]).
    pub actors: Vec<Actor>,
    /// The players; each owns one actor.
    pub players: Vec<Player>,
    /// The world's only randomness.
    pub rng: Rng,
    /// Completed tics.
    pub tic: u32,
    /// What happened since the caller last cleared it, in order.
    pub events: Vec<Event>,
    /// Monsters and weapons do not search for targets vertically or sideways (Collateral Damage).
    pub no_autoaim: bool,
}
