//! What older versions wrote, read as what it is called now.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::config::{AlgorithmKind, TrainConfig};

impl<'de> Deserialize<'de> for TrainConfig {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<TrainConfig, D::Error> {
        let mut config = TrainConfig::deserialize(from)?;
        name_rightly(&mut config);
        Ok(config)
    }
}

impl Serialize for TrainConfig {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        TrainConfig::serialize(self, to)
    }
}

/// A multiplier with damping is the sum of an integral and of the present excess, which is a PI
/// controller: such runs were PPOPID and TRPOPID, whatever they were called.
fn name_rightly(config: &mut TrainConfig) {
    let settings = &mut config.algorithm_settings;
    let damping = std::mem::take(&mut settings.former_damping);
    let controlled = match config.algorithm {
        AlgorithmKind::PpoLag => AlgorithmKind::PpoPid,
        AlgorithmKind::TrpoLag => AlgorithmKind::TrpoPid,
        _ => return,
    };
    if damping > 0.0 {
        config.algorithm = controlled;
        settings.pid_gains = (damping, settings.multiplier_rate, 0.0);
        (settings.pid_initial, settings.pid_decay) = (settings.multiplier_initial, 0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{EnvConfig, MultiplierUpdate, Preset};

    /// A2: the quick preset's PPOLag of older versions, read by the name of the rule that moved its
    /// multiplier.
    #[test]
    fn a_damped_multiplier_is_read_as_the_pid_controller_that_it_was() {
        let plain =
            TrainConfig::plain(AlgorithmKind::PpoLag, Preset::Quick, EnvConfig::new("test"));
        let mut file = serde_json::to_value(&plain).unwrap();
        let settings = file["algorithm_settings"].as_object_mut().unwrap();
        settings.remove("multiplier_update");
        settings.remove("pid_reference_budget");
        settings.insert("multiplier_damping".into(), 1.5.into());
        settings.insert("multiplier_rate".into(), 0.01.into());
        settings.insert("multiplier_reference_budget".into(), 45.0.into());
        let old: TrainConfig = serde_json::from_value(file.clone()).unwrap();
        let settings = &old.algorithm_settings;
        assert_eq!(old.algorithm, AlgorithmKind::PpoPid);
        assert_eq!(
            (settings.pid_gains, settings.pid_initial, settings.pid_decay),
            ((1.5, 0.01, 0.0), 0.0, 0.0)
        );
        assert_eq!(settings.pid_reference_budget, Some(45.0));
        assert_eq!(settings.multiplier_update, MultiplierUpdate::Minibatch);
        // What is written from then on says so itself.
        let again = serde_json::to_value(&old).unwrap();
        assert_eq!(again["algorithm"], "PPOPID");
        assert_eq!(serde_json::from_value::<TrainConfig>(again).unwrap(), old);
        file["algorithm_settings"]["multiplier_damping"] = 0.0.into();
        assert_eq!(
            serde_json::from_value::<TrainConfig>(file).unwrap().algorithm,
            AlgorithmKind::PpoLag
        );
    }
}
