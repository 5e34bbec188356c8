//! Weights of another run, or of an agent's file, to begin a run with.

use std::path::Path;

use crate::config::{EnvConfig, InitFrom, TrainConfig};
use crate::error::LearnError;
use crate::runs::agent_file::AgentFile;
use crate::runs::buttons;
use crate::runs::checkpoint::Store;
use crate::runs::checksum::sha256;
use crate::runs::run_directory::read_config;
use crate::runs::session::Beginning;

impl InitFrom {
    /// What lies at a place now: an agent's file, `zoo:NAME`, or the newest whole checkpoint of a
    /// run's directory. `warn` gets a line for each damaged checkpoint that is passed over.
    ///
    /// # Errors
    /// When there are no weights.
    pub fn at(place: &Path, warn: &mut dyn FnMut(String)) -> Result<InitFrom, LearnError> {
        found(place, None, warn).map(|(_, init_from)| init_from)
    }
}

/// What a run with these settings begins with, and their `init_from`.
pub fn read(
    place: &Path,
    config: &TrainConfig,
    warn: &mut dyn FnMut(String),
) -> Result<(Beginning<'static>, InitFrom), LearnError> {
    found(place, Some(&config.env), warn)
}

/// What a run began with, read again for one that ended before its first checkpoint.
pub fn read_again(
    directory: &Path,
    config: &TrainConfig,
    warn: &mut dyn FnMut(String),
) -> Result<Beginning<'static>, LearnError> {
    let Some(known) = &config.init_from else { return Ok(Beginning::Nothing) };
    let advice = "bring them back, say with --init-from where they are now, or train anew with another --out";
    let (beginning, found) = read(&known.place, config, warn).map_err(|error| {
        let problem = format!("it has no checkpoint yet, and the weights that it began with are gone ({error}); {advice}");
        LearnError::content(directory, problem)
    })?;
    if found.sha256 == known.sha256 {
        return Ok(beginning);
    }
    let problem = format!(
        "it has no checkpoint yet, and {} has other weights now than it began with; {advice}",
        known.place.display()
    );
    Err(LearnError::content(directory, problem))
}

/// The weights at a place, their buttons in the order of a run's environment if one is given.
fn found(
    place: &Path,
    run: Option<&EnvConfig>,
    warn: &mut dyn FnMut(String),
) -> Result<(Beginning<'static>, InitFrom), LearnError> {
    let order = |env: &EnvConfig| match run {
        Some(run) => buttons::order(run, env),
        None => Ok(None),
    };
    let init_from = |sha256| InitFrom { place: place.to_path_buf(), sha256 };
    if AgentFile::is_at(place) {
        let (bytes, file) = AgentFile::read_whole(place)?;
        let init_from = init_from(sha256(&bytes));
        return Ok((Beginning::Agent(bytes, order(&file.card.config.env)?), init_from));
    }
    let loaded = Store::new(place, 1).newest(warn)?.ok_or_else(|| {
        LearnError::content(
            place,
            "no checkpoint to take weights from is here; give a run's directory, an agent's file or zoo:NAME",
        )
    })?;
    let init_from = init_from(loaded.weights_sha256());
    Ok((Beginning::Weights(Box::new(loaded), order(&read_config(place)?.env)?), init_from))
}
