//! Lines as they lie before the eye. ViZDoom turns the ends of a line into view and keeps 4096ths
//! of a unit of them; distances along its wall and the texels that it shows follow from the ends so
//! cut, not from the line on the map.

use crate::render::scene::prepared::Sidedef;
use crate::render::view::camera::Camera;
use crate::render::view::line::{INVERSE_BITS, ProjectedLine, TextureLine};
use crate::render::view::tables::COLUMN_RAY_BITS;
use crate::render::view::tables::View;

/// Fractional bits of turned points.
pub(crate) const VIEW_BITS: u32 = 12;
/// `1 / number` is an [`Inverse`]'s digits by two to the power of this and its shift.
const DIGIT_BITS: i32 = 95;

/// How far a point is to the right of the eye, and how far ahead.
pub(crate) type Turned = [i64; 2];

/// The ends of a line that sidedefs the eye, from left to right as seen from its side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ViewLine(pub [Turned; 2]);

impl Camera {
    /// A point of the map, 16.16, turned; the rest of its [`VIEW_BITS`] is cut.
    #[inline]
    pub fn turned(&self, [x, y]: [i32; 2]) -> Turned {
        let (dx, dy) = (i64::from(x) - self.x, i64::from(y) - self.y);
        let (cos, sin) = (self.forward[0], self.forward[1]);
        [dx * sin - dy * cos, dx * cos + dy * sin].map(|part| part >> (32 - VIEW_BITS))
    }
}

impl ViewLine {
    /// The line of a side.
    #[inline]
    pub fn of_sidedef(camera: &Camera, face: &Sidedef) -> ViewLine {
        ViewLine(face.ends.map(|end| camera.turned(end)))
    }

    /// How far away its plane is in each column: where the ray `(r, 1)` meets the line from `p` to
    /// `p + d`, `(r * d.ahead - d.right) / (p.ahead * d.right - p.right * d.ahead)` is the inverse
    /// of the distance.
    #[inline]
    pub fn seen(&self, view: &View) -> ProjectedLine {
        let [[right, ahead], end] = self.0;
        let along = [end[0] - right, end[1] - ahead];
        // Nearer than 1/256 unit counts as that far.
        let least = (along[0].abs() + along[1].abs()).max(1) << (VIEW_BITS - 8);
        let Inverse { digits, shift } = Inverse::of((end[0] * ahead - right * end[1]).max(least));
        let scaled =
            |part: i64| shifted(part, shift + DIGIT_BITS - (INVERSE_BITS + VIEW_BITS) as i32);
        // The outermost ray is `(-1, 1)`.
        let step =
            (i128::from(-along[1] * digits) * i128::from(view.column_ray)) >> COLUMN_RAY_BITS;
        ProjectedLine {
            inverse: scaled((along[0] + along[1]) * digits),
            inverse_step: scaled(step as i64),
        }
    }

    /// The texture positions of the side whose line it is, of which a seg is seen in base columns:
    /// where a ray `(r, 1)` of some length ends, the line has run for `((r, 1) * length - p) . d /
    /// (d . d)` of itself.
    pub fn texture(&self, view: &View, face: &Sidedef, base_ends: [i64; 2]) -> TextureLine {
        let [start, end] = self.0;
        let along = [end[0] - start[0], end[1] - start[1]];
        let Inverse { digits, shift } =
            Inverse::of((along[0] * along[0] + along[1] * along[1]).max(1));
        let texels = i128::from(digits * face.texels);
        let scaled = |part: i64, bits: u32| {
            shifted_wide(i128::from(part) * texels, shift + DIGIT_BITS - bits as i32)
        };
        // What a unit to the right and a unit ahead gain.
        let [right, ahead] = along.map(|part| scaled(part, TextureLine::GAIN_BITS + VIEW_BITS));
        let before = -(start[0] * along[0] + start[1] * along[1]);
        let step = (i128::from(right) * i128::from(view.column_ray)) >> COLUMN_RAY_BITS;
        // To the nearest 65536th of a texel: what begins right between two columns begins there. Of
        // a line of next to no length the numbers do not fit and wrap; what is shown is held within
        // the line's texels.
        let along = scaled(before, TextureLine::ALONG_BITS);
        TextureLine {
            along: along.wrapping_add(1 << (TextureLine::ALONG_BITS - 17)),
            gain: ahead.wrapping_sub(right).wrapping_add(1 << (TextureLine::GAIN_BITS - 29)),
            gain_step: step as i64,
            least: self.least_position(face, base_ends),
            last: face.last_position(),
            offset: face.u_offset,
        }
    }

    /// The first position that is shown. The left edge of a line's first column may lie before the
    /// line: it shows the line's first texel. In the first column of the screen it shows the texel
    /// that would be there, or, of a seg that ends in that column too, the line's last one.
    fn least_position(&self, face: &Sidedef, base_ends: [i64; 2]) -> i64 {
        let [right, ahead] = self.0[0];
        match base_ends {
            [0, 1] if ahead + right > 0 => face.last_position(),
            [0, _] => i64::MIN,
            _ => 0,
        }
    }
}

/// `1 / number` to 31 bits: `digits / 2^(DIGIT_BITS + shift)`.
struct Inverse {
    digits: i64,
    shift: i32,
}

impl Inverse {
    /// Of a positive number.
    #[inline]
    fn of(number: i64) -> Inverse {
        let zeros = number.leading_zeros();
        let leading = (number as u64) << zeros >> 32;
        Inverse { digits: ((1u64 << 63) / leading) as i64, shift: -(zeros as i32) }
    }
}

