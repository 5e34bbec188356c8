//! The stage hands: what the rules of several scenarios ask of a world.

use hasard_engine::math::{Angle, Fixed};
use hasard_engine::world::{ActorId, ActorKind, World};

/// Tries to find a free place before giving up: far more than any scenario needs, so that a map
/// without a free place (a user's own, say) cannot hang an episode.
const TRIES: u32 = 10_000;

/// A rectangle of the plane: west, south, east, north; map units.
pub type Area = [i32; 4];

/// A uniform point of an area.
pub fn point_in(world: &mut World, [west, south, east, north]: Area) -> (Fixed, Fixed) {
    let x = world.rng.between_fixed(Fixed::from_int(west), Fixed::from_int(east));
    let y = world.rng.between_fixed(Fixed::from_int(south), Fixed::from_int(north));
    (x, y)
}

/// Places an actor at a random point of an area where it fits, at height `z`; inside rock as well,
/// where nobody gets at it.
pub fn scatter(
    world: &mut World,
    kind: ActorKind,
    area: Area,
    z: i32,
    tid: i32,
) -> Option<ActorId> {
    scatter_where(world, kind, area, z, tid, |_, _, _| true)
}

/// The same, but never inside rock.
pub fn scatter_inside(
    world: &mut World,
    kind: ActorKind,
    area: Area,
    z: i32,
    tid: i32,
) -> Option<ActorId> {
    scatter_where(world, kind, area, z, tid, |world, x, y| world.map.is_inside(x, y))
}

fn scatter_where(
    world: &mut World,
    kind: ActorKind,
    area: Area,
    z: i32,
    tid: i32,
    allowed: impl Fn(&World, Fixed, Fixed) -> bool,
) -> Option<ActorId> {
    for _ in 0..TRIES {
        let (x, y) = point_in(world, area);
        if allowed(world, x, y)
            && let Some(actor) = world.spawn_checked(kind, x, y, Fixed::from_int(z), tid)
        {
            return Some(actor);
        }
    }
    None
}

/// Moves the player's body to a random point of an area where it fits, at height `z`. Never into
/// rock, where the original locks an agent up now and then.
pub fn scatter_player(world: &mut World, area: Area, z: i32) {
    for _ in 0..TRIES {
        let (x, y) = point_in(world, area);
        if world.map.is_inside(x, y)
            && world.set_position(world.players[0].actor, x, y, Fixed::from_int(z))
        {
            return;
        }
    }
}

/// One of the directions that the scenarios' scripts give the agent: multiples of a little more
/// than 256 degrees, which are some 45 directions all around.
pub fn random_angle(world: &mut World) -> Angle {
    Angle::from_turn_65536(world.rng.between(0, 255) * 46603)
}

/// The player's health points; below zero after a blow stronger than needed to kill.
pub fn health(world: &World) -> i32 {
    world.get(world.players[0].actor).map_or(0, |body| body.health)
}

/// Shots that the weapon in hand has left, or the one coming up; 0 for bare hands.
pub fn ammunition(world: &World) -> i32 {
    let player = &world.players[0];
    player.weapon.map_or(0, |weapon| player.ammo[weapon.ammo()])
}

/// Sets the player's health points.
pub fn set_health(world: &mut World, points: i32) {
    if let Some(body) = world.get_mut(world.players[0].actor) {
        body.health = points;
    }
}

/// Turns the player's body.
pub fn set_angle(world: &mut World, angle: Angle) {
    if let Some(body) = world.get_mut(world.players[0].actor) {
        body.angle = angle;
    }
}
