//! How fast the worlds of every scenario and level step on one thread, in processor time, which
//! other programs do not spoil: `cargo run --release -p hasard-envs --example speed_table --
//! [STEPS] [ROUNDS] [NAME PART]` (Linux).
//!
//! Steps of frame skip 4 with random actions and auto-reset, 32 worlds in turn, 128x72: once with
//! colours, once with colours, depth and labels; and the time of a reset. Median of the rounds,
//! which alternate between the two. On virtual machines the clock of processor time may tick every
//! 4 ms: 40,000 steps a round resolve a per cent, some hundred say nothing.

use hasard_engine::math::Rng;
use hasard_engine::render::Buffers;
use hasard_envs::{Env, EnvId, EnvOptions, FrameSize};

/// Nanoseconds that this thread has been running on a processor.
fn processor_time() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    text.split(' ')
        .next()
        .and_then(|first| first.parse().ok())
        .expect("/proc/thread-self/schedstat is needed (Linux)")
}

struct Worlds {
    envs: Vec<Env>,
    sizes: Vec<usize>,
    rng: Rng,
    seed: u64,
    frame: Vec<u8>,
}

impl Worlds {
    fn new(id: &str) -> Worlds {
        let options = EnvOptions { size: FrameSize::LEARNER, ..EnvOptions::default() };
        let first = Env::new(id, &options).expect("a registered environment");
        let mut envs: Vec<Env> = (0..32).map(|_| first.sibling()).collect();
        (0..).zip(&mut envs).for_each(|(seed, env)| env.reset(seed));
        let (sizes, frame) = (first.action_space().sizes(), vec![0; 128 * 72 * 5]);
        Worlds { envs, sizes, rng: Rng::new(1), seed: 32, frame }
    }

    /// Steps the worlds in turn; returns the nanoseconds a step.
    fn run(&mut self, steps: usize, everything: bool) -> f64 {
        let mut actions = vec![0; self.sizes.len()];
        let deltas = vec![0.0; self.envs[0].action_space().deltas.len()];
        let start = processor_time();
        for step in 0..steps {
            let env = step % self.envs.len();
            let env = &mut self.envs[env];
            for (action, &size) in actions.iter_mut().zip(&self.sizes) {
                *action = self.rng.below(size as u32) as u8;
            }
            if env.step(&actions, &deltas).unwrap().ended() {
                self.seed += 1;
                env.reset(self.seed);
            }
            let (colours, rest) = self.frame.split_at_mut(128 * 72 * 3);
            if everything {
                let renderer = env.render(Buffers { depth: true, labels: true });
                renderer.write_rgb_hwc(colours);
                let (depth, labels) = rest.split_at_mut(128 * 72);
                renderer.write_depth(depth);
                renderer.write_labels(labels);
            } else {
                env.observe(colours);
            }
        }
        (processor_time() - start) / steps as f64
    }

    /// Nanoseconds a reset.
    fn reset(&mut self) -> f64 {
        let start = processor_time();
        for _ in 0..10 {
            for env in &mut self.envs {
                self.seed += 1;
                env.reset(self.seed);
            }
        }
        (processor_time() - start) / 10.0 / self.envs.len() as f64
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |i: usize, default: usize| {
        arguments.get(i).map_or(default, |text| text.parse().expect("a number"))
    };
    let (steps, rounds) = (number(0, 8000), number(1, 3));
    println!(
        "| environment | steps/s | all buffers, steps/s | more time | reset, ms |\n|---|---:|---:|---:|---:|"
    );
    for id in EnvId::all().map(|id| id.to_string()) {
        if arguments.get(2).is_some_and(|part| !id.contains(part.as_str())) {
            continue;
        }
        let mut worlds = Worlds::new(&id);
        worlds.run(steps / 4, true);
        let (mut plain, mut full, mut reset) = (Vec::new(), Vec::new(), Vec::new());
        for _ in 0..rounds {
            plain.push(worlds.run(steps, false));
            full.push(worlds.run(steps, true));
            reset.push(worlds.reset());
        }
        let (plain, full) = (median(plain), median(full));
        println!(
            "| {id} | {:.0} | {:.0} | {:+.0} % | {:.3} |",
            1e9 / plain,
            1e9 / full,
            (full / plain - 1.0) * 100.0,
            median(reset) / 1e6
        );
    }
}
