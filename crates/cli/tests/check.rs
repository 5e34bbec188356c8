//! The status of `./check`, with a cargo, a formatter and a Python check that only say how they
//! ended.
#![cfg(unix)]

use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;

fn write_script(path: &Path, text: &str) {
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, format!("#!/usr/bin/env bash\n{text}\n")).unwrap();
    std::fs::set_permissions(path, std::fs::Permissions::from_mode(0o755)).unwrap();
}

/// What `./check` prints last and whether it succeeds, in a folder of its own.
fn check(name: &str, cargo_test: &str, python_check: &str) -> (String, bool) {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"))
        .join(format!("check-{}-{name}", std::process::id()));
    let real = std::fs::read_to_string("../../check").unwrap();
    write_script(&folder.join("check"), &real);
    write_script(
        &folder.join("bin/cargo"),
        &format!("if [ \"$1\" = test ] && [ \"$4\" = --no-fail-fast ]; then {cargo_test}; fi"),
    );
    write_script(&folder.join("bin/python3"), "exit 0");
    write_script(&folder.join("bin/rustfmt"), "exit 0");
    std::fs::create_dir_all(folder.join("crates")).unwrap();
    std::fs::create_dir_all(folder.join("tools")).unwrap();
    write_script(&folder.join("python/check"), python_check);
    let path = format!("{}:{}", folder.join("bin").display(), std::env::var("PATH").unwrap());
    let output = Command::new("bash").arg(folder.join("check")).env("PATH", path).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    (text.lines().last().unwrap_or_default().to_owned(), output.status.success())
}

#[test]
fn the_check_succeeds_when_all_tests_do_and_only_then() {
    let good = "echo 'test result: ok. 3 passed; 0 failed; 1 ignored; 0 measured'";
    let bad = "echo 'test result: FAILED. 2 passed; 1 failed; 1 ignored; 0 measured'; exit 101";
    assert_eq!(check("good", good, "exit 0"), ("3 passed, 0 failed, 1 skipped".into(), true));
    assert_eq!(check("rust", bad, "exit 0"), ("2 passed, 1 failed, 1 skipped".into(), false));
    assert!(!check("python", good, "exit 1").1);
}
