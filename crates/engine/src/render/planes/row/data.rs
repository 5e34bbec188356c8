//! Texture positions along a row of a floor.

/// Texture positions along a row, as fractions of the texture's side with 32 bits: linear in the
/// base column.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowWalk {
    /// At base column 0, to the right.
    pub u: u32,
    /// At base column 0, down.
    pub v: u32,
    /// Changes a base column.
    pub u_step: u32,
    pub v_step: u32,
}

/// Index of a position in a texture of side `2^BITS`, column by column.
#[inline(always)]
pub(crate) fn index<const BITS: u32>(u: u32, v: u32) -> u32 {
    (u >> (32 - BITS)) << BITS | v >> (32 - BITS)
}

impl RowWalk {
    /// The position in a base column.
    #[inline(always)]
    pub fn at(&self, column: u32) -> (u32, u32) {
        let u = self.u.wrapping_add(self.u_step.wrapping_mul(column));
        (u, self.v.wrapping_add(self.v_step.wrapping_mul(column)))
    }
}
