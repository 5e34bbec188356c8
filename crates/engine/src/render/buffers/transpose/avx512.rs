//! As with vectors of 32 bytes, where there are twice as many registers.

use crate::render::buffers::transpose::avx2;

/// Sixteen columns.
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
pub(crate) fn strip(columns: &[u8], stride: usize, pixels: &mut [u8], width: usize, rows: usize) {
    avx2::strip(columns, stride, pixels, width, rows);
}
