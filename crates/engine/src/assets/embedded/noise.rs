//! Tileable noise: value noise summed over octaves, and cells around scattered points.

/// A well mixed 32-bit hash of a lattice point.
pub(super) const fn hash(x: i32, y: i32, seed: u32) -> u32 {
    let mut h = (x as u32).wrapping_mul(0x9E37_79B1)
        ^ (y as u32).wrapping_mul(0x85EB_CA77)
        ^ seed.wrapping_mul(0xC2B2_AE3D);
    h ^= h >> 15;
    h = h.wrapping_mul(0x2C1B_3C6D);
    h ^= h >> 12;
    h = h.wrapping_mul(0x297A_2D39);
    h ^ h >> 15
}

/// The hash as a number in 0..1.
pub(super) fn unit(x: i32, y: i32, seed: u32) -> f32 {
    (hash(x, y, seed) >> 8) as f32 / 16_777_216.0
}

/// A grid of numbers as large as a texture, that wraps around at its edges. Row after row.
#[derive(Clone)]
pub(super) struct Field {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) values: Vec<f32>,
}

impl Field {
    /// A field with one value everywhere.
    pub(super) fn constant(width: usize, height: usize, value: f32) -> Field {
        Field { width, height, values: vec![value; width * height] }
    }

    /// The value at a point, wrapped around.
    pub(super) fn at(&self, x: i32, y: i32) -> f32 {
        let (x, y) = (x.rem_euclid(self.width as i32), y.rem_euclid(self.height as i32));
        self.values[y as usize * self.width + x as usize]
    }

    /// Cloud-like noise in 0..=1: `octaves` layers, the first with `cells_x` by `cells_y` lattice
    /// cells over the whole field, each further one twice as fine and half as strong. Unequal cells
    /// give grain and streaks.
    pub(super) fn clouds(
        width: usize,
        height: usize,
        cells: (usize, usize),
        octaves: u32,
        seed: u32,
    ) -> Field {
        let mut field = Field::constant(width, height, 0.0);
        let (mut amplitude, mut sum) = (1.0, 0.0);
        for octave in 0..octaves {
            let cells = ((cells.0 << octave).min(width), (cells.1 << octave).min(height));
            field.add_octave(cells, amplitude, seed.wrapping_mul(31).wrapping_add(octave));
            sum += amplitude;
            amplitude *= 0.5;
        }
        // Sums of octaves crowd around the middle; stretch them so that callers can rely on the
        // whole range.
        for value in &mut field.values {
            *value = ((*value / sum - 0.5) * 1.6 + 0.5).clamp(0.0, 1.0);
        }
        field
    }

    fn add_octave(&mut self, (cells_x, cells_y): (usize, usize), amplitude: f32, seed: u32) {
        let columns: Vec<(usize, usize, f32)> =
            (0..self.width).map(|x| lattice(x, self.width, cells_x)).collect();
        let mut upper = vec![0.0; cells_x];
        let mut lower = vec![0.0; cells_x];
        let mut rows_at = usize::MAX;
        for y in 0..self.height {
            let (top, bottom, down) = lattice(y, self.height, cells_y);
            if rows_at != top {
                for x in 0..cells_x {
                    upper[x] = unit(x as i32, top as i32, seed);
                    lower[x] = unit(x as i32, bottom as i32, seed);
                }
                rows_at = top;
            }
            let row = &mut self.values[y * self.width..][..self.width];
            for (value, &(left, right, across)) in row.iter_mut().zip(&columns) {
                let above = upper[left] + (upper[right] - upper[left]) * across;
                let below = lower[left] + (lower[right] - lower[left]) * across;
                *value += amplitude * (above + (below - above) * down);
            }
        }
    }
}

/// The lattice cells left and right of a texel and its smoothed position between them.
fn lattice(at: usize, size: usize, cells: usize) -> (usize, usize, f32) {
    let cell = at * cells / size;
    let part = (at * cells % size) as f32 / size as f32;
    (cell, (cell + 1) % cells, part * part * (3.0 - 2.0 * part))
}

