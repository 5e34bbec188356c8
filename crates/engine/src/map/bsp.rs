//! The BSP builder: cuts the sectors into convex subsectors by the lines' own directions.
//!
//! Every comparison is exact integer arithmetic on the original lines. The only rounding is of a
//! cut point, once, to 1/65536 unit, and it is computed from the uncut line, so that errors never
//! add up. Points closer to a partition than [`EPSILON`] count as on it, which keeps cuts from
//! leaving slivers.

use super::{Line, MapError, Node, SectorId, Seg, Side, SideId, Subsector, Vertex};
use crate::math::Fixed;

/// Deepest tree; renderers may keep a stack of this size. Balanced trees of 65,000 segs are about
/// 30 deep.
pub(super) const DEPTH_LIMIT: usize = 1024;

/// Distance from a partition, in 1/65536 units, within which a point counts as on it: cut points
/// are rounded by less than 1, so 6 leaves room for the rounding of two cuts, and is far below
/// anything visible.
const EPSILON: i64 = 6;

/// Side tests that one build may make: ten times what a town of 15,000 lines needs, about two
/// seconds at worst.
const WORK_LIMIT: u64 = 1 << 28;

/// Partition candidates that are fully priced per node.
const CANDIDATES: usize = 48;

/// What a cut costs, in segs of imbalance: cuts cost memory and time for ever, imbalance only
/// depth.
const CUT_COST: i64 = 9;

/// A seg in the making. Direction and exact position come from its line.
#[derive(Clone, Copy)]
struct WorkSeg {
    v1: Vertex,
    v2: Vertex,
    line: u32,
    /// Faces the line's back.
    back: bool,
}

/// The infinite line that a map line lies on, with what a side test needs.
struct Partition {
    x: i64,
    y: i64,
    dx: i64,
    dy: i64,
    /// Cross products below this are within [`EPSILON`] of the line.
    tolerance: i64,
    line: u32,
}

/// Where a seg lies relative to a partition.
enum Place {
    Right,
    Left,
    Cut,
}

impl Partition {
    fn of(lines: &[Line], line: u32) -> Partition {
        let l = &lines[line as usize];
        let (dx, dy) = (i64::from(l.dx.0), i64::from(l.dy.0));
        let length = (dx.unsigned_abs().pow(2) + dy.unsigned_abs().pow(2)).isqrt() as i64;
        Partition {
            x: i64::from(l.v1.x.0),
            y: i64::from(l.v1.y.0),
            dx,
            dy,
            tolerance: EPSILON * length,
            line,
        }
    }

    /// Twice the area spanned by the partition and the point: positive on the left. Exact:
    /// coordinates are below 2^30.
    fn cross(&self, v: Vertex) -> i64 {
        (i64::from(v.y.0) - self.y) * self.dx - (i64::from(v.x.0) - self.x) * self.dy
    }

    fn place(&self, seg: &WorkSeg, lines: &[Line]) -> Place {
        if seg.line == self.line {
            return if seg.back { Place::Left } else { Place::Right };
        }
        let (a, b) = (self.cross(seg.v1), self.cross(seg.v2));
        let (a_on, b_on) = (a.abs() <= self.tolerance, b.abs() <= self.tolerance);
        match (a_on, b_on) {
            (true, true) => {
                let line = &lines[seg.line as usize];
                let along = i64::from(line.dx.0) as i128 * i128::from(self.dx)
                    + i64::from(line.dy.0) as i128 * i128::from(self.dy);
                if (along > 0) != seg.back { Place::Right } else { Place::Left }
            }
            (true, false) => {
                if b < 0 {
                    Place::Right
                } else {
                    Place::Left
                }
            }
            (false, true) => {
                if a < 0 {
                    Place::Right
                } else {
                    Place::Left
                }
            }
            (false, false) if (a < 0) == (b < 0) => {
                if a < 0 {
                    Place::Right
                } else {
                    Place::Left
                }
            }
            (false, false) => Place::Cut,
        }
    }

