//! `hasard play`: a window for people.

use crate::args::PlayArgs;
use crate::failure::{Failure, Outcome};

/// Runs the command.
#[cfg(feature = "window")]
pub fn run(args: &PlayArgs) -> Outcome {
    use crate::args::Size;
    use hasard_media::shell::quote;
    let options = crate::settings::env_options(&args.env_args, Size { width: 640, height: 480 })?;
    let folder = (!args.no_record).then(|| args.out.clone());
    let settings = hasard_play::PlaySettings {
        env: args.env.clone(),
        options,
        seed: args.seed,
        folder,
        player: args.player.clone(),
    };
    let episodes = hasard_play::play(settings).map_err(Failure::bad)?;
    for path in &episodes {
        say!("{}", path.display());
    }
    if let Some(path) = episodes.first() {
        let (path, out) = (quote(path), quote(&args.out));
        say!("see it again: hasard replay {path} -o episode.mp4; count it: hasard report {out}");
    }
    Ok(())
}

/// Runs the command.
#[cfg(not(feature = "window"))]
pub fn run(args: &PlayArgs) -> Outcome {
    let problem = "this hasard was built without its window; build it with: cargo build --release -p hasard --features window";
    Err(Failure::bad(format!("play {}: {problem}", args.env)))
}
