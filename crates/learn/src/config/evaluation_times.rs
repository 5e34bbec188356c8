//! At which frames a run is evaluated, and on how many episodes.

use crate::config::train_config::TrainConfig;

/// Most evaluations of a run that does not say how often: those of the first half are never the
/// best.
const EVALUATIONS: u64 = 10;

/// They take no more than this part of the run's frames.
const SHARE: u64 = 20;

/// Further episodes of a run that does not say how many, at most and at least.
const CONFIRMING: (u64, u64) = (100, 10);

/// Frames of a run that is worth them.
const WORTH_EVALUATING: u64 = 400_000;

impl TrainConfig {
    /// Whether an evaluation falls between two moments of the run, the second included. The end of
    /// a run is one.
    #[must_use]
    pub fn evaluates(&self, before: u64, frames: u64) -> bool {
        let ends = before < self.frames && self.frames <= frames;
        if let Some(every) = self.evaluation.every {
            return every > 0 && (ends || before / every < frames / every);
        }
        if self.frames < WORTH_EVALUATING {
            return false;
        }
        let each = (self.evaluation.episodes as u64 * self.longest_episode()).max(1);
        let count = (self.frames / SHARE / each).clamp(1, EVALUATIONS);
        // Counted from the end, so that it is one of them.
        let every = self.frames.div_ceil(2 * count);
        let left = |frames: u64| self.frames.saturating_sub(frames).div_ceil(every);
        ends || (left(before) > left(frames) && left(frames) < count)
    }

    /// Frames of the longest episode.
    fn longest_episode(&self) -> u64 {
        (u64::from(self.episode_steps) * u64::from(self.env.frame_skip)).max(1)
    }

    /// Episodes that confirm a checkpoint, and those of every closing evaluation.
    #[must_use]
    pub fn confirming_episodes(&self) -> usize {
        let (most, least) = CONFIRMING;
        let affordable = (self.frames / SHARE / self.longest_episode()).clamp(least, most);
        self.evaluation.confirming_episodes.unwrap_or(affordable as usize)
    }

    /// Whether the run is evaluated at its end: every run that is evaluated at all.
    #[must_use]
    pub fn evaluates_at_its_end(&self) -> bool {
        self.evaluation.every.map_or(self.frames >= WORTH_EVALUATING, |every| every > 0)
    }
}

#[cfg(test)]
mod tests {
    use crate::config::{AlgorithmKind, EnvConfig, Preset, TrainConfig};

    #[test]
    fn a_run_is_evaluated_by_frames_and_at_its_end() {
        let mut config =
            TrainConfig::plain(AlgorithmKind::PpoLag, Preset::Paper, EnvConfig::new("test"));
        config.frames = 1000;
        let at = |config: &TrainConfig| -> Vec<u64> {
            (0..11)
                .map(|k| k * 96)
                .filter(|&before| config.evaluates(before, before + 96))
                .map(|before| before + 96)
                .collect()
        };
        assert!(at(&config).is_empty(), "a short run is not evaluated unless it is asked for");
        config.evaluation.every = Some(50);
        assert_eq!(at(&config).len(), 11, "50 frames are fewer than a rollout's");
        config.evaluation.every = Some(400);
        // The rollouts that reach 400, 800 and the end.
        assert_eq!(at(&config), [480, 864, 1056]);
        config.evaluation.every = Some(0);
        assert!(at(&config).is_empty());
        (config.frames, config.evaluation.every) = (4_000_000, None);
        // 32 episodes of 2,100 frames are 67,200 frames: two evaluations are no more than a
        // twentieth of 4 million frames, ten of 16 million.
        let rollouts = |frames: u64| frames.div_ceil(4096);
        let evaluated = |config: &TrainConfig| -> Vec<u64> {
            let at = |rollout: &u64| config.evaluates(rollout * 4096, (rollout + 1) * 4096);
            (0..rollouts(config.frames) + 3)
                .filter(at)
                .map(|rollout| (rollout + 1) * 4096)
                .collect()
        };
        assert_eq!(evaluated(&config), [3_002_368, 4_001_792]);
        config.frames = 16_000_000;
        let at = evaluated(&config);
        assert_eq!((at.len(), at[9]), (10, rollouts(16_000_000) * 4096));
        assert!(at[0] > 8_000_000 && at.len() as u64 * 67_200 <= 16_000_000 / 20);
        // However little is left of a twentieth, the end is evaluated.
        config.frames = 500_000;
        assert_eq!(evaluated(&config), [rollouts(500_000) * 4096]);
    }

    /// Two sets of a twentieth of a million frames each, of episodes of 2,100 frames: 23.
    #[test]
    fn short_runs_are_confirmed_and_closed_in_proportion() {
        let mut config =
            TrainConfig::plain(AlgorithmKind::PpoLag, Preset::Paper, EnvConfig::new("test"));
        for (frames, episodes) in
            [(100_000, 10), (400_000, 10), (1_000_000, 23), (4_200_000, 100), (500_000_000, 100)]
        {
            config.frames = frames;
            assert_eq!(config.confirming_episodes(), episodes, "{frames}");
        }
        config.evaluation.confirming_episodes = Some(7);
        assert_eq!(config.confirming_episodes(), 7);
    }
}
