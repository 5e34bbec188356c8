//! Recorded episodes.

use super::{Target, assert_presentable};
use hasard_envs::{Env, EnvId, EnvOptions, FrameSize};
use hasard_media::episode::EpisodeFile;
use hasard_play::{Recorder, Replay};
use std::path::Path;

/// Episode files, read and played again.
pub const EPISODE: Target = Target {
    name: "episode",
    samples: || {
        vec![
            record("RemedyRushLevel1-v0", false, 12),
            record("CollateralDamageLevel1-v0", true, 40),
            record("PrecipicePlungeLevel1-v0", true, 3),
        ]
    },
    words: &[
        "\"steps\":",
        "\"groups\":",
        "\"deltas\":",
        "\"options\":{",
        "\"seed\":",
        "\"outcome\":null",
        "\"frame-skip\":\"35\"",
        "CollateralDamageLevel3-v0",
        "\"hard\":\"true\"",
        "\"rules\":\"released\"",
        "\"state_hash\":",
    ],
    repair: fit,
    run: |bytes| {
        let file = match EpisodeFile::from_bytes(bytes, Path::new("spoiled.episode")) {
            Ok(file) => file,
            Err(error) => {
                assert_presentable(&error.to_string());
                return false;
            }
        };
        let again = EpisodeFile::from_bytes(&file.to_bytes(), Path::new("again"))
            .expect("what is written can be read");
        assert_eq!(again, file, "written and read, it is another episode");
        play(file)
    },
    // A million steps of 32 sub-actions, in the file's order and in the episode's.
    memory: 320 << 20,
};

fn options() -> EnvOptions {
    EnvOptions { size: FrameSize { width: 64, height: 48 }, ..EnvOptions::default() }
}

fn record(id: &str, full_actions: bool, steps: usize) -> Vec<u8> {
    let mut env = Env::new(id, &EnvOptions { full_actions, ..options() })
        .expect("an environment of the benchmark");
    let mut recorder = Recorder::begin(&mut env, 7, "sample").expect("a sound name");
    let (groups, deltas) =
        (vec![1; env.action_space().groups.len()], vec![0.25; env.action_space().deltas.len()]);
    for _ in 0..steps {
        env.step(&groups, &deltas).expect("an action of the environment");
        recorder.push(&groups, &deltas).expect("an action of the environment");
    }
    recorder.finish(&env).to_bytes()
}

/// Plays the beginning of an episode that was read; longer ones of the benchmark's are let go.
fn play(file: EpisodeFile) -> bool {
    // An environment takes a moment to make; few spoiled ids are one.
    if file.header().env.parse::<EnvId>().is_err() {
        return false;
    }
    match Replay::new(file, Path::new("spoiled.episode"), &options()) {
        Ok(mut replay) => {
            for _ in 0..200 {
                if !replay.tic() {
                    break;
                }
            }
            if let Some(difference) = replay.difference() {
                assert_presentable(&difference.to_string());
            }
            true
        }
        Err(error) => {
            assert_presentable(&error.to_string());
            false
        }
    }
}

/// The lengths of header and body, then the checksum, are made to fit what is there.
fn fit(mut bytes: Vec<u8>) -> Vec<u8> {
    let Some(end) = bytes.len().checked_sub(4).filter(|&end| end > 20) else { return bytes };
    // The header ends in a brace; four bytes later the compressed body begins.
    let last = (14..end - 5).rev().find(|&at| bytes[at] == b'}' && bytes[at + 5] == 0x78);
    if let Some(last) = last {
        bytes[10..14].copy_from_slice(&(last as u32 + 1 - 14).to_le_bytes());
        bytes[last + 1..last + 5].copy_from_slice(&((end - last - 5) as u32).to_le_bytes());
    }
    let mut sum = flate2::Crc::new();
    sum.update(&bytes[..end]);
    bytes[end..].copy_from_slice(&sum.sum().to_le_bytes());
    bytes
}
