//! Which runs are asked for.

use crate::answer::{aside, refusal};
use crate::catalogue::Catalogue;
use crate::shared::Shared;
use axum::http::StatusCode;
use axum::response::Response;
use serde::Deserialize;
use std::path::PathBuf;
use std::sync::{Arc, PoisonError};

/// Runs of a chart at a time.
const MAX_CHOSEN: usize = 100;

/// Works on the catalogue, away from the threads that answer.
pub(super) async fn on_catalogue<T: Send + 'static>(
    shared: Arc<Shared>,
    work: impl FnOnce(&mut Catalogue) -> T + Send + 'static,
) -> Result<T, Response> {
    // The catalogue only caches files: after a panic, what it holds is still read again.
    aside(move || work(&mut shared.catalogue.lock().unwrap_or_else(PoisonError::into_inner))).await
}

/// The directory of a run by its id; paths never come from outside.
pub(crate) async fn directory(shared: &Arc<Shared>, id: String) -> Result<PathBuf, Response> {
    let found = on_catalogue(Arc::clone(shared), move |catalogue| {
        catalogue.refresh();
        catalogue.path(&id)
    });
    found.await?.ok_or_else(|| {
        refusal(StatusCode::NOT_FOUND, "there is no such run; choose one from the list of runs")
    })
}

/// One run.
#[derive(Deserialize)]
pub(crate) struct One {
    pub id: String,
    /// The number of a moment.
    #[serde(default)]
    pub at: usize,
}

/// Some runs, and columns of them.
#[derive(Deserialize)]
pub(crate) struct Chosen {
    /// Ids of runs, separated by commas.
    pub runs: String,
    /// Names of columns, separated by commas.
    #[serde(default)]
    pub columns: String,
}

impl Chosen {
    /// The ids, if there are not too many.
    pub fn ids(&self) -> Result<Vec<String>, Response> {
        let ids: Vec<String> =
            self.runs.split(',').filter(|id| !id.is_empty()).map(str::to_owned).collect();
        if ids.is_empty() || ids.len() > MAX_CHOSEN {
            return Err(refusal(StatusCode::BAD_REQUEST, "choose 1 to 100 runs"));
        }
        Ok(ids)
    }
}
