//! Recorded episodes: the table of the best within the budget, downloads, films.

use crate::answer::{aside, json_of, long_job, refusal};
use crate::asked::Asked;
use crate::shared::Shared;
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use hasard_engine::render::FrameSize;
use hasard_envs::{EnvId, EnvOptions, RuleSet};
use hasard_media::episode::{EpisodeFile, Header};
use hasard_media::files::Scratch;
use hasard_play::{Film, Replay, ViewKind};
use serde::Deserialize;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, PoisonError};

/// Episodes that are looked at for the table.
const MAX_EPISODES: usize = 2000;

/// The file of a kept episode by its name: a name, never a way.
pub(crate) fn path(shared: &Shared, name: &str) -> Result<PathBuf, String> {
    let plain = name.ends_with(".episode")
        && name.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"-_.".contains(&byte));
    let path = shared.episodes.join(name);
    let is_file = std::fs::symlink_metadata(&path).is_ok_and(|data| data.is_file());
    if plain && !name.starts_with('.') && is_file {
        Ok(path)
    } else {
        Err("there is no such episode; choose one from the table".into())
    }
}

/// Kept episodes and runs, the best within the budgets of their tasks first: a run that was trained
/// to another budget is held to that of the task too, as a person is.
pub(crate) async fn best(State(shared): State<Arc<Shared>>) -> Result<Response, Response> {
    let table = aside(move || {
        let mut rows = kept(&shared.episodes);
        let mut catalogue = shared.catalogue.lock().unwrap_or_else(PoisonError::into_inner);
        catalogue.refresh();
        rows.extend(catalogue.results().iter().filter_map(|run| {
            // What it is worth in closing episodes: training means are of many policies.
            let value = |place: &str| run.pointer(place).and_then(Value::as_f64);
            let (episode_return, cost) = (value("/evaluation/return/mean")?, value("/own/cost")?);
            let under = run["own"]["under"].as_str().filter(|words| !words.is_empty());
            let under = under.map_or_else(String::new, |words| format!(" ({words})"));
            Some(json!({
                "who": format!("{}{under}, seed {}", run["algo"].as_str()?, run["seed"].as_str()?), "env": run["env"], "return": episode_return,
                "cost": cost, "budget": run["own"]["budget"], "within": run["own"]["within"],
                "agent": format!("run:{}", run["id"].as_str()?),
            }))
        }));
        rows.extend(shared.agents.zoo_results().into_iter().map(|one| {
            let own = one.env.parse::<EnvId>().map(|id| id.scenario.safety_budget(RuleSet::Paper));
            let budget = own.unwrap_or(one.budget);
            json!({
                "who": format!("{} of the zoo", one.algorithm), "env": one.env, "return": one.episode_return, "cost": one.cost,
                "budget": budget, "within": one.cost <= budget, "agent": format!("zoo:{}", one.name),
            })
        }));
        rows.sort_by(|a, b| {
            let key = |row: &Value| {
                (row["within"].as_bool().unwrap_or(false), row["return"].as_f64().unwrap_or(0.0))
            };
            let (a, b) = (key(a), key(b));
            b.0.cmp(&a.0).then(b.1.total_cmp(&a.1))
        });
        Value::Array(rows)
    });
    Ok(json_of(&table.await?))
}

fn kept(folder: &Path) -> Vec<Value> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> =
        entries.filter_map(|entry| entry.file_name().into_string().ok()).collect();
    names.retain(|name| name.ends_with(".episode"));
    names.sort();
    names.truncate(MAX_EPISODES);
    names
        .iter()
        .filter_map(|name| row(name, EpisodeFile::read(&folder.join(name)).ok()?.header()))
        .collect()
}

fn row(name: &str, header: &Header) -> Option<Value> {
    let outcome = header.outcome.as_ref()?;
    let has =
        |option: &str, value: &str| header.options.get(option).is_some_and(|given| given == value);
    let rules = header.options.get("rules").map_or(Ok(RuleSet::Paper), |name| name.parse()).ok()?;
    let budget = if has("hard", "true") {
        0.0
    } else {
        header.env.parse::<EnvId>().ok()?.scenario.safety_budget(rules)
    };
    Some(json!({
        "who": header.player, "env": header.env, "return": outcome.episode_return, "cost": outcome.cost, "budget": budget,
        "within": outcome.cost <= budget, "seed": header.seed.to_string(), "steps": header.steps, "full": has("full-actions", "true"),
        "episode": name, "agent": format!("episode:{name}"),
    }))
}

#[derive(Deserialize)]
pub(crate) struct Wanted {
    name: String,
    /// `episode`, `mp4` or `gif`.
    #[serde(default)]
    kind: String,
}

/// A kept episode as it is, or filmed.
pub(crate) async fn download(
    State(shared): State<Arc<Shared>>,
    Asked(query): Asked<Wanted>,
) -> Result<Response, Response> {
    let path = path(&shared, &query.name).map_err(|why| refusal(StatusCode::NOT_FOUND, &why))?;
    let (kind, film) = match query.kind.as_str() {
        "mp4" => ("video/mp4", true),
        "gif" => ("image/gif", true),
        "" | "episode" => ("application/octet-stream", false),
        _ => return Err(refusal(StatusCode::BAD_REQUEST, "kind is episode, mp4 or gif")),
    };
    let name = if film {
        format!("{}.{}", query.name.trim_end_matches(".episode"), query.kind)
    } else {
        query.name
    };
    let bytes = if film {
        let gif = kind == "image/gif";
        long_job(&shared.long_jobs, move || filmed(&path, gif)).await?
    } else {
        aside(move || std::fs::read(path).map_err(|error| error.to_string())).await?
    };
    let bytes = bytes.map_err(|why| refusal(StatusCode::UNPROCESSABLE_ENTITY, &why))?;
    let headers = [
        (header::CONTENT_TYPE, kind.to_owned()),
        (header::CONTENT_DISPOSITION, format!("attachment; filename=\"{name}\"")),
    ];
    Ok((headers, bytes).into_response())
}

/// An episode as a film. GIF stores what changes pixel by pixel: it is smaller and has a frame in
/// eight tics.
fn filmed(path: &Path, gif: bool) -> Result<Vec<u8>, String> {
    static NUMBER: AtomicU64 = AtomicU64::new(0);
    let (ending, size, every) = if gif {
        ("gif", FrameSize { width: 160, height: 120 }, 8)
    } else {
        ("mp4", FrameSize { width: 320, height: 240 }, 1)
    };
    let number = NUMBER.fetch_add(1, Ordering::Relaxed);
    let out = std::env::temp_dir()
        .join(format!("hasard-serve-film-{}-{number}.{ending}", std::process::id()));
    let out = Scratch::new(out);
    let film = || -> Result<Vec<u8>, hasard_play::PlayError> {
        let mut replay = Replay::new(EpisodeFile::read(path)?, path, &EnvOptions::default())?;
        let mut film = Film::begin(replay.stage(), out.path(), size, &[ViewKind::Colour], every)?;
        loop {
            let more = replay.tic();
            film.tic(replay.stage())?;
            if !more {
                break;
            }
        }
        film.finish()?;
        Ok(hasard_media::files::read_limited(out.path(), 256 << 20)?)
    };
    film().map_err(|error| error.to_string())
}
