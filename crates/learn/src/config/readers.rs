//! Which algorithms read a setting of `algorithm_settings`: of the others it changes nothing.

use crate::config::AlgorithmKind;

/// Whether an algorithm reads a setting.
type Reads = fn(AlgorithmKind) -> bool;

/// Settings by the beginning of their names, the longer ones first, and who reads them.
const READERS: [(&str, Reads); 15] = [
    ("multiplier_update", |one| one.has_multipliers() || one == AlgorithmKind::Ipo),
    ("multiplier_limit", AlgorithmKind::has_multipliers),
    ("multiplier_", |one| {
        use AlgorithmKind::{Cup, Focops, PpoLag, TrpoLag};
        matches!(one, PpoLag | TrpoLag | Focops | Cup)
    }),
    ("penalty_", |one| one == AlgorithmKind::PpoCost),
    ("pid_", |one| matches!(one, AlgorithmKind::PpoPid | AlgorithmKind::TrpoPid)),
    ("p3o_", |one| one == AlgorithmKind::P3o),
    ("saute_", |one| one == AlgorithmKind::PpoSaute),
    ("trpo_", |one| one.is_second_order() && one != AlgorithmKind::Cpo),
    ("trust_", AlgorithmKind::is_second_order),
    ("conjugate_", AlgorithmKind::is_second_order),
    ("fisher_", AlgorithmKind::is_second_order),
    ("critic_", AlgorithmKind::is_second_order),
    ("line_search_", AlgorithmKind::is_second_order),
    ("focops_", |one| one == AlgorithmKind::Focops),
    ("ipo_", |one| one == AlgorithmKind::Ipo),
];

/// The algorithms that read a setting, if it is one of `algorithm_settings`.
#[must_use]
pub fn readers(setting: &str) -> Option<Vec<AlgorithmKind>> {
    let name = setting.strip_prefix("algorithm_settings.")?;
    let (_, reads) = READERS.iter().find(|(beginning, _)| name.starts_with(beginning))?;
    Some(AlgorithmKind::ALL.iter().copied().filter(|one| reads(*one)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{EnvConfig, Preset, TrainConfig};

    /// A setting that is added must be thought of here.
    #[test]
    fn every_setting_of_an_algorithm_has_readers() {
        let env = EnvConfig::new("RemedyRushLevel1-v0");
        let config = TrainConfig::new(AlgorithmKind::Ppo, Preset::Quick, env).unwrap();
        let all = serde_json::to_value(&config.algorithm_settings).unwrap();
        for name in all.as_object().unwrap().keys() {
            let found = readers(&format!("algorithm_settings.{name}"));
            assert!(found.is_some_and(|found| !found.is_empty()), "{name}");
        }
        assert_eq!(readers("learning.gamma"), None);
    }
}
