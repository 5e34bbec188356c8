//! What an address asks for, or the line that says what is wrong with it.

use crate::answer::refusal;
use axum::extract::{FromRequestParts, Query};
use axum::http::StatusCode;
use axum::http::request::Parts;
use axum::response::{IntoResponse, Response};
use serde::de::{DeserializeOwned, Error};
use serde::{Deserialize, Deserializer};

/// What stands behind the question mark. Wrong, it is answered as everything else is: in JSON.
pub(crate) struct Asked<T>(pub T);

/// What is wrong with an address.
pub(crate) struct Wrong(pub String);

impl IntoResponse for Wrong {
    fn into_response(self) -> Response {
        refusal(StatusCode::BAD_REQUEST, &self.0)
    }
}

impl<T: DeserializeOwned, S: Send + Sync> FromRequestParts<S> for Asked<T> {
    type Rejection = Wrong;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Asked<T>, Wrong> {
        let Query(asked) = Query::try_from_uri(&parts.uri).map_err(|rejection| {
            let text = rejection.body_text();
            let why = text.rsplit("query string: ").next().unwrap_or(&text);
            Wrong(format!("the address cannot be understood: {why}"))
        })?;
        Ok(Asked(asked))
    }
}

/// A seed, with words for those who give another thing.
pub(crate) fn seed<'de, D: Deserializer<'de>>(given: D) -> Result<u64, D::Error> {
    let text = String::deserialize(given)?;
    text.parse().map_err(|_| {
        let begin: String = text.chars().take(24).collect();
        D::Error::custom(format!(
            "{begin:?} is no seed; give a whole number from 0 to {}",
            u64::MAX
        ))
    })
}
