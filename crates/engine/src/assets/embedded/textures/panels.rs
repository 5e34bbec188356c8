//! Built walls: panels, computers, consoles, doors, house fronts.

use crate::assets::embedded::canvas::Canvas;
use crate::assets::embedded::colour::{Colour, gradient};
use crate::assets::embedded::gallery::Gallery;
use crate::assets::embedded::noise::{Field, hash, unit};
use crate::assets::embedded::surface::Surface;

/// Paints the panels.
pub(super) fn paint(gallery: &mut Gallery) {
    gallery.surface(
        "STARGR2",
        &wall_panels(Colour::hex(0x5C5C5C), 64, 701).with_mean(Colour(84.0, 84.0, 83.0)),
    );
    gallery.surface(
        "GRAY4",
        &wall_panels(Colour::hex(0x686868), 32, 706).with_mean(Colour(98.0, 98.0, 98.0)),
    );
    gallery.surface(
        "SILVER3",
        &wall_panels(Colour::hex(0x8C9098), 128, 711).with_mean(Colour(116.0, 120.0, 126.0)),
    );
    gallery.surface(
        "REDWALL1",
        &wall_panels(Colour::hex(0xA01010), 64, 716).with_mean(Colour(193.0, 4.0, 4.0)),
    );
    gallery.texture("COMPUTE2", &computers(721));
    for (name, kind, seed) in [("CONS1_1", 0, 731), ("CONS1_5", 1, 736), ("CONS1_7", 2, 741)] {
        gallery.texture(name, &console(kind, seed));
    }
    gallery.texture("COMPOHSO", &circuitry(751));
    gallery.texture("MODWALL3", &modular_wall(Colour::hex(0x5C7058), 761));
    gallery.texture("MODWALL4", &shutters(771));
    gallery.texture("CITY06", &house_front(781));
    gallery.texture("SW2PSKUL", &skull_switch(791));
    gallery.texture("DUMMY3", &hazard_panel(Colour::hex(0xC8A020), 801));
    gallery.texture("PDUMMY", &hazard_panel(Colour::hex(0xB048A0), 811));
}

/// Plain panels with bevelled edges and a faint brushed grain; 128 square.
fn wall_panels(colour: Colour, width: i32, seed: u32) -> Surface {
    let brush = Field::clouds(128, 128, (24, 3), 3, seed);
    let stain = Field::clouds(128, 128, (4, 4), 4, seed + 1);
    let mut surface = Surface::new(128, 128, |x, y| {
        let (u, v) = (x % width, y % 64);
        let edge = u.min(width - 1 - u).min(v.min(63 - v)) as f32;
        let streak = if v < 24 { 0.1 * (brush.at(x, y / 3) - 0.5) } else { 0.0 };
        let tone = 0.88 + 0.18 * brush.at(x, y) + 0.28 * (stain.at(x, y) - 0.5) + streak;
        (
            colour * if edge < 1.0 { 0.5 } else { tone },
            (edge / 2.5).min(1.0) * 1.6 - if edge > 5.0 { 0.5 } else { 0.0 },
        )
    });
    for x in (0..128).step_by(width as usize) {
        for y in [8, 55, 72, 119] {
            surface.rivet(x + 3, y, 1.0, colour * 1.2);
            surface.rivet(x + width - 4, y, 1.0, colour * 1.2);
        }
    }
    surface.lit(0.36, 0.08, seed + 2)
}

/// A dark plate to build machines on.
fn dark_plate(size: (usize, usize), tone: f32, seed: u32) -> Canvas {
    let grime = Field::clouds(size.0, size.1, (6, 6), 4, seed);
    let surface = Surface::new(size.0, size.1, |x, y| {
        let level = tone * (0.75 + 0.5 * grime.at(x, y));
        (Colour(level, level * 1.01, level * 1.03), grime.at(x, y))
    });
    surface.lit(0.3, 0.1, seed + 1).canvas()
}