/// Where a point lies among scattered cells.
#[derive(Clone, Copy)]
pub(super) struct CellPoint {
    /// A random number naming the cell.
    pub(super) id: u32,
    /// How far from the border to the next cell, in texels.
    pub(super) border: f32,
    /// How far from the cell's own point, in texels.
    pub(super) centre: f32,
}

/// Irregular cells (cobbles, cracked rock, scales): one jittered point in each square of a grid,
/// wrapped at the edges.
pub(super) struct Cells {
    size: (f32, f32),
    count: (i32, i32),
    points: Vec<(f32, f32, u32)>,
}

impl Cells {
    /// `count` cells across and down a `width` by `height` field; `jitter` 0 gives a grid, 1 the
    /// wildest scatter.
    pub(super) fn new(
        width: usize,
        height: usize,
        count: (usize, usize),
        jitter: f32,
        seed: u32,
    ) -> Cells {
        let size = (width as f32 / count.0 as f32, height as f32 / count.1 as f32);
        let mut points = Vec::with_capacity(count.0 * count.1);
        for row in 0..count.1 as i32 {
            for column in 0..count.0 as i32 {
                let dx = (unit(column, row, seed) - 0.5) * jitter + 0.5;
                let dy = (unit(column, row, seed ^ 0x5555) - 0.5) * jitter + 0.5;
                points.push((
                    (column as f32 + dx) * size.0,
                    (row as f32 + dy) * size.1,
                    hash(column, row, seed.wrapping_add(77)),
                ));
            }
        }
        Cells { size, count: (count.0 as i32, count.1 as i32), points }
    }

    /// Six-sided cells: points on a grid whose odd rows are shifted by half a cell; the number of
    /// rows must be even.
    pub(super) fn honeycomb(
        width: usize,
        height: usize,
        count: (usize, usize),
        seed: u32,
    ) -> Cells {
        let mut cells = Cells::new(width, height, count, 0.0, seed);
        for (i, point) in cells.points.iter_mut().enumerate() {
            let shift = if (i / count.0).is_multiple_of(2) { -0.25 } else { 0.25 };
            point.0 += shift * cells.size.0;
        }
        cells
    }

    /// The cell that holds a point.
    pub(super) fn at(&self, x: f32, y: f32) -> CellPoint {
        let (column, row) = ((x / self.size.0) as i32, (y / self.size.1) as i32);
        let (wrap_x, wrap_y) =
            (self.size.0 * self.count.0 as f32, self.size.1 * self.count.1 as f32);
        let mut nearest = [(f32::MAX, (0.0, 0.0), 0), (f32::MAX, (0.0, 0.0), 0)];
        for r in row - 1..=row + 1 {
            for c in column - 1..=column + 1 {
                let (wc, wr) = (c.rem_euclid(self.count.0), r.rem_euclid(self.count.1));
                let (px, py, id) = self.points[(wr * self.count.0 + wc) as usize];
                let px = px
                    + if c < 0 {
                        -wrap_x
                    } else if c >= self.count.0 {
                        wrap_x
                    } else {
                        0.0
                    };
                let py = py
                    + if r < 0 {
                        -wrap_y
                    } else if r >= self.count.1 {
                        wrap_y
                    } else {
                        0.0
                    };
                let distance = (px - x) * (px - x) + (py - y) * (py - y);
                if distance < nearest[0].0 {
                    nearest[1] = nearest[0];
                    nearest[0] = (distance, (px, py), id);
                } else if distance < nearest[1].0 {
                    nearest[1] = (distance, (px, py), id);
                }
            }
        }
        // Distance to the line halfway between the two nearest points.
        let [(d0, a, id), (d1, b, _)] = nearest;
        let between = ((a.0 - b.0) * (a.0 - b.0) + (a.1 - b.1) * (a.1 - b.1)).sqrt().max(0.001);
        CellPoint { id, border: (d1 - d0) / (2.0 * between), centre: d0.sqrt() }
    }
}
