//! Runs that begin with the weights of an agent's file.

mod tiny;

use hasard_learn::config::{AlgorithmKind, TrainConfig};
use hasard_learn::runs::agent_file::{AgentFile, export, export_latest};
use hasard_learn::runs::run_directory::{read_config, read_selection};
use hasard_learn::runs::trainer::Start;
use std::fs;
use std::path::{Path, PathBuf};

/// A run that has selected a checkpoint, and the file of its agent.
fn trained(name: &str) -> (TrainConfig, PathBuf, PathBuf) {
    let mut config = tiny::config(AlgorithmKind::PpoLag);
    config.frames = 4 * config.frames_per_rollout();
    config.evaluation.every = Some(config.frames);
    (config.evaluation.episodes, config.evaluation.confirming_episodes) = (2, Some(2));
    let run = tiny::directory(name);
    tiny::run(Start::Fresh(config.clone()), &run).0.unwrap();
    let file = run.with_extension("agent");
    fs::write(&file, export(&run).unwrap()).unwrap();
    (config, run, file)
}

fn network(bytes: &[u8]) -> Vec<(String, Vec<f32>)> {
    let tensors = safetensors::SafeTensors::deserialize(bytes).unwrap();
    let mut all: Vec<(String, Vec<f32>)> = tensors
        .iter()
        .filter(|(name, _)| name.starts_with("network"))
        .map(|(name, view)| {
            let (words, _) = view.data().as_chunks::<4>();
            (name.to_string(), words.iter().map(|word| f32::from_le_bytes(*word)).collect())
        })
        .collect();
    all.sort_by(|a, b| a.0.cmp(&b.0));
    all
}

/// With a learning rate of zero the weights at the end are those of the file: the run's own to
/// within half a step of their eight bits.
#[test]
fn a_run_begins_with_the_weights_of_a_file() {
    let (mut config, run, file) = trained("from-agent");
    config.learning.rate = 0.0;
    let second = tiny::directory("from-agent-second");
    tiny::run(Start::From(config, file.clone()), &second).0.unwrap();
    let (before, after) = (network(&tiny::weights(&run)), network(&tiny::weights(&second)));
    assert_eq!(before.len(), after.len());
    let mut largest_step = 0.0f32;
    for ((name, before), (other, after)) in before.iter().zip(&after) {
        assert_eq!((name, before.len()), (other, after.len()));
        let largest = before.iter().fold(0.0f32, |largest, weight| largest.max(weight.abs()));
        for (a, b) in before.iter().zip(after) {
            assert!((a - b).abs() <= largest / 253.0, "{name}: {a} became {b}");
            largest_step = largest_step.max((a - b).abs());
        }
    }
    assert!(largest_step > 0.0, "the file has eight bits a weight, the run thirty-two");
    for at in [run, second] {
        fs::remove_dir_all(at).unwrap();
    }
    fs::remove_file(file).unwrap();
}

/// The critics' values are in units of what returns were like, which the new run's join.
#[test]
fn a_run_begins_with_the_statistics_of_returns_of_a_file() {
    let (config, run, file) = trained("from-returns");
    let second = tiny::directory("from-returns-second");
    tiny::run(Start::From(config, file.clone()), &second).0.unwrap();
    let returns = |run: &Path| {
        let file = AgentFile::parse(&export_latest(run, &mut |line| panic!("{line}")).unwrap());
        file.unwrap().card.returns
    };
    let (before, after) = (returns(&run), returns(&second));
    assert_eq!((before.len(), after.len()), (2, 2), "of the return and of a cost");
    for (before, after) in before.iter().zip(&after) {
        // The made-up first draw of the first run, then as many of each run.
        assert!(before.count > 1.0);
        assert_eq!(after.count, 1.0 + 2.0 * (before.count - 1.0));
        assert!(before.variance > 0.0 && before.mean != 0.0);
    }
    // A file of a program that wrote none; the card is a text in the header, its quotes marked.
    let mut bytes = fs::read(&file).unwrap();
    let name = br#"\"returns\":["#;
    let at = bytes.windows(name.len()).position(|some| some == name).expect("statistics");
    bytes[at + 2] = b'R';
    let old = AgentFile::parse(&bytes).unwrap();
    assert!(old.card.returns.is_empty());
    for at in [run, second] {
        fs::remove_dir_all(at).unwrap();
    }
    fs::remove_file(file).unwrap();
}

