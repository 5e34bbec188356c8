//! From a sector's light and a distance to one of the 32 light tables.

use crate::render::view::camera::Camera;

/// Nearness brightens by at most this many tables, 16.16.
const NEAREST: i64 = 24 << 16;
/// Distance at which nearness brightens by one table, map units.
pub(crate) const ONE_TABLE_DISTANCE: i64 = 1280;

/// The light of a surface: which table at which distance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Light {
    /// Table at infinite distance, 16.16; negative is brighter than full.
    pub base: i64,
    /// Tables by which nearness brightens at most, 16.16: 0 where the table is the same at every
    /// distance.
    pub most: i64,
}

impl Light {
    /// The light of a surface in a sector of light `level`.
    pub fn new(camera: &Camera, level: i32) -> Light {
        if let Some(table) = camera.fixed_table {
            return Light { base: (table as i64) << 16, most: 0 };
        }
        let level = i64::from(level) + 12 + 16 * i64::from(camera.extra_light);
        Light { base: (64 << 16) - (level << 14), most: NEAREST }
    }

    /// The table of what is as near as counts: the player's own weapon.
    pub fn nearest_table(self) -> usize {
        self.table(NEAREST)
    }

    /// The table where `nearness` is [`ONE_TABLE_DISTANCE`] divided by the distance, 16.16.
    #[inline]
    pub fn table(self, nearness: i64) -> usize {
        ((self.base - nearness.min(self.most)) >> 16).clamp(0, 31) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(level: i32, distance: i64) -> usize {
        Light::new(&Camera::default(), level).table((ONE_TABLE_DISTANCE << 16) / distance)
    }

    #[test]
    fn tables_are_those_of_the_formula() {
        assert_eq!([table(255, 10), table(255, 10_000)], [0, 0]);
        assert_eq!([table(210, 100), table(210, 150), table(210, 10_000)], [0, 0, 8]);
        assert_eq!(table(0, 10_000), 31);
        assert_eq!(table(0, 1), 31, "no nearness lights a black room");
        assert_eq!(table(176, 1280), 16);
        assert_eq!(table(-400, 10), 31);
    }

    #[test]
    fn muzzle_light_is_four_tables() {
        let flash = Camera { extra_light: 1, ..Camera::default() };
        assert_eq!(
            Light::new(&flash, 160).table(0) + 4,
            Light::new(&Camera::default(), 160).table(0)
        );
    }
}
