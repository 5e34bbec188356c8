//! One drawseg after another, without a branch.

use crate::render::buffers::drawsegs::overlap::reaches::DrawSegBounds;

/// [`list`](super::list), one by one.
pub(crate) fn list(
    reaches: &DrawSegBounds,
    [first, end]: [u32; 2],
    inverse: i64,
    met: &mut [u32],
) -> usize {
    let mut count = 0;
    for i in 0..reaches.count {
        met[count] = i as u32;
        count += usize::from(
            (reaches.firsts[i] < end) & (reaches.ends[i] > first) & (reaches.nears[i] >= inverse),
        );
    }
    count
}
