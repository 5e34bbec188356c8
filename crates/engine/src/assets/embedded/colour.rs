//! A colour while it is being painted: three channels from 0 to 255, not yet rounded.

use std::ops::{Add, Mul};

/// Red, green and blue, each nominally 0..=255; values outside are clamped only when the colour is
/// stored.
///
/// Floating point is safe here although the engine is integer otherwise: only additions,
/// multiplications, divisions and square roots are used, which every platform rounds alike, and the
/// result is a palette index.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(super) struct Colour(pub(super) f32, pub(super) f32, pub(super) f32);

impl Colour {
    pub(super) const BLACK: Colour = Colour(0.0, 0.0, 0.0);

    /// A colour from `0xRRGGBB`.
    pub(super) const fn hex(rgb: u32) -> Colour {
        Colour((rgb >> 16 & 255) as f32, (rgb >> 8 & 255) as f32, (rgb & 255) as f32)
    }

    /// A grey.
    pub(super) const fn grey(level: f32) -> Colour {
        Colour(level, level, level)
    }

    /// This colour moved towards `other` by `part` (0..=1, clamped).
    pub(super) fn mix(self, other: Colour, part: f32) -> Colour {
        let part = part.clamp(0.0, 1.0);
        self * (1.0 - part) + other * part
    }

    /// The channels rounded to bytes.
    pub(super) fn bytes(self) -> [u8; 3] {
        [self.0, self.1, self.2].map(|channel| (channel + 0.5).clamp(0.0, 255.0) as u8)
    }
}

impl Add for Colour {
    type Output = Colour;
    fn add(self, other: Colour) -> Colour {
        Colour(self.0 + other.0, self.1 + other.1, self.2 + other.2)
    }
}

impl Mul<f32> for Colour {
    type Output = Colour;
    fn mul(self, factor: f32) -> Colour {
        Colour(self.0 * factor, self.1 * factor, self.2 * factor)
    }
}

/// The colour that lies at `part` (0..=1) along evenly spaced `stops`.
pub(super) fn gradient(stops: &[Colour], part: f32) -> Colour {
    let position = part.clamp(0.0, 1.0) * (stops.len() - 1) as f32;
    let segment = (position as usize).min(stops.len() - 2);
    stops[segment].mix(stops[segment + 1], position - segment as f32)
}
