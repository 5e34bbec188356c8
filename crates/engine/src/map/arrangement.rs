//! The planar arrangement behind the map builder: edges of overlapping polygons, cut where they
//! meet, and the polygon that lies uppermost on each side of each piece. Exact integers throughout;
//! only a crossing point is rounded.

use std::collections::BTreeMap;

/// A point in 1/64 map units.
pub(super) type Point = (i64, i64);

/// Points of the arrangement a map unit: fine enough that a rounded crossing is invisible, and
/// exact in 16.16.
pub(super) const POINTS_PER_UNIT: i64 = 64;

/// What an edge was drawn for: the outline of polygon `n`, or mark `n`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum Owner {
    Polygon(usize),
    Mark(usize),
}

/// A piece of edge that no other piece crosses or touches but at its ends; `a < b`.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub a: Point,
    pub b: Point,
    pub owners: Vec<Owner>,
}

type Edges = BTreeMap<(Point, Point), Vec<Owner>>;

/// Cuts edges where they cross, touch or nearly touch. Rounding a crossing bends both edges by less
/// than 1/64 unit, which may make new contacts, so this repeats until there are none; `None` if
/// that takes absurdly long.
pub(super) fn cut(edges: impl Iterator<Item = (Point, Point, Owner)>) -> Option<Vec<Piece>> {
    let mut pieces: Edges = BTreeMap::new();
    for (a, b, owner) in edges {
        insert(&mut pieces, a, b, &[owner]);
    }
    for _ in 0..64 {
        let list: Vec<Piece> =
            pieces.into_iter().map(|((a, b), owners)| Piece { a, b, owners }).collect();
        let cuts = contacts(&list);
        if cuts.is_empty() {
            return Some(list);
        }
        pieces = BTreeMap::new();
        let mut next = cuts.into_iter().peekable();
        for (index, piece) in list.iter().enumerate() {
            let mut from = piece.a;
            // Sorted by piece, then along it: points of a piece with `a < b` are ordered as it
            // runs.
            while let Some(&(of, point)) = next.peek().filter(|&&(of, _)| of == index) {
                debug_assert_eq!(of, index);
                insert(&mut pieces, from, point, &piece.owners);
                from = point;
                next.next();
            }
            insert(&mut pieces, from, piece.b, &piece.owners);
        }
    }
    None
}

fn insert(pieces: &mut Edges, a: Point, b: Point, owners: &[Owner]) {
    if a == b {
        return;
    }
    let list = pieces.entry((a.min(b), a.max(b))).or_default();
    list.extend_from_slice(owners);
    list.sort_unstable();
}

/// Where pieces must be cut: (index, point), sorted. Pieces are sorted by their western end.
fn contacts(pieces: &[Piece]) -> Vec<(usize, Point)> {
    let mut cuts = Vec::new();
    for (i, p) in pieces.iter().enumerate() {
        let (south, north) = (p.a.1.min(p.b.1) - 1, p.a.1.max(p.b.1) + 1);
        for (j, q) in pieces.iter().enumerate().skip(i + 1) {
            if q.a.0 > p.b.0 + 1 {
                break;
            }
            if q.a.1.max(q.b.1) < south || q.a.1.min(q.b.1) > north {
                continue;
            }
            let before = cuts.len();
            for (index, piece, end) in [(i, p, q.a), (i, p, q.b), (j, q, p.a), (j, q, p.b)] {
                if touches(piece, end) {
                    cuts.push((index, end));
                }
            }
            if cuts.len() == before
                && let Some(point) = crossing(p, q)
            {
                for (index, piece) in [(i, p), (j, q)] {
                    if point != piece.a && point != piece.b {
                        cuts.push((index, point));
                    }
                }
            }
        }
    }
    cuts.sort_unstable();
    cuts.dedup();
    cuts
}

fn sub(p: Point, q: Point) -> Point {
    (p.0 - q.0, p.1 - q.1)
}

fn cross(p: Point, q: Point) -> i64 {
    p.0 * q.1 - p.1 * q.0
}

fn dot(p: Point, q: Point) -> i64 {
    p.0 * q.0 + p.1 * q.1
}

