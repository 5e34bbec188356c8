//! Columns of walls that wait to be drawn.

/// What is listed; a column is one entry in each list.
#[derive(Debug, Default)]
pub(crate) struct WallBatch {
    pub count: usize,
    /// Index of the first texel in those of all pictures.
    pub texels: Vec<u32>,
    /// One less than there are texels.
    pub last_texels: Vec<u32>,
    /// Position in the texture at base row 0, as a fraction of its height with 32 bits, and its
    /// change a base row.
    pub positions: Vec<u32>,
    pub steps: Vec<u32>,
    pub tables: Vec<u32>,
    /// Frame columns.
    pub columns: Vec<u32>,
    /// A bit for each row that shows the wall.
    pub rows: Vec<u64>,
    pub distances: Vec<u64>,
}

impl WallBatch {
    /// Forgets what was drawn.
    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// Has room for so many entries, and for as many again.
    pub fn make_room(&mut self, entries: usize) {
        if self.rows.len() < entries {
            let Self {
                texels,
                last_texels,
                positions,
                steps,
                tables,
                columns,
                rows,
                distances,
                ..
            } = self;
            [texels, last_texels, positions, steps, tables, columns]
                .into_iter()
                .for_each(|list| list.resize(2 * entries, 0));
            [rows, distances].into_iter().for_each(|list| list.resize(2 * entries, 0));
        }
    }
}