    /// Where the uncut line of a seg crosses the partition, rounded to the nearest raw unit.
    fn crossing(&self, line: &Line) -> Vertex {
        let (a, b) = (i128::from(self.cross(line.v1)), i128::from(self.cross(line.v2)));
        let span = a - b;
        let along = |from: Fixed, delta: Fixed| {
            let product = i128::from(delta.0) * a;
            // Rounded to nearest: (2p + s) / 2s, floored.
            Fixed(from.0 + (2 * product + span).div_euclid(2 * span) as i32)
        };
        let point = Vertex { x: along(line.v1.x, line.dx), y: along(line.v1.y, line.dy) };
        debug_assert!(span != 0);
        point
    }
}

/// The three lists of a built tree.
pub(super) struct Tree {
    pub segs: Vec<Seg>,
    pub subsectors: Vec<Subsector>,
    pub nodes: Vec<Node>,
}

struct Builder<'a> {
    lines: &'a [Line],
    tree: Tree,
    work: u64,
    seg_limit: usize,
}

/// Builds the tree for closed sectors.
pub(super) fn build(lines: &[Line], sides: &[Side]) -> Result<Tree, MapError> {
    // A line that parts a sector from itself and shows nothing stops bodies at most: no view needs
    // it.
    let shows =
        |side: Option<SideId>| side.is_some_and(|side| sides[side.0 as usize].middle.is_some());
    let parts = |line: &Line| {
        line.back_sector != Some(line.front_sector) || shows(Some(line.front)) || shows(line.back)
    };
    let none_parts = !lines.iter().any(parts);
    let mut segs = Vec::with_capacity(lines.len() * 2);
    for (index, line) in lines.iter().enumerate().filter(|(_, line)| none_parts || parts(line)) {
        segs.push(WorkSeg { v1: line.v1, v2: line.v2, line: index as u32, back: false });
        if line.back.is_some() {
            segs.push(WorkSeg { v1: line.v2, v2: line.v1, line: index as u32, back: true });
        }
    }
    let seg_limit = segs.len() * 8 + 4096;
    let tree = Tree { segs: Vec::new(), subsectors: Vec::new(), nodes: Vec::new() };
    let mut builder = Builder { lines, tree, work: 0, seg_limit };
    builder.grow(segs, 0)?;
    Ok(builder.tree)
}

