//! Soot that bursting rockets leave on walls. Nothing in the world minds it: only pictures show it.

use crate::map::{Line, SectorId, SideId, Vertex};
use crate::math::Fixed;
use crate::world::parts::lines::behind;
use crate::world::parts::soot::Soot;
use crate::world::state::world::World;

/// Most marks of a world; the oldest go first. An agent that fires all the time leaves some hundred
/// in an episode of 2,100 tics.
const MOST_MARKS: usize = 96;

/// How far a mark reaches along a wall from its middle, map units: half the published picture's
/// width. What lies beyond the end of a line goes on around the corner.
const REACH: Fixed = Fixed((39 << 16) / 2);

/// Lines that a mark goes on along to either side; more than fit in its reach are tiny.
const MOST_CORNERS: usize = 4;

impl World {
    /// Leaves soot on a line at its point nearest to (x, y), on the side where that lies.
    ///
    /// The original draws lots for how a mark is turned. Here its place decides, so that what only
    /// pictures show takes no number from the world's randomness.
    pub fn leave_soot(&mut self, line: u32, x: Fixed, y: Fixed, z: Fixed) {
        let line = &self.map.lines[line as usize];
        let back = Facing::back(line).filter(|_| behind(line, x, y));
        let facing = back.unwrap_or_else(|| Facing::front(line));
        let wide = |value: Fixed| i128::from(value.0);
        let square = wide(line.dx) * wide(line.dx) + wide(line.dy) * wide(line.dy);
        if square == 0 {
            return;
        }
        let along = wide(x - line.v1.x) * wide(line.dx) + wide(y - line.v1.y) * wide(line.dy);
        let on_line = |start: Fixed, part: Fixed| {
            start + Fixed((wide(part) * along.clamp(0, square) / square) as i32)
        };
        let (x, y) = (on_line(line.v1.x, line.dx), on_line(line.v1.y, line.dy));
        let lot = (x.0 ^ y.0.rotate_left(7) ^ z.0.rotate_left(13))
            .wrapping_mul(0x9E37_79B1_u32 as i32)
            >> 16;
        let mark =
            Soot { side: facing.side, x, y, z, mirrored: lot & 1 != 0, upturned: lot & 2 != 0 };
        self.add_soot(mark);
        self.spread_soot(mark, facing, true);
        self.spread_soot(mark, facing, false);
    }

    fn add_soot(&mut self, mark: Soot) {
        if self.soot.len() >= MOST_MARKS {
            self.soot.remove(0);
        }
        self.soot.push(mark);
    }

    /// Carries a mark on to the next lines of its sector, as if the walls were one.
    fn spread_soot(&mut self, mark: Soot, mut facing: Facing, onwards: bool) {
        let mut passed = facing.corner(onwards).away(mark.x, mark.y);
        for _ in 0..MOST_CORNERS {
            let corner = facing.corner(onwards);
            if passed >= REACH {
                return;
            }
            let Some(next) = self.next_facing(facing, onwards) else { return };
            // Where the middle would be if the wall went on straight.
            let length = next.start.away(next.end.x, next.end.y);
            let far = next.corner(onwards);
            let before = |corner: Fixed, far: Fixed| {
                corner
                    - Fixed(
                        (i64::from((far - corner).0) * i64::from(passed.0)
                            / i64::from(length.0.max(1))) as i32,
                    )
            };
            self.add_soot(Soot {
                side: next.side,
                x: before(corner.x, far.x),
                y: before(corner.y, far.y),
                ..mark
            });
            (passed, facing) = (passed + length.min(REACH), next);
        }
    }

    /// The side that joins another of the same sector at its end, or at its start.
    fn next_facing(&self, facing: Facing, onwards: bool) -> Option<Facing> {
        let corner = facing.corner(onwards);
        let lines = self.map.sectors[facing.sector.0 as usize]
            .lines
            .iter()
            .map(|&line| &self.map.lines[line as usize]);
        let mut sides =
            lines.flat_map(|line| [Some(Facing::front(line)), Facing::back(line)]).flatten();
        sides.find(|next| {
            next.sector == facing.sector
                && next.side != facing.side
                && next.corner(!onwards) == corner
        })
    }
}

/// A side of a line in its own direction: its sector is on the right.
#[derive(Clone, Copy)]
struct Facing {
    side: SideId,
    sector: SectorId,
    start: Vertex,
    end: Vertex,
}

impl Facing {
    fn front(line: &Line) -> Facing {
        Facing { side: line.front, sector: line.front_sector, start: line.v1, end: line.v2 }
    }

    fn back(line: &Line) -> Option<Facing> {
        let (side, sector) = line.back.zip(line.back_sector)?;
        Some(Facing { side, sector, start: line.v2, end: line.v1 })
    }

    fn corner(&self, onwards: bool) -> Vertex {
        if onwards { self.end } else { self.start }
    }
}

impl Vertex {
    /// The distance to a point.
    fn away(self, x: Fixed, y: Fixed) -> Fixed {
        Fixed::length_of(x - self.x, y - self.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::stone_room;
    use crate::math::Angle;
    use crate::world::tables::kinds::ActorKind;

    fn room() -> World {
        World::new(stone_room(200, [-256, -256, 256, 256], &[]), 1)
    }

    #[test]
    fn a_rocket_leaves_soot_where_it_meets_a_wall_and_nowhere_else() {
        let mut world = room();
        let id =
            world.spawn(ActorKind::Rocket, Fixed::ZERO, Fixed::from_int(40), Fixed::from_int(50));
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
        let line = world
            .map
            .lines
            .iter()
            .find(|line| line.front == mark.side || line.back == Some(mark.side))
            .unwrap();
        assert_eq!([line.v1.x, line.v2.x], [Fixed::from_int(256); 2]);
    }

    #[test]
    fn soot_goes_on_around_corners_as_far_as_it_reaches() {
        let mut world = World::new(stone_room(200, [-256, -256, 256, 256], &[[0.0, 0.0]]), 1);
        let fixed = Fixed::from_int;
        let east = world
            .map
            .lines
            .iter()
            .position(|line| line.v1.x == fixed(256) && line.v2.x == fixed(256))
            .unwrap();
        for (y, pieces) in [(0, 1), (236, 1), (248, 2), (-250, 2)] {
            world.soot.clear();
            world.leave_soot(east as u32, fixed(240), fixed(y), fixed(30));
            assert_eq!(world.soot.len(), pieces, "at {y}");
        }
        let [first, second] = world.soot[..] else { panic!("{:?}", world.soot) };
        assert_eq!(([first.x, first.y], first.z), ([fixed(256), fixed(-250)], second.z));
        // Six units from the corner along the one wall: the other would have to be six units
        // longer.
        assert_eq!([second.x, second.y], [fixed(262), fixed(-256)]);
        assert_eq!((first.mirrored, first.upturned), (second.mirrored, second.upturned));
        assert_ne!(first.side, second.side);
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
