//! Lines through the map: what a straight path crosses, and whether one actor can see another.

use crate::map::{Blocks, Line, TextureId, TextureName};
use crate::math::Fixed;
use crate::world::parts::crossing::Crossed;
use crate::world::parts::crossing::Crossing;
use crate::world::parts::crossing::WHOLE_PATH;
use crate::world::state::world::World;
use crate::world::tables::info::ActorFlags;

/// A straight path in the plane.
#[derive(Clone, Copy, Debug)]
pub(in crate::world) struct Path {
    /// Start.
    pub x: Fixed,
    /// Start.
    pub y: Fixed,
    /// From start to end.
    pub dx: Fixed,
    /// From start to end.
    pub dy: Fixed,
}

impl Path {
    /// Where the path crosses a line, if it does.
    fn meets_line(&self, line: &Line) -> Option<i64> {
        let wide = |f: Fixed| i128::from(f.0);
        let (dx, dy) = (wide(self.dx), wide(self.dy));
        let (ax, ay) = (wide(line.v1.x) - wide(self.x), wide(line.v1.y) - wide(self.y));
        let (lx, ly) = (wide(line.dx), wide(line.dy));
        // Twice the areas that say on which side of the path the line's ends are.
        let first = dx * ay - dy * ax;
        let second = first + dx * ly - dy * lx;
        if (first > 0) == (second > 0) {
            return None;
        }
        let across = dx * ly - dy * lx;
        if across == 0 {
            return None;
        }
        let at = (ax * ly - ay * lx) * i128::from(WHOLE_PATH) / across;
        (0..=i128::from(WHOLE_PATH)).contains(&at).then_some(at as i64)
    }

    /// Where the path enters the square of half side `radius` around (x, y), if it does; 0 if it
    /// starts inside.
    pub(in crate::world) fn meets_square(
        &self,
        x: Fixed,
        y: Fixed,
        radius: Fixed,
    ) -> Option<(i64, i64)> {
        let (mut enters, mut leaves) = (0, WHOLE_PATH);
        for (from, by, centre) in [(self.x, self.dx, x), (self.y, self.dy, y)] {
            let (low, high) =
                (i64::from((centre - radius - from).0), i64::from((centre + radius - from).0));
            let by = i64::from(by.0);
            if by == 0 {
                if low > 0 || high < 0 {
                    return None;
                }
                continue;
            }
            let (near, far) = if by > 0 { (low, high) } else { (high, low) };
            let scale = |distance: i64| {
                ((i128::from(distance) * i128::from(WHOLE_PATH)) / i128::from(by)) as i64
            };
            enters = enters.max(scale(near));
            leaves = leaves.min(scale(far));
        }
        (enters <= leaves).then_some((enters, leaves))
    }
}

/// The ceiling texture that is the sky.
const SKY: TextureName = TextureName::new("F_SKY1");

impl World {
    /// Whether a ceiling texture is the sky, into which missiles and bullets vanish.
    pub(in crate::world) fn is_sky(&self, texture: TextureId) -> bool {
        self.map.textures.get(usize::from(texture.0)) == Some(&SKY)
    }

    /// Collects the lines that a path crosses, nearest first, into `found`.
    pub(in crate::world) fn lines_on(&self, path: &Path, found: &mut Vec<Crossing>) {
        found.clear();
        let blocks = &self.map.blockmap;
        let (x, y, end_x, end_y) = (path.x, path.y, path.x + path.dx, path.y + path.dy);
        let columns = (blocks.column_of(x.min(end_x)), blocks.column_of(x.max(end_x)));
        let rows = (blocks.row_of(y.min(end_y)), blocks.row_of(y.max(end_y)));
        let half = Fixed::from_int(64);
        for row in rows.0.max(0)..=rows.1.min(blocks.rows - 1) {
            for column in columns.0.max(0)..=columns.1.min(blocks.columns - 1) {
                // Only blocks that the path touches; the blocks of a small rectangle are not worth
                // the test.
                let centre_x = blocks.origin_x + Fixed::from_int(128 * column) + half;
                let centre_y = blocks.origin_y + Fixed::from_int(128 * row) + half;
                if path.meets_square(centre_x, centre_y, half).is_none() {
                    continue;
                }
                for &index in blocks.lines_in(column, row) {
                    if let Some(at) = path.meets_line(&self.map.lines[index as usize]) {
                        found.push(Crossing { at, what: Crossed::Line(index) });
                    }
                }
            }
        }
        // A line lies in several blocks.
        found.sort_unstable();
        found.dedup();
    }

    /// Whether the actor in `viewer` has a clear line from its eyes to any height of the actor in
    /// `other`.
    pub(in crate::world) fn sees(&mut self, viewer: usize, other: usize) -> bool {
        let (from, to) = (self.actors[viewer], self.actors[other]);
        let path = Path { x: from.x, y: from.y, dx: to.x - from.x, dy: to.y - from.y };
        let eye = from.z + from.height - (from.height >> 2);
        // The window through which the other is seen, as heights above the eye at its distance.
        let mut low = i64::from((to.z - eye).0);
        let mut high = low + i64::from(to.height.0);
        let mut crossings = std::mem::take(&mut self.scratch_crossings);
        self.lines_on(&path, &mut crossings);
        let mut clear = true;
        for crossing in &crossings {
            let Crossed::Line(index) = crossing.what else { continue };
            let line = &self.map.lines[index as usize];
            let Some(back) = line.back_sector else {
                clear = false;
                break;
            };
            let opening = self.opening(line.front_sector, back);
            if opening.bottom >= opening.top
                || line.flags.blocks.any(Blocks::EVERYTHING.with(Blocks::SIGHT))
            {
                clear = false;
                break;
            }
            let at = crossing.at.max(1);
            let extend = |height: Fixed| {
                (i128::from((height - eye).0) * i128::from(WHOLE_PATH) / i128::from(at)) as i64
            };
            low = low.max(extend(opening.bottom));
            high = high.min(extend(opening.top));
            if high <= low {
                clear = false;
                break;
            }
        }
        self.scratch_crossings = crossings;
        clear
    }

    /// Collects the shootable actors that a path meets and the lines that it crosses, nearest
    /// first.
    pub(in crate::world) fn everything_on(
        &self,
        path: &Path,
        except: usize,
        found: &mut Vec<Crossing>,
    ) {
        self.lines_on(path, found);
        for (slot, actor) in self.actors.iter().enumerate() {
            if slot == except || actor.removed || !actor.flags.any(ActorFlags::SHOOTABLE) {
                continue;
            }
            if let Some((at, _)) = path.meets_square(actor.x, actor.y, actor.radius) {
                found.push(Crossing { at, what: Crossed::Actor(slot as u16) });
            }
        }
        found.sort_unstable();
    }
}
