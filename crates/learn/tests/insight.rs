//! What learners see of real worlds beside their pictures, from the worlds to the weights.

mod tiny;

use hasard_envs::{Env, EnvError, EnvOptions, FrameSize, ObservationKind, VecEnv, VecOptions};
use hasard_learn::config::{AlgorithmKind, CriticInput, EnvConfig, TrainConfig};
use hasard_learn::networks::distribution::ActionShape;
use hasard_learn::runs::agent::{Agent, Choice, Which};
use hasard_learn::runs::agent_file::export;
use hasard_learn::runs::session::{Beginning, Session};
use hasard_learn::runs::trainer::Start;
use std::fs;
use std::path::Path;

/// Small grey pictures of Remedy Rush in episodes of eleven steps.
fn worlds(env: &EnvConfig, options: VecOptions) -> Result<VecEnv, EnvError> {
    let size = FrameSize { width: 64, height: 48 };
    let observation = ObservationKind::Grey;
    let small =
        EnvOptions { size, observation, max_episode_steps: Some(11), ..EnvOptions::default() };
    VecEnv::new(&env.id, &small, options)
}

fn config() -> TrainConfig {
    let mut config = tiny::remedy_rush(AlgorithmKind::PpoLag);
    config.learning.critic_inputs = CriticInput::ALL.to_vec();
    (config.learning.auxiliary_depth, config.learning.auxiliary_labels) = (0.2, 0.1);
    config.frames = 6 * config.frames_per_rollout();
    config
}

fn go(start: Start, path: &Path) -> Vec<u8> {
    tiny::trained_in(&worlds, start, path)
}

/// A run that stopped in the midst of episodes and went on equals the one that did not, and neither
/// samplers, groups nor threads change a bit.
#[test]
fn runs_with_insight_resume_exactly_and_for_any_number_of_threads() {
    tiny::however_trained(&worlds, &config(), "insight");
}

/// What the critics see differs from lane to lane and step to step, is of about the size of other
/// inputs, and is of the moment of the picture beside it: a lane that has just begun has the health
/// of an episode's start.
#[test]
fn critics_see_the_world_of_the_moment() {
    let mut config = config();
    config.learning.critic_inputs = vec![CriticInput::Health, CriticInput::Position];
    config.sampling.samplers = 1;
    let mut session = Session::new(config, &Beginning::Nothing, &worlds).unwrap();
    let rollout = session.gatherer.next_rollout().unwrap();
    let part = &rollout.parts[0];
    let row = |step: usize, lane: usize| &part.privileged[(step * part.lanes + lane) * 8..][..8];
    let env = Env::new("RemedyRushLevel1-v0", &EnvOptions::default()).unwrap();
    let health = env.world().get(env.world().players[0].actor).unwrap().health;
    let health = (health as f32 - 100.0) / 100.0;
    let (mut moved, mut begun) = (0, 0);
    for step in 1..=part.steps {
        for lane in 0..part.lanes {
            moved += usize::from(row(step, lane)[1..] != row(step - 1, lane)[1..]);
            if part.done[(step - 1) * part.lanes + lane] {
                begun += 1;
                assert_eq!(row(step, lane)[0], health, "health at an episode's start");
            }
            assert!(row(step, lane).iter().all(|number| number.abs() <= 2.0));
        }
    }
    assert!(moved > 20 && begun > 2, "{moved} {begun}");
}

/// What the network predicts of pictures it learns to predict; and its agent, from the run or from
/// a file, is one without: the same actions, whatever the head says.
#[test]
fn predictions_are_learned_and_not_handed_on() {
    let mut config = config();
    config.frames = 60 * config.frames_per_rollout();
    config.evaluation.every = Some(config.frames);
    (config.evaluation.episodes, config.evaluation.confirming_episodes) = (2, Some(2));
    let path = tiny::directory("insight-learned");
    let _ = go(Start::Fresh(config), &path);
    let text = fs::read_to_string(path.join("metrics.jsonl")).unwrap();
    let rows: Vec<serde_json::Value> =
        text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    for name in ["auxiliary_depth_loss", "auxiliary_labels_loss"] {
        let loss = |row: &serde_json::Value| row[name].as_f64().unwrap();
        let (first, last) = (loss(&rows[0]), loss(&rows[rows.len() - 1]));
        assert!(last < 0.7 * first, "{name}: from {first} to {last}");
    }
    let file = path.with_extension("agent");
    fs::write(&file, export(&path).unwrap()).unwrap();
    let names = |bytes: &[u8]| -> Vec<String> {
        let tensors = safetensors::SafeTensors::deserialize(bytes).unwrap();
        tensors.names().into_iter().map(String::from).collect()
    };
    let last = path.join("checkpoints");
    let last = fs::read_dir(last).unwrap().map(|entry| entry.unwrap().path()).max().unwrap();
    let own = names(&fs::read(last.join("weights.safetensors")).unwrap());
    assert!(own.iter().any(|name| name == "network0.head3.weight"), "{own:?}");
    let handed_on = names(&fs::read(&file).unwrap());
    assert!(handed_on.iter().any(|name| name == "network0.head2.weight"), "{handed_on:?}");
    assert!(!handed_on.iter().any(|name| name.contains("head3")), "{handed_on:?}");
    let space = Env::new("RemedyRushLevel1-v0", &EnvOptions::default()).unwrap();
    let action = ActionShape::from(space.action_space());
    for place in [&path, &file] {
        let mut agent = Agent::load(
            place,
            Which::Latest,
            Choice::Greedy,
            2,
            [48, 64, 1],
            action.clone(),
            &mut |warning| panic!("{warning}"),
        )
        .unwrap();
        assert_eq!(agent.act(&[90; 2 * 48 * 64]).len(), 2);
    }
    fs::remove_file(file).unwrap();
    fs::remove_dir_all(path).unwrap();
}
