//! A picture being painted: true colours with a mask, and the primitives that sprites and panels
//! are drawn from.

use super::colour::Colour;
use super::palette::Quantiser;
use crate::assets::Image;

/// A picture in true colour; column-major like [`Image`].
#[derive(Clone)]
pub(super) struct Canvas {
    pub(super) width: i32,
    pub(super) height: i32,
    colours: Vec<Colour>,
    opaque: Vec<bool>,
}

impl Canvas {
    /// An empty (wholly transparent) canvas.
    pub(super) fn new(width: i32, height: i32) -> Canvas {
        let size = (width * height) as usize;
        Canvas { width, height, colours: vec![Colour::BLACK; size], opaque: vec![false; size] }
    }

    fn index(&self, x: i32, y: i32) -> Option<usize> {
        (x >= 0 && y >= 0 && x < self.width && y < self.height)
            .then(|| (x * self.height + y) as usize)
    }

    /// The colour at a point, where there is one.
    pub(super) fn get(&self, x: i32, y: i32) -> Option<Colour> {
        self.index(x, y).filter(|&i| self.opaque[i]).map(|i| self.colours[i])
    }

    /// Paints a point; outside the canvas nothing happens.
    pub(super) fn set(&mut self, x: i32, y: i32, colour: Colour) {
        if let Some(i) = self.index(x, y) {
            self.colours[i] = colour;
            self.opaque[i] = true;
        }
    }

    /// Makes a point transparent.
    pub(super) fn clear(&mut self, x: i32, y: i32) {
        if let Some(i) = self.index(x, y) {
            self.opaque[i] = false;
        }
    }

    /// Replaces every opaque point by what `paint` makes of it.
    pub(super) fn each(&mut self, mut paint: impl FnMut(i32, i32, Colour) -> Colour) {
        for x in 0..self.width {
            for y in 0..self.height {
                let i = (x * self.height + y) as usize;
                if self.opaque[i] {
                    self.colours[i] = paint(x, y, self.colours[i]);
                }
            }
        }
    }

    /// Fills a rectangle.
    pub(super) fn rect(&mut self, x: i32, y: i32, width: i32, height: i32, colour: Colour) {
        for at_x in x..x + width {
            for at_y in y..y + height {
                self.set(at_x, at_y, colour);
            }
        }
    }

    /// A rectangle with a light upper left and a dark lower right edge, sunk when `raise` is
    /// negative.
    pub(super) fn bevel(
        &mut self,
        x: i32,
        y: i32,
        width: i32,
        height: i32,
        colour: Colour,
        raise: f32,
    ) {
        self.rect(x, y, width, height, colour);
        let (light, dark) = (colour * (1.0 + raise), colour * (1.0 - raise));
        self.rect(x, y, width, 1, light);
        self.rect(x, y, 1, height, light);
        self.rect(x, y + height - 1, width, 1, dark);
        self.rect(x + width - 1, y, 1, height, dark);
    }

    /// Fills an ellipse given its centre and radii; `paint` gets the position inside it, each
    /// from -1 to 1.
    pub(super) fn ellipse(
        &mut self,
        centre: (f32, f32),
        radii: (f32, f32),
        mut paint: impl FnMut(f32, f32) -> Colour,
    ) {
        for x in (centre.0 - radii.0) as i32 - 1..=(centre.0 + radii.0) as i32 + 1 {
            for y in (centre.1 - radii.1) as i32 - 1..=(centre.1 + radii.1) as i32 + 1 {
                let (u, v) =
                    ((x as f32 + 0.5 - centre.0) / radii.0, (y as f32 + 0.5 - centre.1) / radii.1);
                if u * u + v * v <= 1.0 {
                    self.set(x, y, paint(u, v));
                }
            }
        }
    }

    /// A shaded ball or egg of one colour, lit from the upper left.
    pub(super) fn ball(&mut self, centre: (f32, f32), radii: (f32, f32), colour: Colour) {
        self.ellipse(centre, radii, |u, v| colour * ball_light(u, v));
    }

    /// A one-texel line.
    pub(super) fn line(&mut self, from: (f32, f32), to: (f32, f32), colour: Colour) {
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let steps = dx.abs().max(dy.abs()).max(1.0) as i32;
        for i in 0..=steps {
            let part = i as f32 / steps as f32;
            self.set((from.0 + dx * part) as i32, (from.1 + dy * part) as i32, colour);
        }
    }

    /// Fills a polygon (even-odd); `paint` gets the texel.
    pub(super) fn polygon(
        &mut self,
        points: &[(f32, f32)],
        mut paint: impl FnMut(i32, i32) -> Colour,
    ) {
        for y in 0..self.height {
            let row = y as f32 + 0.5;
            for x in 0..self.width {
                let column = x as f32 + 0.5;
                let mut inside = false;
                for (i, a) in points.iter().enumerate() {
                    let b = points[(i + 1) % points.len()];
                    if (a.1 > row) != (b.1 > row)
                        && column < a.0 + (row - a.1) / (b.1 - a.1) * (b.0 - a.0)
                    {
                        inside = !inside;
                    }
                }
                if inside {
                    self.set(x, y, paint(x, y));
                }
            }
        }
    }

    /// Darkens the rim: an opaque point beside a transparent one (or the canvas edge) keeps `keep`
    /// of its brightness.
    pub(super) fn outline(&mut self, keep: f32) {
        let before = self.clone();
        let empty = |x, y| before.get(x, y).is_none();
        self.each(|x, y, colour| {
            let rim = empty(x - 1, y) || empty(x + 1, y) || empty(x, y - 1) || empty(x, y + 1);
            if rim { colour * keep } else { colour }
        });
    }

    /// The finished picture; it keeps a mask only where some point is transparent.
    pub(super) fn image(&self, quantiser: &Quantiser, offset_x: i32, offset_y: i32) -> Image {
        let pixels = self.colours.iter().map(|&colour| quantiser.index(colour)).collect();
        let mask = self
            .opaque
            .iter()
            .any(|opaque| !opaque)
            .then(|| self.opaque.iter().map(|&o| u8::from(o)).collect());
        Image {
            width: self.width as u16,
            height: self.height as u16,
            offset_x: offset_x as i16,
            offset_y: offset_y as i16,
            pixels,
            mask,
        }
    }
}

/// Brightness of a ball at a point of its disc: lit from the upper left, with a small highlight.
pub(super) fn ball_light(u: f32, v: f32) -> f32 {
    let depth = (1.0 - u * u - v * v).max(0.0).sqrt();
    let light = (-0.5 * u - 0.6 * v + 0.62 * depth).max(0.0);
    let gloss = ((light - 0.86) * 6.0).max(0.0);
    0.3 + 0.85 * light + gloss
}
