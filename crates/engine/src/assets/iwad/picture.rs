//! The column format of patches, sprites and status-bar pictures.

use super::budget::{Budget, SIDE_LIMIT};
use super::{IwadError, long, short};
use crate::assets::Image;
use crate::wad::Lump;

/// Bytes before the column offsets: width, height, left and top offset.
const HEADER: usize = 8;

/// Decodes a picture: columns of opaque runs, transparent between.
pub(super) fn decode(lump: &Lump<'_>, budget: &mut Budget) -> Result<Image, IwadError> {
    let wrong = |what| IwadError::Picture { lump: lump.name, what };
    let bytes = lump.bytes;
    if bytes.len() < HEADER {
        return Err(IwadError::TooShort { lump: lump.name, least: HEADER, length: bytes.len() });
    }
    let (width, height) = (i32::from(short(bytes, 0)), i32::from(short(bytes, 2)));
    let allowed = 1..=SIDE_LIMIT as i32;
    if !allowed.contains(&width) || !allowed.contains(&height) {
        return Err(wrong("its size is absurd"));
    }
    let (width, height) = (width as usize, height as usize);
    let offsets =
        bytes.get(HEADER..HEADER + 4 * width).ok_or_else(|| wrong("its columns lie outside"))?;
    budget.keep(width * height)?;
    let mut pixels = vec![0; width * height].into_boxed_slice();
    let mut mask = vec![0; width * height].into_boxed_slice();
    for column in 0..width {
        let start = usize::try_from(long(offsets, 4 * column))
            .map_err(|_| wrong("its columns lie outside"))?;
        let part = column * height..(column + 1) * height;
        let posts = bytes.get(start..).ok_or_else(|| wrong("its columns lie outside"))?;
        let visited = draw_posts(posts, &mut pixels[part.clone()], &mut mask[part])
            .ok_or_else(|| wrong("a column never ends"))?;
        budget.visit(visited)?;
    }
    let opaque = mask.iter().all(|&opaque| opaque == 1);
    Ok(Image {
        width: width as u16,
        height: height as u16,
        offset_x: short(bytes, 4),
        offset_y: short(bytes, 6),
        pixels,
        mask: (!opaque).then_some(mask),
    })
}

/// Draws a column's runs and gives the number of bytes read; `None` if they lead outside.
fn draw_posts(posts: &[u8], pixels: &mut [u8], mask: &mut [u8]) -> Option<usize> {
    let mut at = 0;
    let mut last_top = None;
    loop {
        let delta = usize::from(*posts.get(at)?);
        if delta == 255 {
            return Some(at + 1);
        }
        let length = usize::from(*posts.get(at + 1)?);
        // Rows beyond 254 are marked by a step that does not go down: it then counts from the run
        // before.
        let top = match last_top {
            Some(last) if delta <= last => last + delta,
            _ => delta,
        };
        last_top = Some(top);
        // One unused byte before and after the run.
        let run = posts.get(at + 3..at + 3 + length)?;
        if let Some(room) = pixels.len().checked_sub(top) {
            let shown = length.min(room);
            pixels[top..top + shown].copy_from_slice(&run[..shown]);
            mask[top..top + shown].fill(1);
        }
        at += length + 4;
    }
}
