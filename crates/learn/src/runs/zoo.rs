//! Trained agents that are part of the program: one for each environment.
//!
//! Their files are in the folder `zoo` of the repository. Here they are bytes, so that an installed
//! program or wheel has them wherever it is.

use std::path::Path;

/// What the place of one begins with: `zoo:RemedyRushLevel1`.
pub const PREFIX: &str = "zoo:";

/// Name and file of each, in the order of their names.
static AGENTS: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/zoo.rs"));

/// Their names, in order.
pub fn names() -> impl Iterator<Item = &'static str> {
    AGENTS.iter().map(|(name, _)| *name)
}

/// The file of the one at a place such as `zoo:RemedyRushLevel1`.
#[must_use]
pub fn bytes(place: &Path) -> Option<&'static [u8]> {
    let wanted = place.to_str()?.strip_prefix(PREFIX)?;
    AGENTS.iter().find(|(name, _)| *name == wanted).map(|(_, bytes)| *bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::runs::agent_file::AgentFile;

    /// Every file of the folder is part of the program, and plays the environment of its name.
    #[test]
    fn the_folder_is_in_the_program() {
        let mut files: Vec<String> = std::fs::read_dir("../../zoo")
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.extension().is_some_and(|ending| ending == "agent"))
            .map(|path| path.file_stem().unwrap().to_string_lossy().into_owned())
            .collect();
        files.sort();
        assert_eq!(files, names().collect::<Vec<_>>());
        for name in names() {
            let bytes = bytes(Path::new(&format!("{PREFIX}{name}"))).unwrap();
            assert_eq!(bytes, std::fs::read(format!("../../zoo/{name}.agent")).unwrap());
            assert_eq!(AgentFile::parse(bytes).unwrap().card.config.env.id, format!("{name}-v0"));
        }
        assert_eq!(bytes(Path::new("RemedyRushLevel1")), None);
    }
}
