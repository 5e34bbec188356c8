//! What a scenario is called stands in its folder and in two lists: that of the crate `envs` and that of
//! Python. All else reads specs, so that a new scenario is one folder.

use std::path::{Path, PathBuf};

/// The names, as ids and as folders have them.
const NAMES: [&str; 12] = [
    "ArmamentBurden",
    "CollateralDamage",
    "DetonatorsDilemma",
    "PrecipicePlunge",
    "RemedyRush",
    "VolcanicVenture",
    "armament_burden",
    "collateral_damage",
    "detonators_dilemma",
    "precipice_plunge",
    "remedy_rush",
    "volcanic_venture",
];

/// The two lists, and what belongs to one scenario or one moment of its own by its nature.
const MAY: [&str; 7] = [
    "crates/envs/src/scenarios/mod.rs",
    "python/hasard_rs/registry.py",
    // The one scenario that the policy `carrier` plays, and how a witness of two of them is found.
    "crates/envs/src/policies/carrier.rs",
    "crates/play/src/witness.rs",
    // The refusal of an option that one environment has.
    "crates/envs/src/scenarios/common/spec.rs",
    // The map that a task has which names none, and an example in a message.
    "crates/envs/src/own/read.rs",
    "crates/envs/src/own/read_map.rs",
];

/// The sources of programs, without tests, examples and what compares with other packages.
fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("the folder is there").flatten() {
        let path = entry.path();
        let name = entry.file_name().to_string_lossy().into_owned();
        let other = ["tests", "examples", "benches", "compat", "fuzz", "target"];
        if path.is_dir() {
            if !other.contains(&&*name) && !NAMES.contains(&&*name) && !name.starts_with('.') {
                sources(&path, found);
            }
        } else if (name.ends_with(".rs") || name.ends_with(".py"))
            && !name.ends_with("tests.rs")
            && !name.ends_with("_test.rs")
        {
            found.push(path);
        }
    }
}

/// Without comments and tests of Rust, and without docstrings of Python.
fn program(text: &str, is_rust: bool) -> String {
    if !is_rust {
        return text.split("\"\"\"").step_by(2).collect();
    }
    let tests = ["", "pub(super) "].map(|seen| format!("\n#[cfg(test)]\n{seen}mod tests {{"));
    let end = tests.iter().find_map(|tests| text.find(tests.as_str())).unwrap_or(text.len());
    let lines = text[..end].lines().filter(|line| !line.trim_start().starts_with("//"));
    lines.collect::<Vec<_>>().join("\n")
}

#[test]
fn scenarios_are_named_in_their_folders_and_two_lists() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut files = Vec::new();
    sources(&root.join("crates"), &mut files);
    sources(&root.join("python/hasard_rs"), &mut files);
    assert!(files.len() > 500, "only {} files", files.len());
    let mut naming = Vec::new();
    for file in files {
        let text = std::fs::read_to_string(&file).expect("a source is text");
        let is_rust = file.extension().is_some_and(|ending| ending == "rs");
        let program = program(&text, is_rust);
        if NAMES.iter().any(|name| program.contains(name)) {
            let below = file.strip_prefix(&root).expect("it lies below");
            naming.push(below.to_string_lossy().replace('\\', "/"));
        }
    }
    let wrong: Vec<&String> = naming.iter().filter(|file| !MAY.contains(&file.as_str())).collect();
    assert!(wrong.is_empty(), "these name a scenario: {wrong:#?}");
    for file in MAY {
        assert!(naming.iter().any(|name| name == file), "{file} names none: take it off the list");
    }
}
