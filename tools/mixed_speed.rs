//! A mixed batch beside batches of each of its tasks: all with the same action space and the same
//! random choices, in turns.
//!
//! ```sh
//! cargo run --release -p hasard-envs --example mixed_speed -- TURNS ID ID...
//! ```
//!
//! An id may be a task's file. Prints steps a second of each, and the median over turns of the
//! mixture's rate over that expected from its parts.

use hasard_engine::math::Rng;
use hasard_envs::{Env, EnvOptions, FrameSize, Mixture, VecEnv, VecOptions, own};
use std::time::Instant;

const LANES_A_TASK: usize = 16;
/// Two episodes of a minute.
const STEPS: usize = 1050;

/// Steps a second of all lanes.
fn rate(worlds: &mut VecEnv) -> f64 {
    let sizes = worlds.action_space().sizes();
    let mut batch = worlds.whole_batch();
    let mut rng = Rng::new(1);
    worlds.seed(1).unwrap();
    worlds.reset(&mut batch).unwrap();
    let start = Instant::now();
    for _ in 0..STEPS {
        for (index, action) in batch.actions.iter_mut().enumerate() {
            *action = rng.below(sizes[index % sizes.len()] as u32) as u8;
        }
        worlds.step(&mut batch).unwrap();
    }
    (STEPS * worlds.lanes()) as f64 / start.elapsed().as_secs_f64()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [turns, ids @ ..] = words.as_slice() else { return Err("give TURNS ID ID...".into()) };
    let turns: usize = turns.parse()?;
    let options =
        EnvOptions { size: FrameSize { width: 128, height: 72 }, ..EnvOptions::default() };
    let open = |id: &String| {
        let id = if own::is_file(id) { own::open(id)?.to_string() } else { id.clone() };
        Env::new(&id, &options)
    };
    let firsts = ids.iter().map(open).collect::<Result<Vec<Env>, _>>()?;
    let mixture = Mixture::of(&firsts)?;
    let lanes = |count| VecOptions { lanes: count, threads: 0, ..VecOptions::default() };
    let mut parts = (0..firsts.len())
        .map(|task| {
            // As wide as the mixture: wider batches are slower, as their worlds leave the caches.
            VecEnv::from_fn(lanes(LANES_A_TASK * firsts.len()), |_| {
                Ok(mixture.lane(task, Box::new(firsts[task].sibling())))
            })
        })
        .collect::<Result<Vec<VecEnv>, _>>()?;
    let mut mixed =
        VecEnv::mixed(mixture.clone(), lanes(LANES_A_TASK * firsts.len()), |task, _| {
            Ok(Box::new(firsts[task].sibling()))
        })?;
    let mut rates = vec![Vec::new(); parts.len() + 1];
    let mut ratios = Vec::new();
    for turn in 0..turns {
        let mut of_turn = vec![0.0; parts.len() + 1];
        let order: Vec<usize> = (0..=parts.len()).collect();
        let order: Vec<usize> =
            if turn % 2 == 0 { order } else { order.into_iter().rev().collect() };
        for which in order {
            of_turn[which] = rate(parts.get_mut(which).unwrap_or(&mut mixed));
        }
        let time: f64 = of_turn[..parts.len()].iter().map(|rate| 1.0 / rate).sum();
        ratios.push(of_turn[parts.len()] * time / parts.len() as f64);
        rates.iter_mut().zip(of_turn).for_each(|(all, rate)| all.push(rate));
    }
    for (id, rates) in ids.iter().map(String::as_str).chain(["mixed"]).zip(rates) {
        println!("{id}: {:.0} steps/s", median(rates));
    }
    println!("mixed over what its parts let expect: {:.3}", median(ratios));
    Ok(())
}
