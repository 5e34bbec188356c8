//! From palette indices to what callers want, written once into their own buffer.

#[cfg(target_arch = "x86_64")]
use super::convert_wide::Wide;

/// Weight of red, green and blue in luminance, in 256ths.
const LUMINANCE: [u32; 3] = [77, 150, 29];

/// The luminance of a colour.
pub(super) fn luminance(colour: [u8; 3]) -> u8 {
    let sum: u32 = colour.iter().zip(LUMINANCE).map(|(&channel, weight)| u32::from(channel) * weight).sum();
    (sum >> 8) as u8
}

/// The channels of a palette, a table each.
fn channels(palette: &[[u8; 3]; 256]) -> [[u8; 256]; 3] {
    std::array::from_fn(|channel| std::array::from_fn(|i| palette[i][channel]))
}

/// Looks every index up.
fn look_up(table: &[u8; 256], indices: &[u8], out: &mut [u8]) {
    #[cfg(target_arch = "x86_64")]
    let done = Wide::detect().map_or(0, |wide| wide.look_up(table, indices, out));
    #[cfg(not(target_arch = "x86_64"))]
    let done = 0;
    look_up_plainly(table, &indices[done..], &mut out[done..]);
}

fn look_up_plainly(table: &[u8; 256], indices: &[u8], out: &mut [u8]) {
    for (to, &index) in out.iter_mut().zip(indices) {
        *to = table[usize::from(index)];
    }
}

/// Red, green, blue of each pixel in turn.
pub(super) fn rgb_interleaved(palette: &[[u8; 3]; 256], indices: &[u8], out: &mut [u8]) {
    interleaved(palette, &channels(palette), indices, out);
}

/// The same with the palette's `channels`, which callers that come often make once.
fn interleaved(palette: &[[u8; 3]; 256], channels: &[[u8; 256]; 3], indices: &[u8], out: &mut [u8]) {
    #[cfg(target_arch = "x86_64")]
    let done = Wide::detect().map_or(0, |wide| wide.interleaved(channels, indices, out));
    #[cfg(not(target_arch = "x86_64"))]
    let (_, done) = (channels, 0);
    rgb_interleaved_plainly(palette, &indices[done..], &mut out[done * 3..]);
}

fn rgb_interleaved_plainly(palette: &[[u8; 3]; 256], indices: &[u8], out: &mut [u8]) {
    for (to, &index) in out.chunks_exact_mut(3).zip(indices) {
        to.copy_from_slice(&palette[usize::from(index)]);
    }
}

/// A plane of red, one of green, one of blue.
pub(super) fn rgb_planes(palette: &[[u8; 3]; 256], indices: &[u8], out: &mut [u8]) {
    for (table, plane) in channels(palette).iter().zip(out.chunks_exact_mut(indices.len())) {
        look_up(table, indices, plane);
    }
}

/// Luminance.
pub(super) fn grey(palette: &[[u8; 3]; 256], indices: &[u8], out: &mut [u8]) {
    look_up(&palette.map(luminance), indices, out);
}

/// The colour of a class; those beyond the table share its last one.
#[inline]
fn colour_of<const N: usize>(colours: &[[u8; 3]; N], class: u16) -> [u8; 3] {
    colours[usize::from(class).min(N - 1)]
}

/// The value of each class: 255 for `full`, 1 for `ones`, 0 for the others below 8, `values` for the rest; those beyond share its last one.
///
/// Most of a picture is surfaces and the weapon, which are told a block at a time.
pub(super) fn classes_one_byte<const N: usize>(values: &[u8; N], full: u16, ones: [u16; 2], classes: &[u16], out: &mut [u8]) {
    const BLOCK: usize = 32;
    for (to, classes) in out.chunks_mut(BLOCK).zip(classes.chunks(BLOCK)) {
        if classes.iter().fold(0, |bits, &class| bits | class) < 8 {
            let value = |class: u16| if class == full { 255 } else { u8::from(ones.contains(&class)) };
            to.iter_mut().zip(classes).for_each(|(to, &class)| *to = value(class));
        } else {
            to.iter_mut().zip(classes).for_each(|(to, &class)| *to = values[usize::from(class).min(N - 1)]);
        }
    }
}

/// Pixels converted at a time where a step in between needs room.
const STRETCH: usize = 1024;

