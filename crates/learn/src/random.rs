//! Random numbers of the learner: streams named by what they are for, so that none has to be
//! stored.
//!
//! Every draw comes from a stream made of (run seed, purpose, counters). A resumed run knows its
//! counters and therefore draws what the uninterrupted run would have drawn; and lanes can be
//! sampled on any thread in any order.

use hasard_engine::math::Rng;

/// What a stream is for; keeps streams of equal counters apart.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Purpose {
    /// Initial weights; counters: network, parameter.
    Weights = 1,
    /// Sampled actions; counters: lane, step.
    Actions = 2,
    /// Order of trajectories within an epoch; counters: update, epoch.
    Shuffle = 3,
    /// Seeds of the worlds; counter: lane.
    Worlds = 4,
    /// Actions during evaluation; counters: episode, step.
    Evaluation = 5,
    /// Random steps before a run's first episode; counter: lane.
    FirstSteps = 6,
    /// Seeds of a curriculum's lessons; counter: lesson.
    Lesson = 7,
    /// Seeds of the episodes of evaluations during training; counters: set of episodes, episode.
    EvaluatedWorlds = 8,
}

/// A stream of random numbers.
#[derive(Clone, Debug)]
pub struct Stream(Rng);

impl Stream {
    /// The stream for a purpose and two counters in the run of `seed`.
    #[must_use]
    pub fn new(seed: u64, purpose: Purpose, first: u64, second: u64) -> Stream {
        let outer = Rng::for_lane(seed, purpose as u64).next_u64();
        let middle = Rng::for_lane(outer, first).next_u64();
        Stream(Rng::for_lane(middle, second))
    }

    /// The next 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// Uniform in [0, 1).
    pub fn uniform(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Standard normal, by Box and Muller.
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * libm::log(1.0 - self.uniform())).sqrt();
        radius * libm::cos(std::f64::consts::TAU * self.uniform())
    }

    /// Puts a slice into random order.
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for end in (1..items.len()).rev() {
            items.swap(end, self.0.below(end as u32 + 1) as usize);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_of_different_purpose_or_counter_differ() {
        let first = |seed, purpose, a, b| Stream::new(seed, purpose, a, b).bits();
        let base = first(1, Purpose::Actions, 2, 3);
        assert_eq!(base, first(1, Purpose::Actions, 2, 3));
        for other in [
            first(2, Purpose::Actions, 2, 3),
            first(1, Purpose::Weights, 2, 3),
            first(1, Purpose::Actions, 3, 2),
            first(1, Purpose::Actions, 2, 4),
        ] {
            assert_ne!(base, other);
        }
    }

    #[test]
    fn normal_draws_have_mean_zero_and_variance_one() {
        let mut stream = Stream::new(7, Purpose::Weights, 0, 0);
        let draws: Vec<f64> = (0..20_000).map(|_| stream.normal()).collect();
        let mean = draws.iter().sum::<f64>() / draws.len() as f64;
        let variance = draws.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / draws.len() as f64;
        assert!(mean.abs() < 0.03 && (variance - 1.0).abs() < 0.05, "{mean} {variance}");
    }
}
