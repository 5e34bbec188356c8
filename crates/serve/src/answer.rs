//! What a request is answered with.

use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde_json::{Value, json};

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
