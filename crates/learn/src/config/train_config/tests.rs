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
    refuse(|c| c.learning.final_gamma = Some(1.1), "the final gamma cannot be 1.1");
    refuse(|c| c.learning.final_gae_lambda = Some(-0.1), "the final lambda cannot be -0.1");
    refuse(
        |c| (c.algorithm, c.learning.final_gamma) = (AlgorithmKind::Cup, Some(1.0)),
        "below 1 for CUP",
    );
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
    refuse(
        |c| {
            (c.network.separate, c.learning.critic_rate) = (true, Some(0.001));
            (c.learning.rate, c.learning.final_rate) = (0.0, Some(0.001));
        },
        "null where learning.rate is 0",
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

/// Every run of a file assumed 525 steps: budgets by the step, Saute's horizon and the random
/// steps that spread worlds out were those of other episodes.
#[test]
fn episodes_of_a_file_are_as_long_as_it_says() {
    let path = std::env::temp_dir().join(format!("hasard-short-{}.toml", std::process::id()));
    let text = "[scenario]\nname = \"ShortOne\"\ntics = 70\n[map]\nbuiltin = \"RemedyRush\"\n[levels.2]\nscenario.tics = 141\n";
    std::fs::write(&path, text).unwrap();
    let id = hasard_envs::own::open(path.to_str().unwrap()).unwrap().to_string();
    let env = EnvConfig::new(&id);
    let config = |preset| TrainConfig::new(AlgorithmKind::PpoPid, preset, env.clone()).unwrap();
    assert_eq!(config(Preset::Quick).episode_steps, 18);
    let horizon = |preset| config(preset).algorithm_settings.saute_horizon;
    assert_eq!((horizon(Preset::Paper), horizon(Preset::Released)), (18.0, 72.0));
    let mut lessons = config(Preset::Quick);
    let lesson = |level| crate::config::curriculum::Lesson { level, frames: 100 };
    lessons.set_curriculum(vec![lesson(2), lesson(1)]);
    assert_eq!(lessons.episode_steps, 36, "the longest of its levels");
    let both = EnvConfig::new(&format!("{id},RemedyRushLevel1-v0"));
    let mixed = TrainConfig::new(AlgorithmKind::PpoPid, Preset::Quick, both).unwrap();
    assert_eq!(mixed.episode_steps, 525);
    std::fs::remove_file(path).unwrap();
}

/// The discount of costs is that of rewards at the time, but for one of their own.
#[test]
fn a_discount_goes_to_its_end_in_a_straight_line() {
    let mut config =
        TrainConfig::plain(AlgorithmKind::PpoLag, Preset::Paper, EnvConfig::new("test"));
    config.frames = 1000;
    let learning = &mut config.learning;
    (learning.gamma, learning.final_gamma) = (0.75, Some(1.0));
    (learning.gae_lambda, learning.final_gae_lambda) = (0.5, Some(0.0));
    let all = [0.0, 0.5, 1.0].map(|share| config.learning.horizon_after(share));
    assert_eq!(all, [(0.75, 0.5), (0.875, 0.25), (1.0, 0.0)]);
    assert_eq!([0, 500, 2000].map(|frames| config.cost_gamma_after(frames)), [0.75, 0.875, 1.0]);
    config.learning.cost_gamma = Some(0.6);
    assert_eq!(config.cost_gamma_after(500), 0.6);
}
