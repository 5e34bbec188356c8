//! A tile by plain code.

use crate::networks::cpu::tile::data::{Finish, PANEL, Tile};

/// A quarter of a panel at a time, for processors of sixteen short registers.
pub unsafe fn tile<const ROWS: usize, const AHEAD: u8>(
    tile: Tile,
    left: *const f32,
    right: *const f32,
    _ahead: *const f32,
    out: *mut f32,
) {
    const WIDTH: usize = 8;
    // SAFETY: see [`Tile::run`].
    unsafe {
        for quarter in 0..PANEL / WIDTH {
            let (mut part, mut right, out) =
                (left, right.add(quarter * WIDTH), out.add(quarter * WIDTH));
            let mut sums = [[0.0f32; WIDTH]; ROWS];
            if tile.finish == Finish::Continue {
                for (row, sums) in sums.iter_mut().enumerate() {
                    *sums = out.add(row * tile.out_stride).cast::<[f32; WIDTH]>().read();
                }
            }
            for _ in 0..tile.parts {
                let mut left = part;
                for _ in 0..tile.inner {
                    let columns = right.cast::<[f32; WIDTH]>().read();
                    for (row, sums) in sums.iter_mut().enumerate() {
                        let factor = *left.add(row * tile.row_stride);
                        for (sum, column) in sums.iter_mut().zip(columns) {
                            *sum += factor * column;
                        }
                    }
                    left = left.wrapping_add(tile.left_inner);
                    right = right.wrapping_add(tile.right_inner);
                }
                part = part.wrapping_add(tile.left_part);
            }
            for (row, sums) in sums.iter_mut().enumerate() {
                let to = out.add(row * tile.out_stride).cast::<[f32; WIDTH]>();
                if tile.finish == Finish::Add {
                    for (sum, there) in sums.iter_mut().zip(to.read()) {
                        *sum += there;
                    }
                }
                to.write(*sums);
            }
        }
    }
}
