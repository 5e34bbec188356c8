//! Tables of bytes held in registers, a file for each family of vectors. What looks a table up has
//! its scalar twin where it is used.

pub mod avx2;
pub mod avx512;

/// The mask of the first `count` of eight numbers side by side, of all if there are more.
#[inline(always)]
pub(crate) const fn first_of_eight(count: usize) -> u8 {
    if count < 8 { (1 << count) - 1 } else { u8::MAX }
}
