//! An episode of an agent as a film to keep.

use super::performer::{Performer, performer};
use super::query::WatchQuery;
use super::rehearsal::Rehearsal;
use crate::answer::{long_job, refusal};
use crate::asked::Asked;
use crate::shared::Shared;
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use hasard_media::files::{Scratch, read_limited};
use hasard_play::{Film, PlayError};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// Largest film that is sent.
const LARGEST_FILM: u64 = 256 << 20;
/// Time that an agent has to act out its episode.
const PATIENCE: Duration = Duration::from_secs(120);

/// The whole episode that a link of the watch page shows, as MP4.
pub(crate) async fn film(
    State(shared): State<Arc<Shared>>,
    Asked(query): Asked<WatchQuery>,
) -> Result<Response, Response> {
    query.check().map_err(|why| refusal(StatusCode::BAD_REQUEST, &why))?;
    let performer =
        performer(&shared, &query).await.map_err(|why| refusal(StatusCode::NOT_FOUND, &why))?;
    let places = Arc::clone(&shared.long_jobs);
    let made = long_job(&places, move || filmed(&shared, &query, &performer));
    let (name, bytes) =
        made.await?.map_err(|why| refusal(StatusCode::UNPROCESSABLE_ENTITY, &why))?;
    let disposition = format!("attachment; filename=\"{name}\"");
    Ok((
        [
            (header::CONTENT_TYPE, "video/mp4".to_owned()),
            (header::CONTENT_DISPOSITION, disposition),
        ],
        bytes,
    )
        .into_response())
}

fn filmed(
    shared: &Shared,
    query: &WatchQuery,
    performer: &Performer,
) -> Result<(String, Vec<u8>), String> {
    static NUMBER: AtomicU64 = AtomicU64::new(0);
    let mut rehearsal = Rehearsal::new(shared, query, performer)?;
    rehearsal.go_on(PATIENCE, usize::MAX);
    let number = NUMBER.fetch_add(1, Ordering::Relaxed);
    let out = std::env::temp_dir()
        .join(format!("hasard-serve-watched-{}-{number}.mp4", std::process::id()));
    let out = Scratch::new(out);
    let mut stage = rehearsal.stage(shared)?;
    let views = query.views()?;
    let mut film = || -> Result<Vec<u8>, PlayError> {
        let mut film = Film::begin(&stage, out.path(), query.size(), &views, 1)?;
        while !stage.ended() {
            if stage.wants_action() {
                match rehearsal.command(stage.env().episode().length as usize) {
                    Some(command) => stage.press(command),
                    None => break,
                }
            }
            stage.tic();
            film.tic(&stage)?;
        }
        film.finish()?;
        Ok(read_limited(out.path(), LARGEST_FILM)?)
    };
    let bytes = film().map_err(|error| error.to_string())?;
    Ok((format!("{}-seed{}.mp4", rehearsal.id, rehearsal.seed), bytes))
}
