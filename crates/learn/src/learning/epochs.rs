//! How often a rollout is gone through, and in which minibatches.

use crate::config::TrainConfig;
use crate::random::{Purpose, Stream};
use crate::threads::deal;

/// The epochs over one rollout.
#[derive(Clone, Debug)]
pub struct Epochs {
    seed: u64,
    /// Number of the rollout.
    rollout: u64,
    lanes: usize,
    /// How many.
    pub count: usize,
    /// Number of the first, by which lanes are dealt.
    first: u64,
    minibatches: usize,
    target_kl: Option<f64>,
}

impl Epochs {
    /// The epochs over a rollout of a number of lanes, the `rollout`th of the run.
    #[must_use]
    pub fn new(config: &TrainConfig, rollout: u64, lanes: usize) -> Epochs {
        let learning = &config.learning;
        let (count, minibatches, target_kl) =
            (learning.epochs, learning.minibatches, learning.target_kl);
        Epochs { seed: config.seed, rollout, lanes, count, first: 0, minibatches, target_kl }
    }

    /// The passes of the critics' phase after it, dealt otherwise.
    #[must_use]
    pub fn of_values(config: &TrainConfig, rollout: u64, lanes: usize) -> Epochs {
        let own = Epochs::new(config, rollout, lanes);
        Epochs {
            count: config.learning.value_phase_passes,
            target_kl: None,
            first: config.learning.epochs as u64,
            ..own
        }
    }

    /// The lanes of each minibatch of an epoch: dealt anew every time, unless one minibatch takes
    /// them all.
    #[must_use]
    pub fn minibatches(&self, epoch: usize) -> Vec<Vec<usize>> {
        let mut lanes: Vec<usize> = (0..self.lanes).collect();
        if self.minibatches > 1 {
            Stream::new(self.seed, Purpose::Shuffle, self.rollout, self.first + epoch as u64)
                .shuffle(&mut lanes);
        }
        deal(self.lanes, self.minibatches).map(|part| lanes[part].to_vec()).collect()
    }

    /// Whether the policy has moved far enough; where no target is set its divergence is not asked
    /// for.
    #[must_use]
    pub fn end_at(&self, divergence: impl FnOnce() -> f64) -> bool {
        self.target_kl.is_some_and(|target| divergence() > target)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{AlgorithmKind, EnvConfig, Preset};

    #[test]
    fn every_lane_is_in_one_minibatch_of_an_epoch_and_epochs_differ() {
        let mut config =
            TrainConfig::plain(AlgorithmKind::Ppo, Preset::Paper, EnvConfig::new("test"));
        assert_eq!(Epochs::new(&config, 3, 4).minibatches(0), [[0, 1, 2, 3]]);
        config.learning.minibatches = 3;
        config.learning.target_kl = Some(0.02);
        let epochs = Epochs::new(&config, 3, 8);
        let (first, second) = (epochs.minibatches(0), epochs.minibatches(1));
        assert_eq!(first.iter().map(Vec::len).collect::<Vec<_>>(), [3, 3, 2]);
        let mut all = first.concat();
        all.sort_unstable();
        assert_eq!(all, (0..8).collect::<Vec<_>>());
        assert_ne!(first, second);
        assert_ne!(first, Epochs::new(&config, 4, 8).minibatches(0));
        // 6 lanes in 4 minibatches were dealt into 3.
        for (lanes, count) in
            (1..=40).flat_map(|lanes| (1..=lanes).map(move |count| (lanes, count)))
        {
            config.learning.minibatches = count;
            let sizes: Vec<usize> =
                Epochs::new(&config, 0, lanes).minibatches(0).iter().map(Vec::len).collect();
            assert_eq!((sizes.len(), sizes.iter().sum()), (count, lanes));
            assert!(sizes.iter().max().unwrap() - sizes.iter().min().unwrap() <= 1);
        }
        assert!(epochs.end_at(|| 0.03) && !epochs.end_at(|| 0.01));
        let endless = Epochs { target_kl: None, ..epochs };
        assert!(!endless.end_at(|| panic!("nobody asks")));
    }
}
