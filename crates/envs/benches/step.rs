//! Time of a policy step, of a reset and of an observation in every scenario: `cargo bench -p
//! hasard-envs`.
//!
//! Random actions of the simplified action space, 4 tics a step, episodes one after another.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use hasard_engine::math::Rng;
use hasard_envs::{Env, EnvId, EnvOptions, FrameSize};
use std::hint::black_box;

/// An environment that is stepped by random actions.
struct Player {
    env: Env,
    actions: Vec<u8>,
    deltas: Vec<f32>,
    rng: Rng,
    seed: u64,
}

impl Player {
    fn new(id: &str) -> Player {
        let env = Env::new(id, &EnvOptions { size: FrameSize::LEARNER, ..EnvOptions::default() })
            .expect("a registered id");
        let space = env.action_space();
        let (actions, deltas) = (vec![0; space.groups.len()], vec![0.0; space.deltas.len()]);
        Player { actions, deltas, env, rng: Rng::new(1), seed: 0 }
    }

    fn reset(&mut self) {
        self.seed += 1;
        self.env.reset(self.seed);
    }

    fn step(&mut self) {
        // Buttons alone: continuous parts stay at rest.
        self.env.action_space().sample(&mut self.rng, &mut self.actions, &mut []);
        if self.env.step(&self.actions, &self.deltas).unwrap().ended() {
            self.reset();
        }
    }
}

fn steps(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("environment");
    for id in EnvId::all().map(|id| id.to_string()) {
        let mut player = Player::new(&id);
        let mut frame = vec![0; player.env.observation_shape().iter().product()];
        group.bench_function(BenchmarkId::new("step", &id), |bencher| {
            bencher.iter(|| player.step())
        });
        group.bench_function(BenchmarkId::new("step and observe", &id), |bencher| {
            bencher.iter(|| {
                player.step();
                player.env.observe(black_box(&mut frame));
            });
        });
        group.bench_function(BenchmarkId::new("reset", &id), |bencher| {
            bencher.iter(|| player.reset())
        });
    }
}

criterion_group!(benches, steps);
criterion_main!(benches);
