//! How bytes of pixels become numbers.

/// What turns an 8-bit pixel into the network's input: `clamp(pixel * scale + shift, -5, 5)`, in
/// the image's order.
#[derive(Clone, PartialEq, Debug)]
pub struct PixelScale {
    /// Factor of each pixel.
    pub scale: Vec<f32>,
    /// Summand of each pixel.
    pub shift: Vec<f32>,
}

impl PixelScale {
    /// Pixels over 255, nothing else.
    #[must_use]
    pub fn unit(pixels: usize) -> PixelScale {
        PixelScale { scale: vec![1.0 / 255.0; pixels], shift: vec![0.0; pixels] }
    }
}
