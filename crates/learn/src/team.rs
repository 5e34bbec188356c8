//! The workers of one run, each with its share of the lanes, and the one thing that they do
//! together: hand everyone's bytes to everyone.
//!
//! Every worker knows the whole rollout but for its pixels, and computes advantages, losses and the
//! optimiser's step by itself, in the same order and to the same bit. Only what needs pixels is
//! shared: a worker runs the networks on its own lanes, gives its rows of outputs, and adds its
//! part to the gradient. So an algorithm need not know that there are others, and a run of several
//! workers differs from a run of one by the order in which parts of a gradient are added up, and by
//! nothing else.

use std::ops::Range;
use std::sync::{Arc, Mutex, MutexGuard};

use crate::error::LearnError;
use crate::threads::deal;

/// What carries bytes between the workers of a run.
pub trait Exchange: Send {
    /// Everyone's bytes in the order of their ranks, once all have given theirs. An error ends the
    /// run.
    fn gather(&mut self, bytes: Vec<u8>) -> Result<Vec<Vec<u8>>, String>;
}

struct Line {
    exchange: Box<dyn Exchange>,
    /// Why nothing can be exchanged any more.
    broken: Option<String>,
}

/// A worker's place among the workers of its run.
#[derive(Clone, Default)]
pub struct Team {
    rank: usize,
    others: Option<(usize, Arc<Mutex<Line>>)>,
}

impl Team {
    /// The `rank`th of `ranks` workers.
    #[must_use]
    pub fn new(rank: usize, ranks: usize, exchange: Box<dyn Exchange>) -> Team {
        let line = Line { exchange, broken: None };
        Team { rank, others: (ranks > 1).then(|| (ranks, Arc::new(Mutex::new(line)))) }
    }

    /// The worker's number.
    #[must_use]
    pub fn rank(&self) -> usize {
        self.rank
    }

    /// Number of workers.
    #[must_use]
    pub fn ranks(&self) -> usize {
        self.others.as_ref().map_or(1, |(ranks, _)| *ranks)
    }

    /// Whether there is nobody else.
    #[must_use]
    pub fn is_alone(&self) -> bool {
        self.others.is_none()
    }

    /// The lanes of every sampler of every worker, `samplers` a worker, in the order of ranks, and
    /// which of those samplers are this one's.
    #[must_use]
    pub fn shares(&self, lanes: usize, samplers: usize) -> (Vec<Range<usize>>, Range<usize>) {
        let (mut shares, mut own) = (Vec::new(), 0..0);
        for (rank, part) in deal(lanes, self.ranks()).enumerate() {
            let first = shares.len();
            shares.extend(
                deal(part.len(), samplers)
                    .map(|share| part.start + share.start..part.start + share.end),
            );
            if rank == self.rank {
                own = first..shares.len();
            }
        }
        (shares, own)
    }

    /// Everyone's bytes in the order of ranks.
    pub fn gather(&self, bytes: Vec<u8>) -> Result<Vec<Vec<u8>>, LearnError> {
        let Some((ranks, line)) = &self.others else { return Ok(vec![bytes]) };
        let mut line = locked(line);
        if line.broken.is_none() {
            match line.exchange.gather(bytes) {
                Ok(all) if all.len() == *ranks => return Ok(all),
                Ok(all) => line.broken = Some(format!("{} of {ranks} workers answered", all.len())),
                Err(why) => line.broken = Some(why),
            }
        }
        Err(LearnError::Team(line.broken.clone().unwrap_or_default()))
    }

    /// What the first worker says, to all; what the others give is not sent.
    pub fn hear_first(&self, bytes: Vec<u8>) -> Result<Vec<u8>, LearnError> {
        let given = if self.rank == 0 { bytes } else { Vec::new() };
        Ok(self.gather(given)?.swap_remove(0))
    }

    /// Sums of everyone's numbers, added up in the order of ranks, so that all hold the same bits.
    /// Where nothing can be exchanged any more they become zero, and [`Team::check`] says why.
    pub fn sum(&self, numbers: &mut [f32]) {
        if self.is_alone() {
            return;
        }
        let bytes = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        let all = self.gather(bytes).and_then(|all| self.alike(all, size_of_val(numbers)));
        numbers.fill(0.0);
        for part in all.unwrap_or_default() {
            for (sum, four) in numbers.iter_mut().zip(part.as_chunks().0) {
                *sum += f32::from_le_bytes(*four);
            }
        }
    }

    /// Sums of everyone's whole numbers.
    pub fn sum_whole(&self, numbers: &mut [u64]) -> Result<(), LearnError> {
        if self.is_alone() {
            return Ok(());
        }
        let bytes = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        let all = self.gather(bytes).and_then(|all| self.alike(all, size_of_val(numbers)))?;
        numbers.fill(0);
        for part in all {
            for (sum, eight) in numbers.iter_mut().zip(part.as_chunks().0) {
                *sum += u64::from_le_bytes(*eight);
            }
        }
        Ok(())
    }

    fn alike(&self, all: Vec<Vec<u8>>, length: usize) -> Result<Vec<Vec<u8>>, LearnError> {
        if all.iter().all(|part| part.len() == length) {
            return Ok(all);
        }
        Err(self.break_off("the workers' numbers do not belong together; start them all from one version of hasard"))
    }

    /// Ends what can be exchanged, and says why from now on.
    pub fn break_off(&self, why: &str) -> LearnError {
        if let Some((_, line)) = &self.others {
            locked(line).broken.get_or_insert_with(|| why.to_string());
        }
        LearnError::Team(why.to_string())
    }

    /// Whether everything so far could be exchanged.
    pub fn check(&self) -> Result<(), LearnError> {
        let broken = self.others.as_ref().and_then(|(_, line)| locked(line).broken.clone());
        broken.map_or(Ok(()), |why| Err(LearnError::Team(why)))
    }
}

fn locked(line: &Mutex<Line>) -> MutexGuard<'_, Line> {
    line.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_lane_is_some_samplers_in_their_order() {
        for (lanes, ranks, samplers) in [(32, 1, 2), (32, 4, 2), (7, 3, 2), (5, 5, 3)] {
            let mut seen = Vec::new();
            let mut all = Vec::new();
            for rank in 0..ranks {
                struct Nobody;
                impl Exchange for Nobody {
                    fn gather(&mut self, _: Vec<u8>) -> Result<Vec<Vec<u8>>, String> {
                        Err("nobody answers".into())
                    }
                }
                let team = Team::new(rank, ranks, Box::new(Nobody));
                let (shares, own) = team.shares(lanes, samplers);
                seen.extend(shares[own].iter().cloned());
                all = shares;
            }
            assert_eq!(seen, all);
            assert_eq!(
                seen.into_iter().flatten().collect::<Vec<_>>(),
                (0..lanes).collect::<Vec<_>>()
            );
        }
    }
}