/// Red, green, blue of each pixel in turn, and its depth.
pub(super) fn rgb_depth_interleaved(palette: &[[u8; 3]; 256], indices: &[u8], depth: &[u8], out: &mut [u8]) {
    let tables = channels(palette);
    let mut planes = [[0; STRETCH]; 3];
    for ((to, indices), depth) in out.chunks_mut(STRETCH * 4).zip(indices.chunks(STRETCH)).zip(depth.chunks(STRETCH)) {
        for (table, plane) in tables.iter().zip(&mut planes) {
            look_up(table, indices, &mut plane[..indices.len()]);
        }
        let [red, green, blue] = &planes;
        for ((((to, &red), &green), &blue), &depth) in to.chunks_exact_mut(4).zip(red).zip(green).zip(blue).zip(depth) {
            to.copy_from_slice(&[red, green, blue, depth]);
        }
    }
}

/// The colour of each class, pixel by pixel.
pub(super) fn classes_interleaved<const N: usize>(colours: &[[u8; 3]; N], classes: &[u16], out: &mut [u8]) {
    let mut palette = [[0; 3]; 256];
    palette.iter_mut().zip(colours).for_each(|(to, &colour)| *to = colour);
    let channels = channels(&palette);
    let mut indices = [0; STRETCH];
    for (to, classes) in out.chunks_mut(STRETCH * 3).zip(classes.chunks(STRETCH)) {
        // Few pictures hold so many things that a class does not fit a byte.
        if classes.iter().fold(0, |bits, &class| bits | class) < N.min(256) as u16 {
            indices.iter_mut().zip(classes).for_each(|(index, &class)| *index = class as u8);
            interleaved(&palette, &channels, &indices[..classes.len()], to);
        } else {
            for (to, &class) in to.chunks_exact_mut(3).zip(classes) {
                to.copy_from_slice(&colour_of(colours, class));
            }
        }
    }
}

/// The colour of each class, as three planes.
pub(super) fn classes_planes<const N: usize>(colours: &[[u8; 3]; N], classes: &[u16], out: &mut [u8]) {
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
        (values[5], values[1], values[2]) = (255, 1, 1);
        (8..64).for_each(|i| values[i] = i as u8 * 3);
        for length in [0, 31, 32, 33, 100] {
            for (at, class) in [(0, 5), (length / 2, 63), (length.max(1) - 1, 9), (3, 700), (7, 4)] {
                let classes: Vec<u16> = (0..length).map(|i| if i == at { class } else { i as u16 % 5 }).collect();
                let mut out = vec![1; length];
                classes_one_byte(&values, 5, [1, 2], &classes, &mut out);
                let plain: Vec<u8> = classes.iter().map(|&class| values[usize::from(class).min(63)]).collect();
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
            let mut out = vec![0; length * 4];
            rgb_depth_interleaved(&palette, &indices, &depth, &mut out);
            for (i, pixel) in out.chunks_exact(4).enumerate() {
                assert_eq!((&pixel[..3], pixel[3]), (&palette[usize::from(indices[i])][..], depth[i]));
            }
            let mut out = vec![0; length * 3];
            classes_interleaved(&colours, &classes, &mut out);
            for (i, pixel) in out.chunks_exact(3).enumerate() {
                assert_eq!(pixel, colour_of(&colours, classes[i]));
            }
        }
    }

    #[test]
    fn wide_and_plain_look_ups_agree() {
        let mut rng = Rng::new(3);
        let palette: [[u8; 3]; 256] = std::array::from_fn(|_| [0; 3].map(|_| rng.byte() as u8));
        for length in [0, 1, 63, 64, 65, 192, 1000, 9216] {
            let indices: Vec<u8> = (0..length).map(|_| rng.byte() as u8).collect();
            let (mut wide, mut plain) = (vec![0; length], vec![0; length]);
            look_up(&channels(&palette)[1], &indices, &mut wide);
            look_up_plainly(&channels(&palette)[1], &indices, &mut plain);
            assert_eq!(wide, plain);
            let (mut wide, mut plain) = (vec![0; length * 3], vec![0; length * 3]);
            rgb_interleaved(&palette, &indices, &mut wide);
            rgb_interleaved_plainly(&palette, &indices, &mut plain);
            assert_eq!(wide, plain);
        }
    }
}
