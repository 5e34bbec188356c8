//! Light tables of eight distances at once.

use crate::render::view::light::Light;
use std::arch::x86_64::*;

/// [`Light::table`].
#[inline]
#[target_feature(enable = "avx512f")]
pub(crate) fn tables(light: Light, nearness: __m512i) -> __m512i {
    let nearness = _mm512_min_epi64(nearness, _mm512_set1_epi64(light.most));
    let table = _mm512_srai_epi64(_mm512_sub_epi64(_mm512_set1_epi64(light.base), nearness), 16);
    _mm512_max_epi64(_mm512_min_epi64(table, _mm512_set1_epi64(31)), _mm512_setzero_si512())
}
