//! A tileable surface with relief: colours plus heights, lit from the upper left when it is
//! finished.

use super::canvas::Canvas;
use super::colour::Colour;
use super::noise::{Field, unit};

/// A wall or floor being made: a colour and a height (in texels) at every point, wrapped around at
/// its edges.
pub(super) struct Surface {
    pub(super) width: usize,
    pub(super) height: usize,
    colours: Vec<Colour>,
    relief: Field,
}

impl Surface {
    /// A surface whose points `make` colours and raises.
    pub(super) fn new(
        width: usize,
        height: usize,
        mut make: impl FnMut(i32, i32) -> (Colour, f32),
    ) -> Surface {
        let mut colours = Vec::with_capacity(width * height);
        let mut relief = Field::constant(width, height, 0.0);
        for y in 0..height {
            for x in 0..width {
                let (colour, raise) = make(x as i32, y as i32);
                colours.push(colour);
                relief.values[y * width + x] = raise;
            }
        }
        Surface { width, height, colours, relief }
    }

    fn index(&self, x: i32, y: i32) -> usize {
        y.rem_euclid(self.height as i32) as usize * self.width
            + x.rem_euclid(self.width as i32) as usize
    }

    /// The colour at a point, wrapped.
    pub(super) fn colour(&self, x: i32, y: i32) -> Colour {
        self.colours[self.index(x, y)]
    }

    /// The height at a point, wrapped.
    pub(super) fn relief(&self, x: i32, y: i32) -> f32 {
        self.relief.at(x, y)
    }

    /// Replaces colour and height of a point, wrapped.
    pub(super) fn set(&mut self, x: i32, y: i32, colour: Colour, raise: f32) {
        let index = self.index(x, y);
        self.colours[index] = colour;
        self.relief.values[index] = raise;
    }

    /// Changes every point of a rectangle (wrapped) to what `make` turns its colour and height
    /// into.
    pub(super) fn area(
        &mut self,
        x: i32,
        y: i32,
        width: i32,
        height: i32,
        mut make: impl FnMut(i32, i32, Colour, f32) -> (Colour, f32),
    ) {
        for at_y in y..y + height {
            for at_x in x..x + width {
                let (colour, raise) =
                    make(at_x - x, at_y - y, self.colour(at_x, at_y), self.relief(at_x, at_y));
                self.set(at_x, at_y, colour, raise);
            }
        }
    }

    /// A raised round rivet or knob.
    pub(super) fn rivet(&mut self, x: i32, y: i32, radius: f32, colour: Colour) {
        let reach = radius as i32 + 1;
        for dy in -reach..=reach {
            for dx in -reach..=reach {
                let distance = ((dx * dx + dy * dy) as f32).sqrt() / (radius + 0.3);
                if distance <= 1.0 {
                    let base = self.relief(x + dx, y + dy);
                    self.set(
                        x + dx,
                        y + dy,
                        colour,
                        base + (1.0 - distance * distance).sqrt() * radius,
                    );
                }
            }
        }
    }

    /// Lights the relief and returns the colours: slopes that face the upper left brighten, hollows
    /// darken. `strength` is the change of brightness for a slope of one texel in one; `grain` is
    /// the spread of a random speckle.
    pub(super) fn lit(mut self, strength: f32, grain: f32, seed: u32) -> Surface {
        let (width, height) = (self.width as i32, self.height as i32);
        let mut lit = Vec::with_capacity(self.colours.len());
        for y in 0..height {
            for x in 0..width {
                let h = |dx, dy| self.relief.at(x + dx, y + dy);
                let (here, left, right, up, down) = (h(0, 0), h(-1, 0), h(1, 0), h(0, -1), h(0, 1));
                let slope = (right - left) * 0.5 + (down - up) * 0.62;
                let hollow = ((left + right + up + down) * 0.25 - here).clamp(-0.5, 1.0);
                let light = (1.0 + strength * slope - strength * 0.5 * hollow).clamp(0.25, 1.9);
                let speckle = 1.0 + grain * (unit(x, y, seed) - 0.5);
                lit.push(self.colours[self.index(x, y)] * (light * speckle));
            }
        }
        self.colours = lit;
        self
    }

    /// Scales the channels so that the mean colour becomes `mean`; what the benchmark's tables ask
    /// of a texture.
    pub(super) fn with_mean(mut self, mean: Colour) -> Surface {
        // Bright points are cut off at 255, so a few rounds are needed.
        for _ in 0..3 {
            let mut sum = [0.0f64; 3];
            for colour in &self.colours {
                for (total, channel) in sum.iter_mut().zip([colour.0, colour.1, colour.2]) {
                    *total += f64::from(channel.clamp(0.0, 255.0));
                }
            }
            let count = self.colours.len() as f64;
            let scale = |target: f32, total: f64| {
                (f64::from(target) / (total / count).max(0.5)).clamp(0.1, 10.0) as f32
            };
            let factors = (scale(mean.0, sum[0]), scale(mean.1, sum[1]), scale(mean.2, sum[2]));
            for colour in &mut self.colours {
                *colour = Colour(colour.0 * factors.0, colour.1 * factors.1, colour.2 * factors.2);
            }
        }
        self
    }

    /// The colours as an opaque canvas.
    pub(super) fn canvas(&self) -> Canvas {
        let mut canvas = Canvas::new(self.width as i32, self.height as i32);
        for y in 0..self.height {
            for x in 0..self.width {
                canvas.set(x as i32, y as i32, self.colours[y * self.width + x]);
            }
        }
        canvas
    }
}
