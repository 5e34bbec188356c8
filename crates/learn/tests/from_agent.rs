//! Runs that begin with the weights of an agent's file.

mod tiny;

use hasard_learn::config::{AlgorithmKind, TrainConfig};
use hasard_learn::runs::agent_file::{AgentFile, export, export_latest};
use hasard_learn::runs::run_directory::read_selection;
use hasard_learn::runs::trainer::Start;
use std::fs;
use std::path::PathBuf;

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

/// The policy at the end is there too, with its own closing episodes.
#[test]
fn the_latest_checkpoint_becomes_a_file_with_the_word_of_the_last_policy() {
    let (config, run, file) = trained("from-latest");
    let longer = config.frames + 2 * config.frames_per_rollout();
    let settings = vec![format!("frames={longer}")];
    tiny::run(Start::Resume { settings }, &run).0.unwrap();
    let latest = AgentFile::parse(&export_latest(&run).unwrap()).unwrap();
    let said = latest.card.selection.unwrap();
    let selection = read_selection(&run).unwrap();
    assert_eq!((said.frames, selection.selected.frames), (longer, config.frames));
    assert_eq!(said.closing, selection.last.map(|last| last.closing));
    assert_eq!(AgentFile::read(&file).unwrap().card.selection.unwrap().frames, config.frames);
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
