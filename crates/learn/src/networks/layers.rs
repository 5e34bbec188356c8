//! The convolutions of an encoder in the order of its parameters: plain ones, or those of a
//! residual network.

use serde::{Deserialize, Serialize};

use crate::config::Convolution;

/// Convolutions of a residual stage: one before the pooling, two in each of two blocks (Espeholt et
/// al. 2018, arXiv 1802.01561, figure 3, right).
pub const STAGE: usize = 5;
/// Zeros around the image of each of them, so that it keeps its size.
const BORDER: usize = 1;

/// Height, width and channels of an image.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct ImageShape {
    /// Rows.
    pub height: usize,
    /// Columns.
    pub width: usize,
    /// Values of a pixel.
    pub channels: usize,
}

impl ImageShape {
    /// Number of values.
    #[must_use]
    pub fn size(&self) -> usize {
        self.height * self.width * self.channels
    }

    /// Shape after a convolution, if the kernel fits.
    #[must_use]
    pub fn after(&self, convolution: &Convolution) -> Option<ImageShape> {
        let side =
            |length: usize| Some(length.checked_sub(convolution.kernel)? / convolution.stride + 1);
        Some(ImageShape {
            height: side(self.height)?,
            width: side(self.width)?,
            channels: convolution.channels,
        })
    }
}

/// One convolution of an encoder.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct EncoderLayer {
    /// Name of its parameters.
    pub name: String,
    /// The convolution.
    pub convolution: Convolution,
    /// The image that it is on.
    pub image: ImageShape,
    /// Rows and columns of zeros around that image.
    pub border: usize,
    /// What comes out.
    pub output: ImageShape,
}

impl EncoderLayer {
    /// Products of a weight and a value in one pass over an image.
    #[must_use]
    pub fn products(&self) -> f64 {
        (self.output.size() * self.convolution.kernel.pow(2) * self.image.channels) as f64
    }
}

impl ImageShape {
    /// Shape with a border around.
    #[must_use]
    pub fn bordered(&self, border: usize) -> ImageShape {
        ImageShape { height: self.height + 2 * border, width: self.width + 2 * border, ..*self }
    }

    /// Shape after pooling 3x3 pixels around every second one, as the residual network does.
    #[must_use]
    pub fn pooled(&self) -> ImageShape {
        ImageShape { height: self.height.div_ceil(2), width: self.width.div_ceil(2), ..*self }
    }
}

/// The convolutions of an encoder: plain ones, or those of a residual one, which has so many
/// channels in each stage.
#[must_use]
pub fn encoder_layers(
    image: ImageShape,
    convolutions: &[Convolution],
    residual: &[usize],
) -> Vec<EncoderLayer> {
    let mut layers = Vec::new();
    let mut image = image;
    for (index, convolution) in convolutions.iter().enumerate() {
        let output = image.after(convolution).expect("checked shape");
        layers.push(EncoderLayer {
            name: format!("convolution{index}"),
            convolution: *convolution,
            image,
            border: 0,
            output,
        });
        image = output;
    }
    for (stage, &channels) in residual.iter().enumerate() {
        let convolution = Convolution { channels, kernel: 2 * BORDER + 1, stride: 1 };
        for part in 0..STAGE {
            let name = match part {
                0 => format!("stage{stage}.convolution"),
                _ => format!("stage{stage}.block{}.convolution{}", (part - 1) / 2, (part - 1) % 2),
            };
            let output = ImageShape { channels, ..image };
            layers.push(EncoderLayer { name, convolution, image, border: BORDER, output });
            image = if part == 0 { output.pooled() } else { output };
        }
    }
    layers
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::networks::NetworkShape;

    /// Figure 3, right, on the benchmark's pictures: each stage halves them, and has one
    /// convolution before and four behind that.
    #[test]
    fn residual_stages_halve_the_picture() {
        let shape = NetworkShape {
            convolutions: vec![],
            residual: vec![32, 32, 32],
            ..NetworkShape::default()
        };
        shape.check().unwrap();
        let layers = shape.encoder_layers();
        let (size, sides) =
            (|index: usize| layers[index].output.size(), [(72, 128), (36, 64), (18, 32), (9, 16)]);
        for (stage, ((height, width), (lower, narrower))) in
            sides.into_iter().zip(sides.into_iter().skip(1)).enumerate()
        {
            assert_eq!(size(STAGE * stage), height * width * 32);
            assert!((1..STAGE).all(|part| size(STAGE * stage + part) == lower * narrower * 32));
        }
        assert_eq!(shape.features(), 9 * 16 * 32);
        let each = 9.0 * 32.0 * 32.0;
        let pictures = 72.0 * 128.0 * 27.0 * 32.0
            + (5.0 * 36.0 * 64.0 + 5.0 * 18.0 * 32.0 + 4.0 * 9.0 * 16.0) * each;
        assert_eq!(layers.iter().map(EncoderLayer::products).sum::<f64>(), pictures);
        let names: Vec<&str> =
            layers.iter().skip(STAGE).map(|layer| layer.name.as_str()).take(STAGE).collect();
        assert_eq!(names[0], "stage1.convolution");
        assert_eq!(names[4], "stage1.block1.convolution1");
    }
}
