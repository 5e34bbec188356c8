//! Do the worlds last? `cargo run --release -p hasard-envs --example soak -- [STEPS] [LANES]
//! [THREADS] [FILE]` (Linux; 1,000,000 steps in all, 8 worlds of each environment, 1 thread).
//!
//! Steps batches of all 18 environments in turn with random actions, and prints ten times on the
//! way the memory of the process and a fingerprint of what has come out: every reward, cost and
//! flag, and every sixteenth observation. Runs that were given the same steps and lanes print the
//! same fingerprints, whatever their threads, and their memory stays where it is. With a FILE where
//! it stands is kept a hundred times on the way, and what finds such a file goes on from there: to
//! the same fingerprints.

use hasard_engine::math::Rng;
use hasard_envs::{Batch, EnvId, EnvOptions, FrameSize, LaneState, VecEnv, VecOptions};
use std::path::Path;

/// Anything that can go wrong here ends the program with a line.
type Any<T> = Result<T, Box<dyn std::error::Error>>;

/// Of so many observations one counts towards the fingerprint: hashing takes longer than drawing.
const HASH_EVERY: u64 = 16;

/// FNV-1a over words.
fn fnv(hash: u64, bytes: &[u8]) -> u64 {
    let (words, rest) = bytes.as_chunks::<8>();
    let words = words.iter().map(|&word| u64::from_le_bytes(word));
    words
        .chain(rest.iter().map(|&byte| u64::from(byte)))
        .fold(hash, |hash, word| (hash ^ word).wrapping_mul(0x100_0000_01B3))
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
    fn step(
        &mut self,
        rng: &mut Rng,
        mut hash: u64,
        with_observations: bool,
    ) -> Result<u64, hasard_envs::EnvError> {
        let (lanes, batch) = (self.batch.lanes(), &mut self.batch);
        for (action, &size) in batch.actions.iter_mut().zip(self.sizes.iter().cycle()) {
            *action = rng.below(size as u32) as u8;
        }
        self.worlds.step(batch)?;
        for lane in 0..lanes {
            let flags = [u8::from(batch.terminated[lane]), u8::from(batch.truncated[lane])];
            hash = fnv(
                hash,
                &[&batch.rewards[lane].to_le_bytes()[..], &batch.costs[lane].to_le_bytes(), &flags]
                    .concat(),
            );
        }
        Ok(if with_observations { fnv(hash, &batch.observations) } else { hash })
    }
}

const EARLY: &str = "the file ends early: remove it";

/// Takes a word off the front of a kept file.
fn word(rest: &mut &[u8]) -> Any<u64> {
    let (word, after) = rest.split_first_chunk().ok_or(EARLY)?;
    *rest = after;
    Ok(u64::from_le_bytes(*word))
}

/// Where a soak stands, beside its worlds.
struct Standing {
    round: u64,
    rng: Rng,
    hash: u64,
}

impl Standing {
    /// Three words, then for each environment the number of its bytes and the bytes of its lanes,
    /// little-endian.
    fn keep(&self, all: &mut [Worlds], file: &Path) -> Any<()> {
        let mut bytes = [self.round, self.rng.state(), self.hash].map(u64::to_le_bytes).concat();
        for worlds in all {
            let lanes = LaneState::to_bytes(&worlds.worlds.save()?);
            bytes.extend((lanes.len() as u64).to_le_bytes());
            bytes.extend(lanes);
        }
        let partial = file.with_extension("partial");
        std::fs::write(&partial, bytes)?;
        Ok(std::fs::rename(partial, file)?)
    }

    /// Brings worlds to where [`Standing::keep`] left them.
    fn find(all: &mut [Worlds], file: &Path) -> Any<Standing> {
        let bytes = std::fs::read(file)?;
        let mut rest = &bytes[..];
        let standing = Standing {
            round: word(&mut rest)?,
            rng: Rng::from_state(word(&mut rest)?),
            hash: word(&mut rest)?,
        };
        for worlds in all {
            let length = usize::try_from(word(&mut rest)?)?;
            let (lanes, after) = rest.split_at_checked(length).ok_or(EARLY)?;
            worlds.worlds.restore(LaneState::from_bytes(lanes)?, &mut worlds.batch)?;
            rest = after;
        }
        Ok(standing)
    }
}

/// Mebibytes of memory that the process holds.
fn memory() -> f64 {
    let text = std::fs::read_to_string("/proc/self/statm").unwrap_or_default();
    let pages: f64 = text
        .split(' ')
        .nth(1)
        .and_then(|pages| pages.parse().ok())
        .expect("/proc/self/statm is needed (Linux)");
    pages * 4096.0 / f64::from(1 << 20)
}

fn main() -> Any<()> {
    let mut given = std::env::args().skip(1);
    let mut number =
        |usual: u64| match given.next().map(|text| text.parse::<u64>().map_err(|_| text)) {
            None => Ok(usual),
            Some(number) => number
                .map(|number| number.max(1))
                .map_err(|text| format!("{text} is no number of steps, lanes or threads")),
        };
    let (steps, lanes, threads) = (number(1_000_000)?, number(8)? as usize, number(1)? as usize);
    let file = given.next();
    let file = file.as_ref().map(Path::new);
    let mut all =
        EnvId::all().map(|id| Worlds::new(id, lanes, threads)).collect::<Result<Vec<_>, _>>()?;
    let mut at = match file {
        Some(file) if file.exists() => Standing::find(&mut all, file)?,
        _ => Standing { round: 0, rng: Rng::new(0), hash: 0xCBF2_9CE4_8422_2325 },
    };
    let a_round = all.len() as u64 * lanes as u64;
    let rounds = steps.div_ceil(a_round);
    while at.round < rounds {
        at.round += 1;
        let ends_part_of =
            |parts: u64| at.round * parts / rounds != (at.round - 1) * parts / rounds;
        let (prints, keeps) = (ends_part_of(10), ends_part_of(100));
        for worlds in &mut all {
            at.hash = worlds.step(&mut at.rng, at.hash, at.round % HASH_EVERY == 0)?;
        }
        if prints {
            println!(
                "{} steps, fingerprint {:016x}, {:.1} MiB",
                at.round * a_round,
                at.hash,
                memory()
            );
        }
        if let Some(file) = file.filter(|_| keeps) {
            at.keep(&mut all, file)?;
        }
    }
    Ok(())
}
