//! How many rows and columns vector code touches at once, and by how much lists are longer for it.

/// Rows that are drawn at once at most: columns are whole blocks of these.
pub(crate) const ROW_BLOCK: usize = 64;

/// Rows that may be asked for behind a column's last one: lists by row are that much longer than a
/// column.
pub(crate) const ROW_PADDING: usize = 32;

/// Most columns that are clipped at once. Lists by column are that much longer than a frame is
/// wide, so that the last columns of a seg need no other code: what lies beyond is read, and left
/// as it is.
pub(crate) const COLUMN_BLOCK: usize = 16;

/// Length of a list by column.
pub(crate) const fn padded(width: usize) -> usize {
    width + COLUMN_BLOCK
}

/// From one column to the next: whole blocks of rows.
pub(crate) fn column_stride(rows: usize) -> usize {
    rows.next_multiple_of(ROW_BLOCK)
}

/// Columns that rows are drawn in steps of: the base columns of a chunk repeat in the next one, a
/// constant to the right.
pub(crate) const CHUNK: usize = 8;
