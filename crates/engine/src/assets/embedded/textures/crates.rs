//! Boxes to stand on and hide behind.

use crate::assets::embedded::canvas::Canvas;
use crate::assets::embedded::colour::Colour;
use crate::assets::embedded::gallery::Gallery;
use crate::assets::embedded::noise::{Field, unit};
use crate::assets::embedded::surface::Surface;

/// Paints the crates.
pub(super) fn paint(gallery: &mut Gallery) {
    gallery.surface("CRATOP2", &planks(64, 601, false).with_mean(Colour(113.0, 90.0, 61.0)));
    gallery.surface("CRATE1", &planks(64, 611, true).with_mean(Colour(113.0, 90.0, 62.0)));
    gallery.texture("CR128LB", &container(621));
}

/// A wooden crate: planks in a nailed frame, with a diagonal brace on its sides.
fn planks(size: usize, seed: u32, braced: bool) -> Surface {
    let grain = Field::clouds(size, size, (3, 20), 4, seed);
    let cross_grain = Field::clouds(size, size, (20, 3), 4, seed + 1);
    let last = size as i32 - 1;
    let mut surface = Surface::new(size, size, |x, y| {
        let edge_x = x.min(last - x);
        let edge_y = y.min(last - y);
        let along_edge = edge_x.min(edge_y);
        let brace = braced && (x - (last - y)).abs() < 6 && along_edge >= 8;
        let wood = Colour::hex(0x8C6C44);
        if along_edge < 8 {
            // The frame: standing posts over lying rails.
            let post = edge_x < 8;
            let level = if post { cross_grain.at(x, y) } else { grain.at(x, y) };
            let inside = if post { edge_x.min(7 - edge_x) } else { edge_y.min(7 - edge_y) };
            (wood * (0.8 + 0.5 * level), 2.6 + (inside as f32 / 1.5).min(1.0) + level * 0.8)
        } else if brace {
            let across = 6 - (x - (last - y)).abs();
            (wood * (0.75 + 0.5 * grain.at(x + y, y - x)), 1.6 + (across as f32 / 2.0).min(1.0))
        } else {
            let (plank, into) = (y / 8, y % 8);
            let gap = into == 0;
            let shade = 0.62 + 0.16 * unit(plank, 0, seed + 2);
            (
                wood * (shade + 0.4 * grain.at(x + plank * 13, y)) * if gap { 0.4 } else { 1.0 },
                if gap { -0.6 } else { 0.4 },
            )
        }
    });
    for near in [4, last - 4] {
        for far in [4, last - 4, last / 2] {
            surface.rivet(near, far, 1.0, Colour::hex(0x403830));
        }
    }
    surface.lit(0.32, 0.12, seed + 3)
}

/// A large painted steel container with a stencilled number.
fn container(seed: u32) -> Canvas {
    let size = 128;
    let rust = Field::clouds(size, size, (5, 5), 5, seed);
    let surface = Surface::new(size, size, |x, y| {
        let edge = x.min(127 - x).min(y.min(127 - y)) as f32;
        let rib = (x % 16 - 8).abs() as f32;
        let raise = if edge < 8.0 {
            3.0 + (edge.min(8.0 - edge) / 2.0).min(1.0)
        } else {
            (rib / 3.0).min(1.0) * 1.6
        };
        let paint = Colour::hex(0x4C5C70) * (0.85 + 0.3 * rust.at(x, y));
        (
            paint.mix(Colour::hex(0x6C4020), ((rust.at(x + 40, y) - 0.62) * 5.0).clamp(0.0, 0.8)),
            raise,
        )
    });
    let mut canvas = surface.lit(0.3, 0.1, seed + 1).canvas();
    for (i, digit) in [0b1110111_u8, 0b1011101, 0b1111111].into_iter().enumerate() {
        let (x, y) = (30 + 24 * i as i32, 48);
        for (segment, (left, top, width, height)) in [
            (2, 0, 12, 3),
            (0, 2, 3, 12),
            (13, 2, 3, 12),
            (2, 14, 12, 3),
            (0, 16, 3, 12),
            (13, 16, 3, 12),
            (2, 28, 12, 3),
        ]
        .into_iter()
        .enumerate()
        {
            if digit >> (6 - segment) & 1 == 1 {
                for (dx, dy) in (0..width).flat_map(|dx| (0..height).map(move |dy| (dx, dy))) {
                    let (at_x, at_y) = (x + left + dx, y + top + dy);
                    if let Some(under) = canvas.get(at_x, at_y) {
                        canvas.set(
                            at_x,
                            at_y,
                            under.mix(Colour::hex(0xD8C88C), 0.55 + 0.4 * rust.at(at_x, at_y)),
                        );
                    }
                }
            }
        }
    }
    canvas
}