/// A run that was killed before its first checkpoint had random weights when it went on.
#[test]
fn a_run_that_goes_on_from_nothing_has_the_weights_that_it_began_with() {
    let (config, run, file) = trained("from-again");
    for (place, name) in [(&file, "file"), (&run, "run")] {
        let whole = tiny::directory(&format!("from-again-whole-{name}"));
        tiny::run(Start::From(config.clone(), place.clone()), &whole).0.unwrap();
        let written = fs::read(whole.join("config.json")).unwrap();
        let killed = tiny::directory(&format!("from-again-killed-{name}"));
        fs::create_dir_all(&killed).unwrap();
        fs::write(killed.join("config.json"), &written).unwrap();
        tiny::run(Start::RESUME, &killed).0.unwrap();
        assert_eq!(tiny::weights(&killed), tiny::weights(&whole), "{name}");
        let apart = read_config(&killed).unwrap().init_from.unwrap();
        assert_eq!((apart.place.as_path(), apart.sha256.len()), (place.as_path(), 64));
        // Other weights at the place are not those that it began with; these may be elsewhere.
        fs::remove_dir_all(killed.join("checkpoints")).unwrap();
        for name in ["metrics.jsonl", "selected.json"] {
            fs::remove_file(killed.join(name)).unwrap();
        }
        let elsewhere = place.with_extension("elsewhere");
        if place.is_file() {
            fs::copy(place, &elsewhere).unwrap();
            fs::write(place, export_latest(&whole, &mut |line| panic!("{line}")).unwrap()).unwrap();
        } else {
            let settings = vec![format!("frames={}", config.frames + config.frames_per_rollout())];
            tiny::run(Start::Resume { settings }, place).0.unwrap();
        }
        let refused = tiny::run(Start::RESUME, &killed).0.unwrap_err();
        assert!(refused.contains("other weights now") && refused.contains("--out"), "{refused}");
        if place.is_file() {
            fs::remove_file(place).unwrap();
            let refused = tiny::run(Start::RESUME, &killed).0.unwrap_err();
            assert!(refused.contains("are gone"), "{refused}");
            assert_eq!(fs::read(killed.join("config.json")).unwrap(), written);
            let settings = vec![format!("init_from.place={}", elsewhere.display())];
            tiny::run(Start::Resume { settings }, &killed).0.unwrap();
            assert_eq!(tiny::weights(&killed), tiny::weights(&whole));
            let known = read_config(&killed).unwrap();
            assert_eq!(
                (known.init_from.unwrap().place, known.changes),
                (elsewhere.clone(), vec![])
            );
            fs::remove_file(elsewhere).unwrap();
        }
        fs::remove_dir_all(whole).unwrap();
        fs::remove_dir_all(killed).unwrap();
    }
    fs::remove_dir_all(run).unwrap();
}

/// What a run began with is no setting of the machine: a run from other weights is another.
#[test]
fn settings_know_what_a_run_began_with() {
    let (config, run, file) = trained("from-known");
    let second = tiny::directory("from-known-second");
    tiny::run(Start::From(config.clone(), file.clone()), &second).0.unwrap();
    let known = read_config(&second).unwrap();
    let (name, ..) = known.unlike(&config.clone().begun()).unwrap();
    assert_eq!(name, "init_from");
    // The same weights at another place are the same.
    let mut elsewhere = known.clone();
    elsewhere.init_from.as_mut().unwrap().place = "elsewhere".into();
    assert_eq!(known.unlike(&elsewhere), None);
    elsewhere.init_from.as_mut().unwrap().sha256 = "0".repeat(64);
    assert_eq!(known.unlike(&elsewhere).unwrap().0, "init_from.sha256");
    let refused = known.with("init_from=null").unwrap_err().to_string();
    assert!(refused.contains("--init-from"), "{refused}");
    for at in [run, second] {
        fs::remove_dir_all(at).unwrap();
    }
    fs::remove_file(file).unwrap();
}

