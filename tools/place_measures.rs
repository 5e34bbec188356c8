//! What a map is like to be in, for holding our own town and terrain against the published ones:
//! ground by clearance, sight, ways between places, and what fixed policies earn.
//!
//! `cargo run --release -p hasard-envs --example place_measures -- ENV EPISODES [WAD
//! [PICTURE.pgm]]`: with a WAD its map is played in place of ours. The picture has a pixel for
//! every 16 map units: dark where a body cannot stand.

use hasard_engine::map::udmf;
use hasard_engine::math::Fixed;
use hasard_engine::wad::Wad;
use hasard_engine::world::{ActorKind, World};
use hasard_envs::{Env, EnvOptions, Policy, RuleSet, Scenario, rollout};
use std::collections::VecDeque;
use std::error::Error;
use std::sync::Arc;

/// Distance of the points at which the ground is looked at, in map units.
const PITCH: i32 = 16;
/// A body that jumps gets up so far: a peak of 36 and a step of 24.
const CLIMB: i32 = 60;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [id, episodes, files @ ..] = &arguments[..] else {
        return Err("give ENV EPISODES [WAD [PICTURE.pgm]]".into());
    };
    let mut options = EnvOptions { rules: RuleSet::Released, ..EnvOptions::default() };
    if let Some(file) = files.first().filter(|file| *file != "-") {
        let bytes = std::fs::read(file)?;
        options.map = Some(Arc::new(udmf::read(Wad::read(&bytes)?.map_text("MAP01")?)?));
    }
    let mut env = Env::new(id, &options)?;
    env.reset(1);
    let ground = Ground::of(env.world());
    println!("{id} {}", files.first().map_or("our map", String::as_str));
    ground.print();
    if env.id().scenario == Scenario::RemedyRush {
        places(env.world_mut(), &ground);
    }
    if let Some(file) = files.get(1) {
        ground.picture(file)?;
    }
    let policies: &[&str] = if env.id().scenario == Scenario::DetonatorsDilemma {
        &["random", "sticky:10", "hold:ATTACK+TURN_LEFT", "hold:MOVE_FORWARD+ATTACK"]
    } else {
        &[
            "random",
            "sticky:10",
            "hold:MOVE_FORWARD",
            "hold:MOVE_FORWARD+SPEED",
            "hold:MOVE_FORWARD+TURN_LEFT",
        ]
    };
    for policy in policies {
        let policy_at: Policy = policy.parse()?;
        let episodes: u64 = episodes.parse()?;
        let (mut returns, mut costs) = (Mean::default(), Mean::default());
        for seed in 0..episodes {
            let episode = rollout(&mut env, &policy_at, 1000 + seed)?;
            returns.add(episode.episode_return);
            costs.add(episode.cost);
        }
        println!("{policy}: return {}, cost {}", returns.text(), costs.text());
    }
    Ok(())
}

/// Prints where the items of Remedy Rush can appear: 20 units above floor 0 in the rectangle of its
/// supplies.
fn places(world: &mut World, ground: &Ground) {
    let (mut free, mut near, mut tried) = (0u32, 0u32, 0u32);
    for x in (-604..1056).step_by(8) {
        for y in (-220..1312).step_by(8) {
            tried += 1;
            let [fixed_x, fixed_y] = [x, y].map(Fixed::from_int);
            if let Some(item) = world.spawn_checked(
                ActorKind::HealthBonus,
                fixed_x,
                fixed_y,
                Fixed::from_int(20),
                0,
            ) {
                world.remove(item);
                free += 1;
                near += u32::from(ground.is_reached(x, y));
            }
        }
    }
    let share = |part: u32, whole: u32| 100.0 * f64::from(part) / f64::from(whole);
    println!(
        "items: {:.2} % of their rectangle takes them, {:.2} % of that within reach",
        share(free, tried),
        share(near, free)
    );
}

/// A mean with its standard error.
#[derive(Default)]
struct Mean {
    count: f64,
    sum: f64,
    squares: f64,
}

impl Mean {
    fn add(&mut self, value: f64) {
        self.count += 1.0;
        self.sum += value;
        self.squares += value * value;
    }

    fn text(&self) -> String {
        let mean = self.sum / self.count;
        let variance = (self.squares / self.count - mean * mean).max(0.0);
        format!("{mean:.3} +- {:.3}", (variance / self.count).sqrt())
    }
}

