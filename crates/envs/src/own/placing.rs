//! Where things and the agent are put.

use super::model::{Height, Place};
use super::program::Program;
use crate::scenarios::common::stage;
use hasard_engine::math::Fixed;
use hasard_engine::world::{ActorId, World};

/// Tries to find a free place for the agent.
const PLAYER_TRIES: u32 = 2_000;

/// A random point of a place; none where it fell into rock.
pub(super) fn drawn_place(
    program: &Program,
    place: Place,
    height: Height,
    rock: bool,
    world: &mut World,
) -> Option<[Fixed; 3]> {
    let area = match place {
        Place::Area(area) => area,
        _ => match program.areas_of(place) {
            [] => return None,
            [area] => *area,
            areas => areas[world.rng.below(areas.len() as u32) as usize],
        },
    };
    let (x, y) = stage::point_in(world, area);
    if !rock && !world.map.is_inside(x, y) {
        return None;
    }
    if let Place::Zone(zone) = place
        && !program.holds(zone, [x, y], &world.map)
    {
        return None;
    }
    if matches!(place, Place::Free) && program.hurts[world.map.sector_at(x, y).0 as usize] {
        return None;
    }
    let z = match height {
        Height::At(z) => Fixed::from_int(z),
        Height::Above(above) => {
            world.sector(world.map.sector_at(x, y)).floor + Fixed::from_int(above)
        }
    };
    Some([x, y, z])
}

/// Moves the agent to a random point of a place, if there is room for it: whether there was.
pub(super) fn move_player(
    program: &Program,
    place: Place,
    height: Height,
    tries: &mut u32,
    world: &mut World,
) -> bool {
    for _ in 0..PLAYER_TRIES.min(*tries) {
        *tries -= 1;
        if let Some([x, y, z]) = drawn_place(program, place, height, false, world)
            && world.set_position(body(world), x, y, z)
        {
            return true;
        }
    }
    false
}

/// The agent's body.
pub(super) fn body(world: &World) -> ActorId {
    world.players[0].actor
}
