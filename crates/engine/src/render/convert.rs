//! From palette indices to what callers want, written once into their own buffer.

/// Weight of red, green and blue in luminance, in 256ths.
const LUMINANCE: [u32; 3] = [77, 150, 29];

/// The luminance of a colour.
pub(super) fn luminance(colour: [u8; 3]) -> u8 {
    let sum: u32 = colour.iter().zip(LUMINANCE).map(|(&channel, weight)| u32::from(channel) * weight).sum();
    (sum >> 8) as u8
}

/// One channel of a palette.
fn channel(palette: &[[u8; 3]; 256], index: usize) -> [u8; 256] {
    std::array::from_fn(|i| palette[i][index])
}

/// Looks every index up.
fn look_up(table: &[u8; 256], indices: &[u8], out: &mut [u8]) {
    for (to, &index) in out.iter_mut().zip(indices) {
        *to = table[usize::from(index)];
    }
}

/// Red, green, blue of each pixel in turn.
pub(super) fn rgb_interleaved(palette: &[[u8; 3]; 256], indices: &[u8], out: &mut [u8]) {
    for (to, &index) in out.chunks_exact_mut(3).zip(indices) {
        to.copy_from_slice(&palette[usize::from(index)]);
    }
}

/// A plane of red, one of green, one of blue.
pub(super) fn rgb_planes(palette: &[[u8; 3]; 256], indices: &[u8], out: &mut [u8]) {
    for (i, plane) in out.chunks_exact_mut(indices.len()).enumerate() {
        look_up(&channel(palette, i), indices, plane);
    }
}

/// Luminance.
pub(super) fn grey(palette: &[[u8; 3]; 256], indices: &[u8], out: &mut [u8]) {
    look_up(&palette.map(luminance), indices, out);
}

/// The colour of each class, pixel by pixel.
pub(super) fn classes_interleaved(colours: &[[u8; 3]], classes: &[u16], out: &mut [u8]) {
    for (to, &class) in out.chunks_exact_mut(3).zip(classes) {
        to.copy_from_slice(&colours[usize::from(class)]);
    }
}

/// The colour of each class, as three planes.
pub(super) fn classes_planes(colours: &[[u8; 3]], classes: &[u16], out: &mut [u8]) {
    for (i, plane) in out.chunks_exact_mut(classes.len()).enumerate() {
        plane.iter_mut().zip(classes).for_each(|(to, &class)| *to = colours[usize::from(class)][i]);
    }
}
