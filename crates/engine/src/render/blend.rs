//! Colours between two: what shines through things that are not opaque.

use super::scene::nearest_colour;
use crate::world::OPAQUE;

/// Bits of a channel that tell apart what a mixture may become.
const BITS: usize = 5;
/// The largest channel of so many bits.
const MOST: usize = (1 << BITS) - 1;

/// The palette, ready for mixing.
#[derive(Debug)]
pub(super) struct Blend {
    palette: Box<[[u8; 3]; 256]>,
    /// The nearest index of every colour reduced to [`BITS`] a channel: a mixture of any two needs no search, and none is
    /// kept of all pairs and all shares.
    nearest: Box<[u8]>,
    /// The index of black.
    black: u8,
}

impl Blend {
    pub fn new(palette: &[[u8; 3]; 256]) -> Blend {
        // Eight bits of five by repeating the topmost.
        let widened = |channel: usize| (channel << 3 | channel >> 2) as u8;
        let colour = |i: usize| [2 * BITS, BITS, 0].map(|shift| widened(i >> shift & MOST));
        let nearest = (0..1 << (3 * BITS)).map(|i| nearest_colour(palette, colour(i))).collect();
        Blend { palette: Box::new(*palette), nearest, black: nearest_colour(palette, [0; 3]) }
    }

    /// The palette index of `upper`, which has so many parts of [`OPAQUE`], over `lower`; each of the two is cut to a quarter
    /// of a level. By this, nearly every pixel of the original's puffs and souls comes out.
    #[inline]
    pub fn over(&self, upper: u8, lower: u8, share: u8) -> u8 {
        let (share, [upper, lower]) = (usize::from(share), [upper, lower].map(|index| self.palette[usize::from(index)]));
        let rest = usize::from(OPAQUE) - share;
        let mixed = |channel: usize| {
            let parts = ((usize::from(upper[channel]) * share) >> 4) + ((usize::from(lower[channel]) * rest) >> 4);
            (parts >> BITS) & MOST
        };
        self.nearest[mixed(0) << (2 * BITS) | mixed(1) << BITS | mixed(2)]
    }

    /// A palette index under so many parts of black.
    #[inline]
    pub fn darkened(&self, lower: u8, share: u8) -> u8 {
        self.over(self.black, lower, share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assets::Assets;

    #[test]
    fn a_mixture_lies_between_its_colours() {
        let palette = &Assets::embedded().palette;
        let blend = Blend::new(palette);
        let (black, white) = (nearest_colour(palette, [0; 3]), nearest_colour(palette, [255; 3]));
        let grey = |share| i32::from(palette[usize::from(blend.over(white, black, share))][1]);
        for share in 0..=OPAQUE {
            assert!((grey(share) - 255 * i32::from(share) / i32::from(OPAQUE)).abs() <= 16, "{share}: {}", grey(share));
        }
    }

    #[test]
    fn nothing_of_the_upper_colour_leaves_the_lower_one_to_five_bits() {
        let palette = &Assets::embedded().palette;
        let blend = Blend::new(palette);
        for lower in 0..=255 {
            for (upper, share) in [(lower, OPAQUE), (lower, OPAQUE / 2), (7, 0)] {
                let shown = palette[usize::from(blend.over(upper, lower, share))];
                let apart = shown.iter().zip(palette[usize::from(lower)]).map(|(&a, b)| a.abs_diff(b)).max();
                assert!(apart <= Some(24), "{lower} {share}: {shown:?}");
            }
        }
    }
}
