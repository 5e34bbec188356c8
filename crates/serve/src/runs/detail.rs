//! One run: its settings beside those of its preset, what it is worth, what it reports.

use super::asked::{Chosen, One, directory, on_catalogue};
use super::metrics::{listed, place};
use crate::answer::{aside, json_of};
use crate::asked::Asked;
use crate::catalogue::files::read;
use crate::shared::Shared;
use axum::extract::State;
use axum::response::Response;
use hasard_learn::config::explained::settings as explained;
use hasard_learn::config::settings::setting_pointer;
use hasard_learn::config::{EnvConfig, TrainConfig};
use hasard_report::run::{Config, read_episode_lines};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

/// Settings that belong to a single run or to its machine: they differ from any preset and say
/// nothing about it.
const OF_ONE_RUN: [&str; 9] = [
    "version",
    "seed",
    "frames",
    "device",
    "learning.schedule_frames",
    "learning.threads",
    "sampling.samplers",
    "sampling.world_threads",
    "sampling.groups",
];

/// Settings of a run, its selected checkpoint, its metrics with their meanings, moments of its
/// heatmaps.
pub(crate) async fn detail(
    State(shared): State<Arc<Shared>>,
    Asked(query): Asked<One>,
) -> Result<Response, Response> {
    let path = directory(&shared, query.id.clone()).await?;
    let id = query.id;
    let found = on_catalogue(Arc::clone(&shared), move |catalogue| {
        let names = catalogue.columns(&id).map(|columns| columns.names()).unwrap_or_default();
        (names, catalogue.results_of(&[id]).pop())
    });
    let (mut names, run) = found.await?;
    let body = aside(move || {
        let config = text_of(&path);
        let heatmaps = read(&path.join("heatmaps.jsonl")).unwrap_or_default();
        let moments = heatmaps.lines().map(|line| {
            serde_json::from_str::<Value>(line).map_or(Value::Null, |line| line["frames"].clone())
        });
        names.sort_by_cached_key(|name| (place(name), name.clone()));
        let metrics = names.iter().map(|name| listed(name));
        json!({
            "run": run, "settings": beside_preset(&config), "metrics": metrics.collect::<Vec<_>>(),
            "heatmaps": moments.collect::<Vec<_>>(), "over": share_over(&path), "frame_skip": config["env"]["frame_skip"],
            "changes": config["changes"],
        })
    });
    Ok(json_of(&body.await?))
}

/// The metrics that any of some runs reports, with their meanings.
pub(crate) async fn reported(
    State(shared): State<Arc<Shared>>,
    Asked(query): Asked<Chosen>,
) -> Result<Response, Response> {
    let ids = query.ids()?;
    let names = on_catalogue(shared, move |catalogue| {
        let of = |id: &String| catalogue.columns(id).map(|columns| columns.names());
        ids.iter().filter_map(of).flatten().collect::<BTreeSet<String>>()
    });
    let mut names: Vec<String> = names.await?.into_iter().collect();
    names.sort_by_cached_key(|name| place(name));
    Ok(json_of(&names.iter().map(|name| listed(name)).collect()))
}

fn text_of(run: &Path) -> Value {
    read(&run.join("config.json"))
        .and_then(|text| serde_json::from_str(&text).ok())
        .unwrap_or(Value::Null)
}

/// Every setting by name: its value, its preset's, its meaning. What an older version wrote is read
/// as what it is called now. A file of other programs is listed as it is.
fn beside_preset(config: &Value) -> Value {
    let Ok(own) = serde_json::from_value::<TrainConfig>(config.clone()) else {
        return as_it_is(config);
    };
    let mut usual = TrainConfig::new(own.algorithm, own.preset, EnvConfig::new(&own.env.id)).ok();
    if let Some(usual) = &mut usual {
        usual.set_frames(own.frames);
    }
    let value = |config: &TrainConfig| serde_json::to_value(config).unwrap_or(Value::Null);
    let (own, usual) = (value(&own), usual.as_ref().map(value));
    let rows = explained().into_iter().filter_map(|one| {
        let pointer = setting_pointer(&one.name);
        let value = own.pointer(&pointer).filter(|value| !value.is_object())?;
        let preset = usual.as_ref().map(|usual| usual.pointer(&pointer).unwrap_or(&Value::Null));
        let differs = preset.is_some_and(|preset| preset != value) && !OF_ONE_RUN.contains(&one.name.as_str());
        let value = shown(&one.name, value);
        Some(json!({ "name": one.name, "value": value, "preset": preset, "differs": differs, "meaning": one.meaning }))
    });
    rows.collect()
}

/// A setting as the page shows it: seeds as text, since a page's numbers do not hold them all.
fn shown(name: &str, value: &Value) -> Value {
    match value.as_u64().filter(|_| name == "seed") {
        Some(seed) => json!(seed.to_string()),
        None => value.clone(),
    }
}

fn as_it_is(config: &Value) -> Value {
    let rows = config.as_object().into_iter().flatten();
    rows.map(|(name, value)| json!({ "name": name, "value": shown(name, value), "preset": null, "differs": false, "meaning": "" })).collect()
}

/// Share of the closing episodes that cost more than a budget; nothing where they were not kept.
fn share_over(run: &Path) -> Option<f64> {
    let path = run.join("closing_episodes.jsonl");
    let episodes = read_episode_lines(&read(&path)?, &path, &mut Vec::new());
    let config = Config::read(&run.join("config.json")).ok()?;
    let over = |episode: &&hasard_report::run::EpisodeResult| {
        config
            .constraints
            .iter()
            .any(|one| episode.cost_of(one).is_some_and(|cost| cost > one.budget))
    };
    (!episodes.is_empty())
        .then(|| episodes.iter().filter(over).count() as f64 / episodes.len() as f64)
}

/// The settings of some runs, so that their differences show.
pub(crate) async fn settings(
    State(shared): State<Arc<Shared>>,
    Asked(query): Asked<Chosen>,
) -> Result<Response, Response> {
    let ids = query.ids()?;
    let paths = on_catalogue(shared, move |catalogue| {
        ids.into_iter().filter_map(|id| Some((catalogue.path(&id)?, id))).collect::<Vec<_>>()
    });
    let paths = paths.await?;
    let body = aside(move || {
        let all = paths.into_iter().map(|(path, id)| (id, beside_preset(&text_of(&path))));
        Value::Object(all.collect())
    });
    Ok(json_of(&body.await?))
}
