//! PNG pictures among the lumps: decoded, brought to the palette, anchored by their own chunk.

use super::IwadError;
use super::budget::SIDE_LIMIT;
use super::reader::Reader;
use crate::assets::{Image, Stain};
use crate::wad::Lump;
use std::io::Cursor;

const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";

/// Alpha from which on a pixel is opaque.
const OPAQUE: u8 = 128;

/// Work that a pixel takes: its colour is looked for among the palette's.
const WORK: usize = 16;

/// Whether a lump begins as a PNG.
pub(super) fn is_png(bytes: &[u8]) -> bool {
    bytes.starts_with(&SIGNATURE[..4])
}

/// A decoded PNG.
struct Rows {
    width: usize,
    height: usize,
    /// Bytes of a pixel, and of a row.
    channels: usize,
    line: usize,
    bytes: Vec<u8>,
}

impl Rows {
    fn decode(lump: &Lump<'_>, reader: &mut Reader) -> Result<Rows, IwadError> {
        let wrong = |what| IwadError::Picture { lump: lump.name, what };
        let broken = |_| wrong("it is a broken PNG");
        let limits = png::Limits { bytes: 1 << 27 };
        let mut decoder = png::Decoder::new_with_limits(Cursor::new(lump.bytes), limits);
        decoder.set_transformations(png::Transformations::normalize_to_color8());
        let mut file = decoder.read_info().map_err(broken)?;
        let (width, height) = (file.info().width as usize, file.info().height as usize);
        if !(1..=SIDE_LIMIT).contains(&width) || !(1..=SIDE_LIMIT).contains(&height) {
            return Err(wrong("its size is absurd"));
        }
        reader.budget.keep(width * height)?;
        reader.budget.visit(WORK * width * height)?;
        let mut bytes =
            vec![0; file.output_buffer_size().ok_or_else(|| wrong("its size is absurd"))?];
        let frame = file.next_frame(&mut bytes).map_err(broken)?;
        Ok(Rows {
            width,
            height,
            channels: frame.color_type.samples(),
            line: frame.line_size,
            bytes,
        })
    }

    /// Column, row and channels of every pixel.
    fn pixels(&self) -> impl Iterator<Item = (usize, usize, &[u8])> {
        let rows = self.bytes.chunks_exact(self.line).take(self.height).enumerate();
        rows.flat_map(|(y, row)| {
            row.chunks_exact(self.channels)
                .take(self.width)
                .enumerate()
                .map(move |(x, pixel)| (x, y, pixel))
        })
    }
}

/// Decodes a PNG of any colour type into the palette's nearest colours.
pub(super) fn decode(lump: &Lump<'_>, reader: &mut Reader) -> Result<Image, IwadError> {
    let rows = Rows::decode(lump, reader)?;
    let (width, height) = (rows.width, rows.height);
    let mut pixels = vec![0; width * height].into_boxed_slice();
    let mut mask = vec![0; width * height].into_boxed_slice();
    for (x, y, pixel) in rows.pixels() {
        let (colour, alpha) = match *pixel {
            [grey] => ([grey; 3], u8::MAX),
            [grey, alpha] => ([grey; 3], alpha),
            [red, green, blue] => ([red, green, blue], u8::MAX),
            [red, green, blue, alpha] => ([red, green, blue], alpha),
            _ => return Err(IwadError::Picture { lump: lump.name, what: "it is a broken PNG" }),
        };
        if alpha >= OPAQUE {
            pixels[x * height + y] = reader.nearest(colour);
            mask[x * height + y] = 1;
        }
    }
    let opaque = mask.iter().all(|&opaque| opaque == 1);
    let [offset_x, offset_y] = anchor(lump.bytes).unwrap_or_default();
    Ok(Image {
        width: width as u16,
        height: height as u16,
        offset_x,
        offset_y,
        pixels,
        mask: (!opaque).then_some(mask),
    })
}

/// Decodes a PNG whose first channel says how opaque a stain is.
pub(super) fn stain(lump: &Lump<'_>, reader: &mut Reader) -> Result<Stain, IwadError> {
    let rows = Rows::decode(lump, reader)?;
    let (width, height) = (rows.width, rows.height);
    let mut texels = vec![0; width * height].into_boxed_slice();
    for (x, y, pixel) in rows.pixels() {
        texels[x * height + y] = pixel[0];
    }
    let [offset_x, offset_y] = anchor(lump.bytes).unwrap_or_default();
    Ok(Stain { width: width as u16, height: height as u16, offset_x, offset_y, texels })
}

/// The offsets that the chunk `grAb` holds, as sprites have them.
fn anchor(bytes: &[u8]) -> Option<[i16; 2]> {
    let mut rest = bytes.get(SIGNATURE.len()..)?;
    loop {
        let number = |at: usize| -> Option<[u8; 4]> { rest.get(at..at + 4)?.try_into().ok() };
        let length = u32::from_be_bytes(number(0)?) as usize;
        if rest.get(4..8)? == b"grAb" && length == 8 {
            let side = |at| {
                Some(i32::from_be_bytes(number(at)?).clamp(-(SIDE_LIMIT as i32), SIDE_LIMIT as i32)
                    as i16)
            };
            return Some([side(8)?, side(12)?]);
        }
        // Length, name and checksum around the contents.
        rest = rest.get(length.checked_add(12)?..)?;
    }
}
