//! Agents that act more or less decidedly than they were trained to.

mod tiny;

use hasard_envs::{Env, EnvError, EnvOptions, FrameSize, VecEnv, VecOptions};
use hasard_learn::config::{AlgorithmKind, EnvConfig, TrainConfig};
use hasard_learn::networks::distribution::ActionShape;
use hasard_learn::runs::agent::{Agent, Choice, Which};
use hasard_learn::runs::agent_file::{AgentFile, export_latest, tempered};
use hasard_learn::runs::temperature::Temperature;
use hasard_learn::runs::trainer::Start;
use std::fs;
use std::path::{Path, PathBuf};

const SIZE: FrameSize = FrameSize { width: 64, height: 48 };

fn options(env: &EnvConfig) -> EnvOptions {
    let full_actions = env.full_actions;
    EnvOptions { size: SIZE, max_episode_steps: Some(11), full_actions, ..EnvOptions::default() }
}

fn worlds(env: &EnvConfig, lanes: VecOptions) -> Result<VecEnv, EnvError> {
    VecEnv::new(&env.id, &options(env), lanes)
}

/// The settings of a short run, its directory, and its agent's file.
fn trained(name: &str, full: bool, mirror: bool) -> (TrainConfig, PathBuf, Vec<u8>) {
    let mut config = tiny::remedy_rush(AlgorithmKind::PpoLag);
    (config.env.full_actions, config.network.mirror) = (full, mirror);
    config.frames = config.frames_per_rollout();
    let run = tiny::directory(name);
    tiny::trained_in(&worlds, Start::Fresh(config.clone()), &run);
    let file = export_latest(&run, &mut |line| panic!("{line}")).unwrap();
    (config, run, file)
}

/// The network's rows for a few pictures, and the likeliest actions.
fn plays(file: &Path, action: &ActionShape) -> (Vec<f32>, Vec<Vec<u8>>) {
    let mut agent = Agent::load(
        file,
        Which::Latest,
        Choice::Greedy,
        1,
        [48, 64, 3],
        action.clone(),
        &mut |warning| panic!("{warning}"),
    )
    .unwrap();
    let picture = |step: u32| -> Vec<u8> {
        (0..48 * 64 * 3u32).map(|pixel| (pixel * (7 + step) % 251) as u8).collect()
    };
    let (mut rows, mut actions) = (Vec::new(), Vec::new());
    for step in 0..4 {
        rows.extend_from_slice(agent.rows(&picture(step)));
        actions.push(agent.act(&picture(step)).swap_remove(0).actions);
    }
    (rows, actions)
}

/// p^(1/T), normalised, has the logits over T; a normal's deviation is multiplied by T; what the
/// critics say and which action is the likeliest stays. Mirrored agents too.
#[test]
fn logits_are_divided_and_deviations_multiplied() {
    for (full, mirror) in [(false, false), (false, true), (true, false)] {
        let name = format!("temperature-{full}-{mirror}");
        let (config, run, plain) = trained(&name, full, mirror);
        let env = Env::new(&config.env.id, &options(&config.env)).unwrap();
        let action = ActionShape::from(env.action_space());
        let file = run.with_extension("agent");
        fs::write(&file, &plain).unwrap();
        let (rows, actions) = plays(&file, &action);
        for text in ["0.01", "0.25", "3"] {
            let temperature: f64 = text.parse().unwrap();
            let bytes = tempered(&plain, text.parse().unwrap()).unwrap();
            let card = AgentFile::parse(&bytes).unwrap().card;
            assert_eq!((card.temperature, card.selection), (text.parse().unwrap(), None));
            fs::write(&file, &bytes).unwrap();
            let (other, likeliest) = plays(&file, &action);
            assert_eq!(actions, likeliest, "{text}");
            let width = rows.len() / 4;
            let logits: usize = action.sizes.iter().sum();
            for (row, other) in rows.chunks_exact(width).zip(other.chunks_exact(width)) {
                for (at, (&was, &is)) in row.iter().zip(other).enumerate() {
                    let normal = at >= logits && at < action.parameters();
                    let expected = match at {
                        _ if at < logits => f64::from(was) / temperature,
                        _ if normal && (at - logits) % 2 == 1 => f64::from(was) + temperature.ln(),
                        _ => f64::from(was),
                    };
                    assert!(
                        (f64::from(is) - expected).abs() <= 1e-5 * expected.abs().max(1.0),
                        "{text}, output {at}: {was} became {is}, not {expected}"
                    );
                }
            }
        }
        fs::remove_dir_all(&run).unwrap();
        fs::remove_file(&file).unwrap();
    }
}

/// A file's temperature is what was asked for last, and a training begins with what was trained.
#[test]
fn a_temperature_takes_nothing_away() {
    let (mut config, run, plain) = trained("temperature-again", false, false);
    let at = |bytes: &[u8], text: &str| tempered(bytes, text.parse().unwrap()).unwrap();
    let warm = at(&plain, "3");
    assert!(at(&warm, "0.01") == at(&plain, "0.01") && at(&warm, "1") == plain && warm != plain);
    config.learning.rate = 0.0;
    let second = |bytes: &[u8], name: &str| {
        let (file, run) = (run.with_extension("agent"), tiny::directory(name));
        fs::write(&file, bytes).unwrap();
        let weights = tiny::trained_in(&worlds, Start::From(config.clone(), file.clone()), &run);
        fs::remove_dir_all(run).unwrap();
        fs::remove_file(file).unwrap();
        weights
    };
    assert!(second(&plain, "temperature-none") == second(&warm, "temperature-warm"));
    fs::remove_dir_all(&run).unwrap();
}

#[test]
fn a_temperature_is_a_positive_number() {
    for text in ["0", "-1", "0.001", "1000", "nan", "inf", "warm", ""] {
        let refused = text.parse::<Temperature>().unwrap_err();
        assert!(refused.contains("from 0.01"), "{text}: {refused}");
    }
    assert!(tempered(b"no agent", "0.5".parse().unwrap()).is_err());
}
