//! Depth and labels predicted from what policy and critics are computed from: what is predicted, and
//! what a row's picture shows of it.

use hasard_envs::Insight;
use hasard_envs::insight::{CELLS, THINGS};

use crate::config::TrainConfig;

/// Mean depths at which the next band begins, 7.3 map units each: bands as Mirowski et al. have
/// them, finer where it is near.
const BANDS: [u8; 7] = [6, 12, 20, 32, 48, 72, 112];

/// What is predicted, and how much it counts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Auxiliary {
    pub(crate) depth: f64,
    pub(crate) labels: f64,
}

impl Auxiliary {
    /// What a run's network predicts.
    #[must_use]
    pub fn new(config: &TrainConfig) -> Auxiliary {
        let learning = &config.learning;
        Auxiliary { depth: learning.auxiliary_depth, labels: learning.auxiliary_labels }
    }

    /// What the worlds have to show for it.
    #[must_use]
    pub fn insight(self) -> Insight {
        Insight { depth: self.depth > 0.0, labels: self.labels > 0.0, ..Insight::default() }
    }

    /// The name of each prediction's loss, its weight, and the classes of a cell.
    pub(crate) fn classes(self) -> impl Iterator<Item = (&'static str, f64, usize)> {
        [
            ("auxiliary_depth_loss", self.depth, BANDS.len() + 1),
            ("auxiliary_labels_loss", self.labels, THINGS + 1),
        ]
        .into_iter()
        .filter(|(_, weight, _)| *weight > 0.0)
    }

    /// Outputs of the head.
    #[must_use]
    pub fn outputs(self) -> usize {
        self.classes().map(|(.., classes)| CELLS * classes).sum()
    }

    /// Cells of a row that are predicted.
    #[must_use]
    pub fn cells(self) -> usize {
        CELLS * self.classes().count()
    }

    /// Classes of the cells of a row that a world has shown: depth first, then labels.
    pub fn targets(self, what: Insight, shown: &[u8]) -> impl Iterator<Item = u8> {
        let [_, _, depth, labels] = what.places();
        let band = |&depth: &u8| BANDS.iter().filter(|&&from| depth >= from).count() as u8;
        let depth = if self.depth > 0.0 { &shown[depth] } else { &[] };
        let labels = if self.labels > 0.0 { &shown[labels] } else { &[] };
        depth.iter().map(band).chain(labels.iter().copied())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: bands begin at the depths of the list; groups of things are classes themselves.
    #[test]
    fn depths_become_bands() {
        let auxiliary = Auxiliary { depth: 1.0, labels: 1.0 };
        let what = Insight { state: true, ..auxiliary.insight() };
        let mut shown = vec![0; what.bytes()];
        let [_, _, depth, labels] = what.places();
        shown[depth.start..depth.start + 6].copy_from_slice(&[0, 5, 6, 47, 48, 255]);
        shown[labels.start + 1] = 10;
        let targets: Vec<u8> = auxiliary.targets(what, &shown).collect();
        assert_eq!(targets[..6], [0, 0, 1, 4, 5, 7]);
        assert_eq!((targets.len(), targets[32], targets[33]), (64, 0, 10));
    }
}