impl Builder<'_> {
    /// Adds the subtree of `segs` and returns its child number.
    fn grow(&mut self, segs: Vec<WorkSeg>, depth: usize) -> Result<u32, MapError> {
        if depth >= DEPTH_LIMIT {
            return Err(MapError::TooComplex { what: "its BSP tree would be too deep" });
        }
        let Some(partition) = self.choose(&segs)? else { return self.leaf(&segs) };
        let (mut right, mut left) = (Vec::new(), Vec::new());
        for seg in &segs {
            match partition.place(seg, self.lines) {
                Place::Right => right.push(*seg),
                Place::Left => left.push(*seg),
                Place::Cut => {
                    let middle = partition.crossing(&self.lines[seg.line as usize]);
                    let (first, second) =
                        (WorkSeg { v2: middle, ..*seg }, WorkSeg { v1: middle, ..*seg });
                    if partition.cross(seg.v1) < 0 {
                        right.push(first);
                        left.push(second);
                    } else {
                        left.push(first);
                        right.push(second);
                    }
                }
            }
        }
        drop(segs);
        let mut bounds = [bounds_of(&right), bounds_of(&left)];
        let mut children = [self.grow(right, depth + 1)?, self.grow(left, depth + 1)?];
        let line = &self.lines[partition.line as usize];
        let mut dx = line.dx;
        // Points on a partition are on its right. Those that run west are turned about: a thing
        // exactly on the line between two sectors, one north of the other, belongs to the southern
        // one in the original, which lights it.
        if line.dy.0 == 0 && dx.0 < 0 {
            dx = -dx;
            bounds.reverse();
            children.reverse();
        }
        self.tree.nodes.push(Node {
            x: line.v1.x,
            y: line.v1.y,
            dx,
            dy: line.dy,
            bounds,
            children,
        });
        Ok(self.tree.nodes.len() as u32 - 1)
    }

    /// The line that divides `segs` best, or none when they bound a convex region.
    fn choose(&mut self, segs: &[WorkSeg]) -> Result<Option<Partition>, MapError> {
        let mut candidates: Vec<u32> = segs.iter().map(|seg| seg.line).collect();
        candidates.sort_unstable();
        candidates.dedup();
        let stride = candidates.len().div_ceil(CANDIDATES).max(1);
        let mut best: Option<(i64, Partition)> = None;
        for first in 0..stride {
            for &line in candidates.iter().skip(first).step_by(stride) {
                let partition = Partition::of(self.lines, line);
                let bound = best.as_ref().map_or(i64::MAX, |&(cost, _)| cost);
                if let Some(cost) = self.price(&partition, segs, bound)? {
                    best = Some((cost, partition));
                }
            }
            // The first sample usually holds a good line; the others are only tried to prove
            // convexity.
            if best.is_some() {
                break;
            }
        }
        Ok(best.map(|(_, partition)| partition))
    }

    /// The cost of a partition if it divides `segs` and costs less than `bound`.
    fn price(
        &mut self,
        partition: &Partition,
        segs: &[WorkSeg],
        bound: i64,
    ) -> Result<Option<i64>, MapError> {
        let (mut right, mut left, mut cuts) = (0i64, 0i64, 0i64);
        for (done, seg) in segs.iter().enumerate() {
            match partition.place(seg, self.lines) {
                Place::Right => right += 1,
                Place::Left => left += 1,
                Place::Cut => {
                    cuts += 1;
                    if cuts * CUT_COST >= bound {
                        self.work += done as u64;
                        return Ok(None);
                    }
                }
            }
        }
        self.work += segs.len() as u64;
        if self.work > WORK_LIMIT {
            return Err(MapError::TooComplex { what: "its BSP tree would take too long" });
        }
        let (right, left) = (right + cuts, left + cuts);
        let cost = cuts * CUT_COST + (right - left).abs();
        Ok((right > 0 && left > 0 && cost < bound).then_some(cost))
    }

    fn leaf(&mut self, segs: &[WorkSeg]) -> Result<u32, MapError> {
        if self.tree.segs.len() + segs.len() > self.seg_limit {
            return Err(MapError::TooComplex { what: "its BSP tree would have too many segs" });
        }
        let first_seg = self.tree.segs.len() as u32;
        for seg in segs {
            self.tree.segs.push(finish(seg, &self.lines[seg.line as usize]));
        }
        let sector = self.tree.segs[first_seg as usize].front_sector;
        self.tree.subsectors.push(Subsector { sector, first_seg, seg_count: segs.len() as u32 });
        Ok((self.tree.subsectors.len() as u32 - 1) | Node::SUBSECTOR)
    }
}

fn bounds_of(segs: &[WorkSeg]) -> [Fixed; 4] {
    let mut bounds = [Fixed::MAX, Fixed::MIN, Fixed::MAX, Fixed::MIN];
    for v in segs.iter().flat_map(|seg| [seg.v1, seg.v2]) {
        bounds = [bounds[0].min(v.x), bounds[1].max(v.x), bounds[2].min(v.y), bounds[3].max(v.y)];
    }
    bounds
}

fn finish(seg: &WorkSeg, line: &Line) -> Seg {
    let (start, side, front_sector, back_sector): (Vertex, SideId, SectorId, Option<SectorId>) =
        if seg.back {
            let (side, sector) =
                line.back.zip(line.back_sector).unwrap_or((line.front, line.front_sector));
            (line.v2, side, sector, Some(line.front_sector))
        } else {
            (line.v1, line.front, line.front_sector, line.back_sector)
        };
    let dx = i64::from(seg.v1.x.0) - i64::from(start.x.0);
    let dy = i64::from(seg.v1.y.0) - i64::from(start.y.0);
    let offset = Fixed((dx.unsigned_abs().pow(2) + dy.unsigned_abs().pow(2)).isqrt() as i32);
    Seg { v1: seg.v1, v2: seg.v2, line: seg.line, side, offset, front_sector, back_sector }
}
