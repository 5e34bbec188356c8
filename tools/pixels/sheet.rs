//! A picture of a moment: theirs, ours, and what differs.

use crate::Any;
use std::path::Path;

/// Differences are this many times as bright as they are large.
const BRIGHTER: u8 = 4;

/// Writes two pictures of a size and their difference beside one another; small ones four times as
/// large.
pub fn write(path: &Path, [width, height]: [usize; 2], [theirs, ours]: [&[u8]; 2]) -> Any<()> {
    let scale = if width < 320 { 4 } else { 1 };
    let difference: Vec<u8> =
        theirs.iter().zip(ours).map(|(a, b)| a.abs_diff(*b).saturating_mul(BRIGHTER)).collect();
    let mut sheet = Vec::with_capacity(3 * width * height * scale * scale * 3);
    for y in 0..height * scale {
        for picture in [theirs, ours, &difference] {
            for x in 0..width * scale {
                let at = (y / scale * width + x / scale) * 3;
                sheet.extend_from_slice(&picture[at..at + 3]);
            }
        }
    }
    let file = std::io::BufWriter::new(std::fs::File::create(path)?);
    let mut encoder = png::Encoder::new(file, (3 * width * scale) as u32, (height * scale) as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header()?.write_image_data(&sheet)?;
    Ok(())
}
