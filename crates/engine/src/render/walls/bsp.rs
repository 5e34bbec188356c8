//! The walk through the BSP tree, front to back.

use crate::map::Node;
use crate::math::Fixed;
use crate::render::buffers::written::DepthBuffer;
use crate::render::scene::prepared::{NO_SECTOR, Scene};
use crate::render::view::camera::Camera;
use crate::render::walls::pass::WallPass;
use crate::simd::{prefetch, prefetch_lines};

/// Base columns by which the view's wedge is wider than what is open.
const WEDGE_MARGIN: i64 = 2;

/// One side of the view's wedge, as a test for boxes.
#[derive(Clone, Copy)]
struct WedgeSide {
    /// Points inwards.
    normal: [i64; 2],
    /// Where the eye lies along it.
    offset: i64,
    /// Which of (west, east) and (south, north) lies farthest inside.
    corner: [usize; 2],
}

impl WedgeSide {
    fn new(camera: &Camera, normal: [i64; 2]) -> WedgeSide {
        WedgeSide {
            normal,
            offset: camera.x * normal[0] + camera.y * normal[1],
            corner: [usize::from(normal[0] > 0), 2 + usize::from(normal[1] > 0)],
        }
    }

    /// Negative if a box lies wholly outside.
    #[inline]
    fn inside(&self, bounds: &[Fixed; 4]) -> i64 {
        let (x, y) = (bounds[self.corner[0] & 3].0, bounds[self.corner[1] & 3].0);
        i64::from(x) * self.normal[0] + i64::from(y) * self.normal[1] - self.offset
    }
}

/// Asks for the memory that a visit to a child reads first, its node or the segs of its subsector:
/// a map is larger than the nearest cache, and the way to it depends on what is found there.
#[inline(always)]
fn ask_for(scene: &Scene, child: u32) {
    let (is_subsector, index) = (child & Node::SUBSECTOR != 0, (child & !Node::SUBSECTOR) as usize);
    // Which of both it is is unpredictable.
    let [first_seg, ..] = scene.subsectors[if is_subsector { index } else { 0 }];
    let segs = scene.segs.as_ptr().wrapping_add(first_seg as usize).cast::<u8>();
    let node = scene.nodes.as_ptr().wrapping_add(index).cast::<u8>();
    prefetch_lines(if is_subsector { segs } else { node }, 3);
}

impl WallPass<'_> {
    /// Draws all walls, and lists what else there is to draw.
    pub fn run<D: DepthBuffer>(&mut self) {
        self.visit::<D>();
        self.draw_walls::<D>();
    }

    /// Walks until everything is covered.
    ///
    /// Which child is near and which one is in view is unpredictable, so that all of it is
    /// arithmetic without branches: children that are out of view are written to the stack too, but
    /// not counted.
    fn visit<D: DepthBuffer>(&mut self) {
        let scene = self.scene;
        let (x, y) = (Fixed(self.camera.x as i32), Fixed(self.camera.y as i32));
        let mut open = self.clip.range();
        let mut wedge = self.wedge(open);
        let mut stacked = 0;
        let mut child = match scene.nodes.len() {
            0 => Node::SUBSECTOR,
            count => count as u32 - 1,
        };
        loop {
            if child & Node::SUBSECTOR != 0 {
                let closed = self.clip.closed();
                self.subsector::<D>((child & !Node::SUBSECTOR) as usize);
                if self.clip.closed() != closed {
                    let now_open = self.clip.range();
                    if now_open.0 >= now_open.1 {
                        return;
                    }
                    if now_open != open {
                        open = now_open;
                        wedge = self.wedge(open);
                    }
                }
            } else {
                let node = &scene.nodes[child as usize];
                let near = u32::from(node.is_left(x, y));
                for side in [near ^ 1, near] {
                    let bounds = &node.bounds[side as usize];
                    let inside = wedge[0].inside(bounds) | wedge[1].inside(bounds);
                    self.scratch.stack[stacked] = child * 2 + side;
                    stacked += usize::from(inside >= 0);
                    ask_for(scene, node.children[side as usize]);
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
                let (child, bounds) = (node.children[side], &node.bounds[side]);
                // For a single subsector the second question costs more than it saves.
                let hidden = wedge[0].inside(bounds) | wedge[1].inside(bounds) < 0
                    || (child & Node::SUBSECTOR == 0
                        && self.clip.has_holes()
                        && !self.box_is_open(bounds));
                if !hidden {
                    break child;
                }
            };
        }
    }

    /// The wedge between the outermost rays of a range of frame columns, and a little more: sprites
    /// stand out of their sectors, so that those just out of view are entered too.
    fn wedge(&self, (first, end): (usize, usize)) -> [WedgeSide; 2] {
        let camera = self.camera;
        let ray = |column: i64| {
            [0, 1].map(|axis| (camera.ray[axis] + camera.ray_step[axis] * column) >> 16)
        };
        let left = ray(i64::from(self.view.columns[first]) - WEDGE_MARGIN);
        let right = ray(i64::from(self.view.columns[end - 1]) + WEDGE_MARGIN + 1);
        [WedgeSide::new(camera, [left[1], -left[0]]), WedgeSide::new(camera, [-right[1], right[0]])]
    }

    /// Whether an open column may show something of a box.
    fn box_is_open(&self, bounds: &[Fixed; 4]) -> bool {
        let width = self.view.base_width;
        let (mut first, mut end) = (width, 0);
        for corner in 0..4 {
            let [left, right] = self
                .camera
                .edges(i64::from(bounds[corner & 1].0), i64::from(bounds[2 + corner / 2].0));
            if left < 0 {
                first = 0;
            }
            if right < 0 {
                end = width;
            }
            if left >= 0 && right >= 0 {
                let column = (left as u64 * u64::from(width) / (left + right).max(1) as u64) as u32;
                first = first.min(column.saturating_sub(1));
                end = end.max((column + 2).min(width));
            }
        }
        let (first, end) =
            (self.view.first_column[first as usize], self.view.first_column[end as usize]);
        first < end && self.clip.any_open(usize::from(first), usize::from(end))
    }

    fn subsector<D: DepthBuffer>(&mut self, index: usize) {
        let WallPass { scene, world, ref mut surfaces, .. } = *self;
        let [first, end, sector] = scene.subsectors[index];
        self.entered[sector as usize] = true;
        let own = surfaces.of(world, sector);
        let (segs, sidedefs) = (&scene.segs[..], &scene.sidedefs[..]);
        let (x, y, facing) = (self.camera.x, self.camera.y, &mut self.scratch.facing[..]);
        // First those that face the eye, then those of them that matter, again without branches,
        // then their drawing.
        let mut found = 0;
        for (index, seg) in (first..end).zip(&segs[first as usize..end as usize]) {
            facing[found] = index;
            found += usize::from(seg.away(x, y) > 0);
        }
        let mut kept = 0;
        for i in 0..found {
            let index = facing[i];
            let seg = &segs[index as usize];
            // A one-sided line differs from whatever its sector is compared with.
            let one_sided = seg.back == NO_SECTOR;
            let back = surfaces.of(world, if one_sided { sector } else { seg.back });
            let differs = own.difference(&back) | u64::from(one_sided | seg.masked);
            facing[kept] = index;
            // Of a map's many sidedefs few are in the nearest cache, and they are needed late.
            prefetch(&sidedefs[seg.face as usize]);
            kept += usize::from(differs != 0);
        }
        for i in 0..kept {
            self.seg::<D>(self.scratch.facing[i]);
        }
    }
}
