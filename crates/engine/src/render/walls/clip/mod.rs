//! Narrowing what is open of the columns of a seg: the pass over its columns that most of a frame's geometry comes down to.

#[cfg(target_arch = "x86_64")]
pub mod vector;

use crate::render::buffers::clip::Openings;
use crate::render::buffers::visplane::Planes;
use crate::render::view::line::Edge;
use crate::render::view::tables::RowScale;
use crate::render::view::tables::View;
#[cfg(target_arch = "x86_64")]
use crate::render::walls::clip::vector::{Avx2, Avx512};
#[cfg(target_arch = "x86_64")]
use crate::simd::Level;
use crate::simd::Simd;
use std::ops::Range;

/// What a seg narrows: lists by frame column, which are padded.
pub(crate) struct Narrowing<'a> {
    pub view: &'a View,
    /// What is open.
    pub openings: &'a mut Openings,
    /// The planes, one of which ends at the seg.
    pub planes: &'a mut Planes,
    /// Where the rows of a wall go: first, and one past the last.
    pub wall: [&'a mut [i16]; 2],
}

/// What came of a pass.
#[derive(Clone, Copy)]
struct Narrowed {
    /// Where it ended: before the last column where the plane has other rows in one of the next already.
    done: usize,
    /// Some of the wall is to be seen.
    walled: bool,
}

