//! Run directories, as the page asks for them.

mod asked;
mod compared;
mod detail;
pub(crate) mod metrics;
mod notes;
mod routes;

pub(crate) use asked::directory;
pub(crate) use compared::compare;
pub(crate) use detail::{detail, reported, settings};
pub(crate) use notes::edit;
pub(crate) use routes::{automap, curves, heatmap, list, report};