/// `number / 2^shift`, rounded down.
#[inline]
fn shifted(number: i64, shift: i32) -> i64 {
    if shift >= 0 { number >> shift } else { number << -shift }
}

/// [`shifted`], of numbers that become small enough by it.
#[inline]
fn shifted_wide(number: i128, shift: i32) -> i64 {
    (if shift >= 0 { number >> shift } else { number << -shift }) as i64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rng;
    use crate::render::view::size::FrameSize;

    /// A face of a line with these ends, 16.16, that is as many texels long.
    fn face(ends: [[i32; 2]; 2], texels: i64) -> Sidedef {
        Sidedef { ends, texels, ..Sidedef::bare() }
    }

    #[test]
    fn distances_and_texels_are_those_of_the_line_between_the_cut_ends() {
        let mut rng = Rng::new(31);
        let mut compared = 0;
        for round in 0..3_000 {
            let size =
                [FrameSize::LEARNER, FrameSize::CLASSIC, FrameSize { width: 640, height: 480 }]
                    [round % 3];
            let view = View::new(size).unwrap();
            let width = i64::from(view.base_width);
            let mut place = |reach: i32| [0, 1].map(|_| rng.between(-reach << 16, reach << 16));
            let ends = [place(3000), place(3000)];
            let [x, y] = place(3000).map(i64::from);
            let angle = crate::math::Angle(rng.next_u64() as u32);
            let forward = [i64::from(angle.cos().0), i64::from(angle.sin().0)];
            let camera = Camera { x, y, forward, ..Camera::default() };
            let [dx, dy] = [0, 1].map(|i| f64::from(ends[1][i] - ends[0][i]) / 65536.0);
            let texels = dx.hypot(dy).round().max(1.0) as i64;
            let face = face(ends, texels);
            let turned = ViewLine::of_sidedef(&camera, &face);
            let [[x1, y1], [x2, y2]] = turned.0.map(|point| point.map(|part| part as f64 / 4096.0));
            let (seen, texture) = (turned.seen(&view), turned.texture(&view, &face, [1, 160]));
            // Where the ray (r, 1) * distance meets p + s (q - p), by Cramer's rule; from one unit
            // to the side of the eye on, and in front.
            for column in (0..width).step_by(7) {
                let r = 2.0 * column as f64 / width as f64 - 1.0;
                let determinant = r * (y2 - y1) - (x2 - x1);
                let (distance, s) =
                    ((x1 * (y2 - y1) - y1 * (x2 - x1)) / determinant, (x1 - r * y1) / determinant);
                let length = (x2 - x1).hypot(y2 - y1);
                let facing = x2 * y1 - x1 * y2 > length;
                if !facing || !(1.0..8000.0).contains(&distance) || !(0.0..1.0).contains(&s) {
                    continue;
                }
                let own = seen.distance_at(column);
                assert!(
                    (own as f64 / 65536.0 - distance).abs() < 2e-5 + distance * 1e-6,
                    "{own} for {distance}"
                );
                let u = texture.at(column, own) as f64 / 65536.0;
                assert!((u - s * texels as f64).abs() < 0.01, "{u} for {}", s * texels as f64);
                compared += 1;
            }
        }
        assert!(compared > 10_000, "{compared}");
    }

    #[test]
    fn a_texel_that_begins_right_at_a_column_is_shown_there() {
        // A wall 64 units long across the view, its middle straight ahead, at any distance: its
        // 33rd texel begins where the second half of the view does.
        let view = View::new(FrameSize::CLASSIC).unwrap();
        let angle = crate::math::Angle::EAST;
        let forward = [i64::from(angle.cos().0), i64::from(angle.sin().0)];
        let camera = Camera { forward, ..Camera::default() };
        for distance in 20..2000 {
            let x = distance << 16;
            let face = face([[x, 32 << 16], [x, -32 << 16]], 64);
            let turned = ViewLine::of_sidedef(&camera, &face);
            let texel =
                turned.texture(&view, &face, [1, 160]).at(80, turned.seen(&view).distance_at(80))
                    >> 16;
            assert_eq!(texel, 32, "{distance} units away");
        }
    }

    #[test]
    fn only_in_the_first_column_a_line_is_shown_from_before_its_start() {
        let view = View::new(FrameSize::CLASSIC).unwrap();
        // It begins a little to the right of the view's left edge, along which lines go away.
        let turned = ViewLine([[-100 << 12, 101 << 12], [-95 << 12, 113 << 12]]);
        let face = face([[0; 2]; 2], 13);
        let shown = |base_ends: [i64; 2]| {
            let texture = turned.texture(&view, &face, base_ends);
            texture.at(base_ends[0], turned.seen(&view).distance_at(base_ends[0])) >> 16
        };
        // From the edge's column to where it is seen: half a column, nearly a unit.
        assert_eq!(shown([0, 7]), -1);
        // Where all of the seg lies in that column it is the last texel, as measured.
        assert_eq!(shown([0, 1]), 12);
        // A line that comes from beside the view has no such column.
        let beside = ViewLine([[-100 << 12, 50 << 12], [-95 << 12, 113 << 12]]);
        let position =
            beside.texture(&view, &face, [0, 1]).at(0, beside.seen(&view).distance_at(0)) >> 16;
        assert!((1..12).contains(&position), "{position}");
        assert_eq!(
            [turned.least_position(&face, [1, 7]), beside.least_position(&face, [0, 1])],
            [0, i64::MIN]
        );
    }
}
