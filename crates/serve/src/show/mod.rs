//! A world for a viewer. It lives in a thread of its own while the viewer is there, and costs
//! nothing otherwise.
//!
//! | module | what it holds |
//! |---|---|
//! | `query` | what an address asks for, bounded |
//! | `rehearsal` | an episode acted out once, with what every step brought and what the agent thought |
//! | `repertoire` | an agent's episodes at a glance: seed, return, cost |
//! | `stages` | stages built lately, shared by their viewers |
//! | `watching` | an episode shown: pause, tic, speed, jumps |
//! | `filming` | an episode as a film to keep |
//! | `playing` | an episode played by a person |
//! | `frame` | a moment as one message: numbers and compressed pictures |
//! | `line` | the WebSocket: frames out, commands in, both bounded |

mod filming;
mod frame;
mod line;
mod playing;
mod query;
mod rehearsal;
mod repertoire;
mod stages;
mod watching;

pub(crate) use filming::film;
pub(crate) use repertoire::episodes;
pub(crate) use stages::Stages;

use crate::answer::refusal;
use crate::server::Shared;
use axum::extract::ws::WebSocketUpgrade;
use axum::extract::{Query, State};
use axum::http::StatusCode;
use axum::response::Response;
use query::{PlayQuery, WatchQuery};
use serde_json::json;
use std::path::PathBuf;
use std::sync::Arc;

const NO_RUN: &str = "there is no such run; choose one from the list of runs";

/// Who acts on the stage.
enum Performer {
    /// A policy that looks at nothing.
    Fixed(hasard_envs::Policy),
    /// A trained agent.
    Agent { run: PathBuf, best: bool, greedy: bool },
    /// A recorded episode.
    Recorded(PathBuf),
}

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

/// Who an address asks for.
async fn performer(shared: &Arc<Shared>, query: &WatchQuery) -> Result<Performer, String> {
    match query.agent.split_once(':') {
        Some(("run", id)) => {
            let run = crate::runs::directory(shared, id.to_owned()).await.map_err(|_| NO_RUN)?;
            Ok(Performer::Agent { run, best: query.best, greedy: query.greedy })
        }
        Some(("zoo", name)) => {
            let run = shared.agents.zoo_run(name)?;
            Ok(Performer::Agent { run, best: false, greedy: query.greedy })
        }
        Some(("episode", name)) => crate::episodes::path(shared, name).map(Performer::Recorded),
        _ => query
            .agent
            .parse()
            .map(Performer::Fixed)
            .map_err(|error: hasard_envs::EnvError| error.to_string()),
    }
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
