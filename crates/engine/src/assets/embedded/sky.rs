//! The sky: grey clouds over brown cliffs, all the way around.

use super::canvas::Canvas;
use super::colour::{Colour, gradient};
use super::gallery::Gallery;
use super::noise::{Field, unit};

/// Texels around the horizon: 256 for a quarter turn.
const WIDTH: usize = 1024;
/// Rows from straight up to a little below the horizon.
const HEIGHT: usize = 228;
/// The row of the horizon.
const HORIZON: usize = 200;

/// Paints the sky.
pub(super) fn paint(gallery: &mut Gallery) {
    let sky = sky();
    gallery.graphic("SKY1", &sky, 0, HORIZON as i32);
    gallery.same_graphic("RSKY1", "SKY1");
}

fn sky() -> Canvas {
    let billow = Field::clouds(WIDTH, HEIGHT, (10, 6), 5, 801);
    let streaks = Field::clouds(WIDTH, HEIGHT, (6, 20), 3, 802);
    let ridge_line = Field::clouds(WIDTH, 1, (9, 1), 6, 803);
    let far_line = Field::clouds(WIDTH, 1, (14, 1), 6, 804);
    let rock = Field::clouds(WIDTH, HEIGHT, (64, 12), 4, 805);
    let cloud_tones = [
        Colour::hex(0x3C4048),
        Colour::hex(0x686C74),
        Colour::hex(0x8E929A),
        Colour::hex(0xB4B8BE),
        Colour::hex(0xD8D8D8),
    ];
    let rock_tones = [
        Colour::hex(0x1A120A),
        Colour::hex(0x44321E),
        Colour::hex(0x745838),
        Colour::hex(0x9C7C54),
    ];
    let mut canvas = Canvas::new(WIDTH as i32, HEIGHT as i32);
    for x in 0..WIDTH {
        let ridge = HORIZON as f32 - 6.0 - 74.0 * ridge_line.values[x] * ridge_line.values[x];
        let far = HORIZON as f32 - 16.0 - 44.0 * far_line.values[x];
        for y in 0..HEIGHT {
            let row = y as f32;
            // Clouds crowd together towards the horizon.
            let height = 1.0 - row / HORIZON as f32;
            let (at_x, at_y) = (x as i32, y as i32);
            let cloud = billow.at(at_x, at_y) * (0.55 + 0.35 * height)
                + streaks.at(at_x, at_y) * (0.4 - 0.25 * height);
            let mut colour = gradient(&cloud_tones, cloud * 1.15 - 0.06 + 0.12 * (1.0 - height));
            if row > far {
                let level = rock.at(at_x + 300, at_y) * 0.7 + 0.15;
                colour = gradient(&rock_tones, level).mix(Colour::hex(0x787878), 0.45);
            }
            if row > ridge {
                // Lit from the upper left: a slope of the noise to the right is in the light.
                let slope = rock.at(at_x + 1, at_y + 1) - rock.at(at_x - 1, at_y - 1);
                let depth = ((row - ridge) / 60.0).min(1.0);
                let crest = if row - ridge < 2.0 { 0.2 } else { 0.0 };
                colour = gradient(
                    &rock_tones,
                    0.62 - 0.42 * depth + slope * 2.2 + 0.35 * (rock.at(at_x, at_y) - 0.5) + crest,
                );
            }
            // A little grain breaks the steps of the palette.
            canvas.set(at_x, at_y, colour * (0.97 + 0.06 * unit(at_x, at_y, 806)));
        }
    }
    canvas
}
