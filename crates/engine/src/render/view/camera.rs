//! Where a frame is seen from.

use crate::math::Angle;
use crate::render::colour::tint::power_shows;
use crate::render::view::horizon;
use crate::render::view::tables::View;
use crate::world::World;

/// The light table of light amplification.
const AMPLIFIED_TABLE: usize = 1;

/// Position, direction and light of one frame's eye.
#[derive(Clone, Debug, Default)]
pub(crate) struct Camera {
    /// East, 16.16 map units, as are the next two.
    pub x: i64,
    /// North.
    pub y: i64,
    /// Height.
    pub z: i64,
    /// Facing.
    pub angle: Angle,
    /// Cosine and sine of the facing, 16.16.
    pub forward: [i64; 2],
    /// The horizon in base rows, 16.16.
    pub horizon: i64,
    /// The ray through the left edge of base column 0: what it gains of the world for a unit of
    /// distance forward; 32 fractional bits.
    pub ray: [i64; 2],
    /// Its change a base column.
    pub ray_step: [i64; 2],
    /// The same for floors and ceilings, through the right edge of base column 0.
    pub plane_ray: [i64; 2],
    /// Its change a base column.
    pub plane_step: [i64; 2],
    /// Muzzle light, 0..=2.
    pub extra_light: i32,
    /// Light amplification: everything is drawn with this light table.
    pub fixed_table: Option<usize>,
}

impl Camera {
    /// The eye of a player; a player whose body is gone sees from the origin.
    pub fn of_player(world: &World, player: usize, view: &View) -> Camera {
        let player = &world.players[player];
        let body = world.actors.get(usize::from(player.actor.slot));
        let (x, y, angle) =
            body.map_or((0, 0, Angle::EAST), |body| (body.x.0, body.y.0, body.angle));
        let forward = [i64::from(angle.cos().0), i64::from(angle.sin().0)];
        let right = [forward[1], -forward[0]];
        let width = i64::from(view.base_width);
        // Half the width is one focal length: the outermost rays are 45 degrees off. Floors are
        // laid out along the facing as the sine table has it. Distances are scalar products with
        // the same vector, which is up to 0.04 % short as that table's second quarter lies one
        // entry early: who has gone a unit forward is as many times that farther. Their step has 26
        // fractional bits there, the rest cut: what is lost counts from the middle of the view on.
        let plane_step = right.map(|r| ((r << 11) / width) << 6);
        let plane_ray = [0, 1].map(|i| (forward[i] << 16) - plane_step[i] * (width - 2) / 2);
        let square = forward[0] * forward[0] + forward[1] * forward[1];
        let unit = |part: i64| (part << 46) / (square >> 2);
        let ray_step = right.map(|r| (unit(r) << 1) / width);
        let ray = [0, 1].map(|i| unit(forward[i]) - ray_step[i] * width / 2);
        Camera {
            x: i64::from(x),
            y: i64::from(y),
            z: i64::from(player.view_z.0),
            angle,
            forward,
            horizon: horizon::at_pitch(view, player.pitch),
            ray,
            ray_step,
            plane_ray,
            plane_step,
            extra_light: i32::from(player.extra_light),
            fixed_table: power_shows(player.infrared_tics).then_some(AMPLIFIED_TABLE),
        }
    }

    /// What something that changes by `step` a row changes by from the lower edge of base row 0 to
    /// the horizon.
    #[inline]
    pub fn to_horizon(&self, step: i64) -> i64 {
        step * ((self.horizon >> 16) - 1) + ((step * (self.horizon & 0xFFFF)) >> 16)
    }

    /// How far a point is to the right of the left edge of the view, and to the left of the right
    /// edge, both in units in which their sum is twice the distance forward; 16.16.
    #[inline]
    pub fn edges(&self, x: i64, y: i64) -> [i64; 2] {
        let (dx, dy) = (x - self.x, y - self.y);
        let (cos, sin) = (self.forward[0], self.forward[1]);
        [(dx * (cos + sin) + dy * (sin - cos)) >> 16, (dx * (cos - sin) + dy * (sin + cos)) >> 16]
    }
}
