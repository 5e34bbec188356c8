//! The interleaved look-up, eight pixels at a time, for every processor.

use crate::render::colour::palette::Colours;

/// Eight pixels at a time: pairs of them, whose stores overlap: each writes two bytes too many,
/// which the next one mends.
pub(crate) fn rgb_interleaved(colours: &Colours, indices: &[u8], out: &mut [u8]) {
    let ((eights, rest), (triples, last)) = (indices.as_chunks::<8>(), out.as_chunks_mut::<24>());
    for (to, from) in triples.iter_mut().zip(eights) {
        // Not over a list of indices: the compiler makes calls of that.
        let pair = |one: u8, two: u8| {
            u64::from(colours.words[usize::from(one)])
                | u64::from(colours.words[usize::from(two)]) << 24
        };
        let (a, b, c, d) = (
            pair(from[0], from[1]),
            pair(from[2], from[3]),
            pair(from[4], from[5]),
            pair(from[6], from[7]),
        );
        to[..8].copy_from_slice(&a.to_le_bytes());
        to[6..14].copy_from_slice(&b.to_le_bytes());
        to[12..20].copy_from_slice(&c.to_le_bytes());
        to[16..].copy_from_slice(&(c >> 32 | d << 16).to_le_bytes());
    }
    for (to, &index) in last.chunks_exact_mut(3).zip(rest) {
        to.copy_from_slice(&colours.palette[usize::from(index)]);
    }
}
