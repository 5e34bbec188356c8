//! Where the posts of a midtexture begin on the screen.

use crate::render::textures::midtexture::Post;
use crate::render::view::line::ProjectedLine;
use crate::render::view::tables::View;

/// Rows a texel of the columns of a seg, 16.16, as ViZDoom has them where a run of texels without
/// holes begins: even from the scale of the seg's first column to that of its last, which it would
/// reach one column later, in whole 65536ths.
pub(crate) struct PostScale {
    first_column: i64,
    first: i64,
    change: i64,
}

impl PostScale {
    pub fn new(
        view: &View,
        line: &ProjectedLine,
        [first_column, end_column]: [i64; 2],
    ) -> PostScale {
        let scale = |column| {
            let texels_a_row =
                (((line.distance_at(column) * view.inverse_focal_y) >> 16) + 0x8000) >> 16;
            (1 << 32) / texels_a_row.max(3)
        };
        let first = scale(first_column);
        PostScale {
            first_column,
            first,
            change: (scale(end_column - 1) - first) / (end_column - first_column),
        }
    }

    pub fn at(&self, column: i64) -> i64 {
        self.first + (column - self.first_column) * self.change
    }
}

/// Where a column's runs of texels without holes begin.
#[derive(Clone, Copy)]
pub(crate) struct PostProjection {
    /// Base row at the height of the eye, 16.16.
    pub horizon: i64,
    /// Texel at the height of the eye, 16.16.
    pub eye: i64,
    /// Rows a texel, 16.16.
    pub scale: i64,
}

impl PostProjection {
    /// Base row of the upper edge of texel 0 and its change a texel, 32 fractional bits; what
    /// overflows (a texture a thousand times as high as the view, at the eye's nose) wraps, by all
    /// instructions alike.
    #[inline]
    pub fn rows(&self) -> [i64; 2] {
        [(self.horizon * 65536).wrapping_sub(self.eye.wrapping_mul(self.scale)), self.scale << 16]
    }

    /// The first base row of a run of texels; none, as it were, if it is less than a row high
    /// between two rows.
    #[inline]
    pub fn first_row(&self, [start, end]: Post) -> i64 {
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
    fn runs_begin_where_the_even_scale_has_them() {
        // Half a row a texel, the eye at texel 10, the horizon in row 50: texel t's upper edge is
        // at 50 - (10 - t) / 2.
        let hung = PostProjection { horizon: 50 << 16, eye: 10 << 16, scale: 1 << 15 };
        let first = |start, end| hung.first_row([start, end]);
        assert_eq!([first(0, 4), first(1, 5), first(10, 12)], [45, 45, 50]);
        // From 45.0 to 45.5 and from 45.5 to 46.0: not a row high. From 45.5 to 46.5: ends
        // above 46.
        assert_eq!([first(0, 1), first(1, 2), first(1, 3)], [i64::MAX, 45, 45]);
    }

    #[test]
    fn scales_are_even_and_a_column_late() {
        let view = View::new(crate::render::view::size::FrameSize::CLASSIC).unwrap();
        // Ten times as near in column 100 as in column 0.
        let line = ProjectedLine { inverse: 1 << 34, inverse_step: (9 << 34) / 100 };
        let scale = |column| {
            (1i64 << 32)
                / ((((line.distance_at(column) * view.inverse_focal_y) >> 16) + 0x8000) >> 16)
        };
        let scales = PostScale::new(&view, &line, [20, 60]);
        assert_eq!(scales.at(20), scale(20));
        let change = scales.at(21) - scales.at(20);
        assert!((20..60).all(|column| scales.at(column) == scale(20) + (column - 20) * change));
        assert!((scales.at(60) - scale(59)).abs() < 40, "{} {}", scales.at(60), scale(59));
    }
}
