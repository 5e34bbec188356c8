//! Agents that see each picture's mirror image too, from the worlds to the files.

mod tiny;

use hasard_envs::{Env, EnvError, EnvOptions, FrameSize, VecEnv, VecOptions};
use hasard_learn::config::{AlgorithmKind, EnvConfig, TrainConfig};
use hasard_learn::networks::distribution::ActionShape;
use hasard_learn::runs::agent::{Action, Agent, Choice, Which};
use hasard_learn::runs::agent_file::export;
use hasard_learn::runs::trainer::Start;
use std::fs;
use std::path::Path;

const SIZE: FrameSize = FrameSize { width: 64, height: 48 };

/// Small pictures of Remedy Rush in episodes of eleven steps.
fn worlds(env: &EnvConfig, options: VecOptions) -> Result<VecEnv, EnvError> {
    let small = EnvOptions { size: SIZE, max_episode_steps: Some(11), ..EnvOptions::default() };
    VecEnv::new(&env.id, &small, options)
}

fn config(algorithm: AlgorithmKind) -> TrainConfig {
    let mut config = tiny::remedy_rush(algorithm);
    config.network.mirror = true;
    config.frames = 2 * config.frames_per_rollout();
    config
}

fn go(start: Start, path: &Path) -> Vec<u8> {
    tiny::trained_in(&worlds, start, path)
}

/// What is learned is not what is learned without mirror images, and the same however it is.
#[test]
fn mirrored_runs_resume_exactly_and_for_any_number_of_threads() {
    for algorithm in [AlgorithmKind::PpoPid, AlgorithmKind::TrpoLag] {
        let mut config = config(algorithm);
        let all = tiny::however_trained(&worlds, &config, &format!("mirrored-{algorithm}"));
        let plain = tiny::directory(&format!("mirrored-plain-{algorithm}"));
        config.network.mirror = false;
        assert!(go(Start::Fresh(config), &plain) != all, "the mirror changes nothing");
        fs::remove_dir_all(plain).unwrap();
    }
}

/// The agent of a run and that of its file see mirror images too, and do the same: with pictures
/// that are their own mirror images neither side is likelier than the other.
#[test]
fn a_mirrored_agent_acts_as_it_learned() {
    let path = tiny::directory("mirrored-agent");
    let mut config = config(AlgorithmKind::PpoLag);
    config.evaluation.every = Some(config.frames);
    (config.evaluation.episodes, config.evaluation.confirming_episodes) = (2, Some(2));
    go(Start::Fresh(config), &path);
    let file = path.with_extension("agent");
    fs::write(&file, export(&path).unwrap()).unwrap();
    let env = Env::new("RemedyRushLevel1-v0", &EnvOptions::default()).unwrap();
    let named = |name: &str| {
        let groups = env.action_space().groups.iter().enumerate();
        let mut all = groups.flat_map(|(group, own)| {
            own.buttons.iter().enumerate().map(move |(at, (button, _))| (*button, group, at + 1))
        });
        all.find(|(button, ..)| *button == name).map(|(_, group, at)| (group, at)).unwrap()
    };
    let ((group, left), (_, right)) = (named("TURN_LEFT"), named("TURN_RIGHT"));
    let play = |place: &Path| -> Vec<Action> {
        let mut agent = Agent::load(
            place,
            Which::Latest,
            Choice::Sampled,
            2,
            [48, 64, 3],
            ActionShape::from(env.action_space()),
            &mut |warning| panic!("{warning}"),
        )
        .unwrap();
        let mut all = Vec::new();
        for step in 0..5u8 {
            let pixels = 2 * 48 * 64 * 3;
            let picture: Vec<u8> = (0..pixels)
                .map(|at| (at / 3 % 64) as u8)
                .map(|x| x.min(63 - x).wrapping_mul(7 + step))
                .collect();
            all.extend(agent.act(&picture));
            let probabilities = &agent.thought(0).probabilities[group];
            assert_eq!(probabilities[left], probabilities[right], "{probabilities:?}");
            assert_ne!(probabilities[0], probabilities[left], "{probabilities:?}");
        }
        all
    };
    assert_eq!(play(&path), play(&file));
    fs::remove_file(file).unwrap();
    fs::remove_dir_all(path).unwrap();
}

/// Worlds whose buttons have no names here: refused before anything is written.
#[test]
fn unknown_buttons_are_refused() {
    let mut config = tiny::config(AlgorithmKind::Ppo);
    config.network.mirror = true;
    let path = tiny::directory("mirrored-unknown");
    let error = tiny::run(Start::Fresh(config), &path).0.unwrap_err();
    assert!(error.contains("network.mirror"), "{error}");
    assert!(!path.exists());
}
