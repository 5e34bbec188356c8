//! An episode is watched or played: what the two addresses do.
//!
//! A page sees nothing of a refused handshake: whatever is wrong is said on the line.

use super::performer::performer;
use super::query::{PlayQuery, WatchQuery};
use super::{line, playing, watching};
use crate::asked::{Asked, Wrong};
use crate::shared::Shared;
use axum::extract::State;
use axum::extract::ws::WebSocketUpgrade;
use axum::response::Response;
use std::sync::Arc;

/// Shows an episode.
pub(crate) async fn watch(
    State(shared): State<Arc<Shared>>,
    asked: Result<Asked<WatchQuery>, Wrong>,
    upgrade: WebSocketUpgrade,
) -> Response {
    let ready = async {
        let Asked(query) = asked.map_err(|Wrong(why)| why)?;
        query.check()?;
        Ok((performer(&shared, &query).await?, query))
    };
    match ready.await {
        Ok((performer, query)) => line::open(Arc::clone(&shared), upgrade, move |line| {
            watching::show(&shared, &query, performer, line);
        }),
        Err(why) => line::refuse(upgrade, why),
    }
}

/// Lets a person play.
pub(crate) async fn play(
    State(shared): State<Arc<Shared>>,
    asked: Result<Asked<PlayQuery>, Wrong>,
    upgrade: WebSocketUpgrade,
) -> Response {
    let checked = asked.map_err(|Wrong(why)| why);
    match checked.and_then(|Asked(query)| query.check().map(|()| query)) {
        Ok(query) => line::open(Arc::clone(&shared), upgrade, move |line| {
            playing::play(&shared, &query, line);
        }),
        Err(why) => line::refuse(upgrade, why),
    }
}
