//! PNG files.

use crate::files::{WholeFile, read_limited};
use crate::{MediaError, Picture};
use std::path::Path;

/// Largest PNG file that is read, in bytes.
const READ_LIMIT: u64 = 64 << 20;

/// The picture as the bytes of a PNG file. Same picture, same bytes.
///
/// # Panics
/// Never: memory takes every write.
#[must_use]
pub fn encode(picture: &Picture) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_to(picture, &mut bytes).expect("writing to memory does not fail");
    bytes
}

/// Writes a PNG file, whole or not at all.
///
/// # Errors
/// When the file cannot be written.
pub fn write(picture: &Picture, path: &Path) -> Result<(), MediaError> {
    let mut file = WholeFile::create(path)?;
    write_to(picture, &mut file)
        .map_err(|e| MediaError::io(path, "write", std::io::Error::other(e)))?;
    file.finish()
}

/// Pixels as a renderer has them, row after row.
#[derive(Clone, Copy, Debug)]
pub enum Pixels<'a> {
    /// Indices into colours.
    Indexed(&'a [u8], &'a [[u8; 3]; 256]),
    /// Black to white.
    Grey(&'a [u8]),
    /// Red, green, blue.
    Rgb(&'a [u8]),
}

/// The bytes of a PNG file, made quickly rather than small: for frames that are sent to a viewer as
/// they come (docs/results/serve.md has times and sizes).
///
/// # Errors
/// When the pixels are not those of `width * height` or there are none.
pub fn encode_quickly(
    width: usize,
    height: usize,
    pixels: Pixels<'_>,
) -> Result<Vec<u8>, MediaError> {
    let failed =
        |e: png::EncodingError| MediaError::Size(format!("no PNG of {width}x{height}: {e}"));
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
    encoder.set_depth(png::BitDepth::Eight);
    // Near walls and floors rows repeat; runs of zeros are nearly all that the quickest coder
    // finds.
    encoder.set_filter(png::Filter::Up);
    encoder.set_deflate_compression(png::DeflateCompression::FdeflateUltraFast);
    let data = match pixels {
        Pixels::Indexed(indices, palette) => {
            encoder.set_color(png::ColorType::Indexed);
            encoder.set_palette(palette.as_flattened());
            indices
        }
        Pixels::Grey(data) => {
            encoder.set_color(png::ColorType::Grayscale);
            data
        }
        Pixels::Rgb(data) => {
            encoder.set_color(png::ColorType::Rgb);
            data
        }
    };
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(data).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

fn write_to(picture: &Picture, out: impl std::io::Write) -> Result<(), png::EncodingError> {
    let mut encoder = png::Encoder::new(out, picture.width() as u32, picture.height() as u32);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    let Some((palette, indices)) = indexed(picture) else {
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(picture.rgb())?;
        return writer.finish();
    };
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_palette(palette);
    // Neighbouring indices are not neighbouring colours, so that no filter helps.
    encoder.set_filter(png::Filter::NoFilter);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&indices)?;
    writer.finish()
}

/// The colours of a picture, ordered, and the index of each pixel among them; `None` if there are
/// more than 256. Frames of the engine have no more: their files become half as large without any
/// loss.
fn indexed(picture: &Picture) -> Option<(Vec<u8>, Vec<u8>)> {
    let mut colours = std::collections::BTreeMap::new();
    for pixel in picture.rgb().chunks_exact(3) {
        if colours.insert(pixel, 0u8).is_none() && colours.len() > 256 {
            return None;
        }
    }
    colours.values_mut().zip(0..=255).for_each(|(index, place)| *index = place);
    let indices = picture.rgb().chunks_exact(3).map(|pixel| colours[pixel]).collect();
    Some((colours.into_keys().flatten().copied().collect(), indices))
}

/// Reads a PNG file of any colour type; transparency is laid over black.
///
/// # Errors
/// When it cannot be read, is no PNG, or is larger than 64 MiB or 65,535 pixels a side.
pub fn read(path: &Path) -> Result<Picture, MediaError> {
    decode(&read_limited(path, READ_LIMIT)?, path)
}

/// Reads the bytes of a PNG file; `name` is for messages.
///
/// # Errors
/// As [`read`].
pub fn decode(bytes: &[u8], name: &Path) -> Result<Picture, MediaError> {
    let bad = |e: png::DecodingError| MediaError::format(name, format!("is no readable PNG: {e}"));
    let mut decoder = png::Decoder::new_with_limits(
        std::io::Cursor::new(bytes),
        png::Limits { bytes: 512 << 20 },
    );
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(bad)?;
    let size = reader
        .output_buffer_size()
        .filter(|&size| size <= 512 << 20)
        .ok_or_else(|| MediaError::format(name, "is a PNG of more than 512 MiB of pixels"))?;
    let mut pixels = vec![0; size];
    let info = reader.next_frame(&mut pixels).map_err(bad)?;
    let samples = info.color_type.samples();
    let rgb = pixels[..info.buffer_size()]
        .chunks_exact(samples)
        .flat_map(|p| {
            let (rgb, alpha) = match samples {
                1 => ([p[0]; 3], 255),
                2 => ([p[0]; 3], p[1]),
                3 => ([p[0], p[1], p[2]], 255),
                _ => ([p[0], p[1], p[2]], p[3]),
            };
            rgb.map(|c| (u32::from(c) * u32::from(alpha) / 255) as u8)
        })
        .collect();
    Picture::from_rgb(info.width as usize, info.height as usize, rgb)
        .map_err(|e| MediaError::format(name, format!("is a PNG of an unusable size: {e}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read() {
        let few = Picture::from_rgb(5, 3, (0..45).map(|i| i * 5).collect()).unwrap();
        let exactly_256 =
            Picture::from_grey(256, 2, &[0u8, 1].map(|_| (0..=255).collect::<Vec<u8>>()).concat())
                .unwrap();
        let mut more = exactly_256.clone();
        more.fill(0, 0, 1, 1, [9, 8, 7]);
        for picture in [few, exactly_256, more] {
            assert_eq!(decode(&encode(&picture), Path::new("memory")).unwrap(), picture);
        }
    }

    #[test]
    fn damaged_files_are_errors() {
        let whole = encode(&Picture::filled(40, 30, [1, 2, 3]));
        for cut in 0..whole.len() - 12 {
            // The last 12 bytes are the end mark, which a reader of pixels may do without.
            assert!(decode(&whole[..cut], Path::new("cut.png")).is_err(), "cut at {cut}");
        }
        let error = decode(b"GIF89a", Path::new("x.png")).unwrap_err().to_string();
        assert!(error.starts_with("x.png: is no readable PNG"), "{error}");
    }
}
