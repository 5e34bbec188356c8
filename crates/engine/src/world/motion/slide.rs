//! Sliding along walls: what is left of a player's move when a wall is in the way.

use crate::map::Line;
use crate::math::Fixed;
use crate::world::parts::lines::{behind, stops};
use crate::world::state::world::World;

/// No wall was hit: one above the whole move.
const NO_HIT: Fixed = Fixed((1 << 16) + 1);

/// The part of a move that is kept as distance from the wall.
const GAP: Fixed = Fixed((1 << 16) / 32);

/// Attempts to slide before stair-stepping.
const ATTEMPTS: u32 = 2;

/// A point and a direction: a corner's way, or the straight line that a wall lies on.
#[derive(Clone, Copy)]
struct Trace {
    x: Fixed,
    y: Fixed,
    dx: Fixed,
    dy: Fixed,
}

impl Trace {
    /// The fraction of the way at which it meets a line, rounded to nearest, if its ends are on
    /// different sides of the line. The line counts as endless, and with the coarse sides of
    /// [`behind`] a short way can miss it: both are the original's, and recorded.
    fn meets(&self, line: &Line) -> Option<Fixed> {
        if behind(line, self.x, self.y) == behind(line, self.x + self.dx, self.y + self.dy) {
            return None;
        }
        let fraction = self.crossing(&Trace::of(line));
        (0..=1 << 16).contains(&fraction).then_some(Fixed(fraction as i32))
    }

    fn of(line: &Line) -> Trace {
        Trace { x: line.v1.x, y: line.v1.y, dx: line.dx, dy: line.dy }
    }

    /// Where another straight line crosses this one, in 65536ths of its direction, rounded to the
    /// nearest, halves to the even one; 0 where they are parallel.
    fn crossing(&self, other: &Trace) -> i64 {
        let wide = |value: Fixed| i128::from(value.0);
        let denominator = wide(other.dy) * wide(self.dx) - wide(other.dx) * wide(self.dy);
        let numerator =
            wide(other.x - self.x) * wide(other.dy) + wide(self.y - other.y) * wide(other.dx);
        let (numerator, denominator) =
            if denominator < 0 { (-numerator, -denominator) } else { (numerator, denominator) };
        if denominator == 0 {
            return 0;
        }
        // Halves go to the even neighbour, which slanting lines with whole coordinates often need.
        let twice = numerator << 17;
        let rounded = (twice + denominator).div_euclid(2 * denominator);
        let is_half = (twice + denominator).rem_euclid(2 * denominator) == 0;
        (rounded - i128::from(is_half && rounded & 1 != 0)) as i64
    }
}

impl World {
    /// Slides the actor in `slot` for one of `steps` equal parts (`dx`, `dy`) of its move: up to
    /// the wall, then along it. Its velocity becomes what is left along the wall.
    pub(crate) fn slide(&mut self, slot: usize, mut dx: Fixed, mut dy: Fixed, steps: i32) {
        for _ in 0..ATTEMPTS {
            let actor = &self.actors[slot];
            let (x, y, radius) = (actor.x, actor.y, actor.radius);
            let (lead_x, trail_x) =
                if dx.0 > 0 { (x + radius, x - radius) } else { (x - radius, x + radius) };
            let (lead_y, trail_y) =
                if dy.0 > 0 { (y + radius, y - radius) } else { (y - radius, y + radius) };
            let mut best = (NO_HIT, 0);
            self.nearest_wall(slot, Trace { x: lead_x, y: lead_y, dx, dy }, &mut best);
            self.nearest_wall(slot, Trace { x: trail_x, y: lead_y, dx, dy }, &mut best);
            self.nearest_wall(slot, Trace { x: lead_x, y: trail_y, dx, dy }, &mut best);
            let (hit, wall) = best;
            if hit == NO_HIT {
                break;
            }
            let way = hit - GAP;
            if way > Fixed::ZERO && !self.try_move(slot, x + dx * way, y + dy * way, true).moved {
                break;
            }
            let rest = (Fixed::ONE - hit).min(Fixed::ONE);
            if rest <= Fixed::ZERO {
                return;
            }
            (dx, dy) = (dx * rest, dy * rest);
            let actor = &mut self.actors[slot];
            let (along_x, along_y) =
                along(&self.map.lines[wall as usize], Trace { x: actor.x, y: actor.y, dx, dy });
            (actor.vx, actor.vy) = (along_x * steps, along_y * steps);
            let (x, y) = (actor.x, actor.y);
            self.limit_bob(slot);
            if self.try_move(slot, x + along_x, y + along_y, true).moved {
                return;
            }
        }
        let (x, y) = (self.actors[slot].x, self.actors[slot].y);
        if !self.try_move(slot, x, y + dy, true).moved {
            self.try_move(slot, x + dx, y, true);
        }
    }

