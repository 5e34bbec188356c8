//! Opens a window on an environment: `cargo run --release -p hasard-play --features
//! window --example window RemedyRushLevel1-v0`.

fn main() {
    let env = std::env::args().nth(1).unwrap_or_else(|| "RemedyRushLevel1-v0".into());
    let options = hasard_envs::EnvOptions {
        full_actions: true,
        size: hasard_envs::FrameSize { width: 640, height: 480 },
        ..hasard_envs::EnvOptions::default()
    };
    let settings = hasard_play::PlaySettings {
        fits_window: true,
        rivals: Vec::new(),
        env,
        options,
        seed: 1,
        folder: Some("human".into()),
        player: "human".into(),
    };
    match hasard_play::play(settings) {
        Ok(files) => files.iter().for_each(|file| println!("{}", file.display())),
        Err(error) => {
            eprintln!("{error}");
            std::process::exit(2);
        }
    }
}
