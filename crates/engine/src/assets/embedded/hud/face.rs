//! The player's face: more battered from band to band, glancing about, wincing, grinning, dead.

use crate::assets::embedded::canvas::Canvas;
use crate::assets::embedded::colour::{Colour, gradient};
use crate::assets::embedded::gallery::Gallery;

/// What the face is doing.
#[derive(Clone, Copy, PartialEq)]
enum Mood {
    /// Looking right (0), ahead (1) or left (2) as the viewer sees the digits of `STFST`.
    Glance(i32),
    /// A heavy blow: wide eyes, open mouth.
    Ouch,
    /// A new weapon: a broad grin.
    Grin,
    /// Shooting without pause: clenched teeth.
    Rage,
    /// Eyes closed for good.
    Dead,
}

/// Paints every face: five bands of health, 0 the healthiest.
pub(super) fn paint(gallery: &mut Gallery) {
    for band in 0..5 {
        for glance in 0..3 {
            gallery.graphic(
                &format!("STFST{band}{glance}"),
                &face(band, Mood::Glance(glance)),
                -5,
                -2,
            );
        }
        gallery.graphic(&format!("STFOUCH{band}"), &face(band, Mood::Ouch), -5, -2);
        gallery.graphic(&format!("STFEVL{band}"), &face(band, Mood::Grin), -5, -2);
        gallery.graphic(&format!("STFKILL{band}"), &face(band, Mood::Rage), -5, -2);
    }
    gallery.graphic("STFDEAD0", &face(5, Mood::Dead), -5, -2);
}

fn skin(light: f32, pale: f32) -> Colour {
    let stops = [
        Colour::hex(0x3A1C10),
        Colour::hex(0x8A5436),
        Colour::hex(0xC48A62),
        Colour::hex(0xF4C8A0),
    ];
    gradient(&stops, light).mix(Colour::hex(0x8C8478) * (0.4 + light), pale)
}

/// A 24 by 29 face.
fn face(band: i32, mood: Mood) -> Canvas {
    let mut c = Canvas::new(24, 29);
    let dead = mood == Mood::Dead;
    let pale = if dead { 0.5 } else { band as f32 * 0.06 };
    let light_at = |u: f32, v: f32| 0.68 - 0.3 * u * u - 0.16 * u - 0.14 * v;
    // Neck, ears, skull and jaw.
    c.rect(6, 24, 12, 5, skin(0.28, pale));
    for (x, shade) in [(2, 0.5), (21, 0.34)] {
        c.ellipse((x as f32 + 0.5, 14.5), (1.9, 3.4), |_, v| skin(shade - 0.1 * v, pale));
    }
    c.ellipse((12.0, 12.0), (9.4, 11.4), |u, v| skin(light_at(u, v), pale));
    c.polygon(
        &[(2.9, 13.0), (21.1, 13.0), (20.2, 21.0), (16.6, 27.8), (7.4, 27.8), (3.8, 21.0)],
        |x, y| skin(light_at((x as f32 - 11.5) / 9.6, (y as f32 - 13.0) / 13.0), pale),
    );
    // Stubble.
    for (x, y) in (4..20).flat_map(|x| (21..27).map(move |y| (x, y))) {
        if (x + y) % 2 == 0
            && let Some(colour) = c.get(x, y)
        {
            c.set(x, y, colour * 0.86);
        }
    }
    // Short hair with a jagged line.
    let hair = |x: i32, y: i32| {
        let strand = if (x * 5 + y * 3) % 4 == 0 { 1.35 } else { 1.0 };
        gradient(&[Colour::hex(0x5C3A1C), Colour::hex(0x2A180A)], (x as f32 + y as f32) / 26.0)
            * strand
    };
    let hairline = [10, 9, 7, 5, 5, 4, 5, 4, 4, 5, 4, 5, 4, 5, 5, 7, 9, 10];
    for (i, &bottom) in hairline.iter().enumerate() {
        let x = i as i32 + 3;
        // Twice the distance from the middle, squared.
        let top = ((2 * x - 23) * (2 * x - 23)) / 92;
        for y in top..=bottom {
            c.set(x, y, hair(x, y));
        }
        if i == 0 || i == hairline.len() - 1 {
            c.rect(x, bottom, 1, 4, hair(x, bottom));
        }
    }
    features(&mut c, mood, pale);
    blood(&mut c, band);
    c.outline(0.62);
    c
}