/// Racks of dark machines with rows of small lights.
fn computers(seed: u32) -> Canvas {
    let mut c = dark_plate((128, 128), 26.0, seed);
    for column in 0..4 {
        let x = column * 32;
        c.rect(x, 0, 1, 128, Colour::grey(8.0));
        c.rect(x + 1, 0, 1, 128, Colour::grey(52.0));
        for row in 0..5 {
            let y = row * 26 - 2;
            let kind = hash(column, row, seed) % 4;
            c.bevel(x + 3, y + 3, 27, 22, Colour::grey(30.0), 0.55);
            match kind {
                0 => {
                    // Drives: slots with a lamp each.
                    for slot in 0..4 {
                        c.bevel(x + 6, y + 6 + 4 * slot, 16, 3, Colour::grey(16.0), -0.6);
                        let lamp = if unit(column * 5 + slot, row, seed) > 0.5 {
                            0x40D040
                        } else {
                            0xC03018
                        };
                        c.rect(x + 25, y + 6 + 4 * slot, 2, 2, Colour::hex(lamp));
                    }
                }
                1 => {
                    // A field of lights.
                    for dot in 0..40 {
                        let (dx, dy) = (dot % 8, dot / 8);
                        let level = unit(dot, column * 7 + row, seed + 3);
                        let lamp = if level > 0.8 {
                            0xF0A020
                        } else if level > 0.62 {
                            0x30A8D8
                        } else {
                            0x202428
                        };
                        c.rect(x + 6 + 3 * dx, y + 7 + 3 * dy, 2, 1, Colour::hex(lamp));
                    }
                }
                2 => {
                    // A dim screen with traces.
                    c.bevel(x + 6, y + 6, 21, 15, Colour::hex(0x081810), -0.6);
                    for dx in 0..19 {
                        let wave = (unit((dx + column * 3) / 2, row, seed + 4) * 9.0) as i32;
                        c.rect(x + 7 + dx, y + 9 + wave, 1, 1, Colour::hex(0x38B058));
                    }
                }
                _ => {
                    // Cooling slits.
                    for slit in 0..6 {
                        c.rect(x + 6, y + 6 + 3 * slit, 21, 1, Colour::grey(9.0));
                        c.rect(x + 6, y + 7 + 3 * slit, 21, 1, Colour::grey(46.0));
                    }
                }
            }
        }
    }
    c
}

/// A grey wall with a control desk: screens above, switches below. Three kinds.
fn console(kind: u32, seed: u32) -> Canvas {
    let mut c = dark_plate((128, 128), 78.0, seed);
    for x in [0, 64] {
        c.bevel(x, 0, 64, 128, Colour::grey(80.0), 0.25);
        let tone = Field::clouds(64, 64, (5, 5), 3, seed + 5);
        c.each(|at_x, at_y, colour| colour * (0.94 + 0.12 * tone.at(at_x, at_y)));
        let screens: &[(i32, i32, i32, i32, u32)] = match kind {
            0 => &[(8, 12, 48, 34, 0x103020)],
            1 => &[(6, 10, 24, 20, 0x301008), (34, 10, 24, 20, 0x102038)],
            _ => &[(8, 8, 20, 44, 0x201030), (34, 8, 22, 20, 0x103020), (34, 32, 22, 20, 0x302808)],
        };
        for &(left, top, width, height, colour) in screens {
            c.bevel(x + left - 2, top - 2, width + 4, height + 4, Colour::grey(40.0), -0.6);
            let dark = Colour::hex(colour);
            c.rect(x + left, top, width, height, dark);
            for line in 0..height / 4 {
                let length = (unit(line, left + x, seed) * (width - 4) as f32) as i32 + 2;
                c.rect(
                    x + left + 1,
                    top + 2 + line * 4,
                    length.min(width - 2),
                    1,
                    dark.mix(Colour::hex(0xFFFFFF), 0.45) * 1.4,
                );
            }
        }
        c.bevel(x + 4, 60, 56, 26, Colour::grey(52.0), 0.4);
        for button in 0..24 {
            let (dx, dy) = (button % 8, button / 8);
            let lamp = [0xD03020, 0x30C040, 0xE0C030, 0x4060E0, 0x606468]
                [(hash(button, x, seed) % 5) as usize];
            c.bevel(x + 8 + dx * 6, 64 + dy * 7, 4, 4, Colour::hex(lamp), 0.4);
        }
        c.bevel(x + 4, 90, 56, 34, Colour::grey(66.0), 0.3);
        for slit in 0..7 {
            c.rect(x + 10, 95 + slit * 4, 44, 1, Colour::grey(20.0));
        }
    }
    c
}

