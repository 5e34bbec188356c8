//! The walk through the BSP tree, front to back.

use super::View;
use super::camera::Camera;
use super::frame::Frame;
use super::openings::Openings;
use super::plane::Planes;
use super::scene::{NO_SECTOR, Scene};
use super::silhouette::Silhouettes;
use crate::map::Node;
use crate::math::Fixed;
use crate::world::SectorState;

/// Everything that the walk reads and writes.
pub(super) struct Walk<'a> {
    pub scene: &'a Scene,
    pub view: &'a View,
    pub camera: &'a Camera,
    pub sectors: &'a [SectorState],
    /// Index of the picture that each texture shows now.
    pub pictures: &'a [u32],
    pub frame: &'a mut Frame,
    pub openings: &'a mut Openings,
    pub planes: &'a mut Planes,
    pub silhouettes: &'a mut Silhouettes,
    /// Sectors that were entered.
    pub entered: &'a mut [bool],
    pub scratch: &'a mut WalkScratch,
}

/// Memory that the walk reuses.
#[derive(Clone, Debug)]
pub(super) struct WalkScratch {
    /// Children to visit later: node index times two, plus the side.
    stack: Vec<u32>,
    /// Segs of the subsector at hand that face the eye and matter, with their distance from it.
    facing: Vec<(u32, i64)>,
    /// Rows of the upper end of the part of a wall that is being drawn.
    pub upper: Vec<i16>,
    /// Rows of its lower end.
    pub lower: Vec<i16>,
}

impl WalkScratch {
    /// Room for frames of `width` columns of a scene.
    pub fn new(scene: &Scene, width: usize) -> WalkScratch {
        let most_segs = scene.subsectors.iter().map(|[first, end, _]| end - first).max().unwrap_or(0);
        WalkScratch {
            stack: vec![0; scene.nodes.len() + 2],
            facing: vec![(0, 0); most_segs as usize + 1],
            upper: vec![0; width],
            lower: vec![0; width],
        }
    }
}

/// One side of the view's wedge, as a test for boxes.
#[derive(Clone, Copy)]
struct WedgeSide {
    normal: [i64; 2],
    /// Which of (west, east) and (south, north) lies farthest inside.
    corner: [usize; 2],
}

impl WedgeSide {
    fn new(normal: [i64; 2]) -> WedgeSide {
        WedgeSide { normal, corner: [usize::from(normal[0] > 0), 2 + usize::from(normal[1] > 0)] }
    }

    /// Negative if the box lies wholly outside.
    #[inline]
    fn farthest_inside(&self, camera: &Camera, bounds: &[Fixed; 4]) -> i64 {
        let (x, y) = (bounds[self.corner[0]].0, bounds[self.corner[1]].0);
        (i64::from(x) - camera.x) * self.normal[0] + (i64::from(y) - camera.y) * self.normal[1]
    }
}

impl Walk<'_> {
    /// Walks until everything is covered.
    ///
    /// Which child is near and which one is in view cannot be foretold, so that all of it is arithmetic without
    /// branches: children that are out of view are written to the stack too, but not counted.
    pub fn run<const DEPTH: bool, const CLASS: bool>(&mut self) {
        let (scene, camera) = (self.scene, self.camera);
        let [cos, sin] = camera.forward;
        let wedge = [WedgeSide::new([cos + sin, sin - cos]), WedgeSide::new([cos - sin, sin + cos])];
        let (x, y) = (Fixed(camera.x as i32), Fixed(camera.y as i32));
        let mut stacked = 0;
        let mut child = match scene.nodes.len() {
            0 => Node::SUBSECTOR,
            count => count as u32 - 1,
        };
        loop {
            if child & Node::SUBSECTOR != 0 {
                self.subsector::<DEPTH, CLASS>((child & !Node::SUBSECTOR) as usize);
                if self.openings.all_closed() {
                    return;
                }
            } else {
                let node = &scene.nodes[child as usize];
                let near = u32::from(node.is_left(x, y));
                let inside = |bounds| wedge.iter().fold(0, |inside, side| inside | side.farthest_inside(camera, bounds));
                let in_view = [inside(&node.bounds[0]) >= 0, inside(&node.bounds[1]) >= 0];
                for side in [near ^ 1, near] {
                    self.scratch.stack[stacked] = child * 2 + side;
                    stacked += usize::from(in_view[side as usize]);
                }
            }
            // The next child that is not hidden.
            child = loop {
                if stacked == 0 {
                    return;
                }
                stacked -= 1;
                let entry = self.scratch.stack[stacked];
                let (node, side) = (&scene.nodes[(entry / 2) as usize], (entry & 1) as usize);
                if !self.openings.many_closed() || self.box_is_open(&node.bounds[side]) {
                    break node.children[side];
                }
            };
        }
    }

    /// Whether an open column may show something of a box.
    fn box_is_open(&self, bounds: &[Fixed; 4]) -> bool {
        let width = self.view.base_width;
        let (mut first, mut end) = (width, 0);
        let [west, east, south, north] = bounds.map(|side| i64::from(side.0));
        for (x, y) in [(west, south), (east, south), (west, north), (east, north)] {
            let [left, right] = self.camera.edges(x, y);
            if left < 0 {
                first = 0;
            }
            if right < 0 {
                end = width;
            }
            if left >= 0 && right >= 0 {
                // A quarter of a map unit is exact enough, and its division quicker.
                let (left, sum) = ((left >> 14) as u32, ((left + right) >> 14).max(1) as u32);
                let column = left * width / sum;
                first = first.min(column.saturating_sub(1));
                end = end.max((column + 2).min(width));
            }
        }
        let (first, end) = (self.view.first_column[first as usize], self.view.first_column[end as usize]);
        first < end && self.openings.any_open(usize::from(first), usize::from(end))
    }

    fn subsector<const DEPTH: bool, const CLASS: bool>(&mut self, index: usize) {
        let scene = self.scene;
        let [first, end, sector] = scene.subsectors[index];
        self.entered[sector as usize] = true;
        let own = &self.sectors[sector as usize];
        // First those to draw, again without branches, then their drawing.
        let mut found = 0;
        for (index, seg) in (first..end).zip(&scene.segs[first as usize..end as usize]) {
            // A one-sided line differs from whatever its sector is compared with.
            let one_sided = seg.back == NO_SECTOR;
            let back = &self.sectors[if one_sided { sector } else { seg.back } as usize];
            let matters = one_sided | seg.masked | !same_planes(own, back);
            let away = seg.away(self.camera.x, self.camera.y);
            self.scratch.facing[found] = (index, away);
            found += usize::from(matters & (away > 0));
        }
        for i in 0..found {
            let (index, away) = self.scratch.facing[i];
            self.seg::<DEPTH, CLASS>(index, away);
        }
    }
}

/// Whether nothing of floor and ceiling changes from one sector to the other.
#[inline]
fn same_planes(a: &SectorState, b: &SectorState) -> bool {
    let heights = (a.floor.0 ^ b.floor.0) | (a.ceiling.0 ^ b.ceiling.0);
    let looks = (a.floor_texture.0 ^ b.floor_texture.0) | (a.ceiling_texture.0 ^ b.ceiling_texture.0);
    (heights == 0) & (looks == 0) & (a.light == b.light)
}
