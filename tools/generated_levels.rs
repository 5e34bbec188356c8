//! Levels of generated maps, many of each kind: whether each has a way from the agent to every
//! item, how many are distinct, and what a reset costs beyond that of a map that stays.
//!
//! ```sh
//! cargo run --release -p hasard-envs --example generated_levels -- COUNT
//! ```

use hasard_engine::math::Fixed;
use hasard_engine::world::ActorKind;
use hasard_envs::{Env, EnvOptions, FrameSize, own};
use std::collections::{BTreeSet, VecDeque};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::time::Instant;

const SIDE: i32 = 64;

/// A task with a map of one kind, or with none (open ground of the same size).
fn text(name: &str, kind: Option<&str>, columns: usize, rows: usize) -> String {
    let map = match kind {
        Some(kind) => format!(
            "[map.generate]\nkind = \"{kind}\"\ncolumns = {columns}\nrows = {rows}\nloops = 0.1\n"
        ),
        None => {
            let row = ".".repeat(columns);
            let rows = vec![row; rows].join("\n");
            format!("ascii = \"\"\"\n{rows}\"\"\"\n")
        }
    };
    format!(
        "[scenario]\nname = \"{name}\"\n[map]\ntile = {SIDE}\n{map}\
         [player]\nin = \"free\"\n\
         [[spawn]]\nkind = \"Allmap\"\ncount = 3\n[[spawn]]\nkind = \"HealthBonus\"\ncount = 5\n\
         [[when]]\nevent = \"pickup\"\nof = \"Allmap\"\nreward = 1.0\n"
    )
}

/// The floors of a level's tiles, and which tiles the agent can walk to: it steps 24 up and needs
/// 56 of height.
fn walkable(env: &Env, columns: usize, rows: usize) -> (Vec<i32>, Vec<bool>) {
    let world = env.world();
    let centre = |tile: usize| Fixed::from_int(tile as i32 * SIDE + SIDE / 2);
    let space = |index: usize| {
        let sector = world.map.sector_at(centre(index % columns), centre(index / columns));
        let sector = world.sector(sector);
        (sector.floor, sector.ceiling)
    };
    let spaces: Vec<(Fixed, Fixed)> = (0..columns * rows).map(space).collect();
    let tile_of = |[x, y]: [i32; 2]| (y / SIDE) as usize * columns + (x / SIDE) as usize;
    let start = tile_of(env.position());
    let mut seen = vec![false; spaces.len()];
    let mut queue = VecDeque::from([start]);
    seen[start] = true;
    while let Some(tile) = queue.pop_front() {
        let (column, row) = (tile % columns, tile / columns);
        let beside = [
            (column.wrapping_sub(1), row),
            (column + 1, row),
            (column, row.wrapping_sub(1)),
            (column, row + 1),
        ];
        for (to, of) in beside {
            if to >= columns || of >= rows || seen[of * columns + to] {
                continue;
            }
            let ((from, below), (floor, ceiling)) = (spaces[tile], spaces[of * columns + to]);
            let room = ceiling.min(below) - floor.max(from) >= Fixed::from_int(56);
            if room && floor - from <= Fixed::from_int(24) {
                seen[of * columns + to] = true;
                queue.push_back(of * columns + to);
            }
        }
    }
    (spaces.iter().map(|(floor, _)| floor.0 >> 16).collect(), seen)
}

/// Microseconds of a reset, the least of some rounds.
fn reset_cost(env: &mut Env) -> f64 {
    const RESETS: u64 = 300;
    let round = |env: &mut Env, round: u64| {
        let start = Instant::now();
        (0..RESETS).for_each(|seed| env.reset(round * RESETS + seed));
        start.elapsed().as_secs_f64() * 1e6 / RESETS as f64
    };
    (0..7).map(|number| round(env, number)).fold(f64::INFINITY, f64::min)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let count: u64 = std::env::args().nth(1).ok_or("give COUNT")?.parse()?;
    let options = EnvOptions { size: FrameSize { width: 64, height: 48 }, ..EnvOptions::default() };
    println!(
        "| map | tiles | levels | distinct | without a way | least open | reset, us | without a new map, us |"
    );
    println!("|---|---|--:|--:|--:|--:|--:|--:|");
    for (columns, rows) in [(13, 13), (31, 31)] {
        let plain = format!("Plain{columns}x{rows}");
        own::register("plain.toml", &text(&plain, None, columns, rows))?;
        let mut plain = Env::new(&format!("{plain}-v0"), &options)?;
        for kind in ["maze", "rooms", "columns", "platforms"] {
            let name = format!("Made{kind}{columns}x{rows}");
            own::register("made.toml", &text(&name, Some(kind), columns, rows))?;
            let mut env = Env::new(&format!("{name}-v0"), &options)?;
            let (mut distinct, mut without, mut least) = (BTreeSet::new(), 0, 1.0_f64);
            for seed in 0..count {
                env.reset(seed);
                let (floors, seen) = walkable(&env, columns, rows);
                let mut hasher = DefaultHasher::new();
                floors.hash(&mut hasher);
                distinct.insert(hasher.finish());
                let items = env.world().living().map(|(_, actor)| *actor).filter(|actor| {
                    matches!(actor.kind, ActorKind::Allmap | ActorKind::HealthBonus)
                });
                let tile = |x: Fixed, y: Fixed| {
                    ((y.0 >> 16) / SIDE) as usize * columns + ((x.0 >> 16) / SIDE) as usize
                };
                let places: Vec<usize> = items.map(|item| tile(item.x, item.y)).collect();
                assert_eq!(places.len(), 8, "{kind}, seed {seed}: an item found no place");
                without += usize::from(!places.iter().all(|&place| seen[place]));
                let open = seen.iter().filter(|seen| **seen).count();
                least = least.min(open as f64 / seen.len() as f64);
            }
            println!(
                "| {kind} | {columns} x {rows} | {count} | {} | {without} | {:.0} % | {:.0} | {:.0} |",
                distinct.len(),
                least * 100.0,
                reset_cost(&mut env),
                reset_cost(&mut plain)
            );
        }
    }
    Ok(())
}
