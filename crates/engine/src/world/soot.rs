//! Soot that bursting rockets leave on walls. Nothing in the world minds it: only pictures show it.

use super::World;
use super::collision::behind;
use crate::map::SideId;
use crate::math::Fixed;

/// Most marks of a world; the oldest go first. An agent that fires all the time leaves some hundred in an episode of 2,100 tics.
const MOST_MARKS: usize = 64;

/// A mark on one side of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Soot {
    /// The side.
    pub side: SideId,
    /// Its middle lies on the line.
    pub x: Fixed,
    /// As x.
    pub y: Fixed,
    /// Height of its middle.
    pub z: Fixed,
    /// Shown the other way round.
    pub mirrored: bool,
    /// Shown upside down.
    pub upturned: bool,
}

impl World {
    /// Leaves soot on a line at its point nearest to (x, y), on the side where that lies.
    ///
    /// The original draws lots for how a mark is turned. Here its place decides, so that what only pictures show takes no number
    /// from the world's randomness.
    pub fn leave_soot(&mut self, line: u32, x: Fixed, y: Fixed, z: Fixed) {
        let line = &self.map.lines[line as usize];
        let side = if behind(line, x, y) { line.back.unwrap_or(line.front) } else { line.front };
        let wide = |value: Fixed| i128::from(value.0);
        let square = wide(line.dx) * wide(line.dx) + wide(line.dy) * wide(line.dy);
        if square == 0 {
            return;
        }
        let along = wide(x - line.v1.x) * wide(line.dx) + wide(y - line.v1.y) * wide(line.dy);
        let on_line = |start: Fixed, part: Fixed| start + Fixed((wide(part) * along.clamp(0, square) / square) as i32);
        let (x, y) = (on_line(line.v1.x, line.dx), on_line(line.v1.y, line.dy));
        let lot = (x.0 ^ y.0.rotate_left(7) ^ z.0.rotate_left(13)).wrapping_mul(0x9E37_79B1_u32 as i32) >> 16;
        if self.soot.len() >= MOST_MARKS {
            self.soot.remove(0);
        }
        self.soot.push(Soot { side, x, y, z, mirrored: lot & 1 != 0, upturned: lot & 2 != 0 });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::stone_room;
    use crate::math::Angle;
    use crate::world::ActorKind;

    fn room() -> World {
        World::new(stone_room(200, [-256, -256, 256, 256], &[]), 1)
    }

    #[test]
    fn a_rocket_leaves_soot_where_it_meets_a_wall_and_nowhere_else() {
        let mut world = room();
        let id = world.spawn(ActorKind::Rocket, Fixed::ZERO, Fixed::from_int(40), Fixed::from_int(50));
        let rocket = world.get_mut(id).unwrap();
        (rocket.angle, rocket.vx) = (Angle::EAST, Fixed::from_int(20));
        for _ in 0..12 {
            assert!(world.soot.is_empty());
            world.run_thinkers(&[]);
            world.finish_tic();
        }
        world.run_thinkers(&[]);
        let [mark] = world.soot[..] else { panic!("{:?}", world.soot) };
        assert_eq!([mark.x, mark.y, mark.z], [256, 40, 50].map(Fixed::from_int));
        let line = world.map.lines.iter().find(|line| line.front == mark.side || line.back == Some(mark.side)).unwrap();
        assert_eq!([line.v1.x, line.v2.x], [Fixed::from_int(256); 2]);
    }

    #[test]
    fn the_oldest_marks_go_first_and_nothing_else_depends_on_them() {
        let mut world = room();
        let before = (world.state_hash(), world.rng.clone());
        for z in 0..MOST_MARKS as i32 + 3 {
            world.leave_soot(0, Fixed::ZERO, Fixed::ZERO, Fixed::from_int(z));
        }
        assert_eq!((world.soot.len(), world.soot[0].z), (MOST_MARKS, Fixed::from_int(3)));
        assert_eq!((world.state_hash(), world.rng.clone()), before);
        let turned = |mark: &Soot| (mark.mirrored, mark.upturned);
        assert!(world.soot.iter().any(|mark| turned(mark) != turned(&world.soot[0])));
    }
}
