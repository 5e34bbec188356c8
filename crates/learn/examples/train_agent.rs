//! Trains an agent from a program of one's own: `cargo run --release --example train_agent --
//! PPOLag quick 200000 /tmp/run`.

use hasard_learn::config::{EnvConfig, TrainConfig};
use hasard_learn::runs::progress_bar::line;
use hasard_learn::runs::trainer::{Hooks, Start, train};
use std::sync::atomic::AtomicBool;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [algorithm, preset, frames, directory, rest @ ..] = &arguments[..] else {
        return Err("give algorithm, preset, frames and a directory".into());
    };
    let id = rest.first().map_or("VolcanicVentureLevel1-v0", String::as_str);
    let mut config = TrainConfig::new(algorithm.parse()?, preset.parse()?, EnvConfig::new(id))?;
    config.set_frames(frames.parse()?);
    for setting in rest.iter().skip(1) {
        config = config.with(setting)?;
    }
    let options = config.env.options()?;
    let stop = AtomicBool::new(false);
    let summary = train(
        Start::Fresh(config),
        directory.as_ref(),
        // The task of the lesson, where there is a curriculum.
        &|env, lanes| env.worlds(&options, lanes),
        &mut Hooks {
            stop: &stop,
            report: &mut |report| println!("{}", line(report)),
            warn: &mut |warning| eprintln!("{warning}"),
        },
    )?;
    println!("{}", serde_json::to_string_pretty(&summary.last.row())?);
    Ok(())
}
