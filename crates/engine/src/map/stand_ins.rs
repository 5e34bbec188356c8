//! Textures of the published maps that no game file has, and those that stand in for them.

/// Name, stand-in, size. Assets of an IWAD draw the stand-in, and exported maps ask other engines
/// for the same.
pub(crate) const STAND_INS: [(&str, &str, (u16, u16)); 4] = [
    ("TILES6", "FLAT5_7", (64, 64)),
    ("BIGSTON3", "STONE3", (64, 128)),
    ("BRIKS20", "BRICK10", (64, 128)),
    ("CITY06", "BRWINDOW", (64, 128)),
];
