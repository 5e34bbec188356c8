//! The world's random stream.

/// A small splittable random stream: SplitMix64 (Steele, Lea, Flood: *Fast splittable pseudorandom
/// number generators*, OOPSLA 2014). One lives in every world, and it is the whole of the world's
/// randomness.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Rng {
    state: u64,
}

impl Rng {
    /// A stream for `seed`; neighbouring seeds give unrelated streams.
    #[must_use]
    pub fn new(seed: u64) -> Rng {
        Rng { state: mix(seed.wrapping_add(0x9E37_79B9_7F4A_7C15)) }
    }

    /// A stream for the pair (`seed`, `lane`), so that lanes of one batch never share randomness.
    #[must_use]
    pub fn for_lane(seed: u64, lane: u64) -> Rng {
        Rng {
            state: mix(Rng::new(seed).state
                ^ mix(lane.wrapping_mul(0xD1B5_4A32_D192_ED03).wrapping_add(1))),
        }
    }

    /// The state, for checkpoints.
    #[must_use]
    pub const fn state(&self) -> u64 {
        self.state
    }

    /// The stream that continues from a saved state.
    #[must_use]
    pub const fn from_state(state: u64) -> Rng {
        Rng { state }
    }

    /// The next 64 random bits.
    pub fn next_u64(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        mix(self.state)
    }

    /// A new stream split off this one.
    pub fn split(&mut self) -> Rng {
        Rng { state: mix(self.next_u64() ^ 0xA076_1D64_78BD_642F) }
    }

    /// Uniform in `0..bound` (`bound` > 0), by the multiply-high method; its bias is below 2^-32.
    pub fn below(&mut self, bound: u32) -> u32 {
        (((self.next_u64() >> 32) * u64::from(bound)) >> 32) as u32
    }

    /// Uniform in `low..=high`, ends swapped if out of order: the scripts' `random(a, b)`.
    pub fn between(&mut self, low: i32, high: i32) -> i32 {
        let (low, high) = if low <= high { (low, high) } else { (high, low) };
        let span = (i64::from(high) - i64::from(low) + 1) as u64;
        (i64::from(low) + ((u128::from(self.next_u64()) * u128::from(span)) >> 64) as i64) as i32
    }

    /// Uniform over the raw fixed-point values `low..=high`.
    pub fn between_fixed(&mut self, low: super::Fixed, high: super::Fixed) -> super::Fixed {
        super::Fixed(self.between(low.0, high.0))
    }

    /// Uniform in 0..=255, the engine's basic draw.
    pub fn byte(&mut self) -> i32 {
        (self.next_u64() >> 56) as i32
    }

    /// The difference of two basic draws: triangular in -255..=255.
    pub fn signed_difference(&mut self) -> i32 {
        self.byte() - self.byte()
    }
}

fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_and_seeds_differ() {
        let mut seen = std::collections::BTreeSet::new();
        for seed in 0..64 {
            for lane in 0..64 {
                assert!(
                    seen.insert(Rng::for_lane(seed, lane).next_u64()),
                    "seed {seed} lane {lane}"
                );
            }
        }
    }

    #[test]
    fn a_saved_stream_continues() {
        let mut rng = Rng::new(7);
        rng.next_u64();
        let mut copy = Rng::from_state(rng.state());
        assert_eq!(rng.next_u64(), copy.next_u64());
    }

    #[test]
    fn both_ends_of_a_range_are_drawn() {
        let mut rng = Rng::new(1);
        let draws: Vec<i32> = (0..200).map(|_| rng.between(3, -1)).collect();
        assert_eq!((*draws.iter().min().unwrap(), *draws.iter().max().unwrap()), (-1, 3));
    }
}
