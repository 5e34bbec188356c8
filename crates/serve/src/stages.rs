//! Stages that were built lately. Building one takes a third of a second and 10 MB: its map, its
//! pictures, its tables. All viewers of an environment share those and own nothing but their
//! worlds, so that many viewers are no heavier than few.

use hasard_envs::EnvOptions;
use hasard_play::Stage;
use std::sync::{Mutex, PoisonError};

/// Kinds of stages that are kept: more than are usually watched at a time.
const KEPT: usize = 6;

/// The stages, the one used last at the end.
#[derive(Default)]
pub(crate) struct Stages {
    kept: Mutex<Vec<(String, Stage)>>,
}

impl Stages {
    /// A stage of its own for a viewer, at the start of the episode of seed 0.
    pub fn stage(&self, id: &str, options: &EnvOptions) -> Result<Stage, String> {
        let built = || Stage::new(id, options).map_err(|error| error.to_string());
        // Maps and pictures of files are compared by nobody; they are read anew.
        if options.map.is_some() || options.maps.is_some() || options.assets.is_some() {
            return built();
        }
        let kind = format!("{id} {options:?}");
        // Held while a stage is built: many who come at once for the same wait for one of them to
        // build it.
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let used = match kept.iter().position(|(known, _)| *known == kind) {
            Some(at) => kept.remove(at),
            None => (kind, built()?),
        };
        let stage = used.1.sibling();
        if kept.len() == KEPT {
            kept.remove(0);
        }
        kept.push(used);
        Ok(stage)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_are_kept_apart_and_their_number_is_bounded() {
        let stages = Stages::default();
        let hard = EnvOptions { hard: true, ..EnvOptions::default() };
        assert!(
            !stages
                .stage("RemedyRushLevel1-v0", &EnvOptions::default())
                .unwrap()
                .env()
                .options()
                .hard
        );
        assert!(stages.stage("RemedyRushLevel1-v0", &hard).unwrap().env().options().hard);
        assert!(stages.stage("RemedyRushLevel1-v0", &hard).unwrap().env().options().hard);
        assert_eq!(stages.kept.lock().unwrap().len(), 2);
        for id in ["VolcanicVenture", "PrecipicePlunge"] {
            for level in 1..=3 {
                stages.stage(&format!("{id}Level{level}-v0"), &hard).unwrap();
            }
        }
        assert_eq!(stages.kept.lock().unwrap().len(), KEPT);
        assert!(stages.stage("NoSuchLevel1-v0", &hard).is_err());
    }
}
