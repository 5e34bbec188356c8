//! How fast training is, against what the processor's arithmetic allows.

use std::time::Instant;

use crate::config::TrainConfig;
use crate::error::LearnError;
use crate::networks::cpu::panels::Panels;
use crate::networks::cpu::product::{Left, Size, multiply_panels};
use crate::networks::device::ComputeDevice;
use crate::runs::session::{Beginning, MakeWorlds, Session};
use hasard_engine::simd::Simd;

/// A measurement: medians over its rounds.
#[derive(Clone, Debug)]
pub struct Measurement {
    /// Policy steps a second of the whole loop: worlds, inference, learning.
    pub steps_per_second: f64,
    /// Rate of large products by the same kernels on as many threads, in floating-point operations
    /// a second.
    pub product_rate: f64,
    /// Floating-point operations of a policy step: forward once and backward once an epoch, counted
    /// from the shape. Acting costs nothing here, since a learner that takes turns with the
    /// samplers need not repeat it.
    pub flop_per_step: f64,
    /// What computed both.
    pub kernels: Simd,
    /// Threads.
    pub threads: usize,
    /// Rounds.
    pub rounds: usize,
    /// Bytes of a checkpoint's numbers: weights, and two moments of each optimiser.
    pub checkpoint_bytes: u64,
}

impl Measurement {
    /// Steps a second that the arithmetic alone would allow.
    #[must_use]
    pub fn bound(&self) -> f64 {
        self.product_rate / self.flop_per_step
    }

    /// Share of the bound that the loop reaches.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.steps_per_second / self.bound()
    }
}

/// Side of the products that the bound is taken from.
const SIDE: usize = 1024;

/// Measures the training loop, about `seconds` in each round, and the products in turns, so that
/// whatever else the machine does meets both alike. Nothing is written to the disk.
pub fn measure(
    kernels: Simd,
    config: &TrainConfig,
    make_worlds: &MakeWorlds<'_>,
    rounds: usize,
    seconds: f64,
    round_done: &mut dyn FnMut(usize),
) -> Result<Measurement, LearnError> {
    let mut session = Session::on(
        &ComputeDevice::Processor(kernels),
        config.clone(),
        &Beginning::Nothing,
        make_worlds,
    )?;
    let mut warn = |_| {};
    // The first rollouts fill buffers.
    for _ in 0..2 {
        let rollout = session.turn(&mut warn)?;
        session.go_on(rollout);
    }
    let threads = config.learning.threads;
    let (mut loops, mut products) = (Vec::new(), Vec::new());
    let mut rollout = session.turn(&mut warn)?;
    for round in 0..rounds.max(1) {
        products.push(product_rate(kernels, threads));
        let start = Instant::now();
        let mut steps = 0;
        while steps == 0 || start.elapsed().as_secs_f64() < seconds {
            session.go_on(rollout);
            rollout = session.turn(&mut warn)?;
            steps += rollout.rows();
        }
        loops.push(steps as f64 / start.elapsed().as_secs_f64());
        round_done(round + 1);
    }
    let shape = session.learner.shape();
    let sum =
        |of: fn(&crate::networks::NetworkShape) -> f64| shape.networks.iter().map(of).sum::<f64>();
    let tables = shape.networks.iter().map(crate::networks::NetworkShape::parameters);
    let parameters: usize =
        tables.map(|table| table.iter().map(|one| one.size()).sum::<usize>()).sum();
    let epochs = config.learning.epochs as f64;
    Ok(Measurement {
        steps_per_second: median(loops),
        product_rate: median(products),
        flop_per_step: epochs * sum(|network| network.training_flop()),
        kernels,
        threads,
        rounds: rounds.max(1),
        checkpoint_bytes: 4 * parameters as u64 * (1 + 2 * config.algorithm.optimisers() as u64),
    })
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Floating-point operations a second of large products, one on each thread.
fn product_rate(kernels: Simd, threads: usize) -> f64 {
    let left = vec![0.5f32; SIDE * SIDE];
    let mut right = Panels::default();
    right.pack(kernels, &vec![0.25f32; SIDE * SIDE], SIDE, SIDE);
    let start = Instant::now();
    let count: usize = std::thread::scope(|scope| {
        let work = || {
            let (mut out, mut rounded) = (vec![0.0f32; SIDE * SIDE], Vec::new());
            let mut count = 0;
            while start.elapsed().as_secs_f64() < 0.3 {
                let size = Size { rows: SIDE, columns: SIDE, inner: SIDE };
                let factor = Left::rows(&left, SIDE);
                multiply_panels(kernels, size, factor, &right, &mut out, SIDE, false, &mut rounded);
                count += 1;
            }
            count
        };
        let others: Vec<_> = (0..threads)
            .filter_map(|_| std::thread::Builder::new().spawn_scoped(scope, work).ok())
            .collect();
        others.into_iter().map(|other| other.join().unwrap_or(0)).sum()
    });
    count as f64 * 2.0 * (SIDE as f64).powi(3) / start.elapsed().as_secs_f64()
}
