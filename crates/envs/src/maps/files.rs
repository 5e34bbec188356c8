//! Files of maps: reading them, and naming them in messages.

use crate::error::EnvError;
use std::io::Read;
use std::path::Path;

/// Largest file that is read, bytes.
const LARGEST_FILE: u64 = 256 << 20;

/// Opens a file to read; neither a pipe nor a device, which may never end, or never begin.
pub(crate) fn open(path: &Path) -> std::io::Result<std::fs::File> {
    let kind = std::fs::metadata(path)?;
    if kind.is_file() || kind.is_dir() {
        return std::fs::File::open(path);
    }
    Err(std::io::Error::other("it is a pipe or a device; name a regular file"))
}

/// The bytes of a file of bearable size.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, EnvError> {
    let wrong = |why: String| EnvError::Map { why: format!("{}: {why}", shown(path)) };
    let file = open(path).map_err(|error| wrong(format!("cannot be read: {error}")))?;
    let mut bytes = Vec::new();
    file.take(LARGEST_FILE + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| wrong(format!("cannot be read: {error}")))?;
    if bytes.len() as u64 > LARGEST_FILE {
        return Err(wrong(format!(
            "larger than the {} MiB that a WAD may have",
            LARGEST_FILE >> 20
        )));
    }
    Ok(bytes)
}

/// A path in a message: nothing in it commands the terminal.
pub(crate) fn shown(path: &Path) -> String {
    path.display()
        .to_string()
        .chars()
        .map(|letter| if letter.is_control() { '\u{fffd}' } else { letter })
        .collect()
}
