//! What happened in a step, for rewards and costs of one's own: the engine's events as plain rows.

use hasard_engine::world::{ActorId, ActorKind, DamageKind, Event, World};

/// The kinds of a [`Happening`].
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[repr(u8)]
pub enum HappeningKind {
    /// An item was taken.
    Pickup,
    /// Something lost health.
    Damage,
    /// Something died.
    Death,
    /// A player's feet came to the floor.
    Landing,
    /// A player's weapon fired.
    Shot,
}

impl HappeningKind {
    /// Their names, in the order of their numbers.
    pub const NAMES: [&'static str; 5] = ["pickup", "damage", "death", "landing", "shot"];
}

/// The causes of damage by name, in the order of [`DamageKind`].
pub const DAMAGE_CAUSES: [&str; 7] =
    ["floor", "fall", "bullet", "rocket", "blast", "barrel", "script"];

/// One thing that happened in a step.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Happening {
    /// The world's tic, from the start of the episode.
    pub tic: u32,
    /// What happened.
    pub kind: HappeningKind,
    /// To what: the item that was taken, what was hurt or died, the player that landed or fired.
    pub what: ActorKind,
    /// Who did it, if anybody: the player for an item, the one to blame for damage and death.
    pub by: Option<ActorKind>,
    /// Index of the player who did it, or to whom it happened where nobody did.
    pub player: Option<u8>,
    /// What hurt, of [`HappeningKind::Damage`].
    pub cause: Option<DamageKind>,
    /// Where, in map units.
    pub place: [f32; 2],
    /// Health points of damage, map units a tic of a landing (positive downwards), else 1.
    pub amount: f32,
}

impl Happening {
    /// Reads an event of the tic that has just run.
    pub(crate) fn of(event: Event, world: &World) -> Option<Happening> {
        let player_of = |id: ActorId| {
            world.players.iter().position(|player| player.actor == id).map(|index| index as u8)
        };
        let kind_of = |id: ActorId| world.get(id).map(|actor| actor.kind);
        let place_of = |id: ActorId| {
            world
                .get(id)
                .map_or([0.0; 2], |actor| [actor.x, actor.y].map(|side| side.to_f64() as f32))
        };
        let own = |player: usize| world.players.get(player).map(|player| player.actor);
        let base = Happening {
            tic: world.tic,
            kind: HappeningKind::Pickup,
            what: ActorKind::Player,
            by: None,
            player: None,
            cause: None,
            place: [0.0; 2],
            amount: 1.0,
        };
        Some(match event {
            Event::PickedUp { player, kind, x, y, .. } => Happening {
                what: kind,
                by: Some(ActorKind::Player),
                player: Some(player as u8),
                place: [x, y].map(|side| side.to_f64() as f32),
                ..base
            },
            Event::Hurt { victim, amount, source, by } => Happening {
                kind: HappeningKind::Damage,
                what: kind_of(victim)?,
                by: source.and_then(kind_of),
                player: source.and_then(player_of).or_else(|| player_of(victim)),
                cause: Some(by),
                place: place_of(victim),
                amount: amount as f32,
                ..base
            },
            Event::Died { victim, kind, source, .. } => Happening {
                kind: HappeningKind::Death,
                what: kind,
                by: source.and_then(kind_of),
                player: source.and_then(player_of).or_else(|| player_of(victim)),
                place: place_of(victim),
                ..base
            },
            Event::Landed { player, speed } => Happening {
                kind: HappeningKind::Landing,
                player: Some(player as u8),
                place: own(player).map_or([0.0; 2], place_of),
                amount: -speed.to_f64() as f32,
                ..base
            },
            Event::Fired { player } => Happening {
                kind: HappeningKind::Shot,
                player: Some(player as u8),
                place: own(player).map_or([0.0; 2], place_of),
                ..base
            },
            _ => return None,
        })
    }
}
