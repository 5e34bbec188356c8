//! Colours between two: what shines through things that are not opaque.

use crate::render::colour::palette::nearest_colour;
use crate::world::OPAQUE;
use std::sync::OnceLock;

/// Bits of a channel that distinguish what a mixture may become.
const BITS: usize = 5;
/// The largest channel of so many bits.
const MOST: usize = (1 << BITS) - 1;

/// Parts of a colour that a mixture is made of; an opacity is twice as fine.
pub(crate) const WHOLE: u8 = OPAQUE / 2;

/// Bits of a channel of which a part was taken: a quarter of a level each.
const PART_BITS: usize = 10;

/// What becomes of every two colours at one opacity of the upper one.
#[derive(Debug)]
pub(crate) struct Mixture(Box<[u8]>);

impl Mixture {
    /// So many bytes may be read behind each entry.
    const PADDING: usize = 3;

    /// As [`Blend::over`].
    #[inline(always)]
    pub fn over(&self, upper: u8, lower: u8) -> u8 {
        self.0[usize::from(upper) << 8 | usize::from(lower)]
    }

    /// An entry for each pair, by the upper colour times 256 plus the lower one, and more.
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    pub fn entries(&self) -> &[u8; (1 << 16) + Mixture::PADDING] {
        self.0.first_chunk().expect("all pairs are there")
    }
}

/// The palette, ready for mixing.
#[derive(Debug)]
pub(crate) struct Blend {
    /// So many parts of [`WHOLE`] of every colour, cut to a quarter of a level: red, green and blue
    /// of [`PART_BITS`] each in a number, so that the parts of two colours are added at once.
    parts: Box<[[u32; 256]]>,
    /// The nearest index of every colour reduced to [`BITS`] a channel: a mixture of any two needs
    /// no search.
    nearest: Box<[u8]>,
    /// By opacity, once it was asked for.
    mixtures: Box<[OnceLock<Mixture>; OPAQUE as usize + 1]>,
    /// Every colour under so many parts of [`WHOLE`] of black; under none it stays as it is.
    darkened: Box<[[u8; 256]; 1 << (WHOLE.ilog2() + 1)]>,
}

impl Blend {
    pub fn new(palette: &[[u8; 3]; 256]) -> Blend {
        // Eight bits of five by repeating the topmost.
        let widened = |channel: usize| (channel << 3 | channel >> 2) as u8;
        let colour = |i: usize| [2 * BITS, BITS, 0].map(|shift| widened(i >> shift & MOST));
        let nearest = (0..1 << (3 * BITS)).map(|i| nearest_colour(palette, colour(i))).collect();
        let part = |share: u8, [red, green, blue]: [u8; 3]| {
            [red, green, blue].iter().fold(0, |packed, &channel| {
                packed << PART_BITS | (u32::from(channel) * u32::from(share)) >> 4
            })
        };
        let parts = (0..=WHOLE).map(|share| palette.map(|colour| part(share, colour))).collect();
        let as_it_is = Box::new(std::array::from_fn(|_| std::array::from_fn(|index| index as u8)));
        let mixtures = Box::new([const { OnceLock::new() }; OPAQUE as usize + 1]);
        let mut blend = Blend { parts, nearest, mixtures, darkened: as_it_is };
        let black = nearest_colour(palette, [0; 3]);
        for share in 1..=WHOLE {
            blend.darkened[usize::from(share)] =
                std::array::from_fn(|lower| blend.over(black, lower as u8, 2 * share));
        }
        blend
    }

    /// The parts of the upper and the lower colour where the upper one is so opaque, each cut to a
    /// whole one.
    #[inline]
    pub fn shares(opacity: u8) -> [usize; 2] {
        [opacity, OPAQUE - opacity].map(|part| usize::from(part / 2))
    }

    /// The palette index of `upper`, which hides so many parts of [`OPAQUE`], over `lower`; each of
    /// the two is cut to a quarter of a level. By this, nearly every pixel of the original's puffs,
    /// souls, smoke and explosions comes out.
    #[inline]
    pub fn over(&self, upper: u8, lower: u8, opacity: u8) -> u8 {
        let [above, below] = Blend::shares(opacity);
        let sum = self.parts[above][usize::from(upper)] + self.parts[below][usize::from(lower)];
        let [red, green, blue] = [2, 1, 0]
            .map(|channel| (sum >> (channel * PART_BITS + PART_BITS - BITS)) as usize & MOST);
        self.nearest[red << (2 * BITS) | green << BITS | blue]
    }

    /// What becomes of every two colours where the upper one is so opaque: pictures have few
    /// opacities.
    pub fn mixture(&self, opacity: u8) -> &Mixture {
        let both = |i: usize| self.over((i >> 8) as u8, i as u8, opacity);
        self.mixtures[usize::from(opacity.min(OPAQUE))]
            .get_or_init(|| Mixture((0..1 << 16).map(both).chain([0; Mixture::PADDING]).collect()))
    }

    /// A palette index under black that hides so many parts of [`WHOLE`].
    #[inline]
    pub fn darkened(&self, lower: u8, hidden: u8) -> u8 {
        self.darkened[usize::from(hidden) % self.darkened.len()][usize::from(lower)]
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
        let grey = |opacity| i32::from(palette[usize::from(blend.over(white, black, opacity))][1]);
        for opacity in 0..=OPAQUE {
            assert!(
                (grey(opacity) - 255 * i32::from(opacity) / i32::from(OPAQUE)).abs() <= 16,
                "{opacity}: {}",
                grey(opacity)
            );
        }
    }

    #[test]
    fn channels_are_mixed_apart() {
        let palette = &Assets::embedded().palette;
        let blend = Blend::new(palette);
        for opacity in 0..=OPAQUE {
            let [above, below] = Blend::shares(opacity);
            for (upper, lower) in
                (0..=255).zip((0..=255u8).map(|i| i.wrapping_mul(37).wrapping_add(opacity)))
            {
                let colour: [u8; 3] = std::array::from_fn(|channel| {
                    let part = |index: u8, share: usize| {
                        (usize::from(palette[usize::from(index)][channel]) * share) >> 4
                    };
                    let five = (part(upper, above) + part(lower, below)) >> 5;
                    (five << 3 | five >> 2) as u8
                });
                assert_eq!(blend.over(upper, lower, opacity), nearest_colour(palette, colour));
                assert_eq!(
                    blend.mixture(opacity).over(upper, lower),
                    blend.over(upper, lower, opacity)
                );
            }
        }
    }

    #[test]
    fn what_both_parts_are_cut_by_is_lost() {
        // Two fifths and two thirds: measured on the original's smoke and explosions, where 26 and
        // 38 would differ in one pixel of ten.
        assert_eq!(
            [51, 85, OPAQUE / 2, OPAQUE].map(Blend::shares),
            [[25, 38], [42, 21], [32, 32], [64, 0]]
        );
    }

    #[test]
    fn nothing_of_the_upper_colour_leaves_the_lower_one_to_five_bits() {
        let palette = &Assets::embedded().palette;
        let blend = Blend::new(palette);
        for lower in 0..=255 {
            for (upper, share) in [(lower, OPAQUE), (lower, OPAQUE / 2), (7, 0)] {
                let shown = palette[usize::from(blend.over(upper, lower, share))];
                let apart = shown
                    .iter()
                    .zip(palette[usize::from(lower)])
                    .map(|(&a, b)| a.abs_diff(b))
                    .max();
                assert!(apart <= Some(24), "{lower} {share}: {shown:?}");
            }
        }
    }
}
