//! What a policy step costs: `step_cost ENVIRONMENT STEPS LANES [observe|step|hash] [WARM-UP STEPS]
//! [--maps]` (Linux).
//!
//! Steps worlds in turn (frame skip 4, random actions, resets included) and prints the nanoseconds
//! of a step, first of processor time, then of wall time; `1s` for STEPS takes as many as fit a
//! second. `observe` (the default) draws 128x72 RGB after every step, `step` draws nothing, `hash`
//! prints a fingerprint of all frames and of the state after every step: two builds that print the
//! same did the same work. `ab.py` beside it runs two builds in turn, and valgrind counts the
//! instructions of one (`--tool=callgrind`). With `--maps` the worlds are the published ones, from
//! the Python packages `hasard` and `vizdoom`.

use hasard_engine::math::Rng;
use hasard_envs::maps::{Maps, find_iwad, find_maps};
use hasard_envs::{Env, EnvOptions, FrameSize};
use std::sync::Arc;
use std::time::Instant;

/// What is done after a step.
#[derive(Clone, Copy, PartialEq)]
enum Mode {
    Observe,
    Step,
    Hash,
}

/// How much is done.
#[derive(Clone, Copy)]
enum Amount {
    Steps(usize),
    Seconds(f64),
}

impl Amount {
    fn of(text: &str) -> Option<Amount> {
        match text.strip_suffix('s') {
            Some(seconds) => seconds.parse().ok().map(Amount::Seconds),
            None => text.parse().ok().map(Amount::Steps),
        }
    }
}

/// Steps between two looks at the clock.
const STRETCH: usize = 64;

struct Worlds {
    envs: Vec<Env>,
    sizes: Vec<usize>,
    rng: Rng,
    seed: u64,
    frame: Vec<u8>,
}

impl Worlds {
    fn new(id: &str, lanes: usize, published: bool) -> Result<Worlds, String> {
        let maps = || Ok(Arc::new(Maps::new(&find_maps()?, Some(&find_iwad(true)?))));
        let maps = published
            .then(maps)
            .transpose()
            .map_err(|error: hasard_envs::EnvError| error.to_string())?;
        let options = EnvOptions { size: FrameSize::LEARNER, maps, ..EnvOptions::default() };
        let first = Env::new(id, &options).map_err(|error| error.to_string())?;
        let mut envs: Vec<Env> = (0..lanes).map(|_| first.sibling()).collect();
        (0..).zip(&mut envs).for_each(|(seed, env)| env.reset(seed));
        let (sizes, frame) = (first.action_space().sizes(), vec![0; 128 * 72 * 3]);
        Ok(Worlds { envs, sizes, rng: Rng::new(1), seed: lanes as u64, frame })
    }

    /// Steps the worlds in turn; returns the fingerprint.
    #[inline(never)]
    fn run(&mut self, steps: usize, mode: Mode) -> u64 {
        let mut actions = vec![0; self.sizes.len()];
        let deltas = vec![0.0; self.envs[0].action_space().deltas.len()];
        let (lanes, mut hash) = (self.envs.len(), 0xCBF2_9CE4_8422_2325u64);
        for step in 0..steps {
            let env = &mut self.envs[step % lanes];
            for (action, &size) in actions.iter_mut().zip(&self.sizes) {
                *action = self.rng.below(size as u32) as u8;
            }
            if env.step(&actions, &deltas).unwrap().ended() {
                self.seed += 1;
                env.reset(self.seed);
            }
            if mode != Mode::Step {
                env.observe(&mut self.frame);
            }
            if mode == Mode::Hash {
                for &byte in self.frame.iter().chain(&env.state_hash().to_le_bytes()) {
                    hash = (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01B3);
                }
            }
        }
        hash
    }
}

/// Nanoseconds that this thread has been running on a processor.
fn processor_time() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    text.split(' ')
        .next()
        .and_then(|first| first.parse().ok())
        .expect("/proc/thread-self/schedstat is needed (Linux)")
}

fn run(arguments: &[String]) -> Result<(), String> {
    let published = arguments.iter().any(|argument| argument == "--maps");
    let arguments: Vec<&String> =
        arguments.iter().filter(|argument| *argument != "--maps").collect();
    let [id, steps, lanes, rest @ ..] = &arguments[..] else {
        return Err("which environment, how many steps, how many lanes? e.g. VolcanicVentureLevel3-v0 3000 8".into());
    };
    let number = |text: &&String| {
        text.parse::<usize>().map_err(|_| format!("{text} is no number of steps or lanes"))
    };
    let amount = Amount::of(steps)
        .ok_or_else(|| format!("{steps} is no number of steps, and no time such as 1s"))?;
    let lanes = number(lanes)?.max(1);
    let mode = match rest.first().map(|mode| mode.as_str()) {
        None | Some("observe") => Mode::Observe,
        Some("step") => Mode::Step,
        Some("hash") => Mode::Hash,
        Some(other) => return Err(format!("{other} is no way to run: observe, step or hash")),
    };
    let mut worlds = Worlds::new(id, lanes, published)?;
    worlds.run(rest.get(1).map_or(Ok(0), number)?, Mode::Step);
    let (start, wall, mut done, mut hash) = (processor_time(), Instant::now(), 0, 0);
    match amount {
        Amount::Steps(steps) => (done, hash) = (steps, worlds.run(steps, mode)),
        Amount::Seconds(seconds) => {
            while wall.elapsed().as_secs_f64() < seconds {
                hash ^= worlds.run(STRETCH, mode);
                done += STRETCH;
            }
        }
    }
    let (wall, processor) = (wall.elapsed().as_secs_f64() * 1e9, processor_time() - start);
    match mode {
        Mode::Hash => println!("{id} {hash:016x}"),
        _ => println!("{:.1} {:.1}", processor / done as f64, wall / done as f64),
    }
    Ok(())
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let Err(error) = run(&arguments) {
        eprintln!("{error}");
        std::process::exit(2);
    }
}
