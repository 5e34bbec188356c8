use super::*;
use crate::config::CriticInput;

#[test]
fn bad_settings_are_refused_by_name() {
    let good = TrainConfig::new(
        AlgorithmKind::PpoLag,
        Preset::Paper,
        EnvConfig::new("RemedyRushLevel1-v0"),
    )
    .unwrap();
    let refuse = |change: fn(&mut TrainConfig), word: &str| {
        let mut config = good.clone();
        change(&mut config);
        let message = config.check().unwrap_err().to_string();
        assert!(message.contains(word), "{message}");
    };
    refuse(|c| (c.sampling.lanes, c.sampling.groups) = (33, 2), "number of worlds");
    refuse(|c| c.learning.gamma = 1.5, "gamma");
    refuse(|c| c.learning.rate = f64::NAN, "learning rate");
    refuse(|c| c.constraints[0].budget = -1.0, "budget");
    refuse(|c| c.frames = 0, "frames");
    refuse(
        |c| (c.learning.normaliser, c.sampling.synchronous) = (ReturnNormaliser::PopArt, false),
        "normaliser of returns cannot be popart",
    );
    refuse(|c| c.learning.critic_inputs = vec![CriticInput::TimeLeft; 2], "'time-left' twice");
    refuse(
        |c| (c.sampling.rollout, c.learning.recurrence) = (48, Some(32)),
        "multiple of the recurrence (32)",
    );
    refuse(|c| c.algorithm_settings.critic_steps = 0, "steps of the critics");
    for algorithm in [AlgorithmKind::PpoSaute, AlgorithmKind::PpoCost] {
        let mut config = TrainConfig { algorithm, ..good.clone() };
        config.constraints.push(config.constraints[0].clone());
        let message = config.check().unwrap_err().to_string();
        assert!(
            message.contains("number of constraints cannot be 2")
                && message.contains(algorithm.name()),
            "{message}"
        );
    }
    refuse(|c| c.constraints[0].term = Some("rain".into()), "harmful_items");
    assert!("ppolag".parse::<AlgorithmKind>().is_ok());
    let message = "PPOLagg".parse::<AlgorithmKind>().unwrap_err().to_string();
    assert!(message.contains("PPOLagg") && message.contains("P3O"), "{message}");
    assert!(
        TrainConfig::new(AlgorithmKind::Ppo, Preset::Paper, EnvConfig::new("Nonsense-v0")).is_err()
    );
}
