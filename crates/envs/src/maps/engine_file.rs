//! The file in which ViZDoom has pictures of its own: sprites that no IWAD has.

use crate::error::EnvError;
use crate::maps::files::{read, shown};
use hasard_engine::map::TextureName;
use hasard_engine::wad::{Lump, WadKind, write};
use std::io::{Cursor, Read};
use std::path::Path;

/// Its name; in the Python package `vizdoom` it lies beside the IWADs.
const FILE: &str = "vizdoom.pk3";

/// What is taken from it: the smoke of rockets. It has other sprites too, before which those of an
/// IWAD count.
const SPRITE: &str = "sprites/rsmk";

/// And the soot that rockets leave on walls.
const SOOT: &str = "graphics/scorch1.";

/// Most files that it may hold, and most bytes of one that is taken.
const FILE_LIMIT: usize = 1 << 16;
const PICTURE_LIMIT: u64 = 1 << 20;

/// The pictures of ViZDoom's own file, where it lies beside an IWAD, as a WAD to lay
/// over that one.
///
/// # Errors
/// One line that names the file and what is wrong with it.
pub fn pictures_beside(iwad: &Path) -> Result<Option<Vec<u8>>, EnvError> {
    let path = iwad.with_file_name(FILE);
    if !path.is_file() {
        return Ok(None);
    }
    pictures(&read(&path)?).map(Some).map_err(|why| EnvError::Map {
        why: format!("{}: {why}; install vizdoom again", shown(&path)),
    })
}

/// A WAD of the wanted pictures.
fn pictures(bytes: &[u8]) -> Result<Vec<u8>, String> {
    let broken = |error: &dyn std::fmt::Display| format!("broken ZIP file ({error})");
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).map_err(|error| broken(&error))?;
    if archive.len() > FILE_LIMIT {
        return Err(format!("{} files are too many", archive.len()));
    }
    let mut found = Vec::new();
    for index in 0..archive.len() {
        let Some((name, soot)) = archive.name_for_index(index).and_then(|path| wanted(&path.ok()?))
        else {
            continue;
        };
        let file = archive.by_index(index).map_err(|error| broken(&error))?;
        let mut bytes = Vec::new();
        file.take(PICTURE_LIMIT + 1).read_to_end(&mut bytes).map_err(|error| broken(&error))?;
        if bytes.len() as u64 > PICTURE_LIMIT {
            return Err(format!("{name:?} is too large for a picture"));
        }
        found.push(Picture { name, soot, bytes });
    }
    let marker = |name| [Lump { name: TextureName::new(name), bytes: &[] }];
    let lumps = |soot: bool| {
        found
            .iter()
            .filter(move |file| file.soot == soot)
            .map(|file| Lump { name: file.name, bytes: &file.bytes })
    };
    let all =
        marker("S_START").into_iter().chain(lumps(false)).chain(marker("S_END")).chain(lumps(true));
    Ok(write(WadKind::Pwad, &all.collect::<Vec<_>>()))
}

/// A file that is taken.
struct Picture {
    name: TextureName,
    /// Soot, not a sprite.
    soot: bool,
    bytes: Vec<u8>,
}

/// The lump's name of a file in the archive that is wanted, and whether it is soot.
fn wanted(path: &str) -> Option<(TextureName, bool)> {
    let path = path.to_ascii_lowercase();
    let soot = path.starts_with(SOOT);
    let (stem, _) = path.rsplit('/').next()?.split_once('.')?;
    let taken = soot || path.starts_with(SPRITE);
    (taken && stem.len() <= 8).then(|| (TextureName::new(&stem.to_ascii_uppercase()), soot))
}

#[cfg(test)]
mod tests {
    use super::*;
    use hasard_engine::wad::Wad;
    use std::io::Write;

    fn archive(files: &[(&str, &[u8])]) -> Vec<u8> {
        let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
        for (name, bytes) in files {
            archive.start_file(*name, zip::write::SimpleFileOptions::default()).unwrap();
            archive.write_all(bytes).unwrap();
        }
        archive.finish().unwrap().into_inner()
    }

    #[test]
    fn wanted_pictures_become_sprites_of_a_wad() {
        let files = [
            ("graphics/scorch1.png", b"soot1"),
            ("sprites/rsmka0.png", b"smoke"),
            ("graphics/rsmk.png", b"other"),
        ];
        let bytes = archive(&files.map(|(name, bytes)| (name, &bytes[..])));
        let wad = pictures(&bytes).unwrap();
        let names: Vec<String> = Wad::read(&wad)
            .unwrap()
            .lumps
            .iter()
            .map(|lump| lump.name.as_str().to_owned())
            .collect();
        assert_eq!(names, ["S_START", "RSMKA0", "S_END", "SCORCH1"]);
        assert_eq!(Wad::read(&wad).unwrap().find("RSMKA0"), Some(&b"smoke"[..]));
    }

    #[test]
    fn spoiled_files_are_refused_in_a_line() {
        let whole =
            archive(&[("sprites/rsmka0.png", &[7; 500]), ("sprites/rsmkb0.png", &[8; 500])]);
        for at in 0..whole.len() {
            let mut spoiled = whole.clone();
            spoiled[at] ^= 0xFF;
            for bytes in [&spoiled[..], &whole[..at]] {
                if let Err(why) = pictures(bytes) {
                    assert!(!why.contains('\n') && why.len() < 200, "{why}");
                }
            }
        }
        assert!(pictures(b"no archive").unwrap_err().starts_with("broken ZIP file"));
        let large = archive(&[("sprites/rsmka0.png", &vec![0; PICTURE_LIMIT as usize + 1])]);
        assert!(pictures(&large).unwrap_err().contains("too large"));
    }

    #[test]
    fn nothing_beside_the_iwad_is_nothing() {
        assert_eq!(pictures_beside(Path::new("/no/such/freedoom2.wad")).unwrap(), None);
    }
}
