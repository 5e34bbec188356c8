//! Rows of columns side by side, as the pass over a seg's columns computes with them: what every
//! family of vectors must offer.

use crate::render::view::line::Edge;
use crate::render::view::tables::RowScale;

/// A row for each of some columns side by side; as an answer, all bits or none.
pub(crate) trait Rows: Copy {
    /// Columns.
    const COUNT: usize;
    /// That many of something.
    type Block<T>;

    /// A list in whole blocks; what is left over is no part of any.
    fn blocks<T>(list: &[T]) -> &[Self::Block<T>];
    fn blocks_mut<T>(list: &mut [T]) -> &mut [Self::Block<T>];
    /// The frame rows of an edge in base columns.
    fn of_edge(scale: &RowScale, edge: Edge, base: &Self::Block<u32>) -> Self;
    fn load(block: &Self::Block<i16>) -> Self;
    fn store(self, block: &mut Self::Block<i16>);
    fn at_least(self, other: Self) -> Self;
    fn at_most(self, other: Self) -> Self;
    fn is_less(self, than: Self) -> Self;
    fn and(self, other: Self) -> Self;
    fn and_not(self, other: Self) -> Self;
    /// `yes` where it answers so, else `no`.
    fn choose(self, yes: Self, no: Self) -> Self;
    /// Whether the answer is yes in any column.
    fn any(self) -> bool;
    /// A bit for each column, set where the answer is yes.
    fn bits(self) -> u64;
    /// Yes in the first `count` columns.
    fn first(count: usize) -> Self;
}
