//! Maps from a folder or a file, by environment.

use crate::error::EnvError;
use crate::maps::engine_file::pictures_beside;
use crate::maps::files::{read, shown};
use crate::registry::facts;
use crate::registry::scenario::EnvId;
use crate::scenarios::common::rule_set::RuleSet;
use hasard_engine::assets::Assets;
use hasard_engine::map::{MapSource, TextureName, udmf};
use hasard_engine::wad::Wad;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

/// Name of the map in each file.
const MAP: &str = "MAP01";

/// Editor numbers of the starts of further players, for whom no scenario has a place.
pub(crate) const FURTHER_PLAYERS: std::ops::RangeInclusive<i32> = 2..=4;

/// Where maps come from.
#[derive(Clone, Debug)]
pub struct Maps {
    /// The folder, or the one file for whatever is played.
    place: PathBuf,
    /// The IWAD that their pictures are laid over.
    iwad: Option<PathBuf>,
    /// Gets a line about what is left out.
    report: Option<fn(&str)>,
    /// Lines that it got already.
    reported: Arc<Mutex<BTreeSet<String>>>,
}

/// A map as its file has it.
#[derive(Debug)]
pub struct LevelFile {
    /// The file, as messages name it.
    pub name: String,
    /// The map.
    pub source: MapSource,
    /// The IWAD's pictures with the file's laid over them; none without an IWAD.
    pub assets: Option<Arc<Assets>>,
    /// What the file holds that is not played or drawn as it says; empty if all is.
    pub left_out: Vec<String>,
}

impl Maps {
    /// The maps of a folder, or of one file; drawn with the embedded pictures if `iwad` is none.
    #[must_use]
    pub fn new(place: &Path, iwad: Option<&Path>) -> Maps {
        Maps {
            place: place.to_owned(),
            iwad: iwad.map(Path::to_owned),
            report: None,
            reported: Arc::default(),
        }
    }

    /// The folder, or the one file for whatever is played.
    #[must_use]
    pub fn place(&self) -> &Path {
        &self.place
    }

    /// The same, saying of each map that is read what its file holds that is not played or drawn as
    /// it says: one line, once.
    #[must_use]
    pub fn reporting_to(self, report: fn(&str)) -> Maps {
        Maps { report: Some(report), ..self }
    }

    /// Reads the map of an environment.
    ///
    /// # Errors
    /// One line that names the file and what is wrong with it.
    pub fn level(&self, id: EnvId, rules: RuleSet, hard: bool) -> Result<LevelFile, EnvError> {
        let file = self.file(id, rules, hard)?;
        let bytes = read(&file)?;
        let wrong =
            |why: &dyn std::fmt::Display| EnvError::Map { why: format!("{}: {why}", shown(&file)) };
        let wad = Wad::read(&bytes).map_err(|error| wrong(&error))?;
        let text = wad.map_text(MAP).map_err(|error| wrong(&error))?;
        let mut source = udmf::read(text).map_err(|error| wrong(&error))?;
        source.things.retain(|thing| !FURTHER_PLAYERS.contains(&thing.kind));
        let mut left_out = source.left_out();
        let assets = match &self.iwad {
            Some(path) => {
                let (iwad, engine) = (read(path)?, pictures_beside(path)?);
                let mut wanted = source.textures();
                wanted.extend(id.scenario.textures.iter().map(|name| TextureName::new(name)));
                let additions: Vec<&[u8]> =
                    engine.as_deref().into_iter().chain([&bytes[..]]).collect();
                let assets = Assets::from_wads(&iwad, &additions, &|name| wanted.contains(&name))
                    .map_err(|error| EnvError::Map {
                    why: format!("{} over {}: {error}", shown(&file), shown(path)),
                })?;
                left_out.extend(assets.left_out.iter().cloned());
                let unknown = |name: &&TextureName| {
                    name.is_some() && **name != SKY && !assets.textures.contains_key(name)
                };
                let missing: BTreeSet<&str> =
                    wanted.iter().filter(unknown).map(TextureName::as_str).collect();
                if !missing.is_empty() {
                    let names: Vec<&str> = missing.into_iter().take(8).collect();
                    left_out.push(format!("textures that no file has ({})", names.join(" ")));
                }
                Some(Arc::new(assets))
            }
            None => None,
        };
        let name = shown(&file);
        if let Some(report) = self.report
            && !left_out.is_empty()
            && self.reported.lock().is_ok_and(|mut lines| lines.insert(name.clone()))
        {
            report(&format!("{name}: left out: {}", left_out.join(", ")));
        }
        Ok(LevelFile { name, source, assets, left_out })
    }

    /// The file of an environment's map.
    fn file(&self, id: EnvId, rules: RuleSet, hard: bool) -> Result<PathBuf, EnvError> {
        if self.place.is_file() {
            return Ok(self.place.clone());
        }
        let folder = id.scenario.file_name();
        let folders =
            [self.place.join(&folder), self.place.join("envs").join(&folder), self.place.clone()];
        let mut names = vec![format!("level_{}.wad", id.level)];
        if facts::has_hard_map(id, rules, hard) {
            names.insert(0, format!("level_{}_hard.wad", id.level));
        }
        // A scenario's own folder may be given itself, but only under its own name.
        let own = self.place.file_name().is_some_and(|name| name == folder.as_str());
        let places = folders.iter().take(if own { 3 } else { 2 });
        let candidates: Vec<PathBuf> = names
            .iter()
            .flat_map(|name| places.clone().map(move |place| place.join(name)))
            .collect();
        candidates.iter().find(|path| path.is_file()).cloned().ok_or_else(|| EnvError::Map {
            why: format!(
                "{}: no map of {id}: there is no {folder}/{}; give a folder laid out as the published package's, or a WAD",
                shown(&self.place),
                names[0]
            ),
        })
    }
}

/// The texture name of the sky.
const SKY: TextureName = TextureName::new("F_SKY1");

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_named_as_the_published_package_names_them() {
        let names: Vec<String> =
            crate::Scenario::ALL.into_iter().map(crate::Scenario::file_name).collect();
        let expected = [
            "armament_burden",
            "remedy_rush",
            "collateral_damage",
            "volcanic_venture",
            "precipice_plunge",
            "detonators_dilemma",
        ];
        let (names, expected): (BTreeSet<&str>, BTreeSet<&str>) =
            (names.iter().map(String::as_str).collect(), expected.into());
        assert_eq!(names, expected);
    }

    #[test]
    fn what_is_not_there_is_named_in_one_line() {
        let id: EnvId = "RemedyRushLevel2-v0".parse().unwrap();
        let error = Maps::new(Path::new("/no/such"), None)
            .level(id, RuleSet::Paper, false)
            .unwrap_err()
            .to_string();
        assert!(
            error.starts_with("/no/such: no map of RemedyRushLevel2-v0")
                && error.contains("remedy_rush/level_2.wad"),
            "{error}"
        );
        assert!(!error.contains('\n'));
    }
}