/// Purple boards with bright tracks.
fn circuitry(seed: u32) -> Canvas {
    let mut c = Canvas::new(64, 64);
    c.rect(0, 0, 64, 64, Colour::hex(0x1C142A));
    for track in 0..14 {
        let colour = [0x50388C, 0x6C54B0, 0x3C2C60][track as usize % 3];
        let (x, y) = ((hash(track, 1, seed) % 64) as i32, (hash(track, 2, seed) % 64) as i32);
        let length = 10 + (hash(track, 3, seed) % 30) as i32;
        for step in 0..length {
            // Down, then across.
            let (at_x, at_y) = if step < length / 2 {
                (x, y + step)
            } else {
                (x + step - length / 2, y + length / 2)
            };
            c.set(at_x % 64, at_y % 64, Colour::hex(colour));
        }
        c.bevel(x.min(60), y.min(60), 4, 4, Colour::hex(0x7C6CA8), 0.4);
    }
    for chip in 0..5 {
        let (x, y) = ((hash(chip, 5, seed) % 48) as i32, (hash(chip, 6, seed) % 50) as i32);
        c.bevel(x, y, 14, 10, Colour::hex(0x16121C), 0.6);
        c.rect(x + 2, y + 2, 2, 2, Colour::hex(0xE04890));
        c.rect(x + 6, y + 4, 6, 1, Colour::hex(0x8878B0));
    }
    c
}

/// Painted prefabricated wall with pipes.
fn modular_wall(colour: Colour, seed: u32) -> Canvas {
    let stain = Field::clouds(128, 128, (5, 5), 4, seed);
    let drip = Field::clouds(128, 128, (32, 3), 3, seed + 1);
    let surface = Surface::new(128, 128, |x, y| {
        let v = y % 64;
        let pipe = (v as f32 - 52.0).abs();
        let u = x % 32;
        let edge = u.min(31 - u) as f32;
        let worn = (0.8 + 0.3 * stain.at(x, y)) * (1.0 - 0.25 * (drip.at(x, y) - 0.4).max(0.0));
        if pipe < 5.0 {
            (Colour::hex(0x707068) * worn, (25.0 - pipe * pipe).sqrt() + 1.0)
        } else {
            (colour * if edge < 1.0 { worn * 0.6 } else { worn }, (edge / 2.0).min(1.0) * 1.2)
        }
    });
    surface.lit(0.3, 0.1, seed + 2).canvas()
}

/// Corrugated steel shutters in a frame.
fn shutters(seed: u32) -> Canvas {
    let rust = Field::clouds(128, 128, (5, 5), 5, seed);
    let surface = Surface::new(128, 128, |x, y| {
        let u = x % 64;
        let edge = u.min(63 - u) as f32;
        let slat = (y % 8) as f32;
        let steel = Colour::hex(0x64686C) * (0.8 + 0.4 * rust.at(x, y));
        let colour = steel
            .mix(Colour::hex(0x6C4424), ((rust.at(x + 31, y + 77) - 0.6) * 4.0).clamp(0.0, 0.7));
        if edge < 6.0 || y < 8 {
            (colour * 0.85, 4.0 + (edge.min(6.0 - edge) / 2.0).clamp(0.0, 1.0))
        } else {
            (colour * if slat < 1.0 { 0.5 } else { 1.0 }, slat * 0.45)
        }
    });
    let mut canvas = surface.lit(0.34, 0.1, seed + 1).canvas();
    for x in [0, 64] {
        canvas.bevel(x + 26, 112, 12, 5, Colour::hex(0x3C4044), 0.5);
        canvas.rect(x + 29, 114, 6, 1, Colour::grey(12.0));
    }
    canvas
}

