//! The pages, embedded: plain HTML, CSS and ES modules without a build step.

use axum::http::header;
use axum::response::{IntoResponse, Response};

const FILES: [(&str, &str, &str); 28] = [
    ("/", "text/html; charset=utf-8", include_str!("pages/index.html")),
    ("/style.css", "text/css; charset=utf-8", include_str!("pages/style.css")),
    ("/app.js", "text/javascript", include_str!("pages/app.js")),
    ("/dom.js", "text/javascript", include_str!("pages/dom.js")),
    ("/chart.js", "text/javascript", include_str!("pages/chart.js")),
    ("/runs.js", "text/javascript", include_str!("pages/runs.js")),
    ("/run.js", "text/javascript", include_str!("pages/run.js")),
    ("/rows.js", "text/javascript", include_str!("pages/rows.js")),
    ("/settings.js", "text/javascript", include_str!("pages/settings.js")),
    ("/scale.js", "text/javascript", include_str!("pages/scale.js")),
    ("/curves.js", "text/javascript", include_str!("pages/curves.js")),
    ("/svg.js", "text/javascript", include_str!("pages/svg.js")),
    ("/metrics.js", "text/javascript", include_str!("pages/metrics.js")),
    ("/tools.js", "text/javascript", include_str!("pages/tools.js")),
    ("/strip.js", "text/javascript", include_str!("pages/strip.js")),
    ("/heat.js", "text/javascript", include_str!("pages/heat.js")),
    ("/names.js", "text/javascript", include_str!("pages/names.js")),
    ("/compare.js", "text/javascript", include_str!("pages/compare.js")),
    ("/scatter.js", "text/javascript", include_str!("pages/scatter.js")),
    ("/tasks.js", "text/javascript", include_str!("pages/tasks.js")),
    ("/episodes.js", "text/javascript", include_str!("pages/episodes.js")),
    ("/notes.js", "text/javascript", include_str!("pages/notes.js")),
    ("/pair.js", "text/javascript", include_str!("pages/pair.js")),
    ("/timeline.js", "text/javascript", include_str!("pages/timeline.js")),
    ("/screen.js", "text/javascript", include_str!("pages/screen.js")),
    ("/watch.js", "text/javascript", include_str!("pages/watch.js")),
    ("/play.js", "text/javascript", include_str!("pages/play.js")),
    ("/favicon.ico", "image/svg+xml", include_str!("pages/icon.svg")),
];

/// The file of a path, if there is one.
pub(crate) fn page(path: &str) -> Option<Response> {
    let (_, kind, text) = FILES.iter().find(|(name, _, _)| *name == path)?;
    Some(([(header::CONTENT_TYPE, *kind)], *text).into_response())
}
