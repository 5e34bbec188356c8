//! Files that once broke a limit, or try to, break none; valid samples are let in.

use hasard_fuzz::targets;
use hasard_fuzz::verdict::{Verdict, try_input};
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Memory is counted for the whole process: one test at a time, lest an input is blamed for what
/// another test holds.
fn alone() -> MutexGuard<'static, ()> {
    static ALONE: Mutex<()> = Mutex::new(());
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}

#[test]
fn hostile_files_break_no_limit() {
    let _alone = alone();
    let mut tried = 0;
    for target in targets::ALL {
        let folder = Path::new("hostile").join(target.name);
        let mut files: Vec<_> = std::fs::read_dir(&folder)
            .into_iter()
            .flatten()
            .map(|entry| entry.unwrap().path())
            .collect();
        files.sort();
        for file in files {
            let verdict = try_input(target, &std::fs::read(&file).unwrap());
            assert!(!matches!(verdict, Verdict::Failed(..)), "{}: {verdict:?}", file.display());
            tried += 1;
        }
    }
    assert!(tried >= 30, "{tried} files");
}

#[test]
fn valid_samples_are_accepted() {
    let _alone = alone();
    for target in targets::ALL {
        for (index, sample) in (target.samples)().iter().enumerate() {
            assert_eq!(
                try_input(target, sample),
                Verdict::Accepted,
                "{} sample {index}",
                target.name
            );
            assert!(
                (target.repair)(sample.clone()) == *sample,
                "{} sample {index} needs no repair",
                target.name
            );
        }
    }
}
