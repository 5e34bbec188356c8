//! All that exists only for depth as ViZDoom writes it (the option `published_depth`), behind one
//! type, [`PublishedDepth`].
//!
//! The renderer holds one if depth is to be written so, and the passes over walls and sprites ask
//! it where ViZDoom's depth is another than the distance of what is drawn. It takes numbers and
//! slices and knows no pass. Without it depth is even (`view/depth.rs`), and nothing here runs.

mod decal;
mod formulas;
mod midtexture;
mod quads;

pub(crate) use formulas::DepthFormulas;

use decal::{DecalDepth, DecalMark};
use midtexture::MidtextureDepth;
use std::ops::Range;

/// Depth as ViZDoom writes it: its formulas, and what shows of its drawing four columns at once.
#[derive(Clone, Debug)]
pub(crate) struct PublishedDepth {
    formulas: DepthFormulas,
    /// Whether what is written of quads shows: a reduced frame lacks columns and rows that decide
    /// it.
    by_quads: bool,
    midtextures: MidtextureDepth,
    decals: DecalDepth,
}

impl PublishedDepth {
    /// That of frames of `rows` rows, or of what is left of them in a reduced frame.
    pub fn new(rows: u32, reduced: bool) -> PublishedDepth {
        PublishedDepth {
            formulas: DepthFormulas::new(rows),
            by_quads: !reduced,
            midtextures: MidtextureDepth::default(),
            decals: DecalDepth::default(),
        }
    }

    /// The depth of what is drawn by itself.
    pub fn formulas(&self) -> DepthFormulas {
        self.formulas
    }

    /// Whether walls may be drawn later than they are found: not where each writes below itself.
    pub fn lets_walls_wait(&self) -> bool {
        !self.by_quads
    }

    /// Finds the rows below a wall or the sky that are written its depth too, and gives column and
    /// row to `put`. The columns from `first` on show it between `tops` and `bottoms`; a row may be
    /// past the last one.
    pub fn below(&self, first: usize, [tops, bottoms]: [&[i16]; 2], put: impl FnMut(usize, usize)) {
        if self.by_quads {
            quads::below(first, tops, bottoms, put);
        }
    }

    /// Begins the soot on a wall in the columns `wall`, of whose last column that bears some
    /// `written` was written. `distance` is that of a column.
    pub fn begin_decals(
        &mut self,
        written: u8,
        wall: Range<usize>,
        distance: impl Fn(usize) -> i64,
    ) {
        if self.by_quads {
            let from = wall.end / 4 * 4;
            let depth = |column: usize| self.formulas.decal_of_quad(distance(from - 4 + column));
            let last_quad = (from >= wall.start + 4).then(|| [0, 1, 2, 3].map(depth));
            self.decals.begin(written, last_quad);
        }
    }

    /// Begins a mark of that soot that covers the columns `covered`; none if its depth is as if
    /// each column were drawn by itself.
    pub fn decal(&mut self, covered: Range<usize>) -> Option<DecalMark<'_>> {
        self.by_quads.then(|| self.decals.mark(covered))
    }

    /// Begins a frame's sprites and midtextures.
    pub fn begin_masked(&mut self) {
        self.midtextures.reset();
    }

    /// Notes the depth of something that is drawn between midtextures.
    pub fn note(&mut self, depth: u8) {
        self.midtextures.note(depth);
    }

    /// Begins the base column `column` of a midtexture that shows those from `first` to `last`.
    /// `bottoms[at]` is where what hides it from below begins, and so on in the columns beside it.
    pub fn begin_midtexture_column(
        &mut self,
        [first, last]: [u32; 2],
        column: u32,
        bottoms: &[i16],
        at: usize,
    ) {
        let place = (column & 3) as usize;
        // The columns that ViZDoom draws four at once; the depth of the others it writes as a
        // sprite's. Nor are they drawn at once where nearer walls without an opening hide one.
        let fours = (first + 3) & !3..(last + 1) & !3;
        let is_whole = || bottoms[at - place..at - place + 4].iter().all(|&bottom| bottom > 0);
        let in_four = fours.contains(&column) && (!self.by_quads || is_whole());
        self.midtextures.begin_column(in_four.then_some(place));
    }

    /// The depth of that column, which shows a texture of `height` texels at a distance.
    pub fn midtexture(&mut self, distance: i64, height: u32, focal_y: i64) -> u8 {
        if self.midtextures.is_in_four() {
            self.formulas.wall(distance, height)
        } else {
            let depth = self.formulas.sprite(distance, focal_y);
            self.midtextures.note(depth);
            depth
        }
    }

    /// Notes a row of that column, below those before it, that is written `depth`. `run` is the
    /// start of the run of texels that it shows.
    #[inline]
    pub fn midtexture_row(&mut self, row: usize, depth: u8, run: impl FnOnce() -> u16) {
        if self.by_quads && self.midtextures.is_in_four() {
            self.midtextures.add(row as u16, run(), depth);
        }
    }

    /// Ends that column, frame column `x`: with the last of four, what they are written otherwise
    /// goes into `depth`, a frame of rows of `width` pixels.
    pub fn end_midtexture_column(&mut self, x: usize, width: usize, depth: &mut [u8]) {
        if self.by_quads {
            self.midtextures.end_column(|column, row, written| {
                depth[usize::from(row) * width + x - 3 + column] = written;
            });
        }
    }
}
