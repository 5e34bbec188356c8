//! An episode is watched or played: what the two addresses do.

use super::performer::performer;
use super::query::{PlayQuery, WatchQuery};
use super::{line, playing, watching};
use crate::answer::refusal;
use crate::shared::Shared;
use axum::extract::ws::WebSocketUpgrade;
use axum::extract::{Query, State};
use axum::http::StatusCode;
use axum::response::Response;
use serde_json::json;
use std::sync::Arc;

/// Shows an episode.
pub(crate) async fn watch(
    State(shared): State<Arc<Shared>>,
    Query(query): Query<WatchQuery>,
    upgrade: WebSocketUpgrade,
) -> Result<Response, Response> {
    query.check().map_err(|why| refusal(StatusCode::BAD_REQUEST, &why))?;
    let performer = performer(&shared, &query).await;
    line::open(Arc::clone(&shared), upgrade, move |mut line| match performer {
        Ok(performer) => watching::show(&shared, &query, performer, line),
        // A page sees nothing of a refused handshake; what is said on the line it shows.
        Err(why) => {
            let _ = line.say(&json!({ "kind": "error", "why": why }));
        }
    })
}

/// Lets a person play.
pub(crate) async fn play(
    State(shared): State<Arc<Shared>>,
    Query(query): Query<PlayQuery>,
    upgrade: WebSocketUpgrade,
) -> Result<Response, Response> {
    query.check().map_err(|why| refusal(StatusCode::BAD_REQUEST, &why))?;
    line::open(Arc::clone(&shared), upgrade, move |line| playing::play(&shared, &query, line))
}
