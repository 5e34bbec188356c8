//! Spans column by column.

use crate::render::buffers::visplane::{NO_ROW, Span, VisPlane};

/// From column to column an end of the run of rows stays or moves by one, and which is
/// unpredictable: the first row that comes or goes is handled without a branch, by writing it in
/// any case, and more of them by loops.
pub(crate) fn list(plane: &VisPlane, starts: &mut [u16], spans: &mut Vec<Span>) -> usize {
    let nowhere = starts.len() - 1;
    let mut count = 0;
    // The column behind the last one has no rows, which ends the last spans.
    let (mut top1, mut bottom1) = (0, i32::from(NO_ROW));
    let columns =
        plane.top[plane.first..=plane.end].iter().zip(&plane.bottom[plane.first..=plane.end]);
    for (x, (&top2, &bottom2)) in (plane.first as u16..).zip(columns) {
        let (top2, bottom2) = (i32::from(top2), i32::from(bottom2));
        if (top1, bottom1) == (top2, bottom2) {
            continue;
        }
        if count + 2 * starts.len() > spans.len() {
            spans.resize(count + 4 * starts.len(), Span::default());
        }
        // Rows of the last column that end before this one, from above and from below.
        let upper_end = bottom1.min(top2);
        let mut row = top1;
        loop {
            // The first row of a column without rows may be left from a higher frame.
            spans[count] =
                Span { row: row as u16, first: starts[(row as usize).min(nowhere)], end: x };
            count += usize::from(row < upper_end);
            row += 1;
            if row >= upper_end {
                break;
            }
        }
        let lower_first = top1.max(bottom2).max(upper_end);
        let mut row = bottom1 - 1;
        loop {
            spans[count] = Span { row: row as u16, first: starts[row.max(0) as usize], end: x };
            count += usize::from(row >= lower_first);
            row -= 1;
            if row < lower_first {
                break;
            }
        }
        // Rows that begin with this column.
        let upper_end = bottom2.min(top1);
        let mut row = top2;
        loop {
            starts[if row < upper_end { row as usize } else { nowhere }] = x;
            row += 1;
            if row >= upper_end {
                break;
            }
        }
        let lower_first = top2.max(bottom1).max(upper_end);
        let mut row = bottom2 - 1;
        loop {
            starts[if row >= lower_first { row as usize } else { nowhere }] = x;
            row -= 1;
            if row < lower_first {
                break;
            }
        }
        (top1, bottom1) = (top2, bottom2);
    }
    count
}
