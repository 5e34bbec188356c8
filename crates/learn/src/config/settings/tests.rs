use super::*;
use crate::config::{AlgorithmKind, EnvConfig, Preset, RecurrentCell};

fn config(preset: Preset) -> TrainConfig {
    TrainConfig::new(AlgorithmKind::PpoLag, preset, EnvConfig::new("RemedyRushLevel1-v0")).unwrap()
}

fn all(settings: &[&str]) -> Vec<String> {
    settings.iter().map(|setting| (*setting).to_string()).collect()
}

#[test]
fn runs_are_unlike_by_what_they_learn_with() {
    let one = config(Preset::Quick);
    let with = |settings: &[&str]| one.with_all(&all(settings)).unwrap();
    assert_eq!(one.unlike(&one), None);
    assert_eq!(
        one.unlike(&with(&["frames=99", "learning.threads=7", "evaluation.episodes=3"])),
        None
    );
    let (name, ..) = one.unlike(&with(&["reporting.window=7", "reporting.keep=7"])).unwrap();
    assert_eq!(name, "reporting.window");
    let (one, other) = (with(&["learning.gamma=0.97"]), with(&["learning.gamma=0.5"]));
    let (name, own, others) = one.unlike(&other).unwrap();
    assert_eq!((name.as_str(), own, others), ("learning.gamma", 0.97.into(), 0.5.into()));
}

/// A run that was extended, or had its rate changed on the way, is unlike others in all else.
#[test]
fn a_change_on_the_way_hides_no_other_difference() {
    let one = config(Preset::Quick).with_all(&all(&["network.mirror=true"])).unwrap();
    let longer = one.resumed_with(&all(&["frames=20000000", "learning.rate=0.01"]), 5).unwrap();
    assert!(longer.changes.len() > 1, "{:?}", longer.changes);
    assert_eq!(longer.unlike(&one), None);
    let plain = config(Preset::Quick);
    for (own, other) in [(&longer, &plain), (&plain, &longer)] {
        let names: Vec<String> = own.all_unlike(other).into_iter().map(|(name, ..)| name).collect();
        assert_eq!(names, ["network.mirror"]);
    }
}

#[test]
fn a_learning_rate_without_an_end_is_constant() {
    for preset in [Preset::Paper, Preset::Quick] {
        let rates = |settings: &[&str]| {
            let learning = config(preset).with_all(&all(settings)).unwrap().learning;
            [learning.rate_after(0.0), learning.rate_after(0.5), learning.rate_after(1.0)]
        };
        assert_eq!(rates(&["learning.rate=1e-5"]), [1e-5; 3], "{preset}");
        for order in [
            ["learning.rate=4e-4", "learning.final_rate=2e-4"],
            ["learning.final_rate=2e-4", "learning.rate=4e-4"],
        ] {
            let [first, middle, last] = rates(&order);
            assert_eq!((first, last), (4e-4, 2e-4), "{preset}");
            assert!((middle - 3e-4).abs() < 1e-15);
        }
    }
}

#[test]
fn what_others_hang_on_is_not_set_alone() {
    for (setting, instead) in [
        ("env.frame_skip=2", "--frame-skip"),
        ("env.rules=released", "--rules"),
        ("preset=quick", "--preset"),
        ("algorithm=PPO", "--algo"),
        ("env/hard=true", "--hard"),
        ("env={}", "set the parts"),
    ] {
        let message = config(Preset::Paper).with(setting).unwrap_err().to_string();
        assert!(message.contains(instead) && message.contains("hang on"), "{setting}: {message}");
    }
    assert_eq!(config(Preset::Paper).with("env.frame_stack=2").unwrap().env.frame_stack, 2);
}

#[test]
fn settings_that_few_change_have_names_too() {
    let base = config(Preset::Paper);
    assert!(base.with("learning.reuse_forward=true").unwrap().learning.reuse_forward);
    assert!(base.with("learning.portable=true").unwrap().learning.portable);
    assert_eq!(base.with("network.cell=lstm").unwrap().network.cell, RecurrentCell::Lstm);
    let message = base.with("network.cell=elman").unwrap_err().to_string();
    assert!(message.contains("elman") && message.contains("lstm"), "{message}");
}

