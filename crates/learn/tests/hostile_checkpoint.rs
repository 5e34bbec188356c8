//! Checkpoints and settings that are hostile or belong to another run: an error, no panic.

mod tiny;

use hasard_learn::config::{AlgorithmKind, Constraint};
use hasard_learn::runs::checksum::crc32c;
use hasard_learn::runs::trainer::Start;
use std::path::{Path, PathBuf};
use tiny::{config, directory, run};

/// A run that was trained for one rollout, and the directory of its checkpoint.
fn trained(name: &str) -> (PathBuf, PathBuf) {
    let path = directory(name);
    let mut config = config(AlgorithmKind::PpoLag);
    config.frames = 512;
    run(Start::Fresh(config), &path).0.unwrap();
    let checkpoint = path.join("checkpoints/frames_000000000512");
    assert!(checkpoint.is_dir());
    (path, checkpoint)
}

/// Changes the training file, and makes its checksum fit as an attacker would.
fn change(checkpoint: &Path, spoil: impl FnOnce(&mut Vec<u8>)) {
    let file = checkpoint.join("training.safetensors");
    let mut bytes = std::fs::read(&file).unwrap();
    spoil(&mut bytes);
    std::fs::write(&file, &bytes).unwrap();
    let state = checkpoint.join("state.json");
    let mut json: serde_json::Value =
        serde_json::from_slice(&std::fs::read(&state).unwrap()).unwrap();
    json["training_checksum"] = crc32c(&bytes).into();
    std::fs::write(&state, json.to_string()).unwrap();
}

/// The message that a resumed run ends with.
fn refused(path: &Path) -> String {
    let message = run(Start::Resume { settings: vec!["frames=1024".into()] }, path).0.unwrap_err();
    assert!(!message.contains("panicked") && !message.contains(char::is_control), "{message}");
    message
}

#[test]
fn lengths_that_add_up_by_wrapping_around_are_refused() {
    let (path, checkpoint) = trained("wrapping");
    change(&checkpoint, |bytes| {
        let header = u64::from_le_bytes(bytes[..8].try_into().unwrap()) as usize;
        let tensors: serde_json::Value = serde_json::from_slice(&bytes[8..8 + header]).unwrap();
        let start =
            8 + header + tensors["sampler0.lanes"]["data_offsets"][0].as_u64().unwrap() as usize;
        // A lane is seeds, seed, number of actions, number of deltas: two numbers of actions grow
        // by half of all there are.
        for lane in 0..2 {
            let at = start + lane * 32 + 16;
            let length = u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap());
            bytes[at..at + 8].copy_from_slice(&length.wrapping_add(1 << 63).to_le_bytes());
        }
    });
    let message = refused(&path);
    assert!(message.contains("impossible lengths"), "{message}");
    std::fs::remove_dir_all(path).unwrap();
}

#[test]
fn a_checkpoint_held_against_other_constraints_is_refused() {
    let (path, _) = trained("constraints");
    let file = path.join("config.json");
    let mut settings: hasard_learn::config::TrainConfig =
        serde_json::from_slice(&std::fs::read(&file).unwrap()).unwrap();
    settings.constraints.push(Constraint { term: Some("second".into()), budget: 1.0 });
    std::fs::write(&file, serde_json::to_vec(&settings).unwrap()).unwrap();
    let message = refused(&path);
    assert!(message.contains("does not fit") || message.contains("constraints"), "{message}");
    std::fs::remove_dir_all(path).unwrap();
}

#[test]
fn a_state_of_other_constraints_is_refused() {
    let (path, checkpoint) = trained("watch");
    let state = checkpoint.join("state.json");
    let mut json: serde_json::Value =
        serde_json::from_slice(&std::fs::read(&state).unwrap()).unwrap();
    let recent = json["progress"]["watch"]["recent"].as_array_mut().unwrap();
    assert!(!recent.is_empty());
    recent.iter_mut().for_each(|episode| episode["constrained"] = serde_json::json!([]));
    std::fs::write(&state, json.to_string()).unwrap();
    let message = refused(&path);
    assert!(message.contains("other constraints"), "{message}");
    std::fs::remove_dir_all(path).unwrap();
}

#[test]
fn settings_of_a_giant_network_are_refused() {
    let path = directory("giant");
    let mut settings = config(AlgorithmKind::PpoLag);
    settings.network.dense = vec![1 << 60];
    let message = run(Start::Fresh(settings), &path).0.unwrap_err();
    assert!(message.contains("too large"), "{message}");
    let _ = std::fs::remove_dir_all(path);
}
