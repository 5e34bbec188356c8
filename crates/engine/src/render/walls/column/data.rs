//! What a column of a wall is drawn from.

/// A column of a wall on its way to the screen.
pub(crate) struct Column<'a> {
    pub texels: &'a [u8],
    pub table: &'a [u8; 256],
    /// Position in the texture at base row 0, as a fraction of its height.
    pub at: u32,
    /// Its change a base row.
    pub step: u32,
}

/// A column of a wall whose texels are numbers of its picture's own colours.
pub(crate) struct IndexedColumn<'a, const TEXELS: usize, const COLOURS: usize> {
    pub texels: &'a [u8; TEXELS],
    /// These colours in the column's light.
    pub lit: &'a [u8; COLOURS],
    /// As in [`Column`].
    pub at: u32,
    pub step: u32,
}