    /// Takes the nearest blocking line on a corner's way into `best` (fraction, line).
    fn nearest_wall(&self, slot: usize, mut trace: Trace, best: &mut (Fixed, u32)) {
        let blocks = &self.map.blockmap;
        // A way that starts exactly on a block's edge is shifted by one unit, as the original does.
        let on_edge = |at: Fixed, origin: Fixed| (at - origin).0 & ((128 << 16) - 1) == 0;
        let (end_x, end_y) = (trace.x + trace.dx, trace.y + trace.dy);
        if on_edge(trace.x, blocks.origin_x) {
            trace.x += Fixed::ONE;
            trace.dx = end_x - trace.x;
        }
        if on_edge(trace.y, blocks.origin_y) {
            trace.y += Fixed::ONE;
            trace.dy = end_y - trace.y;
        }
        let (column, row) = (blocks.column_of(trace.x), blocks.row_of(trace.y));
        let (end_column, end_row) = (blocks.column_of(end_x), blocks.row_of(end_y));
        self.nearest_wall_in_block(slot, column, row, trace, best);
        if column != end_column && row != end_row {
            // Ways are shorter than a block: one more block lies between, or both at an exact
            // corner.
            let edge_x = blocks.origin_x + Fixed::from_int(128 * column.max(end_column));
            let edge_y = blocks.origin_y + Fixed::from_int(128 * row.max(end_row));
            let wide = |value: Fixed| i64::from(value.0).abs();
            let to_edge_x = wide(edge_x - trace.x) * wide(trace.dy);
            let to_edge_y = wide(edge_y - trace.y) * wide(trace.dx);
            if to_edge_x <= to_edge_y {
                self.nearest_wall_in_block(slot, end_column, row, trace, best);
            }
            if to_edge_y <= to_edge_x {
                self.nearest_wall_in_block(slot, column, end_row, trace, best);
            }
        }
        if column != end_column || row != end_row {
            self.nearest_wall_in_block(slot, end_column, end_row, trace, best);
        }
    }

    fn nearest_wall_in_block(
        &self,
        slot: usize,
        column: i32,
        row: i32,
        trace: Trace,
        best: &mut (Fixed, u32),
    ) {
        let blocks = &self.map.blockmap;
        for &index in blocks.lines_in(column, row) {
            let line = &self.map.lines[index as usize];
            // The original lists a line on the border of two blocks only in the eastern or northern
            // one.
            if (column < blocks.column_of(line.bounds[0])) | (row < blocks.row_of(line.bounds[2])) {
                continue;
            }
            if let Some(fraction) = trace.meets(line)
                && fraction < best.0
                && self.walls_off(slot, line)
            {
                *best = (fraction, index);
            }
        }
    }

    /// Whether the actor in `slot` cannot cross a line from where it is.
    fn walls_off(&self, slot: usize, line: &Line) -> bool {
        let actor = &self.actors[slot];
        let Some(back) = line.back_sector else { return !behind(line, actor.x, actor.y) };
        if stops(line.flags, actor) {
            return true;
        }
        let opening = self.opening(line.front_sector, back);
        opening.top - opening.bottom < actor.height
            || opening.top - actor.z < actor.height
            || opening.bottom - actor.z > actor.max_step
            || (actor.z < opening.bottom && self.actor_at(slot, opening.bottom).is_some())
    }
}

/// What is left of a body's move along a wall.
///
/// A slanting wall is met by the move and by the plumb line from the body; what lies between,
/// divided by the part of the move that reaches the wall, is the move's share along it. The
/// original's way, with its rounding.
fn along(line: &Line, way: Trace) -> (Fixed, Fixed) {
    if line.dy.0 == 0 {
        return (way.dx, Fixed::ZERO);
    }
    if line.dx.0 == 0 {
        return (Fixed::ZERO, way.dy);
    }
    let wall = Trace::of(line);
    let foot = wall.crossing(&Trace { dx: wall.dy, dy: -wall.dx, ..way });
    let (met, reach) = (wall.crossing(&way), way.crossing(&wall));
    let part = |side: Fixed| match reach {
        0 => Fixed::ZERO,
        // A way almost parallel to the wall meets it nowhere near; the sum is cut to the range of
        // velocities all the same.
        _ => Fixed(
            ((i128::from(met - foot) * i128::from(side.0) / i128::from(reach)) as i64)
                .clamp(-(1 << 30), 1 << 30) as i32,
        ),
    };
    (part(wall.dx), part(wall.dy))
}
