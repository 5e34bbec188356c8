//! Who acts on the stage, by an address.

use super::query::WatchQuery;
use crate::shared::Shared;
use std::path::PathBuf;
use std::sync::Arc;

const NO_RUN: &str = "there is no such run; choose one from the list of runs";

/// Who acts on the stage.
pub(super) enum Performer {
    /// A policy that looks at nothing.
    Fixed(hasard_envs::Policy),
    /// A trained agent.
    Agent { run: PathBuf, best: bool, greedy: bool },
    /// A recorded episode.
    Recorded(PathBuf),
}

/// Who an address asks for.
pub(super) async fn performer(
    shared: &Arc<Shared>,
    query: &WatchQuery,
) -> Result<Performer, String> {
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
