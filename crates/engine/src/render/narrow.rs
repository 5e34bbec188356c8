//! Narrowing what is open of the columns of a seg: the pass over its columns that most of a frame's geometry comes down to.

#[cfg(target_arch = "x86_64")]
use super::narrow_wide::{Avx2, Avx512};
use super::openings::OpenColumns;
use super::view::RowScale;
use super::wall::Edge;
#[cfg(target_arch = "x86_64")]
use crate::simd::Level;
use crate::simd::Simd;

/// Most columns that are narrowed at once. Lists by column are that much longer than a frame is wide, so that the last
/// columns of a seg need no other code: what lies beyond is read, and left as it is.
pub(super) const BLOCK: usize = 16;

/// Length of a list by column.
pub(super) const fn padded(width: usize) -> usize {
    width + BLOCK
}

/// The columns of a seg, and what is open of them; lists begin at its first column and are padded.
pub(super) struct Columns<'a> {
    /// Columns of the seg.
    pub count: usize,
    /// Base columns.
    pub base: &'a [u32],
    /// First open row.
    pub top: &'a mut [i16],
    /// One past the last open row.
    pub bottom: &'a mut [i16],
    /// Which are open.
    pub open: OpenColumns<'a>,
    /// Where the rows of a wall go: first, and one past the last.
    pub wall: [&'a mut [i16]; 2],
    /// The rows of the plane that ends at the seg, if it is seen.
    pub plane: [&'a mut [i16]; 2],
}

/// What came of a pass.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct Narrowed {
    /// Columns that are done: fewer than all where the plane has other rows in one of the next already.
    pub done: usize,
    /// Some of the wall is to be seen.
    pub walled: bool,
}

