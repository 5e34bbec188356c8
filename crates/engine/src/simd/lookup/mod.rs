//! Tables of bytes held in registers, a file for each family of vectors. What looks a table up has
//! its scalar twin where it is used.

pub mod avx2;
pub mod avx512;
