//! Pictures of floors and ceilings, cut to powers of two.

use crate::assets::Image;
use std::sync::Arc;

/// A texture on a floor or ceiling, a square of 64 or 128, column by column.
#[derive(Clone, Debug)]
pub(crate) enum FlatTexture {
    /// The usual size.
    Small(Arc<[u8; 64 * 64]>),
    /// Textures with a side of 128 or more.
    Large(Arc<[u8; 128 * 128]>),
}

impl FlatTexture {
    pub fn new(image: &Image) -> FlatTexture {
        let (width, height) = (usize::from(image.width).max(1), usize::from(image.height).max(1));
        // Sides become powers of two, cut rather than scaled, as one texel is one map unit.
        let (across, down) = (1 << width.ilog2().min(7), 1 << height.ilog2().min(7));
        let texel = |u: usize, v: usize| {
            image.pixels.get((u % across) * height + v % down).copied().unwrap_or(0)
        };
        if across <= 64 && down <= 64 {
            FlatTexture::Small(Arc::new(std::array::from_fn(|i| texel(i / 64, i % 64))))
        } else {
            let mut pixels = Box::new([0; 128 * 128]);
            pixels.iter_mut().enumerate().for_each(|(i, pixel)| *pixel = texel(i / 128, i % 128));
            FlatTexture::Large(Arc::from(pixels))
        }
    }
}
