//! What training writes: settings and checkpoints.

use super::{Target, assert_presentable, nothing_to_repair};
use hasard_envs::{Env, EnvError, VecEnv, VecOptions};
use hasard_learn::config::Convolution;
use hasard_learn::config::{AlgorithmKind, EnvConfig, Preset, TrainConfig};
use hasard_learn::error::LearnError;
use hasard_learn::networks::distribution::ActionShape;
use hasard_learn::networks::{ImageShape, ModelShape};
use hasard_learn::runs::checkpoint::Loaded;
use hasard_learn::runs::checksum::crc32c;
use hasard_learn::runs::session::{Beginning, Session};
use hasard_learn::runs::trainer::{Hooks, Start, train};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::sync::{LazyLock, Mutex};

/// `config.json` of a run.
pub const SETTINGS: Target = Target {
    name: "settings",
    samples: || {
        let config = |algorithm, preset, env| {
            let config = TrainConfig::new(algorithm, preset, env).expect("a preset is sound");
            serde_json::to_vec_pretty(&config).expect("settings are plain data")
        };
        let full = EnvConfig {
            full_actions: true,
            observation: "rgb+depth".into(),
            ..EnvConfig::new("RemedyRushLevel2-v0")
        };
        vec![
            config(AlgorithmKind::PpoLag, Preset::Paper, EnvConfig::new(ID)),
            config(AlgorithmKind::TrpoPid, Preset::Released, full),
            serde_json::to_vec(&small()).expect("settings are plain data"),
        ]
    },
    words: &[
        "\"convolutions\":[]",
        "\"dense\":[32]",
        "\"recurrent\":null",
        "\"residual\":[32]",
        "\"channels\":32",
        "\"kernel\":",
        "\"stride\":",
        "PPOSaute",
        "\"lanes\":",
        "\"budget\":",
        "released",
        "grey",
        "\"size\":[64,48]",
        "\"frame_stack\":16",
    ],
    repair: nothing_to_repair,
    run: |bytes| {
        let config = match serde_json::from_slice::<TrainConfig>(bytes) {
            Ok(config) => config,
            Err(error) => {
                let error = LearnError::content(Path::new("config.json"), error);
                assert_presentable(&error.to_string());
                return false;
            }
        };
        let checked = config.check().and_then(|()| config.env.options()).and_then(|options| {
            options.check().map_err(|error| LearnError::Worlds(error.to_string()))?;
            let image = ImageShape {
                height: usize::from(options.size.height),
                width: usize::from(options.size.width),
                channels: 4 * options.frame_stack,
            };
            let action = ActionShape { sizes: vec![3, 2, 2, 2], deltas: 2 };
            ModelShape::new(image, action, config.constraints.len(), 0, &config.network)
        });
        match checked {
            Ok(shape) => {
                assert!(
                    shape.parameter_count() < 1 << 32,
                    "a network of {} parameters",
                    shape.parameter_count()
                );
                assert!(serde_json::to_string(&config).is_ok());
                true
            }
            Err(error) => {
                assert_presentable(&error.to_string());
                false
            }
        }
    },
    memory: 16 << 20,
};

/// A checkpoint, read and gone on from.
pub const CHECKPOINT: Target = Target {
    name: "checkpoint",
    samples: || vec![checkpoint()],
    words: &[
        "\"frames\":",
        "\"samplers\":[",
        "\"recent\":[",
        "\"constrained\":[",
        "\"optimiser_steps\":[",
        "\"returns\":[]",
        "\"dtype\":\"F64\"",
        "\"data_offsets\":[0,0]",
        "\"shape\":[]",
        "\"__metadata__\":{}",
        "sampler0.lanes",
        "adam0.first",
    ],
    repair: fit,
    run: go_on,
    memory: 256 << 20,
};

const ID: &str = "CollateralDamageLevel1-v0";
/// What stands between the three files of a checkpoint in an input.
const BORDER: &[u8] = b"\n--next file--\n";
const FILES: [&str; 3] = ["weights.safetensors", "training.safetensors", "state.json"];

/// A run that begins in milliseconds.
pub(super) fn small() -> TrainConfig {
    let env = EnvConfig { size: (64, 48), observation: "grey".into(), ..EnvConfig::new(ID) };
    let mut config =
        TrainConfig::new(AlgorithmKind::PpoLag, Preset::Paper, env).expect("a preset is sound");
    config.network.convolutions = vec![Convolution { channels: 32, kernel: 16, stride: 16 }];
    (config.network.dense, config.network.recurrent) = (vec![32], Some(32));
    (config.sampling.lanes, config.sampling.rollout, config.sampling.samplers) = (2, 2, 1);
    (config.sampling.synchronous, config.sampling.spread_out) = (true, true);
    config.learning.threads = 1;
    config.frames = 32;
    config
}

