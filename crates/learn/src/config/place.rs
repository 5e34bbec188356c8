//! Where a file of the user's lies, as a run's settings keep it.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// JSON holds no names but UTF-8: others are kept as a list of their bytes.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Written {
    Text(String),
    Bytes(Vec<u8>),
}

impl From<&Path> for Written {
    fn from(place: &Path) -> Written {
        match place.to_str() {
            Some(text) => Written::Text(text.to_string()),
            None => Written::Bytes(place.as_os_str().as_encoded_bytes().to_vec()),
        }
    }
}

impl From<Written> for PathBuf {
    fn from(written: Written) -> PathBuf {
        match written {
            Written::Text(text) => PathBuf::from(text),
            Written::Bytes(bytes) => of_bytes(bytes),
        }
    }
}

/// Writes a place that there may be.
pub fn serialize<S: Serializer>(place: &Option<PathBuf>, to: S) -> Result<S::Ok, S::Error> {
    place.as_deref().map(Written::from).serialize(to)
}

/// Reads a place that there may be.
pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Option<PathBuf>, D::Error> {
    let written = Option::<Written>::deserialize(from)?;
    Ok(written.map(PathBuf::from))
}

/// A place that there is.
pub mod known {
    use super::{Deserialize, Deserializer, Path, PathBuf, Serialize, Serializer, Written};

    /// Writes it.
    pub fn serialize<S: Serializer>(place: &Path, to: S) -> Result<S::Ok, S::Error> {
        Written::from(place).serialize(to)
    }

    /// Reads it.
    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<PathBuf, D::Error> {
        Written::deserialize(from).map(PathBuf::from)
    }
}

#[cfg(unix)]
fn of_bytes(bytes: Vec<u8>) -> PathBuf {
    use std::os::unix::ffi::OsStringExt;
    std::ffi::OsString::from_vec(bytes).into()
}

#[cfg(not(unix))]
fn of_bytes(bytes: Vec<u8>) -> PathBuf {
    String::from_utf8_lossy(&bytes).into_owned().into()
}

/// The place from whatever folder the program is called next; `auto` is found anew each time.
#[must_use]
pub fn kept(given: &Path) -> PathBuf {
    if given == Path::new("auto") {
        return given.to_path_buf();
    }
    std::path::absolute(given).unwrap_or_else(|_| given.to_path_buf())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::EnvConfig;

    #[test]
    fn places_are_kept_whole_and_for_any_folder() {
        let kept_as = |maps: PathBuf| {
            let env = EnvConfig { maps: Some(maps), ..EnvConfig::new("test") };
            let text = serde_json::to_string(&env).unwrap();
            assert_eq!(serde_json::from_str::<EnvConfig>(&text).unwrap(), env);
            text
        };
        assert!(kept_as("/maps/läva.wad".into()).contains("\"maps\":\"/maps/läva.wad\""));
        assert!(kept_as(of_bytes(b"/m\xe4p".to_vec())).contains("\"maps\":["));
        assert!(
            serde_json::from_str::<EnvConfig>(
                &serde_json::to_string(&EnvConfig::new("x")).unwrap()
            )
            .unwrap()
            .maps
            .is_none()
        );
        assert_eq!(kept(Path::new("auto")), Path::new("auto"));
        assert_eq!(kept(Path::new("a/b.wad")), std::env::current_dir().unwrap().join("a/b.wad"));
    }
}
