//! When a run's agent is evaluated, on episodes that it never learned from.

use serde::{Deserialize, Serialize};

use super::TrainConfig;

/// When and how long a run's agent is evaluated.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct EvaluationConfig {
    /// Frames between evaluations, 0 for none; `null` for a twentieth of the run, and none in a short one.
    pub every: Option<u64>,
    /// Episodes of an evaluation.
    pub episodes: usize,
    /// Further episodes by which a checkpoint must prove itself before the run hands it out.
    pub confirming_episodes: usize,
}

impl Default for EvaluationConfig {
    fn default() -> EvaluationConfig {
        EvaluationConfig { every: None, episodes: 32, confirming_episodes: 100 }
    }
}

/// Evaluations of a run that does not say how often.
const EVALUATIONS: u64 = 20;
/// Frames of a run that is worth them: the episodes that choose, confirm and close are some 500,000 frames themselves.
const WORTH_EVALUATING: u64 = 400_000;

impl TrainConfig {
    /// Whether an evaluation falls between two moments of the run, the second included. The end of a run is one.
    #[must_use]
    pub fn evaluates(&self, before: u64, frames: u64) -> bool {
        let every = self.frames_between_evaluations();
        let ends = before < self.frames && self.frames <= frames;
        every > 0 && (ends || before / every < frames / every)
    }

    /// Whether the run is evaluated at its end: every run that is evaluated at all.
    #[must_use]
    pub fn evaluates_at_its_end(&self) -> bool {
        self.frames_between_evaluations() > 0
    }

    fn frames_between_evaluations(&self) -> u64 {
        let short = self.frames < WORTH_EVALUATING;
        self.evaluation.every.unwrap_or(if short { 0 } else { self.frames.div_ceil(EVALUATIONS) })
    }
}

#[cfg(test)]
mod tests {
    use crate::config::{AlgorithmKind, EnvConfig, Preset, TrainConfig};

    #[test]
    fn a_run_is_evaluated_by_frames_and_at_its_end() {
        let mut config = TrainConfig::plain(AlgorithmKind::PpoLag, Preset::Paper, EnvConfig::new("test"));
        config.frames = 1000;
        let at = |config: &TrainConfig| -> Vec<u64> {
            (0..11).map(|k| k * 96).filter(|&before| config.evaluates(before, before + 96)).map(|before| before + 96).collect()
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
        let evaluated = (0..977).filter(|rollout| config.evaluates(rollout * 4096, (rollout + 1) * 4096)).count();
        assert_eq!(evaluated, 20);
    }
}
