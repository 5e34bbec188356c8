//! A run's directory has one trainer at a time.

use std::sync::atomic::{AtomicUsize, Ordering};

use hasard_learn::config::{AlgorithmKind, EnvConfig, Preset, TrainConfig};
use hasard_learn::runs::run_directory::RunDirectory;

/// Trainings that cannot begin take their lock's file with them, while others wait for it.
#[test]
fn never_two_in_a_directory_whose_lock_comes_and_goes() {
    let env = EnvConfig::new("RemedyRushLevel1-v0");
    let config = TrainConfig::new(AlgorithmKind::Ppo, Preset::Quick, env).unwrap();
    let run = std::env::temp_dir().join(format!("hasard-one-trainer-{}", std::process::id()));
    std::fs::create_dir_all(&run).unwrap();
    let (inside, entered) = (AtomicUsize::new(0), AtomicUsize::new(0));
    std::thread::scope(|threads| {
        for _ in 0..4 {
            threads.spawn(|| {
                for _ in 0..100 {
                    let Ok(held) = RunDirectory::create(&run, &config) else { continue };
                    assert_eq!(
                        inside.fetch_add(1, Ordering::SeqCst),
                        0,
                        "two trainers in one directory"
                    );
                    entered.fetch_add(1, Ordering::SeqCst);
                    std::thread::sleep(std::time::Duration::from_millis(1));
                    inside.fetch_sub(1, Ordering::SeqCst);
                    held.withdraw();
                }
            });
        }
    });
    assert!(entered.into_inner() > 0);
    std::fs::remove_dir_all(&run).unwrap();
}
