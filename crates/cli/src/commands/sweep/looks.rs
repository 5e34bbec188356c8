//! Maps and pictures of a sweep's runs, which are read before anything is listed, measured or run.

use crate::args::SweepArgs;
use crate::failure::{Failure, Outcome};
use crate::sources::looks_reporting;
use hasard_learn::config::{EnvConfig, TrainConfig};
use std::path::Path;

/// Refuses a place that has none of them, by the key that names it.
pub fn check(args: &SweepArgs, configs: &[TrainConfig]) -> Outcome {
    let mut seen: Vec<&EnvConfig> = Vec::new();
    for env in configs.iter().map(|config| &config.env) {
        if (env.iwad.is_none() && env.maps.is_none()) || seen.contains(&env) {
            continue;
        }
        read(env).map_err(|failure| {
            let key = key_of(env, &failure);
            failure.about(&named(args, key))
        })?;
        seen.push(env);
    }
    Ok(())
}

fn read(env: &EnvConfig) -> Outcome {
    // What a map leaves out is said once the map is played.
    let looks = looks_reporting(env.maps.as_deref(), env.iwad.as_deref(), |_| ())?;
    let rules = env.options().map_err(Failure::bad)?.rules;
    if let Some(maps) = &looks.maps {
        for id in env.tasks().iter().filter_map(|task| task.env_id().ok()) {
            maps.level(id, rules, env.hard).map_err(Failure::bad)?;
        }
    }
    Ok(())
}

/// The one of the two that a line is about: it begins with the path, or says that the pictures of
/// `auto` are not found.
fn key_of(env: &EnvConfig, failure: &Failure) -> &'static str {
    let Failure::BadInput(line) = failure else { return "maps" };
    let of_pictures = |iwad: &Path| {
        line.starts_with(&iwad.display().to_string()) || line.starts_with("iwad auto")
    };
    let pictures = env.maps.is_none() || env.iwad.as_deref().is_some_and(of_pictures);
    if pictures { "iwad" } else { "maps" }
}

/// Where a sweep says an option.
fn named(args: &SweepArgs, key: &str) -> String {
    let typed = args.option.iter().find(|option| option.split('=').next() == Some(key));
    match typed {
        Some(option) => format!("--option {option}"),
        None => format!("{}: `{key}` under [options]", args.what.to_string_lossy()),
    }
}
