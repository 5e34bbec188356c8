//! A palette in the forms that it is looked up in, and questions about its colours.

/// Weight of red, green and blue in luminance, in 256ths.
const LUMINANCE: [u32; 3] = [77, 150, 29];

/// The luminance of a colour.
pub(crate) fn luminance(colour: [u8; 3]) -> u8 {
    let sum: u32 =
        colour.iter().zip(LUMINANCE).map(|(&channel, weight)| u32::from(channel) * weight).sum();
    (sum >> 8) as u8
}

/// A table of colours, in the forms that the ways of looking up want.
#[derive(Clone, Debug)]
pub(crate) struct Colours {
    pub palette: [[u8; 3]; 256],
    /// A table of each channel.
    pub channels: [[u8; 256]; 3],
    /// Red, green and blue from the lowest byte on.
    pub words: [u32; 256],
}

impl Colours {
    pub fn new(palette: [[u8; 3]; 256]) -> Colours {
        let channels = std::array::from_fn(|channel| std::array::from_fn(|i| palette[i][channel]));
        let words = palette.map(|[red, green, blue]| u32::from_le_bytes([red, green, blue, 0]));
        Colours { palette, channels, words }
    }
}

/// The palette index nearest to a colour.
pub(crate) fn nearest_colour(palette: &[[u8; 3]; 256], colour: [u8; 3]) -> u8 {
    let distance = |candidate: &[u8; 3]| -> i32 {
        candidate.iter().zip(colour).map(|(&a, b)| (i32::from(a) - i32::from(b)).pow(2)).sum()
    };
    (0..256).min_by_key(|&i| distance(&palette[i])).unwrap_or(0) as u8
}

/// The mean of some palette entries, grey if there are none.
pub(crate) fn mean(palette: &[[u8; 3]; 256], indices: impl Iterator<Item = u8>) -> [u8; 3] {
    let (mut sums, mut count) = ([0u64; 3], 0u64);
    for index in indices {
        let colour = palette[usize::from(index)];
        sums = std::array::from_fn(|i| sums[i] + u64::from(colour[i]));
        count += 1;
    }
    if count == 0 { [128; 3] } else { sums.map(|sum| (sum / count) as u8) }
}

/// Colours of the squares by their [`Shade`](crate::world::Shade): the entries of Freedoom's
/// palette that ViZDoom shows.
pub(crate) const SHADES: [[u8; 3]; 3] = [[171; 3], [87; 3], [255, 255, 0]];