/// The policy at the end is there too, with its own closing episodes.
#[test]
fn the_latest_checkpoint_becomes_a_file_with_the_word_of_the_last_policy() {
    let (config, run, file) = trained("from-latest");
    let longer = config.frames + 2 * config.frames_per_rollout();
    let settings = vec![format!("frames={longer}")];
    tiny::run(Start::Resume { settings }, &run).0.unwrap();
    let latest =
        AgentFile::parse(&export_latest(&run, &mut |line| panic!("{line}")).unwrap()).unwrap();
    let said = latest.card.selection.unwrap();
    let selection = read_selection(&run).unwrap();
    assert_eq!((said.frames, selection.selected.frames), (longer, config.frames));
    assert_eq!(said.closing, selection.last.map(|last| last.closing));
    assert_eq!(AgentFile::read(&file).unwrap().card.selection.unwrap().frames, config.frames);
    // Damaged, it is passed over by name: what lies before it says nothing of the last policy.
    let weights = run.join(format!("checkpoints/frames_{longer:012}/weights.safetensors"));
    let mut bytes = fs::read(&weights).unwrap();
    *bytes.last_mut().unwrap() ^= 1;
    fs::write(&weights, bytes).unwrap();
    let mut lines = Vec::new();
    let before = export_latest(&run, &mut |line| lines.push(line)).unwrap();
    assert!(AgentFile::parse(&before).unwrap().card.selection.is_none());
    assert_eq!(lines.len(), 1, "{lines:?}");
    assert!(lines[0].starts_with(&*weights.to_string_lossy()), "{lines:?}");
    fs::remove_dir_all(run).unwrap();
    fs::remove_file(file).unwrap();
}

#[test]
fn a_file_of_another_network_is_refused_and_nothing_is_left_behind() {
    let (mut config, run, file) = trained("from-other");
    config.network.dense = vec![96];
    let second = tiny::directory("from-other-second");
    let refused = tiny::run(Start::From(config.clone(), file.clone()), &second).0.unwrap_err();
    assert!(refused.contains("does not fit") && refused.contains("--init-from"), "{refused}");
    assert!(!second.exists());
    // A run's checkpoint likewise, which said a tensor's name and nothing to do.
    let refused = tiny::run(Start::From(config.clone(), run.clone()), &second).0.unwrap_err();
    assert!(refused.contains("does not fit") && refused.contains("--init-from"), "{refused}");
    assert!(!second.exists());
    fs::write(&file, "no agent").unwrap();
    let refused = tiny::run(Start::From(config, file.clone()), &second).0.unwrap_err();
    assert!(refused.contains("export-agent"), "{refused}");
    assert!(!second.exists());
    fs::remove_dir_all(run).unwrap();
    fs::remove_file(file).unwrap();
}

/// A policy of such weights plays one action for ever, and a claim of it held.
#[test]
fn a_file_of_weights_that_are_no_numbers_is_refused() {
    let (_, run, file) = trained("from-no-numbers");
    let mut bytes = fs::read(&file).unwrap();
    let (head, facts) = safetensors::SafeTensors::read_metadata(&bytes).unwrap();
    let tensors = facts.tensors();
    let (name, scale) = tensors.iter().find(|(name, _)| name.ends_with(".scale")).unwrap();
    let (name, at) = (name.trim_end_matches(".scale").to_string(), 8 + head + scale.data_offsets.0);
    for wrong in [f32::NAN, f32::INFINITY] {
        bytes[at..at + 4].copy_from_slice(&wrong.to_le_bytes());
        let refused = AgentFile::parse(&bytes).err().unwrap();
        assert!(refused.contains(&name) && refused.contains("no finite number"), "{refused}");
    }
    fs::remove_dir_all(run).unwrap();
    fs::remove_file(file).unwrap();
}
