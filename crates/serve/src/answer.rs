//! What a request is answered with.

use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde_json::{Value, json};
use std::sync::Arc;
use tokio::sync::Semaphore;

/// A JSON document.
pub(crate) fn json_of(value: &Value) -> Response {
    ([(header::CONTENT_TYPE, "application/json")], value.to_string()).into_response()
}

/// Why not, in one line.
pub(crate) fn refusal(status: StatusCode, why: &str) -> Response {
    (status, json_of(&json!({ "error": why }))).into_response()
}

/// Work that reads files or draws, away from the threads that answer.
pub(crate) async fn aside<T: Send + 'static>(
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<T, Response> {
    tokio::task::spawn_blocking(work)
        .await
        .map_err(|_| refusal(StatusCode::INTERNAL_SERVER_ERROR, "this failed; the server goes on"))
}

/// As [`aside`], for work that keeps a core busy: refused while there is no place for it. The place
/// is the work's own, since a visitor who leaves ends the wait and not the work.
pub(crate) async fn long_job<T: Send + 'static>(
    places: &Arc<Semaphore>,
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<T, Response> {
    let Ok(place) = Arc::clone(places).try_acquire_owned() else {
        return Err(refusal(
            StatusCode::SERVICE_UNAVAILABLE,
            "films or reports are in the making; ask again in a moment",
        ));
    };
    aside(move || {
        let done = work();
        drop(place);
        done
    })
    .await
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::channel;
    use std::time::Duration;

    #[test]
    fn work_that_nobody_waits_for_keeps_its_place() {
        let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build().unwrap();
        let places = Arc::new(Semaphore::new(1));
        let (begun, begins) = channel();
        let (end, ends) = channel::<()>();
        let work = move || {
            begun.send(()).unwrap();
            ends.recv().unwrap();
        };
        let asked = Arc::clone(&places);
        let visitor = runtime.spawn(async move { long_job(&asked, work).await.is_ok() });
        begins.recv_timeout(Duration::from_secs(20)).unwrap();
        // The visitor leaves: nobody else gets the place while the work goes on.
        visitor.abort();
        assert!(runtime.block_on(visitor).unwrap_err().is_cancelled());
        assert_eq!(places.available_permits(), 0);
        let refused = runtime.block_on(long_job(&places, || ())).unwrap_err();
        assert_eq!(refused.status(), StatusCode::SERVICE_UNAVAILABLE);
        end.send(()).unwrap();
        let given_back =
            async { tokio::time::timeout(Duration::from_secs(20), places.acquire()).await.is_ok() };
        assert!(runtime.block_on(given_back));
    }
}