/// The plane takes the rows up to `edge`, the wall those from there to `wall`, and what is left stays open: from below if
/// `FLOOR`, else from above. Begins at column `done`.
#[inline]
pub(super) fn narrow<const FLOOR: bool, const PLANE: bool, const WALL: bool>(
    simd: Simd,
    scale: &RowScale,
    edges: [Edge; 2],
    columns: &mut Columns,
    done: usize,
) -> Narrowed {
    #[cfg(target_arch = "x86_64")]
    match simd.level() {
        // SAFETY: whoever has this `Simd` has the instructions.
        Level::Avx512 => return unsafe { narrow_avx512::<FLOOR, PLANE, WALL>(scale, edges, columns, done) },
        // SAFETY: as above.
        Level::Avx2 => return unsafe { narrow_avx2::<FLOOR, PLANE, WALL>(scale, edges, columns, done) },
        Level::Plain => {}
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = simd;
    pass::<i16, FLOOR, PLANE, WALL>(scale, edges, columns, done)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
fn narrow_avx512<const FLOOR: bool, const PLANE: bool, const WALL: bool>(
    scale: &RowScale,
    edges: [Edge; 2],
    columns: &mut Columns,
    done: usize,
) -> Narrowed {
    pass::<Avx512, FLOOR, PLANE, WALL>(scale, edges, columns, done)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn narrow_avx2<const FLOOR: bool, const PLANE: bool, const WALL: bool>(
    scale: &RowScale,
    edges: [Edge; 2],
    columns: &mut Columns,
    done: usize,
) -> Narrowed {
    pass::<Avx2, FLOOR, PLANE, WALL>(scale, edges, columns, done)
}

/// A row for each of some columns side by side; as an answer, all bits or none.
pub(super) trait Rows: Copy {
    /// Columns.
    const COUNT: usize;

    /// The frame rows of an edge.
    fn of_edge(scale: &RowScale, edge: Edge, base: &[u32]) -> Self;
    fn load(list: &[i16]) -> Self;
    fn store(self, list: &mut [i16]);
    fn at_least(self, other: Self) -> Self;
    fn at_most(self, other: Self) -> Self;
    fn is_less(self, than: Self) -> Self;
    fn and(self, other: Self) -> Self;
    fn and_not(self, other: Self) -> Self;
    /// `yes` where it answers so, else `no`.
    fn choose(self, yes: Self, no: Self) -> Self;
    /// Whether the answer is yes in any column.
    fn any(self) -> bool;
    /// A bit for each column, set where the answer is yes.
    fn bits(self) -> u64;
    /// Yes in the first `count` columns.
    fn first(count: usize) -> Self;
}

/// One column: what the pass means.
impl Rows for i16 {
    const COUNT: usize = 1;

    #[inline(always)]
    fn of_edge(scale: &RowScale, edge: Edge, base: &[u32]) -> i16 {
        scale.frame_row(edge.base_row(i64::from(base[0])))
    }

    #[inline(always)]
    fn load(list: &[i16]) -> i16 {
        list[0]
    }

    #[inline(always)]
    fn store(self, list: &mut [i16]) {
        list[0] = self;
    }

    #[inline(always)]
    fn at_least(self, other: i16) -> i16 {
        self.max(other)
    }

    #[inline(always)]
    fn at_most(self, other: i16) -> i16 {
        self.min(other)
    }

    #[inline(always)]
    fn is_less(self, than: i16) -> i16 {
        -i16::from(self < than)
    }

    #[inline(always)]
    fn and(self, other: i16) -> i16 {
        self & other
    }

    #[inline(always)]
    fn and_not(self, other: i16) -> i16 {
        self & !other
    }

    #[inline(always)]
    fn choose(self, yes: i16, no: i16) -> i16 {
        if self != 0 { yes } else { no }
    }

    #[inline(always)]
    fn any(self) -> bool {
        self != 0
    }

    #[inline(always)]
    fn bits(self) -> u64 {
        u64::from(self != 0)
    }

    #[inline(always)]
    fn first(_: usize) -> i16 {
        -1
    }
}

#[inline(always)]
fn pass<R: Rows, const FLOOR: bool, const PLANE: bool, const WALL: bool>(
    scale: &RowScale,
    [edge, wall]: [Edge; 2],
    columns: &mut Columns,
    done: usize,
) -> Narrowed {
    let Columns { count, base, top: tops, bottom: bottoms, open: open_columns, wall: [uppers, lowers], plane } = columns;
    let [plane_tops, plane_bottoms] = plane;
    let (mut at, mut walled) = (done, R::first(0).and_not(R::first(0)));
    while at < *count {
        let inside = R::first(*count - at);
        let (top, bottom) = (R::load(&tops[at..]), R::load(&bottoms[at..]));
        let row = R::of_edge(scale, edge, &base[at..]).at_least(top).at_most(bottom);
        if PLANE {
            let (from, to) = if FLOOR { (row, bottom) } else { (top, row) };
            let (plane_top, plane_bottom) = (R::load(&plane_tops[at..]), R::load(&plane_bottoms[at..]));
            let taken = plane_top.is_less(plane_bottom);
            if inside.and(taken).and(from.is_less(to)).any() {
                break;
            }
            let free = inside.and_not(taken);
            free.choose(from, plane_top).store(&mut plane_tops[at..]);
            free.choose(to, plane_bottom).store(&mut plane_bottoms[at..]);
        }
        let mut open = row;
        if WALL {
            let far = R::of_edge(scale, wall, &base[at..]);
            open = if FLOOR { far.at_least(top).at_most(row) } else { far.at_least(row).at_most(bottom) };
            let (upper, lower) = if FLOOR { (open, row) } else { (row, open) };
            // Who reads these looks at no column beyond the seg's.
            upper.store(&mut uppers[at..]);
            lower.store(&mut lowers[at..]);
            walled = inside.and(upper.is_less(lower)).choose(inside, walled);
        }
        let (open_top, open_bottom) = if FLOOR { (top, open) } else { (open, bottom) };
        let closed = inside.and(top.is_less(bottom)).and_not(open_top.is_less(open_bottom));
        inside.choose(open_top, top).and_not(closed).store(&mut tops[at..]);
        inside.choose(open_bottom, bottom).and_not(closed).store(&mut bottoms[at..]);
        open_columns.close(at, closed.bits());
        at += R::COUNT;
    }
    Narrowed { done: at.min(*count), walled: walled.any() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rng;
    use crate::render::{FrameSize, View};

    /// The lists of a seg and of the plane that ends there, and the bits of columns that are open.
    #[derive(Clone, PartialEq, Debug)]
    struct Lists([Vec<i16>; 6], Vec<u64>);

    /// What the pass means, a column at a time.
    fn plainly<const FLOOR: bool, const PLANE: bool, const WALL: bool>(
        view: &View,
        [edge, wall]: [Edge; 2],
        Lists(lists, open_bits): &mut Lists,
        first: usize,
        count: usize,
    ) -> Narrowed {
        let mut narrowed = Narrowed::default();
        let [tops, bottoms, uppers, lowers, plane_tops, plane_bottoms] = lists;
        for x in first..first + count {
            let frame_row = |edge: Edge| {
                view.first_row[edge.base_row(i64::from(view.columns[x])).clamp(0, i64::from(view.base_view_rows)) as usize]
            };
            let (top, bottom) = (tops[x], bottoms[x]);
            let row = frame_row(edge).max(top).min(bottom);
            let far = if FLOOR { frame_row(wall).max(top).min(row) } else { frame_row(wall).max(row).min(bottom) };
            let open = if WALL { far } else { row };
            if PLANE && plane_tops[x] >= plane_bottoms[x] {
                (plane_tops[x], plane_bottoms[x]) = if FLOOR { (row, bottom) } else { (top, row) };
            }
            if WALL {
                (uppers[x], lowers[x]) = if FLOOR { (open, row) } else { (row, open) };
                narrowed.walled |= open != row;
            }
            *(if FLOOR { &mut bottoms[x] } else { &mut tops[x] }) = open;
            if tops[x] >= bottoms[x] {
                open_bits[x / 64] &= !(1 << (x % 64));
                (tops[x], bottoms[x]) = (0, 0);
            }
            narrowed.done += 1;
        }
        narrowed
    }

    fn compare<const FLOOR: bool, const PLANE: bool, const WALL: bool>(view: &View, rng: &mut Rng) {
        let width = view.columns.len() - BLOCK;
        let rows = view.view_rows as i32;
        let mut any_row = |range: i32| rng.between(0, range) as i16;
        let open: Vec<(i16, i16)> = (0..padded(width)).map(|_| (any_row(rows / 2), any_row(rows))).collect();
        let nothing = vec![0; padded(width)];
        // What is closed has no rows.
        let open: Vec<(i16, i16)> =
            open.into_iter().map(|(top, bottom)| if top < bottom { (top, bottom) } else { (0, 0) }).collect();
        let lists = [open.iter().map(|o| o.0).collect(), open.iter().map(|o| o.1).collect()];
        let [top, bottom]: [Vec<i16>; 2] = lists;
        let bits = open.chunks(64).map(|open| open.iter().rev().fold(0, |bits, o| bits << 1 | u64::from(o.0 < o.1))).collect();
        let mut lists = Lists([top, bottom, nothing.clone(), nothing.clone(), nothing.clone(), nothing], bits);
        let first = rng.below(width as u32) as usize;
        let count = 1 + rng.below((width - first) as u32) as usize;
        let mut edge = |spread: i32| Edge {
            at: i64::from(rng.between(-spread, spread)) << 24,
            step: i64::from(rng.between(-1 << 26, 1 << 26)),
        };
        let edges = [edge(rows), edge(rows * 200)];
        let mut plain = lists.clone();
        let expected = plainly::<FLOOR, PLANE, WALL>(view, edges, &mut plain, first, count);
        let start = lists.clone();
        for simd in Simd::available() {
            lists.clone_from(&start);
            let Lists(rows, bits) = &mut lists;
            let [top, bottom, upper, lower, plane_top, plane_bottom] = rows.each_mut().map(|list| &mut list[first..]);
            let mut closed = 0;
            let mut columns = Columns {
                count,
                base: &view.columns[first..],
                top,
                bottom,
                open: OpenColumns { bits, closed: &mut closed, first },
                wall: [upper, lower],
                plane: [plane_top, plane_bottom],
            };
            assert_eq!(narrow::<FLOOR, PLANE, WALL>(simd, &view.row_scale, edges, &mut columns, 0), expected, "{simd:?}");
            // Rows of walls beyond the seg mean nothing.
            for wall in [2, 3] {
                lists.0[wall][first + count..].fill(0);
            }
            assert_eq!(lists, plain, "{simd:?}");
            let open = |lists: &Lists| lists.1.iter().map(|word| word.count_ones() as usize).sum::<usize>();
            assert_eq!(closed, open(&start) - open(&plain), "{simd:?}");
        }
    }

    #[test]
    fn blocks_do_what_single_columns_would() {
        let mut rng = Rng::new(9);
        for (width, height) in [(128, 72), (160, 120), (100, 50), (1920, 1080)] {
            let view = View::new(FrameSize { width, height }).unwrap();
            for _ in 0..200 {
                compare::<false, true, false>(&view, &mut rng);
                compare::<false, true, true>(&view, &mut rng);
                compare::<false, false, true>(&view, &mut rng);
                compare::<true, true, false>(&view, &mut rng);
                compare::<true, true, true>(&view, &mut rng);
                compare::<true, false, true>(&view, &mut rng);
            }
        }
    }

    #[test]
    fn a_plane_that_has_rows_stops_the_pass() {
        let view = View::new(FrameSize::LEARNER).unwrap();
        let edges = [Edge { at: 20 << 24, step: 0 }; 2];
        for simd in Simd::available() {
            let (mut top, mut bottom, mut plane) = (vec![0; 80], vec![60; 80], [vec![0; 80], vec![0; 80]]);
            (plane[0][40], plane[1][40]) = (3, 4);
            let [plane_top, plane_bottom] = &mut plane;
            let (top, bottom) = (&mut top[..], &mut bottom[..]);
            let (mut bits, mut closed) = ([u64::MAX; 2], 0);
            let mut columns = Columns {
                count: 64,
                base: &view.columns,
                top,
                bottom,
                open: OpenColumns { bits: &mut bits, closed: &mut closed, first: 0 },
                wall: [&mut [], &mut []],
                plane: [plane_top, plane_bottom],
            };
            let narrowed = narrow::<false, true, false>(simd, &view.row_scale, edges, &mut columns, 0);
            assert!((32..=40).contains(&narrowed.done) && !narrowed.walled && closed == 0, "{narrowed:?}");
        }
    }
}
