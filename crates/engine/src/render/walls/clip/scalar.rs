//! One column: what the pass does, as plain arithmetic.

use crate::render::view::line::Edge;
use crate::render::view::tables::RowScale;
use crate::render::walls::clip::rows::Rows;

impl Rows for i16 {
    const COUNT: usize = 1;
    type Block<T> = [T; 1];

    #[inline(always)]
    fn blocks<T>(list: &[T]) -> &[[T; 1]] {
        list.as_chunks().0
    }

    #[inline(always)]
    fn blocks_mut<T>(list: &mut [T]) -> &mut [[T; 1]] {
        list.as_chunks_mut().0
    }

    #[inline(always)]
    fn of_edge(scale: &RowScale, edge: Edge, base: &[u32; 1]) -> i16 {
        scale.frame_row(edge.base_row(i64::from(base[0])))
    }

    #[inline(always)]
    fn load(block: &[i16; 1]) -> i16 {
        block[0]
    }

    #[inline(always)]
    fn store(self, block: &mut [i16; 1]) {
        block[0] = self;
    }

    #[inline(always)]
    fn at_least(self, other: i16) -> i16 {
        self.max(other)
    }

    #[inline(always)]
    fn at_most(self, other: i16) -> i16 {
        self.min(other)
    }

    #[inline(always)]
    fn is_less(self, than: i16) -> i16 {
        -i16::from(self < than)
    }

    #[inline(always)]
    fn and(self, other: i16) -> i16 {
        self & other
    }

    #[inline(always)]
    fn and_not(self, other: i16) -> i16 {
        self & !other
    }

    #[inline(always)]
    fn choose(self, yes: i16, no: i16) -> i16 {
        if self != 0 { yes } else { no }
    }

    #[inline(always)]
    fn any(self) -> bool {
        self != 0
    }

    #[inline(always)]
    fn bits(self) -> u64 {
        u64::from(self != 0)
    }

    #[inline(always)]
    fn first(_: usize) -> i16 {
        -1
    }
}
