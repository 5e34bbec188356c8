//! What the rows of a floor or ceiling have in common: its shader.

use crate::render::buffers::frame::{Frame, class};
use crate::render::buffers::visplane::VisPlaneKey;
use crate::render::buffers::written::{ClassBuffer, DepthBuffer};
use crate::render::planes::row::data::RowWalk;
use crate::render::view::camera::Camera;
use crate::render::view::horizon::PlaneRows;
use crate::render::view::light::{Light, ONE_TABLE_DISTANCE};
use crate::render::view::tables::View;
use std::ops::Range;

/// What the rows of a plane have in common.
pub(crate) struct PlaneShader<'a> {
    pub camera: &'a Camera,
    pub view: &'a View,
    pub tables: &'a [[u8; 256]; 32],
    /// Distance of the plane from the eye's height, 16.16, positive.
    pub height: i64,
    pub slopes: &'a PlaneRows,
    pub light: Light,
    /// [`ONE_TABLE_DISTANCE`] over the distance in the first row from the horizon, 32 fractional
    /// bits.
    pub nearness: i64,
    pub class: u16,
}

impl<'a> PlaneShader<'a> {
    /// For the plane of a key, whose picture is a `square` of 64 texels or another one.
    pub fn new(
        camera: &'a Camera,
        view: &'a View,
        slopes: &'a PlaneRows,
        tables: &'a [[u8; 256]; 32],
        key: VisPlaneKey,
        square: bool,
    ) -> PlaneShader<'a> {
        let above = i64::from(key.height.0) > camera.z;
        let height = (i64::from(key.height.0) - camera.z).abs().max(256);
        let nearness =
            ((i128::from(ONE_TABLE_DISTANCE) << 64) / i128::from(height * view.focal_y)) as i64;
        PlaneShader {
            camera,
            view,
            tables,
            height,
            slopes,
            light: Light::new(camera, i32::from(key.light)),
            nearness,
            class: match (above, square) {
                (false, true) => class::FLOOR,
                (false, false) => class::OTHER_FLOOR,
                (true, true) => class::CEILING,
                (true, false) => class::OTHER_CEILING,
            },
        }
    }

    /// How far the plane is in a row, its light there, and the row's first pixel.
    #[inline(always)]
    pub fn row(&self, width: usize, row: u16) -> (i64, &[u8; 256], usize) {
        let row = usize::from(row);
        let distance = (self.height * self.slopes.distances[row]) >> 16;
        let table = &self.tables[self.light.table((self.nearness * self.slopes.rows[row]) >> 32)];
        (distance, table, row * width)
    }

    #[inline(always)]
    pub fn write<D: DepthBuffer, C: ClassBuffer>(
        &self,
        frame: &mut Frame,
        distance: i64,
        pixels: Range<usize>,
    ) {
        if D::WRITTEN {
            let depth = frame.depths.plane(distance);
            frame.depth[pixels.clone()].fill(depth);
        }
        if C::WRITTEN {
            frame.class[pixels].fill(self.class);
        }
    }

    /// The walk of a row over textures of side `2^BITS`.
    #[inline(always)]
    pub fn walk<const BITS: u32>(&self, distance: i64) -> RowWalk {
        let camera = self.camera;
        // 48 fractional bits, of which the fraction of the side's 32 are kept; whole sides wrap
        // away.
        let part = |position: i64| (position >> (16 + BITS)) as u32;
        let u = (camera.x << 32).wrapping_add(distance.wrapping_mul(camera.plane_ray[0]));
        let v = (camera.y << 32).wrapping_add(distance.wrapping_mul(camera.plane_ray[1]));
        RowWalk {
            u: part(u),
            v: part(v.wrapping_neg()),
            u_step: part(distance.wrapping_mul(camera.plane_step[0])),
            v_step: part(distance.wrapping_mul(camera.plane_step[1]).wrapping_neg()),
        }
    }
}
