//! Lines as actors meet them.

use crate::map::{Blocks, Line, LineFlags, Map};
use crate::math::Fixed;
use crate::world::parts::actor::Actor;
use crate::world::tables::info::ActorFlags;

/// Which side of a line a point is on: true for the back. Points within about one square map unit
/// of cross product count to the front: the original computes with 32 bits less, and the slide
/// along walls depends on it.
pub(crate) fn behind(line: &Line, x: Fixed, y: Fixed) -> bool {
    let across = i64::from((y - line.v1.y).0) * i64::from(line.dx.0)
        + i64::from((line.v1.x - x).0) * i64::from(line.dy.0);
    across >> 32 > 0
}

/// Visits every line that cuts the inside of the square of half side `radius` around (x, y), block
/// by block: one that lies in several blocks comes several times.
#[inline]
pub(crate) fn for_each_line_across(
    map: &Map,
    x: Fixed,
    y: Fixed,
    radius: Fixed,
    mut visit: impl FnMut(u32, &Line),
) {
    let (west, east, south, north) = (x - radius, x + radius, y - radius, y + radius);
    let blocks = &map.blockmap;
    for row in blocks.row_of(south)..=blocks.row_of(north) {
        for column in blocks.column_of(west)..=blocks.column_of(east) {
            for (index, &[line_west, line_east, line_south, line_north]) in
                blocks.bounded_lines_in(column, row)
            {
                if (west >= line_east)
                    | (east <= line_west)
                    | (south >= line_north)
                    | (north <= line_south)
                {
                    continue;
                }
                let line = &map.lines[index as usize];
                // The corners that are farthest to either side of the line's direction.
                let cuts = if line.dx.0 == 0 || line.dy.0 == 0 {
                    true
                } else if (line.dx.0 ^ line.dy.0) >= 0 {
                    behind(line, west, north) != behind(line, east, south)
                } else {
                    behind(line, east, north) != behind(line, west, south)
                };
                if cuts {
                    visit(index, line);
                }
            }
        }
    }
}

/// Whether a line stops an actor although its opening is large enough.
pub(in crate::world) fn stops(flags: LineFlags, actor: &Actor) -> bool {
    let LineFlags { blocking, blocks, .. } = flags;
    let missile = actor.flags.any(ActorFlags::MISSILE);
    if blocks.is_empty() || blocks.any(Blocks::EVERYTHING) {
        return !blocks.is_empty() || blocking && !missile;
    }
    if missile {
        return blocks.any(Blocks::PROJECTILES);
    }
    let kind = if actor.player_index().is_some() { Blocks::PLAYERS } else { Blocks::MONSTERS };
    blocking
        || blocks.any(kind)
        || actor.flags.any(ActorFlags::FLOAT) && blocks.any(Blocks::FLOATERS)
}
