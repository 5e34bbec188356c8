//! From palette indices to what callers want, written once into their own buffer.

crate::simd::kernel_files!(avx512);
mod scalar;

use crate::render::colour::palette::{Colours, luminance};
use crate::simd::{Simd, dispatch};

/// SurfaceCache every index up.
fn look_up(simd: Simd, table: &[u8; 256], indices: &[u8], out: &mut [u8]) {
    let done = dispatch!(simd; avx512 => avx512::look_up(table, indices, out), scalar => 0);
    for (to, &index) in out[done..].iter_mut().zip(&indices[done..]) {
        *to = table[usize::from(index)];
    }
}

/// Red, green, blue of each pixel in turn.
pub(crate) fn rgb_interleaved(simd: Simd, colours: &Colours, indices: &[u8], out: &mut [u8]) {
    let done = dispatch!(simd; avx512 => avx512::interleaved(&colours.channels, indices, out), scalar => 0);
    scalar::rgb_interleaved(colours, &indices[done..], &mut out[done * 3..]);
}

/// A plane of red, one of green, one of blue.
pub(crate) fn rgb_planes(simd: Simd, colours: &Colours, indices: &[u8], out: &mut [u8]) {
    for (table, plane) in colours.channels.iter().zip(out.chunks_exact_mut(indices.len())) {
        look_up(simd, table, indices, plane);
    }
}

/// Luminance.
pub(crate) fn grey(simd: Simd, colours: &Colours, indices: &[u8], out: &mut [u8]) {
    look_up(simd, &colours.palette.map(luminance), indices, out);
}

/// The colour of a class; those beyond the table share its last one.
#[inline]
fn colour_of<const N: usize>(colours: &[[u8; 3]; N], class: u16) -> [u8; 3] {
    colours[usize::from(class).min(N - 1)]
}

/// The value of each class: 255 for `full`, 0 for the others below 8, `values` for the rest; those
/// beyond share its last one.
///
/// Most of a picture is surfaces and the weapon, which are converted a block at a time.
pub(crate) fn classes_one_byte<const N: usize>(
    values: &[u8; N],
    full: u16,
    classes: &[u16],
    out: &mut [u8],
) {
    const BLOCK: usize = 32;
    for (to, classes) in out.chunks_mut(BLOCK).zip(classes.chunks(BLOCK)) {
        if classes.iter().fold(0, |bits, &class| bits | class) < 8 {
            to.iter_mut()
                .zip(classes)
                .for_each(|(to, &class)| *to = if class == full { 255 } else { 0 });
        } else {
            to.iter_mut()
                .zip(classes)
                .for_each(|(to, &class)| *to = values[usize::from(class).min(N - 1)]);
        }
    }
}

/// Pixels converted at a time where a step in between needs room.
const STRETCH: usize = 1024;

/// Red, green, blue of each pixel in turn, and its depth.
pub(crate) fn rgb_depth_interleaved(
    simd: Simd,
    colours: &Colours,
    indices: &[u8],
    depth: &[u8],
    out: &mut [u8],
) {
    let done = dispatch!(simd; avx512 => avx512::with_depth(&colours.channels, indices, depth, out), scalar => 0);
    let (pixels, _) = out[done * 4..].as_chunks_mut::<4>();
    for ((to, &index), &depth) in pixels.iter_mut().zip(&indices[done..]).zip(&depth[done..]) {
        *to = (colours.words[usize::from(index)] | u32::from(depth) << 24).to_le_bytes();
    }
}

/// The colour of each class, pixel by pixel.
pub(crate) fn classes_interleaved<const N: usize>(
    simd: Simd,
    colours: &[[u8; 3]; N],
    classes: &[u16],
    out: &mut [u8],
) {
    let mut palette = [[0; 3]; 256];
    palette.iter_mut().zip(colours).for_each(|(to, &colour)| *to = colour);
    let palette = Colours::new(palette);
    let mut indices = [0; STRETCH];
    for (to, classes) in out.chunks_mut(STRETCH * 3).zip(classes.chunks(STRETCH)) {
        // Few pictures hold so many things that a class does not fit a byte.
        if classes.iter().fold(0, |bits, &class| bits | class) < N.min(256) as u16 {
            indices.iter_mut().zip(classes).for_each(|(index, &class)| *index = class as u8);
            rgb_interleaved(simd, &palette, &indices[..classes.len()], to);
        } else {
            for (to, &class) in to.chunks_exact_mut(3).zip(classes) {
                to.copy_from_slice(&colour_of(colours, class));
            }
        }
    }
}

