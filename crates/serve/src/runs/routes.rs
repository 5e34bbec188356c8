//! The list of runs, their curves, heatmaps, maps and report.

use super::asked::{Chosen, One, directory, on_catalogue};
use crate::answer::{aside, json_of, long_job, refusal};
use crate::asked::Asked;
use crate::catalogue::files::read;
use crate::shared::Shared;
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use hasard_learn::runs::checksum::sha256;
use serde::Deserialize;
use serde_json::Value;
use std::path::Path;
use std::sync::{Arc, LazyLock};

/// Columns of a chart page at a time: a run has some forty metrics, most with an evaluation beside
/// them.
const MAX_COLUMNS: usize = 256;

#[derive(Deserialize)]
pub(crate) struct Since {
    /// Changes that the asker has seen.
    #[serde(default)]
    since: u64,
}

/// Every run that changed since.
pub(crate) async fn list(
    State(shared): State<Arc<Shared>>,
    Asked(query): Asked<Since>,
) -> Result<Response, Response> {
    let listing = on_catalogue(shared, move |catalogue| {
        catalogue.refresh();
        catalogue.changed_since(query.since)
    });
    Ok(json_of(&listing.await?))
}

/// One heatmap of a run.
pub(crate) async fn heatmap(
    State(shared): State<Arc<Shared>>,
    Asked(query): Asked<One>,
) -> Result<Response, Response> {
    let path = directory(&shared, query.id).await?;
    let line = aside(move || {
        let text = read(&path.join("heatmaps.jsonl"))?;
        serde_json::from_str::<Value>(text.lines().nth(query.at)?).ok()
    });
    Ok(json_of(
        &line
            .await?
            .ok_or_else(|| refusal(StatusCode::NOT_FOUND, "this run has no such heatmap"))?,
    ))
}

/// The map that a heatmap lies over: another one in each lesson of a curriculum.
pub(crate) async fn automap(
    State(shared): State<Arc<Shared>>,
    Asked(query): Asked<One>,
) -> Result<Response, Response> {
    let folder = directory(&shared, query.id).await?;
    let picture = aside(move || {
        let lines = read(&folder.join("heatmaps.jsonl")).unwrap_or_default();
        let line = lines
            .lines()
            .nth(query.at)
            .and_then(|line| serde_json::from_str::<Value>(line).ok())
            .unwrap_or(Value::Null);
        let name = line["automap"].as_str().unwrap_or("automap.png");
        // A name that leads elsewhere is no name.
        let plain =
            Path::new(name).file_name().is_some_and(|file| file == name) && !name.starts_with('.');
        let file = folder.join(if plain { name } else { "automap.png" });
        hasard_media::png::read(&file).ok().map(|picture| hasard_media::png::encode(&picture))
    });
    let bytes =
        picture.await?.ok_or_else(|| refusal(StatusCode::NOT_FOUND, "this run has no automap"))?;
    Ok(([(header::CONTENT_TYPE, "image/png")], bytes).into_response())
}

/// Columns of some runs, thinned to what a chart can show.
pub(crate) async fn curves(
    State(shared): State<Arc<Shared>>,
    Asked(query): Asked<Chosen>,
) -> Result<Response, Response> {
    let ids = query.ids()?;
    let names: Vec<String> = query.columns.split(',').map(str::to_owned).collect();
    if names.len() > MAX_COLUMNS {
        let why = format!(
            "{} columns are more than a page of charts takes; choose {MAX_COLUMNS} at most",
            names.len()
        );
        return Err(refusal(StatusCode::BAD_REQUEST, &why));
    }
    let body = on_catalogue(shared, move |catalogue| {
        let curve = |id: &String| Some((id.clone(), catalogue.columns(id)?.thinned(&names)));
        ids.iter().filter_map(curve).collect::<serde_json::Map<String, Value>>()
    });
    Ok(json_of(&Value::Object(body.await?)))
}

/// The page of a report of some runs, as `hasard report` writes it.
pub(crate) async fn report(
    State(shared): State<Arc<Shared>>,
    Asked(query): Asked<Chosen>,
) -> Result<Response, Response> {
    let ids = query.ids()?;
    let paths = on_catalogue(Arc::clone(&shared), move |catalogue| {
        ids.iter().filter_map(|id| catalogue.path(id)).collect::<Vec<_>>()
    })
    .await?;
    let page = long_job(&shared.long_jobs, move || hasard_report::report_page(&paths, "Runs"));
    let page = page.await?.map_err(|why| refusal(StatusCode::UNPROCESSABLE_ENTITY, &why))?;
    let headers = [
        (header::CONTENT_TYPE, "text/html; charset=utf-8"),
        (header::CONTENT_SECURITY_POLICY, report_policy()),
    ];
    Ok((headers, page).into_response())
}

/// The report is one page with its pictures, style and script within: its own script sorts tables
/// and reads curves, and by its hash no other runs.
fn report_policy() -> &'static str {
    static POLICY: LazyLock<String> = LazyLock::new(|| {
        let hex = sha256(hasard_report::SCRIPT.as_bytes());
        let pairs = hex.as_bytes().chunks(2).filter_map(|pair| str::from_utf8(pair).ok());
        let bytes: Vec<u8> = pairs.filter_map(|pair| u8::from_str_radix(pair, 16).ok()).collect();
        format!(
            "default-src 'none'; img-src data:; style-src 'unsafe-inline'; frame-ancestors 'none'; script-src 'sha256-{}'",
            hasard_report::base64(&bytes)
        )
    });
    &POLICY
}
