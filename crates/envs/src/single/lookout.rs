//! What learners see of a world beside its picture, in bytes.

use crate::interface::insight::{CELLS, GRID, Insight, THINGS, thing_group};
use hasard_engine::render::{Label, Renderer, class};
use hasard_engine::world::{Actor, World};

/// Distance at which a thing is half as near as one that is touched, map units.
const HALF_NEAR: u64 = 64;

/// The ends of a map, between which places are given.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Ends {
    /// From and to: west to east, south to north, lowest floor to highest ceiling.
    axes: [[i32; 2]; 3],
}

impl Ends {
    pub fn of(world: &World) -> Ends {
        let map = &world.map;
        let range = |values: &mut dyn Iterator<Item = i32>| {
            let [low, high] = values.fold([i32::MAX, i32::MIN], |[low, high], value| {
                [low.min(value >> 16), high.max(value >> 16)]
            });
            [low.min(high), high]
        };
        let heights = map.sectors.iter().flat_map(|sector| [sector.floor.0, sector.ceiling.0]);
        let axes = [
            range(&mut map.vertices.iter().map(|vertex| vertex.x.0)),
            range(&mut map.vertices.iter().map(|vertex| vertex.y.0)),
            range(&mut { heights }),
        ];
        Ends { axes }
    }

    /// A place along an axis, 0 at one end and 255 at the other.
    fn byte(&self, axis: usize, at: i32) -> u8 {
        let [from, to] = self.axes[axis].map(i64::from);
        let length = (to - from).max(1);
        (((i64::from(at >> 16) - from) * 255 + length / 2) / length).clamp(0, 255) as u8
    }
}

/// What a renderer has drawn, and the width of its frames.
#[derive(Clone, Copy)]
pub(crate) struct Seen<'a> {
    pub renderer: &'a Renderer,
    pub width: usize,
}

/// Writes a row of what is asked for. The renderer has just drawn the world, with depth and labels
/// where they are asked for.
pub(crate) fn write(what: Insight, world: &World, ends: &Ends, view: Seen<'_>, row: &mut [u8]) {
    let [state, in_view, depth, labels] = what.places();
    if what.state {
        row[state].copy_from_slice(&self_of(world, ends));
    }
    if what.depth {
        mean_depth(view, &mut row[depth]);
    }
    if what.in_view || what.labels {
        let counts = things(view);
        if what.in_view {
            things_in_view(world, view.renderer, &counts, &mut row[in_view]);
        }
        if what.labels {
            for (out, cell) in row[labels].iter_mut().zip(&counts) {
                // The first of equals: the order of groups decides.
                let most = (1..=THINGS).rev().max_by_key(|&group| cell[group]).unwrap_or(0);
                *out = if cell[most] > 0 { most as u8 } else { 0 };
            }
        }
    }
}

/// Whether a row of this needs depth or labels drawn.
pub(crate) const fn needs(what: Insight) -> [bool; 2] {
    [what.depth, what.in_view || what.labels]
}

fn body(world: &World) -> Option<&Actor> {
    world.get(world.players[0].actor)
}

fn self_of(world: &World, ends: &Ends) -> [u8; 8] {
    let player = &world.players[0];
    let Some(body) = body(world) else { return [0; 8] };
    let rounds = player.weapon.map_or(0, |weapon| player.ammo[weapon.ammo_type()]);
    let byte = |value: i32| value.clamp(0, 255) as u8;
    let (vx, vy) = (i64::from(body.vx.0), i64::from(body.vy.0));
    let speed = ((vx * vx + vy * vy) as u64).isqrt() >> 14;
    [
        byte(body.health),
        byte(rounds),
        ends.byte(0, body.x.0),
        ends.byte(1, body.y.0),
        ends.byte(2, body.z.0),
        (body.angle.0 >> 24) as u8,
        speed.min(255) as u8,
        byte(128 + (body.vz.0 >> 15)),
    ]
}

/// The cell of each column of a picture, or of each row.
fn cell(at: usize, length: usize, cells: usize) -> usize {
    at * cells / length
}

fn mean_depth(view: Seen<'_>, out: &mut [u8]) {
    let (width, depth) = (view.width, view.renderer.depth());
    let height = depth.len() / width;
    let (mut sums, mut counts) = ([0u32; CELLS], [0u32; CELLS]);
    for (y, row) in depth.chunks_exact(width).enumerate() {
        let first = cell(y, height, GRID[0]) * GRID[1];
        for column in 0..GRID[1] {
            let end = |column: usize| (column * width).div_ceil(GRID[1]);
            let part = &row[end(column)..end(column + 1)];
            sums[first + column] += part.iter().map(|&depth| u32::from(depth)).sum::<u32>();
            counts[first + column] += part.len() as u32;
        }
    }
    for ((out, sum), count) in out.iter_mut().zip(sums).zip(counts) {
        *out = (sum / count.max(1)) as u8;
    }
}

/// Pixels of each group of things in each cell.
fn things(view: Seen<'_>) -> [[u32; THINGS + 1]; CELLS] {
    let (width, classes) = (view.width, view.renderer.classes());
    let height = classes.len() / width;
    let groups: Vec<u8> =
        view.renderer.labels().iter().map(|label| thing_group(label.kind)).collect();
    let mut counts = [[0; THINGS + 1]; CELLS];
    if groups.is_empty() {
        return counts;
    }
    for (y, row) in classes.chunks_exact(width).enumerate() {
        let first = cell(y, height, GRID[0]) * GRID[1];
        for (x, &class) in row.iter().enumerate().filter(|(_, class)| **class >= class::FIRST_ACTOR)
        {
            if let Some(&group) = groups.get(usize::from(class - class::FIRST_ACTOR)) {
                counts[first + cell(x, width, GRID[1])][usize::from(group)] += 1;
            }
        }
    }
    counts
}

/// Of each group the square root of its share of the picture, and how near the nearest is of which
/// a pixel was drawn.
fn things_in_view(
    world: &World,
    renderer: &Renderer,
    counts: &[[u32; THINGS + 1]; CELLS],
    out: &mut [u8],
) {
    let mut nearest = [None; THINGS + 1];
    if let Some(body) = body(world) {
        for label in renderer.labels() {
            let distance = distance(world, body, label);
            let own: &mut Option<u64> = &mut nearest[usize::from(thing_group(label.kind))];
            *own = (*own).into_iter().chain(distance).min();
        }
    }
    let pixels = renderer.classes().len().max(1) as u64;
    for (group, out) in (1..).zip(out.chunks_exact_mut(2)) {
        let shown: u64 = counts.iter().map(|cell| u64::from(cell[group])).sum();
        out[0] = (255 * 255 * shown / pixels).isqrt() as u8;
        let near = |distance: u64| (255 * HALF_NEAR / (HALF_NEAR + distance)) as u8;
        out[1] = if shown > 0 { nearest[group].map_or(0, near) } else { 0 };
    }
}

fn distance(world: &World, body: &Actor, label: &Label) -> Option<u64> {
    let thing = world.get(label.actor)?;
    let [dx, dy] = [(thing.x.0, body.x.0), (thing.y.0, body.y.0)]
        .map(|(a, b)| (i64::from(a >> 16) - i64::from(b >> 16)).unsigned_abs());
    Some((dx * dx + dy * dy).isqrt())
}
