//! The pass over the columns of a seg that most of a frame's geometry comes down to.

use crate::render::buffers::clip::ColumnClip;
use crate::render::buffers::visplane::VisPlanes;
use crate::render::view::line::Edge;
use crate::render::view::tables::View;
use crate::render::walls::clip::parts::{Parts, Side};
use crate::render::walls::clip::rows::Rows;
use std::ops::Range;

/// What a seg clips: lists by frame column, which are padded.
pub(crate) struct ClipLists<'a> {
    pub view: &'a View,
    /// What is open.
    pub clip: &'a mut ColumnClip,
    /// The planes, one of which ends at the seg.
    pub planes: &'a mut VisPlanes,
    /// Where the rows of a wall go: first, and one past the last.
    pub wall: [&'a mut [i16]; 2],
}

/// What came of a pass.
#[derive(Clone, Copy)]
struct Clipped {
    /// Where it ended: before the last column where the plane has other rows in one of the next
    /// already.
    done: usize,
    /// Some of the wall is to be seen.
    walled: bool,
}

#[inline(always)]
pub(crate) fn clip_by<R: Rows, S: Side, P: Parts>(
    lists: &mut ClipLists,
    mut columns: Range<usize>,
    mut plane: u16,
    edges: [Edge; 2],
) -> bool {
    let mut walled = false;
    loop {
        let clipped = pass::<R, S, P>(lists, columns.clone(), plane, edges);
        walled |= clipped.walled;
        if clipped.done >= columns.end {
            return walled;
        }
        columns.start = clipped.done;
        plane = lists.planes.split(plane);
    }
}

/// As [`clip_columns`], until the plane has rows already.
#[inline(always)]
fn pass<R: Rows, S: Side, P: Parts>(
    lists: &mut ClipLists,
    columns: Range<usize>,
    plane: u16,
    [edge, wall]: [Edge; 2],
) -> Clipped {
    let first = columns.start;
    // All lists are cut to the same number of blocks once, so that no place in them is in doubt
    // later.
    let blocks = columns.len().div_ceil(R::COUNT);
    let of = |used: bool| ..if used { blocks } else { 0 };
    let (tops, bottoms, mut open_columns) = lists.clip.from(first);
    let (tops, bottoms) =
        (&mut R::blocks_mut(tops)[of(true)], &mut R::blocks_mut(bottoms)[of(true)]);
    let (base, scale) = (&R::blocks(&lists.view.columns[first..])[of(true)], &lists.view.row_scale);
    let [uppers, lowers] =
        lists.wall.each_mut().map(|list| &mut R::blocks_mut(&mut list[first..])[of(P::WALL)]);
    let plane_rows = if P::PLANE {
        lists.planes.columns(plane, first, columns.end)
    } else {
        [&mut [][..], &mut []]
    };
    let [plane_tops, plane_bottoms] = plane_rows.map(|list| &mut R::blocks_mut(list)[of(P::PLANE)]);
    let mut walled = R::first(0).and_not(R::first(0));
    for i in 0..blocks {
        let at = i * R::COUNT;
        let inside = R::first(columns.len() - at);
        let (top, bottom) = (R::load(&tops[i]), R::load(&bottoms[i]));
        let row = R::of_edge(scale, edge, &base[i]).at_least(top).at_most(bottom);
        if P::PLANE {
            let (from, to) = if S::FLOOR { (row, bottom) } else { (top, row) };
            let (plane_top, plane_bottom) = (R::load(&plane_tops[i]), R::load(&plane_bottoms[i]));
            let taken = plane_top.is_less(plane_bottom);
            if inside.and(taken).and(from.is_less(to)).any() {
                return Clipped { done: first + at, walled: walled.any() };
            }
            let free = inside.and_not(taken);
            free.choose(from, plane_top).store(&mut plane_tops[i]);
            free.choose(to, plane_bottom).store(&mut plane_bottoms[i]);
        }
        let mut open = row;
        if P::WALL {
            let far = R::of_edge(scale, wall, &base[i]);
            open = if S::FLOOR {
                far.at_least(top).at_most(row)
            } else {
                far.at_least(row).at_most(bottom)
            };
            let (upper, lower) = if S::FLOOR { (open, row) } else { (row, open) };
            // Who reads these surfaces at no column beyond the seg's.
            upper.store(&mut uppers[i]);
            lower.store(&mut lowers[i]);
            walled = inside.and(upper.is_less(lower)).choose(inside, walled);
        }
        let (open_top, open_bottom) = if S::FLOOR { (top, open) } else { (open, bottom) };
        let closed = inside.and(top.is_less(bottom)).and_not(open_top.is_less(open_bottom));
        inside.choose(open_top, top).and_not(closed).store(&mut tops[i]);
        inside.choose(open_bottom, bottom).and_not(closed).store(&mut bottoms[i]);
        open_columns.close(at, closed.bits());
    }
    Clipped { done: columns.end, walled: walled.any() }
}