fn features(c: &mut Canvas, mood: Mood, pale: f32) {
    let dark = Colour::hex(0x24120A);
    // Sockets and brows: the brows fall towards the nose in anger.
    for (left, side) in [(5, 1), (15, -1)] {
        c.rect(left, 11, 4, 1, skin(0.30, pale));
        c.rect(left, 12, 4, 2, skin(0.36, pale));
        let (inner, outer) = if side == 1 { (left + 3, left) } else { (left, left + 3) };
        let drop = match mood {
            Mood::Rage | Mood::Grin => 1,
            Mood::Ouch | Mood::Dead => -1,
            Mood::Glance(_) => 0,
        };
        c.line((outer as f32, 10.0), (inner as f32, 10.0 + drop as f32), dark);
        c.line((outer as f32, 9.0), (inner as f32, 9.0 + drop as f32), Colour::hex(0x321C0C));
    }
    // Eyes.
    for left in [5, 15] {
        match mood {
            Mood::Dead => c.rect(left, 13, 4, 1, dark),
            Mood::Ouch => {
                c.rect(left, 11, 4, 3, Colour::hex(0xF4F0E8));
                c.rect(left + 1, 12, 2, 1, Colour::hex(0x203858));
            }
            _ => {
                c.rect(left, 12, 4, 2, Colour::hex(0xE8E4DC));
                let pupil = match mood {
                    Mood::Glance(glance) => left + 2 - glance,
                    _ => left + 1,
                };
                c.rect(pupil.max(left), 12, 2, 2, Colour::hex(0x284878));
                c.set(pupil.max(left), 12, Colour::hex(0x101820));
                c.rect(left, 11, 4, 1, dark);
            }
        }
    }
    // Cheekbones and chin.
    for x in [5, 17] {
        c.rect(x, 16, 2, 1, skin(0.78, pale));
        c.rect(x, 18, 1, 3, skin(0.36, pale));
    }
    c.rect(10, 26, 4, 1, skin(0.66, pale));
    // Nose.
    c.rect(11, 12, 2, 6, skin(0.74, pale));
    c.rect(13, 13, 1, 5, skin(0.36, pale));
    c.rect(10, 17, 1, 2, skin(0.5, pale));
    c.rect(10, 18, 4, 1, skin(0.26, pale));
    // Mouth.
    let lip = Colour::hex(0x783428);
    match mood {
        Mood::Grin => {
            c.rect(7, 21, 10, 3, Colour::hex(0xF4F0E4));
            c.rect(7, 20, 10, 1, lip);
            c.rect(8, 24, 8, 1, lip);
            c.set(6, 20, lip);
            c.set(17, 20, lip);
            for x in [9, 11, 13, 15] {
                c.rect(x, 21, 1, 3, Colour::hex(0xB8B0A4));
            }
        }
        Mood::Rage => {
            c.rect(8, 21, 8, 3, Colour::hex(0xE0DCD0));
            c.rect(8, 22, 8, 1, Colour::hex(0x5C5048));
            c.rect(8, 20, 8, 1, lip);
            c.rect(8, 24, 8, 1, lip);
        }
        Mood::Ouch => c.ellipse((12.0, 23.0), (3.0, 2.8), |_, v| {
            if v < -0.5 { Colour::hex(0xE8E0D4) } else { Colour::hex(0x30100C) }
        }),
        Mood::Dead => c.rect(9, 22, 6, 2, Colour::hex(0x30140E)),
        Mood::Glance(_) => {
            c.rect(9, 22, 6, 1, lip * 0.7);
            c.rect(9, 23, 6, 1, skin(0.62, pale).mix(lip, 0.4));
            c.rect(10, 24, 4, 1, skin(0.3, pale));
        }
    }
}

/// Wounds: each band adds to those of the band before.
fn blood(c: &mut Canvas, band: i32) {
    let trails: [&[(i32, i32, i32)]; 5] = [
        &[(15, 6, 4)],
        &[(13, 18, 4), (12, 19, 2)],
        &[(7, 5, 9), (8, 6, 4), (16, 7, 3)],
        &[(17, 14, 8), (6, 15, 6), (10, 23, 4)],
        &[(9, 5, 6), (14, 23, 5), (18, 11, 9), (5, 12, 8), (12, 4, 5)],
    ];
    for trail in trails.iter().take(band as usize) {
        for &(x, y, length) in trail.iter() {
            for i in 0..length {
                let colour =
                    if i == length - 1 { Colour::hex(0xD01810) } else { Colour::hex(0x980C08) };
                if c.get(x, y + i).is_some() {
                    c.set(x, y + i, colour);
                }
            }
            if c.get(x + 1, y).is_some() {
                c.set(x + 1, y, Colour::hex(0x700806));
            }
        }
    }
}
