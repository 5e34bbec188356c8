//! The top-down map: floors, walls and things from above, north up. For people and as the ground of
//! heat maps.

use crate::map::{Map, SectorId};
use crate::math::Fixed;
use crate::render::scene::prepared::Scene;
use crate::world::{Actor, ActorFlags, ActorKind, World};
use std::sync::Arc;

/// Colour of what lies outside of every sector.
const OUTSIDE: [u8; 3] = [24, 24, 28];
/// Colour of walls.
const WALL: [u8; 3] = [235, 235, 235];
/// Colour of the player.
const PLAYER: [u8; 3] = [60, 150, 255];
/// Pixels that stay free at each edge.
const MARGIN: i64 = 4;
/// Smallest half width of a thing, pixels.
const LEAST_THING: i64 = 2;
/// Smallest half length of a player's and a creature's arrow, pixels, and as a share of the
/// picture's shorter side.
const LEAST_PLAYER: i64 = 5;
/// The same as one part in so many of that side.
const PLAYER_SHARE: i64 = 60;

/// A picture of a map from above at one size: what does not change is worked out once.
#[derive(Clone, Debug)]
pub struct TopDown {
    scene: Arc<Scene>,
    map: Arc<Map>,
    width: usize,
    height: usize,
    /// West, east, south and north end of the picture, 16.16 map units.
    window: [i64; 4],
    /// Sector of each pixel, row by row from the north; `u32::MAX` outside.
    ground: Vec<u32>,
}

impl TopDown {
    /// The whole map in a picture of `width` by `height` pixels (at least 16 by 16), centred, with
    /// square pixels.
    #[must_use]
    pub fn new(map: Arc<Map>, scene: Arc<Scene>, width: usize, height: usize) -> TopDown {
        let mut bounds = [i64::MAX, i64::MIN, i64::MAX, i64::MIN];
        for v in &map.vertices {
            let (x, y) = (i64::from(v.x.0), i64::from(v.y.0));
            bounds = [bounds[0].min(x), bounds[1].max(x), bounds[2].min(y), bounds[3].max(y)];
        }
        TopDown::new_with_margin(map, scene, bounds, [width, height], MARGIN)
    }

    /// The area from west to east and south to north, in map units, in a picture of `width` by
    /// `height` pixels (at least 16 by 16), centred, with square pixels: exactly the area where the
    /// picture has its proportions.
    #[must_use]
    pub fn of_area(
        map: Arc<Map>,
        scene: Arc<Scene>,
        area: [i32; 4],
        width: usize,
        height: usize,
    ) -> TopDown {
        TopDown::new_with_margin(
            map,
            scene,
            area.map(|side| i64::from(side) << 16),
            [width, height],
            0,
        )
    }

    /// An area in 16.16 map units with pixels that stay free at each edge.
    fn new_with_margin(
        map: Arc<Map>,
        scene: Arc<Scene>,
        area: [i64; 4],
        size: [usize; 2],
        margin: i64,
    ) -> TopDown {
        let [width, height] = size.map(|side| side.max(16));
        let [west, east, south, north] = area;
        let inner = [width as i64 - 2 * margin, height as i64 - 2 * margin];
        // Map units a pixel, 16.16, by the tighter side.
        let unit = ((east - west) / inner[0]).max((north - south) / inner[1]).max(1);
        let (middle_x, middle_y) = ((west + east) / 2, (south + north) / 2);
        let (half_x, half_y) = (unit * width as i64 / 2, unit * height as i64 / 2);
        let window = [middle_x - half_x, middle_x + half_x, middle_y - half_y, middle_y + half_y];
        let mut top_down = TopDown { scene, map, width, height, window, ground: Vec::new() };
        top_down.ground = (0..height)
            .flat_map(|row| (0..width).map(move |column| (column, row)))
            .map(|(column, row)| top_down.sector_of_pixel(column, row))
            .collect();
        top_down
    }

    /// The map position of the middle of a pixel.
    #[must_use]
    pub fn position_of(&self, column: usize, row: usize) -> (Fixed, Fixed) {
        let [west, east, south, north] = self.window;
        let x = west + (east - west) * (2 * column as i64 + 1) / (2 * self.width as i64);
        let y = north - (north - south) * (2 * row as i64 + 1) / (2 * self.height as i64);
        (Fixed(x as i32), Fixed(y as i32))
    }

    /// The pixel of a map position; may lie outside of the picture.
    #[must_use]
    pub fn pixel_of(&self, x: Fixed, y: Fixed) -> (i64, i64) {
        let [west, east, south, north] = self.window;
        let column = ((i64::from(x.0) - west) * self.width as i64).div_euclid((east - west).max(1));
        let row =
            ((north - i64::from(y.0)) * self.height as i64).div_euclid((north - south).max(1));
        (column, row)
    }

