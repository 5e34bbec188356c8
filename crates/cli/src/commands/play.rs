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
    let first = hasard_play::guide::task(&args.env).map_or(0, |task| task.seed);
    let rivals = rivals(&args.env, args.env_args.hard, &args.out);
    let settings = hasard_play::PlaySettings {
        env: args.env.clone(),
        options,
        fits_window: args.env_args.size.is_none(),
        rivals,
        seed: args.seed.unwrap_or(first),
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

/// Results within the budget: of kept episodes, and of the zoo's agent; the best first.
#[cfg(feature = "window")]
fn rivals(env: &str, hard: bool, folder: &std::path::Path) -> Vec<hasard_play::Rival> {
    use hasard_learn::runs::zoo_results::results;
    use hasard_play::Rival;
    let people = hasard_play::kept_results(folder, env, hard);
    let zoo = results().iter().filter(|one| one.env == env && !hard);
    let zoo = zoo.filter(|one| one.cost <= one.budget).map(|one| Rival {
        who: format!("{} of the zoo, mean of many episodes", one.algorithm),
        episode_return: one.episode_return,
    });
    let mut all: Vec<Rival> = people.into_iter().chain(zoo).collect();
    all.sort_by(|a, b| b.episode_return.total_cmp(&a.episode_return));
    all
}

/// Runs the command.
#[cfg(not(feature = "window"))]
pub fn run(args: &PlayArgs) -> Outcome {
    let problem = "this hasard was built without its window; build it with: cargo build --release -p hasard --features window";
    Err(Failure::bad(format!("play {}: {problem}", args.env)))
}