/// Whether a point lies on the piece, or within three quarters of a grid step of it, strictly
/// between its ends.
fn touches(piece: &Piece, point: Point) -> bool {
    if point == piece.a || point == piece.b {
        return false;
    }
    let along = sub(piece.b, piece.a);
    let to = sub(point, piece.a);
    let (length, run) = (dot(along, along), dot(to, along));
    let off = i128::from(cross(along, to));
    run > 0 && run < length && 16 * off * off <= 9 * i128::from(length)
}

/// The rounded point where two pieces cross inside both.
fn crossing(p: &Piece, q: &Piece) -> Option<Point> {
    let (along_p, along_q) = (sub(p.b, p.a), sub(q.b, q.a));
    let (qa, qb) = (cross(along_p, sub(q.a, p.a)), cross(along_p, sub(q.b, p.a)));
    let (pa, pb) = (cross(along_q, sub(p.a, q.a)), cross(along_q, sub(p.b, q.a)));
    if (qa < 0) == (qb < 0) || (pa < 0) == (pb < 0) || qa == 0 || qb == 0 || pa == 0 || pb == 0 {
        return None;
    }
    let span = i128::from(pa) - i128::from(pb);
    let at = |from: i64, delta: i64| {
        from + (2 * i128::from(delta) * i128::from(pa) + span).div_euclid(2 * span) as i64
    };
    Some((at(p.a.0, along_p.0), at(p.a.1, along_p.1)))
}

/// The outlines of polygons after cutting, for finding which polygon lies uppermost at a place.
pub(super) struct Regions {
    outlines: Vec<Outline>,
}

struct Outline {
    low: Point,
    high: Point,
    pieces: Vec<(Point, Point)>,
}

impl Regions {
    pub(super) fn new(pieces: &[Piece], polygon_count: usize) -> Regions {
        let empty = || Outline {
            low: (i64::MAX, i64::MAX),
            high: (i64::MIN, i64::MIN),
            pieces: Vec::new(),
        };
        let mut outlines: Vec<Outline> = (0..polygon_count).map(|_| empty()).collect();
        for piece in pieces {
            for owner in &piece.owners {
                if let Owner::Polygon(polygon) = *owner {
                    let outline = &mut outlines[polygon];
                    for end in [piece.a, piece.b] {
                        outline.low = (outline.low.0.min(end.0), outline.low.1.min(end.1));
                        outline.high = (outline.high.0.max(end.0), outline.high.1.max(end.1));
                    }
                    outline.pieces.push((piece.a, piece.b));
                }
            }
        }
        Regions { outlines }
    }

    /// Shows `visit` the polygons that hold the points just left (or right) of the middle of `a ->
    /// b`, last drawn first, until it has seen enough and returns true.
    pub(super) fn beside(
        &self,
        a: Point,
        b: Point,
        left: bool,
        mut visit: impl FnMut(usize) -> bool,
    ) {
        // Doubled coordinates make the middle a grid point.
        let middle = (a.0 + b.0, a.1 + b.1);
        let along = sub(b, a);
        let normal = if left { (-along.1, along.0) } else { (along.1, -along.0) };
        for (polygon, outline) in self.outlines.iter().enumerate().rev() {
            let near = 2 * outline.low.0 <= middle.0
                && middle.0 <= 2 * outline.high.0
                && 2 * outline.low.1 <= middle.1
                && middle.1 <= 2 * outline.high.1;
            if near && holds(&outline.pieces, middle, normal) && visit(polygon) {
                return;
            }
        }
    }
}

/// Even-odd test of the point an infinitesimal step from `middle` (doubled) along `normal`: the ray
/// goes east, ties are decided by the step.
fn holds(pieces: &[(Point, Point)], middle: Point, normal: Point) -> bool {
    let above = |p: Point| 2 * p.1 > middle.1 || (2 * p.1 == middle.1 && normal.1 < 0);
    let mut inside = false;
    for &(p, q) in pieces {
        let (p_above, q_above) = (above(p), above(q));
        if p_above == q_above {
            continue;
        }
        let along = sub(q, p);
        let turn = match cross(along, (middle.0 - 2 * p.0, middle.1 - 2 * p.1)) {
            0 => cross(along, normal),
            turn => turn,
        };
        // The point is west of a piece that goes up if it is on its left.
        if (turn > 0) == q_above {
            inside = !inside;
        }
    }
    inside
}