/// Real worlds; their map and pictures are made once.
fn worlds(_: &EnvConfig, options: VecOptions) -> Result<VecEnv, EnvError> {
    static FIRST: LazyLock<Mutex<Env>> = LazyLock::new(|| {
        let options = small().env.options().expect("options of a sound run");
        Mutex::new(Env::new(ID, &options).expect("an environment of the benchmark"))
    });
    VecEnv::from_fn(options, |_| {
        Ok(Box::new(FIRST.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).sibling()))
    })
}

/// A folder of this process for checkpoints, in memory where the system has such a place.
pub(super) fn folder(name: &str) -> PathBuf {
    let base = Some(PathBuf::from("/dev/shm"))
        .filter(|path| path.is_dir())
        .unwrap_or_else(std::env::temp_dir);
    base.join(format!("hasard-fuzz-{}-{name}", std::process::id()))
}

/// What `read` makes of a real run's directory.
pub(super) fn of_a_run(
    name: &str,
    config: TrainConfig,
    read: impl FnOnce(&Path) -> Vec<u8>,
) -> Vec<u8> {
    let run = folder(name);
    let _ = std::fs::remove_dir_all(&run);
    let stop = AtomicBool::new(false);
    let mut hooks = Hooks { stop: &stop, report: &mut |_| {}, warn: &mut |_| {} };
    train(Start::Fresh(config), &run, &worlds, &mut hooks).expect("the sample run trains");
    let bytes = read(&run);
    let _ = std::fs::remove_dir_all(&run);
    bytes
}

/// The three files of its checkpoint.
fn checkpoint() -> Vec<u8> {
    of_a_run("run", small(), |run| {
        let checkpoints =
            std::fs::read_dir(run.join("checkpoints")).expect("the sample run has checkpoints");
        let path = checkpoints.map(|entry| entry.expect("a readable folder").path()).max();
        let path = path.expect("the sample run has a checkpoint");
        FILES
            .map(|name| std::fs::read(path.join(name)).expect("a checkpoint is three files"))
            .join(BORDER)
    })
}

fn files(bytes: &[u8]) -> [&[u8]; 3] {
    let mut rest = bytes;
    let mut take = || {
        let at = rest.windows(BORDER.len()).position(|window| window == BORDER);
        let (file, after) =
            at.map_or((rest, &rest[rest.len()..]), |at| (&rest[..at], &rest[at + BORDER.len()..]));
        rest = after;
        file
    };
    [take(), take(), take()]
}

/// Lengths of the headers, then the checksums, are made to fit what is there.
fn fit(bytes: Vec<u8>) -> Vec<u8> {
    let [weights, training, state] = files(&bytes);
    let (weights, training) = (fit_header(weights), fit_header(training));
    let mut text = String::from_utf8_lossy(state).into_owned();
    for (key, sum) in [
        ("\"weights_checksum\": ", crc32c(&weights)),
        ("\"training_checksum\": ", crc32c(&training)),
    ] {
        if let Some(start) = text.find(key).map(|at| at + key.len()) {
            let digits = text[start..].bytes().take_while(u8::is_ascii_digit).count();
            text.replace_range(start..start + digits, &sum.to_string());
        }
    }
    [weights, training, text.into_bytes()].join(BORDER)
}

/// A safetensors file begins with the length of its header, which ends in braces and spaces. One
/// that fits is left alone: the numbers behind it may look like braces.
pub(super) fn fit_header(file: &[u8]) -> Vec<u8> {
    let mut file = file.to_vec();
    let stated =
        file.first_chunk().and_then(|bytes| usize::try_from(u64::from_le_bytes(*bytes)).ok());
    let header = stated.and_then(|length| file[8..].get(..length));
    if header.is_some_and(|header| header.trim_ascii_end().ends_with(b"}}")) {
        return file;
    }
    let end = file.windows(2).take(1 << 14).rposition(|window| window == b"}}").map(|at| at + 2);
    if let Some(end) = end.filter(|&end| end > 8) {
        let spaces = file[end..].iter().take_while(|byte| **byte == b' ').count();
        file[..8].copy_from_slice(&((end + spaces - 8) as u64).to_le_bytes());
    }
    file
}

/// Reads a checkpoint and trains on from it.
fn go_on(bytes: &[u8]) -> bool {
    let path = folder("checkpoint");
    write(&path, bytes);
    let went_on = Loaded::read(&path).and_then(|loaded| {
        let mut session = Session::new(small(), &Beginning::Everything(Box::new(loaded)), &worlds)?;
        session.turn(&mut |_| {})
    });
    match went_on {
        Ok(_) => true,
        // A thread's panic is reported as an error; here it is a finding.
        Err(LearnError::Panic(text)) => panic!("{text}"),
        Err(error) => {
            assert_presentable(&error.to_string());
            false
        }
    }
}

fn write(path: &Path, bytes: &[u8]) {
    std::fs::create_dir_all(path).expect("a place for files");
    for (name, file) in FILES.iter().zip(files(bytes)) {
        std::fs::write(path.join(name), file).expect("a place for files");
    }
}