#[test]
fn changes_of_a_resumed_run_are_written_down() {
    let config = config(Preset::Quick);
    let changed = config
        .resumed_with(&all(&["seed=9", "learning.rate=1e-4", "frames=5000000"]), 4096)
        .unwrap();
    let changes: Vec<String> = changed
        .changes
        .iter()
        .map(|one| format!("{} {} {}", one.setting, one.from, one.to))
        .collect();
    assert_eq!(
        changes,
        [
            "frames 10000000 5000000",
            "learning.final_rate 0.0001 null",
            "learning.rate 0.0005 0.0001",
            "seed 1 9"
        ]
    );
    assert!(changed.reseeded_at(4096) && !changed.reseeded_at(8192));
    // Asked for once more, nothing is new; and a run that falls back to an older checkpoint
    // changes there.
    let again = changed.resumed_with(&all(&["seed=9"]), 2048).unwrap();
    assert_eq!(again.changes.len(), 4);
    assert!(again.changes.iter().all(|one| one.frames == 2048));
    assert!(
        changed
            .resumed_with(&all(&["learning.threads=3", "reporting.keep=5"]), 9000)
            .unwrap()
            .changes
            .len()
            == 4
    );
    let message = changed.resumed_with(&all(&["frames=4096"]), 8192).unwrap_err().to_string();
    assert!(message.contains("4096") && message.contains("8192"), "{message}");
    assert!(
        changed.resumed_with(&all(&["frames=5000000"]), 5_001_216).is_ok(),
        "it ended with its last rollout"
    );
    for gamma in ["learning.gamma=0.9", "learning/gamma=0.9"] {
        let message = config.resumed_with(&all(&[gamma]), 0).unwrap_err().to_string();
        assert!(message.contains("learning.gamma") && message.contains("--init-from"), "{message}");
    }
}

/// Rates and the multiplier's speed hang on frames. Gone on with for twice as long, a run
/// neither jumps back in its schedule nor stretches it, and says that it was extended.
#[test]
fn an_extended_run_keeps_its_schedule() {
    let config = config(Preset::Quick);
    let rate =
        |config: &TrainConfig, frames: u64| config.learning.rate_after(config.progress(frames));
    let begun = config.clone().begun();
    assert_eq!(begun.learning.schedule_frames, Some(10_000_000));
    // From 5e-4 to 1e-4 within 10 million frames.
    assert!((rate(&begun, 5_000_000) - 3e-4).abs() < 1e-15);
    for run in [&begun, &config] {
        let longer = run.resumed_with(&all(&["frames=20000000"]), 5_000_000).unwrap();
        for frames in [5_000_000, 7_500_000, 10_000_000] {
            assert_eq!(rate(&longer, frames), rate(&begun, frames));
        }
        assert!(
            (rate(&longer, 20_000_000) - 1e-4).abs() < 1e-15 && longer.progress(20_000_000) == 1.0
        );
        assert_eq!((longer.extended_from(), run.extended_from()), (Some(10_000_000), None));
        let changes: Vec<&str> =
            longer.changes.iter().map(|change| change.setting.as_str()).collect();
        assert_eq!(changes, ["frames"]);
    }
    let shorter = begun.resumed_with(&all(&["frames=7000000"]), 5_000_000).unwrap();
    assert_eq!(
        (shorter.extended_from(), rate(&shorter, 5_000_000)),
        (None, rate(&begun, 5_000_000))
    );
    // Who wants another schedule says so, and that is written down too.
    let stretched = begun
        .resumed_with(&all(&["frames=20000000", "learning.schedule_frames=20000000"]), 5_000_000)
        .unwrap();
    assert_eq!((stretched.progress(5_000_000), stretched.changes.len()), (0.25, 2));
    assert_eq!(
        config.with("learning.schedule_frames=400").unwrap().begun().learning.schedule_frames,
        Some(400)
    );
}
