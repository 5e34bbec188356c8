//! Numbers of line and sector specials, as the UDMF namespaces `zdoom` and `zdoomtranslated` have
//! them.

/// Sector: a light that gleams every 64 tics and is dark between; when, the lowest six bits of the
/// sector's light say.
pub const PHASED: i32 = 1;
/// Sector: the start of a row of neighbouring sectors along which a gleam runs.
pub const SEQUENCE_START: i32 = 2;
/// Sector: the further sectors of such a row, by turns.
pub const SEQUENCE_STEPS: [i32; 2] = [3, 4];
/// Sector: lava that hurts before any script.
pub const LAVA: i32 = 83;

/// Whether the specials of a namespace have these numbers. In all others they are those of an older
/// game.
pub(crate) fn are_of(namespace: &str) -> bool {
    matches!(namespace, "zdoom" | "zdoomtranslated")
}

/// Line specials that need nobody to set them off: horizons, floors within floors, links, contents,
/// scrolling, copied and sloping planes, lines and planes with an own light or air, mirrors,
/// currents, wind, portals.
const AT_START: [i32; 30] = [
    9, 50, 51, 57, 58, 100, 101, 102, 103, 118, 156, 159, 160, 161, 181, 182, 190, 208, 209, 210,
    211, 218, 219, 220, 221, 222, 223, 224, 225, 227,
];

/// Whether a line's special does anything where it stands: one that acts from the start, or one
/// that somebody can set off.
pub(crate) fn acts(namespace: &str, special: i32, triggered: bool) -> bool {
    special != 0 && (triggered || AT_START.contains(&special) || !are_of(namespace))
}
