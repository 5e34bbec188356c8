//! From a distance to a value of the depth buffer as ViZDoom writes it (`docs/results/pixels.md`).

/// Height of the frames that the published depth is made for; the values of lower ones are smaller.
const PUBLISHED_ROWS: i64 = 480;

/// A formula each for walls, floors, sprites and soot.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DepthFormulas {
    /// Rows of the base grid.
    rows: i64,
}

impl DepthFormulas {
    /// Depth of soot where it is written by itself.
    pub const DECAL: u8 = 0;

    /// Those of frames of `rows` rows.
    pub fn new(rows: u32) -> DepthFormulas {
        DepthFormulas { rows: i64::from(rows) }
    }

    /// Depth of a wall at a distance in 16.16 map units that shows a texture of `height` texels.
    /// ViZDoom takes it from the step between the texels of neighbouring rows; where that is half
    /// the texture or more, from what is left to the whole of it.
    #[inline]
    pub fn wall(self, distance: i64, height: u32) -> u8 {
        let mut quarters = quarters(distance, self.rows);
        if height.is_power_of_two() {
            let whole = i64::from(height) << 18;
            quarters &= whole - 1;
            quarters = quarters.min(whole - quarters);
        }
        scaled((quarters * 128 / 100 - 9500) * 255 / 1_590_500, self.rows)
    }

    /// Depth of a sprite, from the texels that one of its rows is high.
    #[inline]
    pub fn sprite(self, distance: i64, focal_y: i64) -> u8 {
        scaled(((distance << 16) / focal_y - 500) * 255 / 319_500, self.rows)
    }

    /// Depth of soot where ViZDoom takes it from a column of the wall, of whose step it keeps the
    /// last bit alone.
    pub fn decal_of_quad(self, distance: i64) -> u8 {
        scaled((quarters(distance, self.rows) & 1) << 7, self.rows)
    }

    /// Depth of a floor or ceiling, in every size the same.
    #[inline]
    pub fn plane(self, distance: i64) -> u8 {
        if distance > 120_000_000 {
            255
        } else {
            ((distance - 716_000) / 469_184).clamp(0, 255) as u8
        }
    }

    /// Depth of the sky and of nothing.
    pub fn farthest(self) -> u8 {
        scaled(255, self.rows)
    }
}

/// The step between the texels of neighbouring rows of a wall, in quarters of a 65536th of a texel,
/// halves cut.
#[inline]
fn quarters(distance: i64, rows: i64) -> i64 {
    (distance * 5 + rows / 2 - 1) / rows
}

fn scaled(value: i64, rows: i64) -> u8 {
    (value.clamp(0, 255) * rows / PUBLISHED_ROWS).min(255) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    fn units(distance: i64) -> i64 {
        distance << 16
    }

    #[test]
    fn published_depth_is_as_measured_in_tall_frames() {
        // Measured at 480 rows: 56 units 6, 256 units 34, 756 units 104.
        let depths = DepthFormulas::new(480);
        assert_eq!([56, 256, 756].map(|distance| depths.wall(units(distance), 128)), [6, 34, 104]);
        assert_eq!([depths.wall(units(5000), 128), depths.farthest()], [255, 255]);
    }

    #[test]
    fn published_depth_of_low_textures_falls_again_from_half_a_texture_a_row_on() {
        // As measured at shutters of 16 texels in Remedy Rush, 1,131.7 and 1,302.1 units away in
        // frames of 120 rows: 11.8 and 13.6 texels a row.
        let depths = DepthFormulas::new(120);
        let written = |tenths: i64, height: u32| depths.wall((tenths << 16) / 10, height);
        assert_eq!([written(11317, 16), written(13021, 16)], [56, 32]);
        assert_eq!([written(11317, 128), written(13021, 100)], [63, 63]);
    }

    #[test]
    fn published_depth_of_soot_is_the_last_bit_of_a_walls_step() {
        // Measured before a wall seen face on: its distance in 4096ths of a unit, and what was
        // written of soot on it in frames of 480 rows.
        let seen = [
            (1_074_260, 128),
            (1_248_605, 128),
            (1_109_006, 0),
            (994_163, 0),
            (320_900, 128),
            (102_608, 128),
            (65_746, 0),
            (574_737, 128),
            (826_277, 128),
            (893_693, 128),
            (1_180_356, 0),
            (850_078, 0),
            (345_606, 128),
            (97_532, 128),
        ];
        // And of 120 rows.
        let seen_low = [
            (1_074_260, 32),
            (1_165_132, 32),
            (491_970, 0),
            (432_126, 0),
            (500_456, 32),
            (544_002, 0),
        ];
        for (rows, seen) in [(480, &seen[..]), (120, &seen_low)] {
            for &(distance, written) in seen {
                assert_eq!(
                    DepthFormulas::new(rows).decal_of_quad(distance << 4),
                    written,
                    "{distance} of {rows} rows"
                );
            }
        }
    }

    #[test]
    fn published_depth_ends_early_in_low_frames_except_on_floors() {
        let depths = DepthFormulas::new(120);
        assert_eq!(
            [
                depths.wall(units(2000), 128),
                depths.sprite(units(2000), 96 << 16),
                depths.farthest()
            ],
            [63; 3]
        );
        assert_eq!(
            [depths.plane(units(1000)), depths.plane(units(1900)), depths.plane(units(5))],
            [138, 255, 0]
        );
    }
}
