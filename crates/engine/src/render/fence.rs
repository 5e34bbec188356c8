//! A texture with holes in an opening: where its runs of texels without holes are, and in which row each begins to show.

use super::View;
use super::picture::MaskedPicture;
use super::wall::SeenLine;
use crate::assets::Image;

/// Runs of texels without holes of a column: for each of its texels where its run starts and where it ends (the one past the last);
/// 0 and 0 for holes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Runs<'a> {
    pub starts: &'a [u16],
    pub ends: &'a [u16],
}

/// A picture with the runs of its columns.
#[derive(Clone, Debug)]
pub(super) struct Fence {
    pub picture: MaskedPicture,
    /// Last of the columns whose runs are kept: the first where there is no hole, as in most pictures of walls.
    last_runs: u32,
    starts: Vec<u16>,
    ends: Vec<u16>,
}

impl Fence {
    pub fn new(image: &Image) -> Fence {
        let picture = MaskedPicture::new(image);
        let height = picture.height as usize;
        let has_holes = picture.texels.iter().any(|texel| texel & MaskedPicture::OPAQUE == 0);
        let kept = if has_holes { picture.width } else { 1 };
        let (mut starts, mut ends) = (vec![0; kept as usize * height], vec![0; kept as usize * height]);
        for (at, column) in picture.texels.chunks(height).take(kept as usize).enumerate() {
            find_runs(column, &mut starts[at * height..], &mut ends[at * height..]);
        }
        Fence { picture, last_runs: kept.saturating_sub(1), starts, ends }
    }

    /// The texels of a column and their runs.
    #[inline]
    pub fn column(&self, column: u32) -> (&[u16], Runs<'_>) {
        let start = (column.min(self.last_runs) * self.picture.height) as usize;
        let runs = start..start + self.picture.height as usize;
        (self.picture.column(column), Runs { starts: &self.starts[runs.clone()], ends: &self.ends[runs] })
    }
}

/// Writes the runs of a column.
pub(super) fn find_runs(texels: &[u16], starts: &mut [u16], ends: &mut [u16]) {
    let is_opaque = |texel: &u16| texel & MaskedPicture::OPAQUE != 0;
    let mut end = 0;
    for run in texels.chunk_by(|one, next| is_opaque(one) == is_opaque(next)) {
        let start = end;
        end += run.len();
        if is_opaque(&run[0]) {
            starts[start..end].fill(start as u16);
            ends[start..end].fill(end as u16);
        }
    }
}

/// Rows a texel of the columns of a seg, 16.16, as the published engine has them where a run of texels without holes begins: even from the
/// scale of the seg's first column to that of its last, which it would reach one column later, in whole 65536ths.
pub(super) struct Scales {
    first_column: i64,
    first: i64,
    change: i64,
}

impl Scales {
    pub fn new(view: &View, line: &SeenLine, [first_column, end_column]: [i64; 2]) -> Scales {
        let scale = |column| {
            let texels_a_row = (((line.distance_at(column) * view.inverse_focal_y) >> 16) + 0x8000) >> 16;
            (1 << 32) / texels_a_row.max(3)
        };
        let first = scale(first_column);
        Scales { first_column, first, change: (scale(end_column - 1) - first) / (end_column - first_column) }
    }

    pub fn at(&self, column: i64) -> i64 {
        self.first + (column - self.first_column) * self.change
    }
}

/// Where a column's runs of texels without holes begin.
#[derive(Clone, Copy)]
pub(super) struct Hung {
    /// Base row at the height of the eye, 16.16.
    pub horizon: i64,
    /// Texel at the height of the eye, 16.16.
    pub eye: i64,
    /// Rows a texel, 16.16.
    pub scale: i64,
}

impl Hung {
    /// Base row of the upper edge of texel 0 and its change a texel, 32 fractional bits; what overflows (a texture a thousand
    /// times as high as the view, at the eye's nose) wraps, by all instructions alike.
    #[inline]
    pub fn rows(&self) -> [i64; 2] {
        [(self.horizon * 65536).wrapping_sub(self.eye.wrapping_mul(self.scale)), self.scale << 16]
    }

    /// The first base row of the run of texels from `start` to `end`; none, as it were, if it is less than a row high between two rows,
    /// as holes are, whose runs are empty.
    #[inline]
    pub fn first_row(&self, start: u16, end: u16) -> i64 {
        let [at, change] = self.rows();
        let row = |texel: u16| at.wrapping_add(i64::from(texel).wrapping_mul(change)) >> 32;
        let first = row(start);
        if first < row(end) { first } else { i64::MAX }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_end_at_holes() {
        let (mut starts, mut ends) = ([0; 5], [0; 5]);
        find_runs(&[1, 0x101, 0x102, 2, 0x103], &mut starts, &mut ends);
        assert_eq!((starts, ends), ([0, 1, 1, 0, 4], [0, 3, 3, 0, 5]));
    }

    #[test]
    fn a_picture_without_holes_keeps_the_runs_of_one_column() {
        let image = |mask: Option<[u8; 6]>| {
            let mask = mask.map(|mask| mask.into());
            Fence::new(&Image { width: 3, height: 2, offset_x: 0, offset_y: 0, pixels: [1, 2, 3, 4, 5, 6].into(), mask })
        };
        let shown = |fence: &Fence| {
            let column = |column| {
                let (texels, Runs { starts, ends }) = fence.column(column);
                [0, 1].map(|row| (texels[row] as u8, starts[row], ends[row]))
            };
            [0, 1, 2].map(column)
        };
        let whole = [[(1, 0, 2), (2, 0, 2)], [(3, 0, 2), (4, 0, 2)], [(5, 0, 2), (6, 0, 2)]];
        assert_eq!((shown(&image(None)), image(None).starts.len()), (whole, 2));
        let holes = [[(1, 0, 2), (2, 0, 2)], [(3, 0, 0), (4, 1, 2)], [(5, 0, 2), (6, 0, 2)]];
        let masked = image(Some([1, 1, 0, 1, 1, 1]));
        assert_eq!((shown(&masked), masked.starts.len()), (holes, 6));
    }

    #[test]
    fn runs_begin_where_the_even_scale_has_them() {
        // Half a row a texel, the eye at texel 10, the horizon in row 50: texel t's upper edge is at 50 - (10 - t) / 2.
        let hung = Hung { horizon: 50 << 16, eye: 10 << 16, scale: 1 << 15 };
        let first = |start, end| hung.first_row(start, end);
        assert_eq!([first(0, 4), first(1, 5), first(10, 12)], [45, 45, 50]);
        // From 45.0 to 45.5 and from 45.5 to 46.0: not a row high. From 45.5 to 46.5: ends above 46.
        assert_eq!([first(0, 1), first(1, 2), first(1, 3)], [i64::MAX, 45, 45]);
    }

    #[test]
    fn scales_are_even_and_a_column_late() {
        let view = View::new(crate::render::FrameSize::CLASSIC).unwrap();
        // Ten times as near in column 100 as in column 0.
        let line = SeenLine { inverse: 1 << 34, inverse_step: (9 << 34) / 100 };
        let scale = |column| (1i64 << 32) / ((((line.distance_at(column) * view.inverse_focal_y) >> 16) + 0x8000) >> 16);
        let scales = Scales::new(&view, &line, [20, 60]);
        assert_eq!(scales.at(20), scale(20));
        let change = scales.at(21) - scales.at(20);
        assert!((20..60).all(|column| scales.at(column) == scale(20) + (column - 20) * change));
        assert!((scales.at(60) - scale(59)).abs() < 40, "{} {}", scales.at(60), scale(59));
    }
}