/// Where a body can stand.
struct Ground {
    west: i32,
    south: i32,
    columns: usize,
    rows: usize,
    /// Height of the floor under a body, by row and column; none where it does not fit.
    floors: Vec<Option<i32>>,
    /// Steps of the way from the agent's place.
    reached: Vec<Option<u32>>,
}

impl Ground {
    fn of(world: &World) -> Ground {
        let bounds =
            world.map.lines.iter().fold([i32::MAX, i32::MAX, i32::MIN, i32::MIN], |b, line| {
                let (x, y) = (line.v1.x.0 >> 16, line.v1.y.0 >> 16);
                [b[0].min(x), b[1].min(y), b[2].max(x), b[3].max(y)]
            });
        let (west, south) =
            (bounds[0].div_euclid(PITCH) * PITCH, bounds[1].div_euclid(PITCH) * PITCH);
        let (columns, rows) =
            (((bounds[2] - west) / PITCH) as usize + 1, ((bounds[3] - south) / PITCH) as usize + 1);
        let slot = usize::from(world.players[0].actor.slot);
        let at = |index: usize| {
            ((west + (index % columns) as i32 * PITCH), (south + (index / columns) as i32 * PITCH))
        };
        let floors: Vec<_> = (0..columns * rows)
            .map(|index| {
                let (x, y) = at(index);
                let (x, y) = (Fixed::from_int(x), Fixed::from_int(y));
                let position = world.check_position(slot, x, y);
                (position.free && world.map.is_inside(x, y)).then_some(position.floor_z.0 >> 16)
            })
            .collect();
        let body = &world.actors[slot];
        let start = (((body.y.0 >> 16) - south) / PITCH) as usize * columns
            + (((body.x.0 >> 16) - west) / PITCH) as usize;
        let mut reached = vec![None; floors.len()];
        reached[start] = Some(0);
        let mut queue = VecDeque::from([start]);
        while let Some(from) = queue.pop_front() {
            let (Some(steps), floor) = (reached[from], floors[from].unwrap_or(0)) else { continue };
            let (column, row) = (from % columns, from / columns);
            let mut next = Vec::new();
            next.extend((column > 0).then(|| from - 1));
            next.extend((column + 1 < columns).then(|| from + 1));
            next.extend((row > 0).then(|| from - columns));
            next.extend((row + 1 < rows).then(|| from + columns));
            for to in next {
                if reached[to].is_none() && floors[to].is_some_and(|other| other - floor <= CLIMB) {
                    reached[to] = Some(steps + 1);
                    queue.push_back(to);
                }
            }
        }
        Ground { west, south, columns, rows, floors, reached }
    }

    fn print(&self) {
        let cell = f64::from(PITCH * PITCH) / 1000.0;
        let reached = self.reached.iter().flatten().count() as f64 * cell;
        println!("within reach: {reached:.0} thousand square units");
        let mut by_floor = std::collections::BTreeMap::<i32, f64>::new();
        for (floor, reached) in self.floors.iter().zip(&self.reached) {
            if let (Some(floor), Some(_)) = (floor, reached) {
                *by_floor.entry(*floor).or_default() += cell;
            }
        }
        let text: Vec<_> =
            by_floor.iter().map(|(floor, area)| format!("{floor}: {area:.0}")).collect();
        println!("by height of the floor: {}", text.join(", "));
    }

    /// Whether a body within reach can touch a point.
    fn is_reached(&self, x: i32, y: i32) -> bool {
        let (column, row) =
            ((x - self.west + PITCH / 2) / PITCH, (y - self.south + PITCH / 2) / PITCH);
        (-2..=2).any(|up| {
            (-2..=2).any(|right| {
                let (column, row) = (column + right, row + up);
                let inside = column >= 0
                    && row >= 0
                    && column < self.columns as i32
                    && row < self.rows as i32;
                inside && self.reached[row as usize * self.columns + column as usize].is_some()
            })
        })
    }

    fn picture(&self, file: &str) -> std::io::Result<()> {
        let mut bytes = format!("P5\n{} {}\n255\n", self.columns, self.rows).into_bytes();
        for row in (0..self.rows).rev() {
            for column in 0..self.columns {
                let index = row * self.columns + column;
                let shade = match (self.floors[index], self.reached[index]) {
                    (_, None) => 0,
                    (Some(floor), _) => (200 - floor).clamp(60, 255) as u8,
                    (None, _) => 0,
                };
                bytes.push(shade);
            }
        }
        println!("the picture's lower left corner is ({}, {})", self.west, self.south);
        std::fs::write(file, bytes)
    }
}
