//! Clipping what is open of the columns of a seg.

crate::simd::kernel_files!(avx2, avx512, sixteen);
pub mod parts;
pub mod pass;
mod rows;
mod scalar;

use crate::render::view::line::Edge;
use crate::render::walls::clip::parts::{Parts, Side};
use crate::simd::{Simd, dispatch};
use pass::ClipLists;
use std::ops::Range;

/// In some columns the plane takes the rows up to the first edge, the wall those from there to the
/// second one, and what is left stays open: from below if the side is [`parts::Floor`], else from above. Where the plane
/// has rows already, another one goes on. Returns whether any of the wall is to be seen.
#[inline]
pub(crate) fn clip_columns<S: Side, P: Parts>(
    simd: Simd,
    lists: &mut ClipLists,
    columns: Range<usize>,
    plane: u16,
    edges: [Edge; 2],
) -> bool {
    dispatch!(simd;
        avx512 => sixteen::clip_avx512::<S, P>(lists, columns, plane, edges),
        avx2 if edges.iter().all(Edge::is_exact) => sixteen::clip_avx2::<S, P>(lists, columns, plane, edges),
        scalar => pass::clip_by::<i16, S, P>(lists, columns, plane, edges),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::TextureId;
    use crate::math::{Fixed, Rng};
    use crate::render::blocks::{COLUMN_BLOCK, padded};
    use crate::render::buffers::clip::ColumnClip;
    use crate::render::buffers::visplane::VisPlaneKey;
    use crate::render::buffers::visplane::VisPlanes;
    use crate::render::view::size::FrameSize;
    use crate::render::view::tables::View;
    use crate::render::walls::clip::parts::{Ceiling, Floor, PlaneAndWall, PlaneOnly, WallOnly};

    const KEY: VisPlaneKey =
        VisPlaneKey { height: Fixed::ZERO, texture: TextureId(0), light: 0, sky: false };

    /// What a frame's segs clip_columns, and the rows of a wall.
    #[derive(Clone)]
    struct Lists {
        clip: ColumnClip,
        planes: VisPlanes,
        wall: [Vec<i16>; 2],
    }

    impl Lists {
        fn new(view: &View) -> Lists {
            let mut lists = Lists {
                clip: ColumnClip::default(),
                planes: VisPlanes::default(),
                wall: [const { vec![] }; 2],
            };
            lists.clip.reset(view.width(), view.view_rows);
            lists.planes.reset(view.width());
            lists.wall = [const { vec![] }; 2].map(|_: Vec<i16>| vec![0; padded(view.width())]);
            lists
        }

        /// All that is to be seen of them; `columns` are those of the wall.
        fn seen(&self, columns: &Range<usize>) -> impl PartialEq + std::fmt::Debug + use<> {
            let width = self.wall[0].len() - COLUMN_BLOCK;
            let open: Vec<bool> = (0..width).map(|x| self.clip.any_open(x, x + 1)).collect();
            let rows = [self.clip.top.clone(), self.clip.bottom.clone()];
            let planes: Vec<_> = self
                .planes
                .used()
                .iter()
                .map(|plane| (plane.top.clone(), plane.bottom.clone()))
                .collect();
            (rows, open, self.wall.clone().map(|list| list[columns.clone()].to_vec()), planes)
        }

        fn clip_columns<S: Side, P: Parts>(
            &mut self,
            simd: Simd,
            view: &View,
            columns: Range<usize>,
            edges: [Edge; 2],
        ) -> bool {
            let plane = if P::PLANE { self.planes.find(KEY) } else { 0 };
            let wall = self.wall.each_mut().map(|list| &mut list[..]);
            let mut lists =
                ClipLists { view, clip: &mut self.clip, planes: &mut self.planes, wall };
            clip_columns::<S, P>(simd, &mut lists, columns, plane, edges)
        }

        /// What it means, a column at a time, where the plane has no rows yet.
        fn narrow_plainly<S: Side, P: Parts>(
            &mut self,
            view: &View,
            columns: Range<usize>,
            [edge, wall]: [Edge; 2],
        ) -> bool {
            let (ColumnClip { top: tops, bottom: bottoms, .. }, [uppers, lowers]) =
                (&mut self.clip, &mut self.wall);
            let (mut walled, mut closed) = (false, vec![]);
            for x in columns {
                let frame_row = |edge: Edge| {
                    let base = edge
                        .base_row(i64::from(view.columns[x]))
                        .clamp(0, i64::from(view.base_view_rows));
                    view.first_row[base as usize]
                };
                let (top, bottom) = (tops[x], bottoms[x]);
                let row = frame_row(edge).max(top).min(bottom);
                let far = if S::FLOOR {
                    frame_row(wall).max(top).min(row)
                } else {
                    frame_row(wall).max(row).min(bottom)
                };
                let open = if P::WALL { far } else { row };
                if P::PLANE {
                    let plane = self.planes.find(KEY);
                    let [plane_top, plane_bottom] = self.planes.columns(plane, x, x + 1);
                    (plane_top[0], plane_bottom[0]) =
                        if S::FLOOR { (row, bottom) } else { (top, row) };
                }
                if P::WALL {
                    (uppers[x], lowers[x]) = if S::FLOOR { (open, row) } else { (row, open) };
                    walled |= open != row;
                }
                *(if S::FLOOR { &mut bottoms[x] } else { &mut tops[x] }) = open;
                if tops[x] >= bottoms[x] {
                    closed.push(x);
                }
            }
            closed.into_iter().for_each(|x| self.clip.close(x, x + 1));
            walled
        }
    }

    fn compare<S: Side, P: Parts>(view: &View, rng: &mut Rng) {
        let (width, rows) = (view.width(), view.view_rows as i32);
        let mut lists = Lists::new(view);
        for x in 0..width {
            let (top, bottom) = (rng.between(0, rows / 2) as i16, rng.between(0, rows) as i16);
            (lists.clip.top[x], lists.clip.bottom[x]) = (top, bottom);
            // What is closed has no rows.
            if top >= bottom {
                lists.clip.close(x, x + 1);
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
        let walled = plain.narrow_plainly::<S, P>(view, columns.clone(), edges);
        for simd in Simd::available() {
            let mut lists = lists.clone();
            assert_eq!(
                lists.clip_columns::<S, P>(simd, view, columns.clone(), edges),
                walled,
                "{simd:?}"
            );
            assert_eq!(lists.seen(&columns), plain.seen(&columns), "{simd:?}");
        }
    }

    #[test]
    fn blocks_do_what_single_columns_would() {
        let mut rng = Rng::new(9);
        for (width, height) in [(128, 72), (160, 120), (100, 50), (1920, 1080)] {
            let view = View::new(FrameSize { width, height }).unwrap();
            for _ in 0..200 {
                compare::<Ceiling, PlaneOnly>(&view, &mut rng);
                compare::<Ceiling, PlaneAndWall>(&view, &mut rng);
                compare::<Ceiling, WallOnly>(&view, &mut rng);
                compare::<Floor, PlaneOnly>(&view, &mut rng);
                compare::<Floor, PlaneAndWall>(&view, &mut rng);
                compare::<Floor, WallOnly>(&view, &mut rng);
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
            assert!(!lists.clip_columns::<Ceiling, PlaneOnly>(simd, &view, 0..64, edges));
            let [first, other] = lists.planes.used() else {
                panic!("{} planes", lists.planes.used().len())
            };
            // Each column's rows are in one of both: the first one's as far as whole blocks go.
            let row = lists.clip.top[0];
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
