//! Columns that ViZDoom draws four at once, one whose number divides by four and the three after
//! it, as far as they share rows. What its depth has of that shows with `published_depth`
//! (`docs/results/pixels.md`).

/// Finds where a wall or the sky has depth besides its own rows: a row more below those that four
/// columns share, which may be past a column's last. What is drawn later hides it. The columns from
/// `first` on show it between `tops` and `bottoms`.
pub(super) fn below(
    first: usize,
    tops: &[i16],
    bottoms: &[i16],
    mut put: impl FnMut(usize, usize),
) {
    for from in (first.next_multiple_of(4)..first + tops.len()).step_by(4) {
        let (Some(tops), Some(bottoms)) =
            (tops[from - first..].first_chunk::<4>(), bottoms[from - first..].first_chunk::<4>())
        else {
            break;
        };
        let end = bottoms.iter().min().copied().unwrap_or(0);
        let all_shown = tops.iter().zip(bottoms).all(|(top, bottom)| top < bottom);
        if all_shown && tops.iter().all(|&top| top < end) {
            (from..from + 4).for_each(|x| put(x, end as usize));
        }
    }
}

/// First and last row of a part of a column without holes.
pub(super) type Piece = [u16; 2];

/// The parts of four columns, from the upper to the lower.
#[derive(Clone, Debug, Default)]
pub(super) struct QuadPieces([Vec<Piece>; 4]);

impl QuadPieces {
    /// Empties them.
    pub fn clear(&mut self) {
        self.0.iter_mut().for_each(Vec::clear);
    }

    /// Those of a column.
    pub fn of(&mut self, column: usize) -> &mut Vec<Piece> {
        &mut self.0[column]
    }

    /// Draws them: gives column and rows of what is drawn by itself to `alone`, in the order in
    /// which it is, and writes the column that is drawn last. Rows that all four have in common are
    /// drawn together. What is left is not to be drawn again.
    pub fn draw(&mut self, mut alone: impl FnMut(usize, Piece)) -> Option<usize> {
        let (mut done, mut last_column) = ([0; 4], None);
        loop {
            let piece =
                |column: usize, after: usize| self.0[column].get(done[column] + after).copied();
            let present: [Option<Piece>; 4] = std::array::from_fn(|column| piece(column, 0));
            // Where the pieces after those at hand begin.
            let next = (0..4)
                .filter_map(|column| piece(column, 1))
                .map(|[first, _]| first)
                .min()
                .unwrap_or(u16::MAX);
            let top = present.iter().flatten().map(|[first, _]| *first).max();
            let bottom = present.iter().flatten().map(|[_, last]| *last).min();
            let (Some(top), Some(bottom)) = (top, bottom) else { return last_column };
            let shared = top <= bottom && present.iter().all(Option::is_some);
            // Above the rows that all have in common; where there are none, to where the next
            // pieces begin, which may have some.
            let end = if shared { top } else { next };
            for (column, piece) in present.iter().enumerate() {
                let Some([first, last]) = *piece else { continue };
                if first < end {
                    alone(column, [first, last.min(end - 1)]);
                    last_column = Some(column);
                }
                let go_on = if shared { bottom + 1 } else { end };
                if last < go_on {
                    done[column] += 1;
                } else {
                    let rest = &mut self.0[column][done[column]][0];
                    *rest = (*rest).max(go_on);
                }
            }
            if shared {
                last_column = Some(3);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Which columns get a depth in which row, of columns from `first` on.
    fn listed(first: usize, tops: &[i16], bottoms: &[i16]) -> Vec<(usize, usize)> {
        let mut list = Vec::new();
        below(first, tops, bottoms, |x, row| list.push((x, row)));
        list
    }

    #[test]
    fn a_row_below_what_four_columns_share_is_written() {
        // Columns 4 to 7 are the only whole four.
        assert_eq!(listed(2, &[0; 7], &[9, 9, 9, 8, 10, 9, 9]), [(4, 8), (5, 8), (6, 8), (7, 8)]);
        // One that shows nothing, and one that ends where another begins: they share nothing.
        assert_eq!(listed(4, &[0, 3, 0, 0], &[5, 3, 5, 5]), []);
        assert_eq!(listed(4, &[0, 5, 0, 0], &[5, 9, 5, 5]), []);
    }
}