    fn sector_of_pixel(&self, column: usize, row: usize) -> u32 {
        let (x, y) = self.position_of(column, row);
        let subsector = self.map.subsector_at(x, y);
        let segs = &self.map.segs[subsector.first_seg as usize..][..subsector.seg_count as usize];
        // What lies left of any wall of its subsector is in the void behind it.
        let inside = segs.iter().all(|seg| {
            let (dx, dy) = (i64::from(seg.v2.x.0 - seg.v1.x.0), i64::from(seg.v2.y.0 - seg.v1.y.0));
            let (px, py) =
                (i64::from(x.0) - i64::from(seg.v1.x.0), i64::from(y.0) - i64::from(seg.v1.y.0));
            i128::from(py) * i128::from(dx) <= i128::from(px) * i128::from(dy)
        });
        if inside { subsector.sector.0 } else { u32::MAX }
    }

    /// Draws a world of the map, row by row, red, green and blue of each pixel in turn.
    ///
    /// # Panics
    /// If `out` is not `width * height * 3` long, or the world is of another map.
    pub fn draw(&self, world: &World, out: &mut [u8]) {
        assert_eq!(
            out.len(),
            self.width * self.height * 3,
            "a buffer of height * width * 3 bytes is needed"
        );
        assert_eq!(world.sector_count(), self.map.sectors.len(), "the world is of another map");
        let floors = || world.sectors().map(|sector| i64::from(sector.floor.floor()));
        let range = [floors().min().unwrap_or(0), floors().max().unwrap_or(0)];
        let colours: Vec<[u8; 3]> = (0..world.sector_count())
            .map(|sector| self.floor_colour(world, sector, range))
            .collect();
        for (pixel, &sector) in out.chunks_exact_mut(3).zip(&self.ground) {
            pixel.copy_from_slice(colours.get(sector as usize).unwrap_or(&OUTSIDE));
        }
        let mut canvas = Canvas { width: self.width as i64, height: self.height as i64, out };
        for line in &self.map.lines {
            let ends = [self.pixel_of(line.v1.x, line.v1.y), self.pixel_of(line.v2.x, line.v2.y)];
            match line.back_sector {
                None => canvas.line(ends, WALL),
                Some(back) => {
                    let floor = |sector: SectorId| world.sector(sector).floor;
                    if floor(back) != floor(line.front_sector) || line.flags.blocking {
                        let colour = colours[line.front_sector.0 as usize];
                        canvas.line(ends, colour.map(|channel| channel / 2 + 70));
                    }
                }
            }
        }
        let bodies = |actor: &Actor| actor.player_index().is_some();
        for wants_body in [false, true] {
            for (_, actor) in world.living().filter(|(_, actor)| bodies(actor) == wants_body) {
                self.thing(&mut canvas, world, actor);
            }
        }
    }

    /// A floor's colour: the mean of its texture, lighter the higher it lies among the others.
    fn floor_colour(&self, world: &World, sector: usize, [lowest, highest]: [i64; 2]) -> [u8; 3] {
        let state = world.sector(SectorId(sector as u32));
        // Maps of gentle slopes keep their colours, in deep ones the whole range is used.
        let above_middle = i64::from(state.floor.floor()) - (lowest + highest) / 2;
        let step = above_middle * 400 / ((highest - lowest) / 2).max(400);
        let mean = self.scene.mean_colour(state.floor_texture);
        mean.map(|channel| (i64::from(channel) * (600 + step) / 600).clamp(0, 255) as u8)
    }

    fn thing(&self, canvas: &mut Canvas, world: &World, actor: &Actor) {
        let shown = actor.picture(world.tic);
        if shown.sprite == u8::MAX || actor.kind == ActorKind::PatrolPoint {
            return;
        }
        let (column, row) = self.pixel_of(actor.x, actor.y);
        let unit = ((self.window[1] - self.window[0]) / self.width as i64).max(1);
        let half = i64::from(actor.radius.0) / unit;
        let arrow = actor.flags.any(ActorFlags::MONSTER) || actor.player_index().is_some();
        let colour = match actor.player_index() {
            Some(_) => PLAYER,
            None => self.scene.sprite_colour(shown.sprite, shown.frame),
        };
        if !arrow {
            let half = half.max(LEAST_THING);
            canvas.rectangle(column - half, row - half, column + half, row + half, colour);
            return;
        }
        let half = half.max(LEAST_PLAYER).max(self.width.min(self.height) as i64 / PLAYER_SHARE);
        // Tip and both tails, in units of half.
        let (cos, sin) = (i64::from(actor.angle.cos().0), i64::from(actor.angle.sin().0));
        let corner = |along: i64, aside: i64| {
            let dx = (along * cos - aside * sin) * half / 4;
            let dy = (along * sin + aside * cos) * half / 4;
            (column + (dx >> 16), row - (dy >> 16))
        };
        canvas.triangle([corner(6, 0), corner(-4, 4), corner(-4, -4)], colour);
    }
}

