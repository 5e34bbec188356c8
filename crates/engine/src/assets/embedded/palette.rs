//! The project's own 256 colours: ramps from dark to light, one for each family of material, and
//! the maps derived from them.

use super::colour::Colour;

/// A ramp: how many palette entries it takes and the colours that it passes through, evenly spaced.
type Ramp = (usize, &'static [[u8; 3]]);

/// The ramps in palette order. The world is mostly earth, stone and metal under dim light, so those
/// families are the long ones and every ramp starts near black: a light table can then darken a
/// colour without changing its hue.
const RAMPS: [Ramp; 19] = [
    // Neutral grey, dense in the dark half.
    (
        30,
        &[[0, 0, 0], [37, 37, 37], [80, 80, 80], [130, 130, 130], [190, 190, 190], [255, 255, 255]],
    ),
    // Warm stone.
    (14, &[[16, 14, 12], [70, 62, 54], [132, 120, 106], [200, 188, 170]]),
    // Weathered stone, slightly green.
    (8, &[[14, 16, 12], [66, 72, 60], [140, 146, 126]]),
    // Steel, slightly blue.
    (12, &[[14, 16, 20], [58, 66, 76], [118, 128, 140], [196, 206, 216]]),
    // Brown earth and leather.
    (24, &[[12, 7, 3], [50, 32, 16], [92, 62, 34], [142, 100, 60], [204, 162, 112]]),
    // Sand and plaster.
    (14, &[[30, 23, 16], [92, 73, 56], [150, 124, 98], [226, 204, 170]]),
    // Rust.
    (12, &[[26, 12, 5], [84, 44, 20], [138, 76, 34], [196, 122, 62]]),
    // Red, from dried blood to a highlight.
    (18, &[[14, 0, 0], [84, 4, 4], [160, 10, 8], [232, 26, 20], [255, 120, 100]]),
    // Fire.
    (
        20,
        &[[34, 6, 0], [110, 26, 2], [186, 62, 4], [246, 128, 16], [255, 200, 60], [255, 250, 190]],
    ),
    // Gold and hazard yellow.
    (10, &[[40, 30, 4], [122, 96, 14], [206, 170, 36], [255, 240, 110]]),
    // Olive drab.
    (12, &[[16, 16, 6], [58, 56, 26], [106, 100, 54], [170, 162, 104]]),
    // Moss and leaves.
    (14, &[[8, 14, 6], [40, 56, 28], [72, 92, 48], [120, 140, 80]]),
    // Acid green.
    (14, &[[2, 18, 2], [14, 70, 10], [40, 150, 26], [110, 235, 70], [200, 255, 170]]),
    // Cyan.
    (6, &[[4, 30, 34], [22, 110, 116], [130, 236, 232]]),
    // Blue.
    (14, &[[0, 0, 18], [8, 8, 84], [26, 30, 156], [70, 96, 250], [172, 200, 255]]),
    // Skin.
    (12, &[[38, 18, 10], [112, 66, 44], [186, 124, 88], [246, 200, 160]]),
    // Raw meat, pink.
    (12, &[[30, 8, 8], [112, 46, 42], [190, 96, 88], [250, 178, 166]]),
    // Purple.
    (8, &[[18, 8, 26], [74, 26, 110], [150, 48, 212], [226, 150, 255]]),
    // Leaden sky.
    (2, &[[150, 156, 168], [178, 184, 194]]),
];

const fn total() -> usize {
    let (mut n, mut i) = (0, 0);
    while i < RAMPS.len() {
        n += RAMPS[i].0;
        i += 1;
    }
    n
}
const _: () = assert!(total() == 256, "the ramps must fill the palette exactly");

/// The 256 colours.
pub(super) fn colours() -> [[u8; 3]; 256] {
    let mut out = [[0; 3]; 256];
    let mut at = 0;
    for (count, stops) in RAMPS {
        for i in 0..count {
            let position = i * (stops.len() - 1) * 256 / (count - 1).max(1);
            let (segment, part) = ((position / 256).min(stops.len() - 2), position);
            let part = (part - segment * 256) as i32;
            for channel in 0..3 {
                let (a, b) =
                    (i32::from(stops[segment][channel]), i32::from(stops[segment + 1][channel]));
                out[at][channel] = (a + (b - a) * part / 256) as u8;
            }
            at += 1;
        }
    }
    out
}

/// The palette split by channel, for a search that the compiler can do several entries at a time.
struct Channels([[i32; 256]; 3]);

impl Channels {
    fn new(palette: &[[u8; 3]; 256]) -> Channels {
        Channels(std::array::from_fn(|channel| {
            std::array::from_fn(|index| i32::from(palette[index][channel]))
        }))
    }

    /// The entry nearest to a colour, the first of equals; the eye's sensitivity weighs the
    /// channels.
    fn nearest(&self, colour: [i32; 3]) -> u8 {
        let mut least = i32::MAX;
        for index in 0..256 {
            let [r, g, b] = [0, 1, 2].map(|channel| colour[channel] - self.0[channel][index]);
            // The largest distance is 650250, which leaves room for the index in the low byte.
            least = least.min((3 * r * r + 5 * g * g + 2 * b * b) << 8 | index as i32);
        }
        least as u8
    }
}

/// The 32 light tables: table `i` maps every colour to the nearest one of `(32 - i) / 32` of its
/// brightness.
pub(super) fn light_tables(palette: &[[u8; 3]; 256]) -> Box<[[u8; 256]; 32]> {
    let channels = Channels::new(palette);
    let mut tables = Box::new([[0; 256]; 32]);
    for (level, table) in tables.iter_mut().enumerate() {
        let factor = 32 - level as i32;
        for (index, entry) in table.iter_mut().enumerate() {
            // Table 0 must be the identity even where two ramps share a colour.
            *entry = if level == 0 {
                index as u8
            } else {
                channels
                    .nearest(palette[index].map(|channel| (i32::from(channel) * factor + 16) / 32))
            };
        }
    }
    tables
}

/// Steps of each channel in the look-up cube of [`Quantiser`].
const STEPS: usize = 32;

/// Turns true colours into palette entries by look-up, finer in the dark where the eye and the
/// light tables need it.
pub(super) struct Quantiser {
    step_of_level: [u8; 256],
    cube: Vec<u8>,
}

impl Quantiser {
    /// The look-up cube of a palette.
    pub(super) fn new(palette: &[[u8; 3]; 256]) -> Quantiser {
        // Steps of 4 below 64, of 8 below 128, of 16 above: 16 + 8 + 8 = 32 steps.
        let mut step_of_level = [0; 256];
        let mut centre = [0; STEPS];
        for (level, step_of_level) in step_of_level.iter_mut().enumerate() {
            let (step, middle) = match level {
                0..64 => (level / 4, level / 4 * 4 + 2),
                64..128 => (16 + (level - 64) / 8, level / 8 * 8 + 4),
                _ => (24 + (level - 128) / 16, level / 16 * 16 + 8),
            };
            *step_of_level = step as u8;
            centre[step] = middle as i32;
        }
        centre[0] = 0;
        centre[STEPS - 1] = 250;
        let channels = Channels::new(palette);
        let mut cube = Vec::with_capacity(STEPS * STEPS * STEPS);
        for red in centre {
            for green in centre {
                for blue in centre {
                    cube.push(channels.nearest([red, green, blue]));
                }
            }
        }
        Quantiser { step_of_level, cube }
    }

    /// The palette entry for a colour.
    pub(super) fn index(&self, colour: Colour) -> u8 {
        let [r, g, b] = colour.bytes().map(|channel| self.step_of_level[channel as usize] as usize);
        self.cube[(r * STEPS + g) * STEPS + b]
    }
}