/// The colour of each class, as three planes.
pub(crate) fn classes_planes<const N: usize>(
    colours: &[[u8; 3]; N],
    classes: &[u16],
    out: &mut [u8],
) {
    for (i, plane) in out.chunks_exact_mut(classes.len()).enumerate() {
        plane.iter_mut().zip(classes).for_each(|(to, &class)| *to = colour_of(colours, class)[i]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rng;

    #[test]
    fn blocks_of_surfaces_are_no_short_cut() {
        let mut values = [0; 64];
        values[5] = 255;
        (8..64).for_each(|i| values[i] = i as u8 * 3);
        for length in [0, 31, 32, 33, 100] {
            for (at, class) in [(0, 5), (length / 2, 63), (length.max(1) - 1, 9), (3, 700), (7, 4)]
            {
                let classes: Vec<u16> =
                    (0..length).map(|i| if i == at { class } else { i as u16 % 5 }).collect();
                let mut out = vec![1; length];
                classes_one_byte(&values, 5, &classes, &mut out);
                let plain: Vec<u8> =
                    classes.iter().map(|&class| values[usize::from(class).min(63)]).collect();
                assert_eq!(out, plain);
            }
        }
    }

    #[test]
    fn depth_and_classes_stand_where_they_belong() {
        let mut rng = Rng::new(5);
        let palette: [[u8; 3]; 256] = std::array::from_fn(|_| [0; 3].map(|_| rng.byte() as u8));
        let colours: [[u8; 3]; 1024] = std::array::from_fn(|_| [0; 3].map(|_| rng.byte() as u8));
        for length in [0, 1, 65, 1023, 1024, 1025, 9216] {
            let indices: Vec<u8> = (0..length).map(|_| rng.byte() as u8).collect();
            let depth: Vec<u8> = (0..length).map(|_| rng.byte() as u8).collect();
            let most = if length % 2 == 0 { 1100 } else { 60 };
            let classes: Vec<u16> = (0..length).map(|_| (rng.byte() as u16 * 5) % most).collect();
            for simd in Simd::available() {
                let mut out = vec![0; length * 4];
                rgb_depth_interleaved(simd, &Colours::new(palette), &indices, &depth, &mut out);
                for (i, pixel) in out.chunks_exact(4).enumerate() {
                    assert_eq!(
                        (&pixel[..3], pixel[3]),
                        (&palette[usize::from(indices[i])][..], depth[i])
                    );
                }
                let mut out = vec![0; length * 3];
                classes_interleaved(simd, &colours, &classes, &mut out);
                for (i, pixel) in out.chunks_exact(3).enumerate() {
                    assert_eq!(pixel, colour_of(&colours, classes[i]));
                }
            }
        }
    }

    #[test]
    fn all_ways_of_looking_up_agree() {
        let mut rng = Rng::new(3);
        let palette: [[u8; 3]; 256] = std::array::from_fn(|_| [0; 3].map(|_| rng.byte() as u8));
        let colours = Colours::new(palette);
        for length in [0, 1, 3, 4, 63, 64, 65, 192, 1000, 9216] {
            let indices: Vec<u8> = (0..length).map(|_| rng.byte() as u8).collect();
            let pixels: Vec<[u8; 3]> =
                indices.iter().map(|&index| palette[usize::from(index)]).collect();
            for simd in Simd::available() {
                let mut out = vec![0; length * 3];
                rgb_interleaved(simd, &colours, &indices, &mut out);
                assert_eq!(out, pixels.concat(), "{simd:?}");
                let mut out = vec![0; length];
                grey(simd, &colours, &indices, &mut out);
                assert!(
                    out.iter().zip(&pixels).all(|(&grey, &pixel)| grey == luminance(pixel)),
                    "{simd:?}"
                );
                let mut out = vec![0; length * 3];
                if length > 0 {
                    rgb_planes(simd, &colours, &indices, &mut out);
                }
                assert!(
                    (0..length * 3).all(|i| out[i] == pixels[i % length][i / length]),
                    "{simd:?}"
                );
            }
        }
    }
}
