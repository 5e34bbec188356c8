//! The walk through the BSP tree, front to back.

use super::View;
use super::camera::Camera;
use super::frame::Frame;
use super::openings::Openings;
use super::plane::Planes;
use super::scene::Scene;
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
#[derive(Clone, Debug, Default)]
pub(super) struct WalkScratch {
    /// Children to visit later: node index times two, plus the side.
    stack: Vec<u32>,
    /// Rows of the upper end of the part of a wall that is being drawn.
    pub upper: Vec<i16>,
    /// Rows of its lower end.
    pub lower: Vec<i16>,
}

impl WalkScratch {
    /// Makes room for frames of `width` columns.
    pub fn resize(&mut self, width: usize) {
        self.upper.resize(width, 0);
        self.lower.resize(width, 0);
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

    #[inline]
    fn may_hold(&self, camera: &Camera, bounds: &[Fixed; 4]) -> bool {
        let (x, y) = (bounds[self.corner[0]].0, bounds[self.corner[1]].0);
        (i64::from(x) - camera.x) * self.normal[0] + (i64::from(y) - camera.y) * self.normal[1] >= 0
    }
}

impl Walk<'_> {
    /// Walks until everything is covered.
    pub fn run<const DEPTH: bool, const CLASS: bool>(&mut self) {
        let [cos, sin] = self.camera.forward;
        let wedge = [WedgeSide::new([cos + sin, sin - cos]), WedgeSide::new([cos - sin, sin + cos])];
        let (x, y) = (Fixed(self.camera.x as i32), Fixed(self.camera.y as i32));
        self.scratch.stack.clear();
        let mut next = Some(match self.scene.nodes.len() {
            0 => Node::SUBSECTOR,
            count => count as u32 - 1,
        });
        while let Some(mut child) = next {
            while child & Node::SUBSECTOR == 0 {
                let node = &self.scene.nodes[child as usize];
                let near = usize::from(node.is_left(x, y));
                let sees = |side: usize| wedge.iter().all(|w| w.may_hold(self.camera, &node.bounds[side]));
                child = match (sees(near), sees(near ^ 1)) {
                    (true, far) => {
                        if far {
                            self.scratch.stack.push(child * 2 + (near as u32 ^ 1));
                        }
                        node.children[near]
                    }
                    (false, true) => node.children[near ^ 1],
                    (false, false) => break,
                };
            }
            if child & Node::SUBSECTOR != 0 {
                self.subsector::<DEPTH, CLASS>((child & !Node::SUBSECTOR) as usize);
                if self.openings.all_closed() {
                    return;
                }
            }
            next = self.pop();
        }
    }

    /// The next stacked child that is not hidden.
    fn pop(&mut self) -> Option<u32> {
        while let Some(entry) = self.scratch.stack.pop() {
            let node = &self.scene.nodes[(entry / 2) as usize];
            let side = (entry & 1) as usize;
            if !self.openings.many_closed() || self.box_is_open(&node.bounds[side]) {
                return Some(node.children[side]);
            }
        }
        None
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
        let [first, end, sector] = self.scene.subsectors[index];
        self.entered[sector as usize] = true;
        let scene = self.scene;
        for (index, seg) in (first..end).zip(&scene.segs[first as usize..end as usize]) {
            self.seg::<DEPTH, CLASS>(index, seg);
        }
    }
}
