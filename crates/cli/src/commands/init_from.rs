//! `--init-from` where a run is already: the words that began it are welcome, others are not.

use crate::args::TrainArgs;
use crate::failure::Failure;
use crate::zoo;
use hasard_learn::config::{InitFrom, TrainConfig};
use hasard_learn::runs::run_directory::read_config;
use serde_json::json;
use std::path::Path;

/// The setting that says where the weights are that the run began with, if they are elsewhere now.
///
/// # Errors
/// When it began otherwise.
pub fn moved(
    args: &TrainArgs,
    saved: &TrainConfig,
    directory: &Path,
) -> Result<Option<String>, Failure> {
    let Some(typed) = &args.init_from else { return Ok(None) };
    let refuse = |why: String| {
        Err(Failure::bad(format!(
            "--init-from {}: the run in {} {why}; leave it out, or choose another --out",
            typed.display(),
            directory.display()
        )))
    };
    let Some(began) = &saved.init_from else {
        return refuse("says of no other weights that it began with".into());
    };
    let place = zoo::find(typed.as_os_str())?;
    // They may have been trained on since, or be gone.
    if place == began.place {
        return Ok(None);
    }
    if at(&place)?.sha256 != began.sha256 {
        return refuse(format!("began with other weights, of {}", began.place.display()));
    }
    // By its own way of writing names that are no text.
    let written = json!(InitFrom { place, ..began.clone() });
    Ok(Some(format!("init_from.place={}", written["place"])))
}

/// What a run of a sweep begins with: what it began with, if it is there and began at that place.
///
/// # Errors
/// When there are no weights.
pub fn of_job(args: &TrainArgs, directory: &Path) -> Result<Option<InitFrom>, Failure> {
    let Some(typed) = &args.init_from else { return Ok(None) };
    let place = zoo::find(typed.as_os_str())?;
    let began = read_config(directory).ok().and_then(|found| found.init_from);
    match began.filter(|began| began.place == place) {
        Some(began) => Ok(Some(began)),
        None => at(&place).map(Some),
    }
}

/// The weights that a place has now.
fn at(place: &Path) -> Result<InitFrom, Failure> {
    // Damaged checkpoints are named when the run begins.
    InitFrom::at(place, &mut |_| ()).map_err(Failure::bad)
}