/// A house front: plaster, a row of windows, a sill.
fn house_front(seed: u32) -> Canvas {
    let stain = Field::clouds(128, 128, (5, 5), 5, seed);
    let drip = Field::clouds(128, 128, (20, 3), 3, seed + 1);
    let surface = Surface::new(128, 128, |x, y| {
        let plaster =
            Colour::hex(0x7C7870) * (0.75 + 0.35 * stain.at(x, y) - 0.2 * (drip.at(x, y) - 0.5));
        let band = (y / 6) % 10 == 0;
        (
            plaster * if band { 0.8 } else { 1.0 },
            stain.at(x, y) * 1.4 + if band { 1.5 } else { 0.0 },
        )
    });
    let mut c = surface.lit(0.34, 0.14, seed + 2).canvas();
    for (x, lit) in [(10, false), (74, true)] {
        for y in [14, 74] {
            c.bevel(x, y, 44, 40, Colour::hex(0x4C4840), 0.4);
            c.bevel(x + 3, y + 3, 38, 34, Colour::hex(0x14181C), -0.7);
            for (dx, dy) in (0..36).flat_map(|dx| (0..32).map(move |dy| (dx, dy))) {
                let glass = if lit && y == 14 {
                    gradient(&[Colour::hex(0xD8B060), Colour::hex(0x8C6428)], dy as f32 / 32.0)
                } else {
                    gradient(
                        &[Colour::hex(0x303C48), Colour::hex(0x101418)],
                        (dx + dy) as f32 / 68.0,
                    )
                };
                c.set(x + 4 + dx, y + 4 + dy, glass);
            }
            c.rect(x + 21, y + 3, 2, 34, Colour::hex(0x58544C));
            c.rect(x + 3, y + 18, 38, 2, Colour::hex(0x58544C));
            c.bevel(x - 2, y + 40, 48, 4, Colour::hex(0x807C74), 0.4);
        }
    }
    c
}

/// A stone panel with a carved skull whose eyes glow.
fn skull_switch(seed: u32) -> Canvas {
    let mut c = dark_plate((64, 64), 84.0, seed);
    c.bevel(4, 4, 56, 56, Colour::hex(0x584C40), 0.4);
    c.bevel(8, 8, 48, 48, Colour::hex(0x3C342C), -0.5);
    c.ball((32.0, 27.0), (15.0, 14.0), Colour::hex(0xC8BCA0));
    c.bevel(24, 36, 16, 12, Colour::hex(0xB0A488), 0.3);
    for x in [25, 34] {
        c.rect(x, 25, 6, 6, Colour::hex(0x180804));
        c.rect(x + 2, 27, 2, 2, Colour::hex(0xFF4010));
    }
    c.rect(31, 33, 2, 3, Colour::hex(0x281810));
    for x in (25..40).step_by(3) {
        c.rect(x, 40, 1, 7, Colour::hex(0x504838));
    }
    c
}

/// A panel with slanting warning stripes.
fn hazard_panel(colour: Colour, seed: u32) -> Canvas {
    let wear = Field::clouds(64, 64, (5, 5), 4, seed);
    let surface = Surface::new(64, 64, |x, y| {
        let edge = x.min(63 - x).min(y.min(63 - y)) as f32;
        let stripe = (x + y) / 8 % 2 == 0;
        let paint = if stripe { colour } else { Colour::hex(0x1C1C20) };
        (paint * (0.7 + 0.5 * wear.at(x, y)), (edge / 2.0).min(1.0) * 1.6 + wear.at(x, y))
    });
    surface.lit(0.36, 0.1, seed + 1).canvas()
}