/// In some columns the plane takes the rows up to the first edge, the wall those from there to the second one, and what is left
/// stays open: from below if `FLOOR`, else from above. Where the plane has rows already, another one goes on. Returns whether any
/// of the wall is to be seen.
#[inline]
pub(crate) fn narrow<const FLOOR: bool, const PLANE: bool, const WALL: bool>(
    simd: Simd,
    lists: &mut Narrowing,
    columns: Range<usize>,
    plane: u16,
    edges: [Edge; 2],
) -> bool {
    #[cfg(target_arch = "x86_64")]
    match simd.level() {
        // SAFETY: whoever has this `Simd` has the instructions.
        Level::Avx512 => return unsafe { narrow_avx512::<FLOOR, PLANE, WALL>(lists, columns, plane, edges) },
        // SAFETY: as above.
        Level::Avx2 if edges.iter().all(Edge::is_exact) => {
            return unsafe { narrow_avx2::<FLOOR, PLANE, WALL>(lists, columns, plane, edges) };
        }
        _ => {}
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = simd;
    narrow_by::<i16, FLOOR, PLANE, WALL>(lists, columns, plane, edges)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
fn narrow_avx512<const FLOOR: bool, const PLANE: bool, const WALL: bool>(
    lists: &mut Narrowing,
    columns: Range<usize>,
    plane: u16,
    edges: [Edge; 2],
) -> bool {
    narrow_by::<Avx512, FLOOR, PLANE, WALL>(lists, columns, plane, edges)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn narrow_avx2<const FLOOR: bool, const PLANE: bool, const WALL: bool>(
    lists: &mut Narrowing,
    columns: Range<usize>,
    plane: u16,
    edges: [Edge; 2],
) -> bool {
    narrow_by::<Avx2, FLOOR, PLANE, WALL>(lists, columns, plane, edges)
}

#[inline(always)]
fn narrow_by<R: Rows, const FLOOR: bool, const PLANE: bool, const WALL: bool>(
    lists: &mut Narrowing,
    mut columns: Range<usize>,
    mut plane: u16,
    edges: [Edge; 2],
) -> bool {
    let mut walled = false;
    loop {
        let narrowed = pass::<R, FLOOR, PLANE, WALL>(lists, columns.clone(), plane, edges);
        walled |= narrowed.walled;
        if narrowed.done >= columns.end {
            return walled;
        }
        columns.start = narrowed.done;
        plane = lists.planes.start_another(plane);
    }
}

/// A row for each of some columns side by side; as an answer, all bits or none.
pub(crate) trait Rows: Copy {
    /// Columns.
    const COUNT: usize;
    /// That many of something.
    type Block<T>;

    /// A list in whole blocks; what is left over is no part of any.
    fn blocks<T>(list: &[T]) -> &[Self::Block<T>];
    fn blocks_mut<T>(list: &mut [T]) -> &mut [Self::Block<T>];
    /// The frame rows of an edge in base columns.
    fn of_edge(scale: &RowScale, edge: Edge, base: &Self::Block<u32>) -> Self;
    fn load(block: &Self::Block<i16>) -> Self;
    fn store(self, block: &mut Self::Block<i16>);
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
    type Block<T> = [T; 1];

    #[inline(always)]
    fn blocks<T>(list: &[T]) -> &[[T; 1]] {
        list.as_chunks().0
    }

    #[inline(always)]
    fn blocks_mut<T>(list: &mut [T]) -> &mut [[T; 1]] {
        list.as_chunks_mut().0
    }

    #[inline(always)]
    fn of_edge(scale: &RowScale, edge: Edge, base: &[u32; 1]) -> i16 {
        scale.frame_row(edge.base_row(i64::from(base[0])))
    }

    #[inline(always)]
    fn load(block: &[i16; 1]) -> i16 {
        block[0]
    }

    #[inline(always)]
    fn store(self, block: &mut [i16; 1]) {
        block[0] = self;
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

/// As [`narrow`], until the plane has rows already.
#[inline(always)]
fn pass<R: Rows, const FLOOR: bool, const PLANE: bool, const WALL: bool>(
    lists: &mut Narrowing,
    columns: Range<usize>,
    plane: u16,
    [edge, wall]: [Edge; 2],
) -> Narrowed {
    let first = columns.start;
    // All lists are cut to the same number of blocks once, so that no place in them is in doubt later.
    let blocks = columns.len().div_ceil(R::COUNT);
    let of = |used: bool| ..if used { blocks } else { 0 };
    let (tops, bottoms, mut open_columns) = lists.openings.from(first);
    let (tops, bottoms) = (&mut R::blocks_mut(tops)[of(true)], &mut R::blocks_mut(bottoms)[of(true)]);
    let (base, scale) = (&R::blocks(&lists.view.columns[first..])[of(true)], &lists.view.row_scale);
    let [uppers, lowers] = lists.wall.each_mut().map(|list| &mut R::blocks_mut(&mut list[first..])[of(WALL)]);
    let plane_rows = if PLANE { lists.planes.columns(plane, first, columns.end) } else { [&mut [][..], &mut []] };
    let [plane_tops, plane_bottoms] = plane_rows.map(|list| &mut R::blocks_mut(list)[of(PLANE)]);
    let mut walled = R::first(0).and_not(R::first(0));
    for i in 0..blocks {
        let at = i * R::COUNT;
        let inside = R::first(columns.len() - at);
        let (top, bottom) = (R::load(&tops[i]), R::load(&bottoms[i]));
        let row = R::of_edge(scale, edge, &base[i]).at_least(top).at_most(bottom);
        if PLANE {
            let (from, to) = if FLOOR { (row, bottom) } else { (top, row) };
            let (plane_top, plane_bottom) = (R::load(&plane_tops[i]), R::load(&plane_bottoms[i]));
            let taken = plane_top.is_less(plane_bottom);
            if inside.and(taken).and(from.is_less(to)).any() {
                return Narrowed { done: first + at, walled: walled.any() };
            }
            let free = inside.and_not(taken);
            free.choose(from, plane_top).store(&mut plane_tops[i]);
            free.choose(to, plane_bottom).store(&mut plane_bottoms[i]);
        }
        let mut open = row;
        if WALL {
            let far = R::of_edge(scale, wall, &base[i]);
            open = if FLOOR { far.at_least(top).at_most(row) } else { far.at_least(row).at_most(bottom) };
            let (upper, lower) = if FLOOR { (open, row) } else { (row, open) };
            // Who reads these looks at no column beyond the seg's.
            upper.store(&mut uppers[i]);
            lower.store(&mut lowers[i]);
            walled = inside.and(upper.is_less(lower)).choose(inside, walled);
        }
        let (open_top, open_bottom) = if FLOOR { (top, open) } else { (open, bottom) };
        let closed = inside.and(top.is_less(bottom)).and_not(open_top.is_less(open_bottom));
        inside.choose(open_top, top).and_not(closed).store(&mut tops[i]);
        inside.choose(open_bottom, bottom).and_not(closed).store(&mut bottoms[i]);
        open_columns.close(at, closed.bits());
    }
    Narrowed { done: columns.end, walled: walled.any() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::TextureId;
    use crate::math::{Fixed, Rng};
    use crate::render::blocks::{COLUMN_BLOCK, padded};
    use crate::render::buffers::visplane::PlaneKey;
    use crate::render::view::size::FrameSize;

    const KEY: PlaneKey = PlaneKey { height: Fixed::ZERO, texture: TextureId(0), light: 0, sky: false };

    /// What a frame's segs narrow, and the rows of a wall.
    #[derive(Clone)]
    struct Lists {
        openings: Openings,
        planes: Planes,
        wall: [Vec<i16>; 2],
    }

    impl Lists {
        fn new(view: &View) -> Lists {
            let mut lists = Lists { openings: Openings::default(), planes: Planes::default(), wall: [const { vec![] }; 2] };
            lists.openings.reset(view.width(), view.view_rows);
            lists.planes.reset(view.width());
            lists.wall = [const { vec![] }; 2].map(|_: Vec<i16>| vec![0; padded(view.width())]);
            lists
        }

        /// All that is to be seen of them; `columns` are those of the wall.
        fn seen(&self, columns: &Range<usize>) -> impl PartialEq + std::fmt::Debug + use<> {
            let width = self.wall[0].len() - COLUMN_BLOCK;
            let open: Vec<bool> = (0..width).map(|x| self.openings.any_open(x, x + 1)).collect();
            let rows = [self.openings.top.clone(), self.openings.bottom.clone()];
            let planes: Vec<_> = self.planes.used().iter().map(|plane| (plane.top.clone(), plane.bottom.clone())).collect();
            (rows, open, self.wall.clone().map(|list| list[columns.clone()].to_vec()), planes)
        }

        fn narrow<const FLOOR: bool, const PLANE: bool, const WALL: bool>(
            &mut self,
            simd: Simd,
            view: &View,
            columns: Range<usize>,
            edges: [Edge; 2],
        ) -> bool {
            let plane = if PLANE { self.planes.find(KEY) } else { 0 };
            let wall = self.wall.each_mut().map(|list| &mut list[..]);
            let mut lists = Narrowing { view, openings: &mut self.openings, planes: &mut self.planes, wall };
            narrow::<FLOOR, PLANE, WALL>(simd, &mut lists, columns, plane, edges)
        }

        /// What it means, a column at a time, where the plane has no rows yet.
        fn narrow_plainly<const FLOOR: bool, const PLANE: bool, const WALL: bool>(
            &mut self,
            view: &View,
            columns: Range<usize>,
            [edge, wall]: [Edge; 2],
        ) -> bool {
            let (Openings { top: tops, bottom: bottoms, .. }, [uppers, lowers]) = (&mut self.openings, &mut self.wall);
            let (mut walled, mut closed) = (false, vec![]);
            for x in columns {
                let frame_row = |edge: Edge| {
                    let base = edge.base_row(i64::from(view.columns[x])).clamp(0, i64::from(view.base_view_rows));
                    view.first_row[base as usize]
                };
                let (top, bottom) = (tops[x], bottoms[x]);
                let row = frame_row(edge).max(top).min(bottom);
                let far = if FLOOR { frame_row(wall).max(top).min(row) } else { frame_row(wall).max(row).min(bottom) };
                let open = if WALL { far } else { row };
                if PLANE {
                    let plane = self.planes.find(KEY);
                    let [plane_top, plane_bottom] = self.planes.columns(plane, x, x + 1);
                    (plane_top[0], plane_bottom[0]) = if FLOOR { (row, bottom) } else { (top, row) };
                }
                if WALL {
                    (uppers[x], lowers[x]) = if FLOOR { (open, row) } else { (row, open) };
                    walled |= open != row;
                }
                *(if FLOOR { &mut bottoms[x] } else { &mut tops[x] }) = open;
                if tops[x] >= bottoms[x] {
                    closed.push(x);
                }
            }
            closed.into_iter().for_each(|x| self.openings.close(x, x + 1));
            walled
        }
    }

    fn compare<const FLOOR: bool, const PLANE: bool, const WALL: bool>(view: &View, rng: &mut Rng) {
        let (width, rows) = (view.width(), view.view_rows as i32);
        let mut lists = Lists::new(view);
        for x in 0..width {
            let (top, bottom) = (rng.between(0, rows / 2) as i16, rng.between(0, rows) as i16);
            (lists.openings.top[x], lists.openings.bottom[x]) = (top, bottom);
            // What is closed has no rows.
            if top >= bottom {
                lists.openings.close(x, x + 1);
            }
        }
        let first = rng.below(width as u32) as usize;
        let columns = first..first + 1 + rng.below((width - first) as u32) as usize;
        // Now and then as steep as walls at the eye are.
        let steep = if rng.below(4) == 0 { rng.below(16) } else { 0 };
        let mut edge = |spread: i32| Edge {
            at: i64::from(rng.between(-spread, spread)) << (24 + steep),
            step: i64::from(rng.between(-1 << 26, 1 << 26)) << steep,
        };
        let edges = [edge(rows), edge(rows * 200)];
        let mut plain = lists.clone();
        let walled = plain.narrow_plainly::<FLOOR, PLANE, WALL>(view, columns.clone(), edges);
        for simd in Simd::available() {
            let mut lists = lists.clone();
            assert_eq!(lists.narrow::<FLOOR, PLANE, WALL>(simd, view, columns.clone(), edges), walled, "{simd:?}");
            assert_eq!(lists.seen(&columns), plain.seen(&columns), "{simd:?}");
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
    fn where_a_plane_has_rows_another_one_goes_on() {
        let view = View::new(FrameSize::LEARNER).unwrap();
        let edges = [Edge { at: 20 << 24, step: 0 }; 2];
        for simd in Simd::available() {
            let mut lists = Lists::new(&view);
            let plane = lists.planes.find(KEY);
            let [plane_top, plane_bottom] = lists.planes.columns(plane, 40, 41);
            (plane_top[0], plane_bottom[0]) = (3, 4);
            assert!(!lists.narrow::<false, true, false>(simd, &view, 0..64, edges));
            let [first, other] = lists.planes.used() else { panic!("{} planes", lists.planes.used().len()) };
            // Each column's rows are in one of both: the first one's as far as whole blocks go.
            let row = lists.openings.top[0];
            let split = (0..=40).rev().find(|&x| x == 0 || first.bottom[x - 1] == row).unwrap();
            assert!((32..=40).contains(&split), "{split}");
            for x in 0..64 {
                let (with, without) = if x < split { (first, other) } else { (other, first) };
                assert_eq!((with.top[x], with.bottom[x]), (0, row), "{x}");
                assert!(x == 40 || without.top[x] >= without.bottom[x], "{x}");
            }
            assert_eq!((first.top[40], first.bottom[40]), (3, 4));
        }
    }
}
