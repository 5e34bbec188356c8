//! A world for a viewer. It lives in a thread of its own while the viewer is there, and costs nothing otherwise.
//!
//! | module | what it holds |
//! |---|---|
//! | `query` | what an address asks for, bounded |
//! | `rehearsal` | an episode acted out once, with what every step brought and what the agent thought |
//! | `watching` | an episode shown: pause, tic, speed, jumps |
//! | `playing` | an episode played by a person |
//! | `frame` | a moment as one message: numbers and compressed pictures |
//! | `line` | the WebSocket: frames out, commands in, both bounded |

mod frame;
mod line;
mod playing;
mod query;
mod rehearsal;
mod watching;

use crate::answer::refusal;
use crate::server::Shared;
use axum::extract::ws::WebSocketUpgrade;
use axum::extract::{Query, State};
use axum::http::StatusCode;
use axum::response::Response;
use query::{PlayQuery, WatchQuery};
use std::path::PathBuf;
use std::sync::Arc;

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
    let bad = |why: String| refusal(StatusCode::BAD_REQUEST, &why);
    query.check().map_err(bad)?;
    let performer = match query.agent.split_once(':') {
        Some(("run", id)) => {
            let run = crate::runs::directory(&shared, id.to_owned()).await?;
            Performer::Agent { run, best: query.best, greedy: query.greedy }
        }
        Some(("zoo", name)) => {
            let run = shared.agents.zoo_run(name).map_err(bad)?;
            Performer::Agent { run, best: false, greedy: query.greedy }
        }
        Some(("episode", name)) => Performer::Recorded(crate::episodes::path(&shared, name).map_err(bad)?),
        _ => Performer::Fixed(query.agent.parse().map_err(|error: hasard_envs::EnvError| bad(error.to_string()))?),
    };
    line::open(Arc::clone(&shared), upgrade, move |line| watching::show(&shared, &query, performer, line))
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