/// The picture being drawn.
struct Canvas<'a> {
    width: i64,
    height: i64,
    out: &'a mut [u8],
}

impl Canvas<'_> {
    fn set(&mut self, column: i64, row: i64, colour: [u8; 3]) {
        if (0..self.width).contains(&column) && (0..self.height).contains(&row) {
            let at = ((row * self.width + column) * 3) as usize;
            self.out[at..at + 3].copy_from_slice(&colour);
        }
    }

    fn line(&mut self, [from, to]: [(i64, i64); 2], colour: [u8; 3]) {
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        // Lines that leave the picture by far would take for ever.
        let steps = dx.abs().max(dy.abs()).clamp(1, 1 << 16);
        for step in 0..=steps {
            self.set(from.0 + dx * step / steps, from.1 + dy * step / steps, colour);
        }
    }

    /// A filled box with a dark rim.
    fn rectangle(&mut self, left: i64, top: i64, right: i64, bottom: i64, colour: [u8; 3]) {
        for row in top..=bottom {
            for column in left..=right {
                let rim = row == top || row == bottom || column == left || column == right;
                self.set(column, row, if rim { colour.map(|channel| channel / 3) } else { colour });
            }
        }
    }

    fn triangle(&mut self, corners: [(i64, i64); 3], colour: [u8; 3]) {
        let [a, b, c] = corners;
        let edge = |p: (i64, i64), q: (i64, i64), at: (i64, i64)| {
            (q.0 - p.0) * (at.1 - p.1) - (q.1 - p.1) * (at.0 - p.0)
        };
        let turn = edge(a, b, c).signum();
        for row in a.1.min(b.1).min(c.1)..=a.1.max(b.1).max(c.1) {
            for column in a.0.min(b.0).min(c.0)..=a.0.max(b.0).max(c.0) {
                let at = (column, row);
                let sides = [edge(a, b, at) * turn, edge(b, c, at) * turn, edge(c, a, at) * turn];
                if sides.iter().all(|&side| side >= 0) {
                    self.set(column, row, colour);
                }
            }
        }
        for pair in [[a, b], [b, c], [c, a]] {
            self.line(pair, colour.map(|channel| channel / 3));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assets::Assets;
    use crate::map::{MapBuilder, Style};
    use crate::math::Angle;

    fn room() -> (TopDown, World) {
        let style = Style {
            floor: 0,
            ceiling: 128,
            light: 200,
            floor_texture: "LAVA1",
            ceiling_texture: "FLAT5_5",
            wall: "A-BROK28",
            step: "A-BROK28",
            lintel: "A-BROK28",
            special: 0,
            tag: 0,
        };
        let mut builder = MapBuilder::new();
        builder.rectangle(style, -300, 0, 500, 400);
        builder.rectangle(
            Style { floor: 16, floor_texture: "FLOOR0_5", ..style },
            100,
            100,
            300,
            300,
        );
        let map = Arc::new(Map::build(&builder.finish().unwrap(), "room", &[]).unwrap());
        let mut world = World::new(map.clone(), 1);
        world.add_player(Fixed::from_int(-200), Fixed::from_int(50), Angle::EAST);
        (TopDown::new(map.clone(), Arc::new(Scene::new(&map, Assets::embedded())), 200, 160), world)
    }

    #[test]
    fn pixels_and_positions_are_inverse() {
        let (top_down, _) = room();
        for (column, row) in [(0, 0), (199, 159), (100, 80), (37, 121)] {
            let (x, y) = top_down.position_of(column, row);
            assert_eq!(top_down.pixel_of(x, y), (column as i64, row as i64));
        }
        let (west, north) = (
            top_down.pixel_of(Fixed::from_int(-300), Fixed::ZERO).0,
            top_down.pixel_of(Fixed::ZERO, Fixed::from_int(400)).1,
        );
        assert!(west >= 0 && north >= 0, "the whole map is in the picture");
    }

    #[test]
    fn floors_walls_and_players_show() {
        let (top_down, world) = room();
        let mut picture = vec![0; 200 * 160 * 3];
        top_down.draw(&world, &mut picture);
        let at = |x: i32, y: i32| {
            let (column, row) = top_down.pixel_of(Fixed::from_int(x), Fixed::from_int(y));
            let at = (row as usize * 200 + column as usize) * 3;
            [picture[at], picture[at + 1], picture[at + 2]]
        };
        assert_eq!(picture[..3], OUTSIDE);
        assert_eq!([at(-300, 200), at(200, 0)], [WALL, WALL]);
        assert_eq!(at(-200, 50), PLAYER);
        let (lava, slab) = (at(0, 200), at(200, 200));
        assert!(lava[0] > 2 * lava[2] && lava != slab, "lava is red: {lava:?}, slab {slab:?}");
    }
}
