//! Do the worlds last? `cargo run --release -p hasard-envs --example soak -- [STEPS] [LANES] [THREADS]` (Linux; 1,000,000 steps in
//! all, 8 worlds of each environment, 1 thread).
//!
//! Steps batches of all 18 environments in turn with random actions, and prints ten times on the way the memory of the process and a
//! fingerprint of what has come out: every reward, cost and flag, and every sixteenth observation. Runs that were given the
//! same steps and lanes print the same fingerprints, whatever their threads, and their memory stays where it is.

use hasard_engine::math::Rng;
use hasard_envs::{Batch, EnvId, EnvOptions, FrameSize, VecEnv, VecOptions};

/// Of so many observations one counts towards the fingerprint: telling takes longer than drawing.
const TOLD: u64 = 16;

/// FNV-1a over words.
fn tell(hash: u64, bytes: &[u8]) -> u64 {
    let (words, rest) = bytes.as_chunks::<8>();
    let words = words.iter().map(|&word| u64::from_le_bytes(word));
    words.chain(rest.iter().map(|&byte| u64::from(byte))).fold(hash, |hash, word| (hash ^ word).wrapping_mul(0x100_0000_01B3))
}

struct Worlds {
    worlds: VecEnv,
    batch: Batch,
    sizes: Vec<usize>,
}

impl Worlds {
    fn new(id: EnvId, lanes: usize, threads: usize) -> Result<Worlds, hasard_envs::EnvError> {
        let options = EnvOptions { size: FrameSize::LEARNER, ..EnvOptions::default() };
        // One of the threads is this one, which helps while it waits.
        let how = VecOptions { lanes, threads: threads.saturating_sub(1), ..VecOptions::default() };
        let mut worlds = VecEnv::new(&id.to_string(), &options, how)?;
        let mut batch = worlds.whole_batch();
        worlds.reset(&mut batch)?;
        let sizes = worlds.action_space().sizes();
        Ok(Worlds { worlds, batch, sizes })
    }

    /// A step of every lane; returns the fingerprint with what came of it.
    fn step(&mut self, rng: &mut Rng, mut hash: u64, told: bool) -> Result<u64, hasard_envs::EnvError> {
        let (lanes, batch) = (self.batch.lanes(), &mut self.batch);
        for (action, &size) in batch.actions.iter_mut().zip(self.sizes.iter().cycle()) {
            *action = rng.below(size as u32) as u8;
        }
        self.worlds.step(batch)?;
        for lane in 0..lanes {
            let flags = [u8::from(batch.terminated[lane]), u8::from(batch.truncated[lane])];
            hash = tell(hash, &[&batch.rewards[lane].to_le_bytes()[..], &batch.costs[lane].to_le_bytes(), &flags].concat());
        }
        Ok(if told { tell(hash, &batch.observations) } else { hash })
    }
}

/// Mebibytes of memory that the process holds.
fn memory() -> f64 {
    let text = std::fs::read_to_string("/proc/self/statm").unwrap_or_default();
    let pages: f64 = text.split(' ').nth(1).and_then(|pages| pages.parse().ok()).expect("/proc/self/statm is needed (Linux)");
    pages * 4096.0 / f64::from(1 << 20)
}

fn main() -> Result<(), hasard_envs::EnvError> {
    let given: Vec<u64> = std::env::args().skip(1).map(|text| text.parse().expect("numbers: steps, lanes, threads")).collect();
    let number = |at: usize, usual: u64| given.get(at).copied().unwrap_or(usual).max(1);
    let (steps, lanes, threads) = (number(0, 1_000_000), number(1, 8) as usize, number(2, 1) as usize);
    let mut all = EnvId::all().map(|id| Worlds::new(id, lanes, threads)).collect::<Result<Vec<_>, _>>()?;
    let (mut rng, mut hash) = (Rng::new(0), 0xCBF2_9CE4_8422_2325);
    let rounds = steps.div_ceil(all.len() as u64 * lanes as u64);
    for round in 1..=rounds {
        for worlds in &mut all {
            hash = worlds.step(&mut rng, hash, round % TOLD == 0)?;
        }
        if round * 10 / rounds != (round - 1) * 10 / rounds {
            let done = round * all.len() as u64 * lanes as u64;
            println!("{done} steps, fingerprint {hash:016x}, {:.1} MiB", memory());
        }
    }
    Ok(())
}
