//! `hasard train FILE --resume` where the task's file is gone: the run has kept its text.

use crate::args::TrainArgs;
use crate::failure::Failure;
use crate::number::{env_id, is_absent_file};
use hasard_envs::own::path_and_level;
use hasard_envs::{EnvId, Scenario};
use hasard_learn::config::{EnvConfig, TrainConfig};
use hasard_learn::runs::run_directory::{go_on, read_config};
use hasard_media::shell::quote;
use std::path::Path;

/// The command with the run's own tasks in the place of files that are no longer there, which its
/// parser leaves as they were typed.
///
/// # Errors
/// Where no run has kept such a file, or what to name instead.
pub fn named(args: &TrainArgs) -> Result<TrainArgs, Failure> {
    let mut args = args.clone();
    let Some(absent) = args.env.split(',').find(|word| is_absent_file(word)) else {
        return Ok(args);
    };
    let run = match &args.out {
        Some(out) if args.resume && out.join("config.json").exists() => out,
        None if args.resume => {
            return Err(Failure::bad(format!(
                "{absent}: is not there, but its run keeps the task; name that too: hasard train {} --resume --out RUN",
                quote(Path::new(&args.env))
            )));
        }
        // What begins needs the file: the line says what is wrong with it.
        _ => {
            args.env = env_id(&args.env).map_err(Failure::bad)?;
            return Ok(args);
        }
    };
    let config = read_config(run).map_err(Failure::bad)?;
    let ids: Result<Vec<String>, Failure> =
        args.env.split(',').map(|word| id_of(word.trim(), &config, run)).collect();
    args.env = ids?.join(",");
    Ok(args)
}

/// The id that a word names, by the run's own text where it is a file that is not there.
fn id_of(word: &str, config: &TrainConfig, run: &Path) -> Result<String, Failure> {
    if !is_absent_file(word) {
        return env_id(word).map_err(Failure::bad);
    }
    let (path, level) = path_and_level(word);
    let level = level.map_or(Some(1), |level| level.parse().ok());
    let kept = kept(&config.env, Path::new(path)).zip(level);
    let there = kept.filter(|(scenario, level)| (1..=scenario.levels.max(1)).contains(level));
    let Some((scenario, level)) = there else {
        return Err(Failure::bad(format!(
            "{word}: is not there, and the run in {} keeps another task; go on with that: {}",
            run.display(),
            go_on(config, run)
        )));
    };
    Ok(EnvId { scenario, level }.to_string())
}

/// The task that a run has kept of a file: of the same path, or of the same name from wherever it
/// is called now.
fn kept(env: &EnvConfig, path: &Path) -> Option<Scenario> {
    let all = || env.scenario_file.iter().chain(&env.scenario_files).map(|kept| kept.scenario());
    let of = |same: &dyn Fn(&Path) -> bool| {
        all().find(|scenario| scenario.file.is_some_and(|file| same(Path::new(file.path))))
    };
    of(&|kept| kept == path).or_else(|| of(&|kept| kept.file_name() == path.file_name()))
}
