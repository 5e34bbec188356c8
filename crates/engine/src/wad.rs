//! WAD files: the directory of named lumps that maps and pictures come in.

use crate::map::{MapSource, STAND_INS, TextureName, udmf};
use std::fmt;

/// Bytes of the header and of a directory entry.
const HEADER: usize = 12;
const ENTRY: usize = 16;

/// Most lumps of a file; the largest published IWAD has some 5,000.
const LUMP_LIMIT: usize = 1 << 18;

/// Whether a file is complete by itself or adds to another.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum WadKind {
    /// A game's own data.
    Iwad,
    /// An addition.
    Pwad,
}

/// A named piece of a WAD.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Lump<'a> {
    /// Its name, upper case.
    pub name: TextureName,
    /// Its contents.
    pub bytes: &'a [u8],
}

/// A WAD whose directory has been read; the lumps stay in the bytes that it was read from.
#[derive(Clone, Debug)]
pub struct Wad<'a> {
    /// Which kind the header says.
    pub kind: WadKind,
    /// The lumps in file order; names may repeat, and of equal names the last counts.
    pub lumps: Vec<Lump<'a>>,
}

/// What can be wrong with a WAD.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum WadError {
    /// The file does not begin as a WAD.
    NotAWad,
    /// The directory lies outside the file.
    Directory {
        /// Number of lumps that the header claims.
        lumps: i32,
        /// Where the header says the directory begins.
        offset: i32,
        /// Length of the file.
        length: usize,
    },
    /// A lump lies outside the file.
    LumpOutside {
        /// Its index.
        index: usize,
        /// Name of the lump.
        name: TextureName,
    },
    /// The map is in a binary format.
    Binary {
        /// The map.
        name: String,
        /// Whose format it is.
        format: &'static str,
    },
    /// There is no such lump or map.
    NotFound {
        /// What was looked for.
        name: String,
    },
}

impl fmt::Display for WadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            WadError::NotAWad => {
                f.write_str("not a WAD: it does not begin with IWAD or PWAD; give a WAD file")
            }
            WadError::Directory { lumps, offset, length } => write!(
                f,
                "broken WAD: a directory of {lumps} lumps at byte {offset} does not fit a file of {length} bytes; \
                 fetch the file again"
            ),
            WadError::LumpOutside { index, name } => {
                write!(
                    f,
                    "broken WAD: lump {index} ({name:?}) lies outside the file; fetch the file again"
                )
            }
            WadError::Binary { name, format } => write!(
                f,
                "its {name} is binary, in {format}'s format, and must be UDMF; \
                 open it in an editor such as Ultimate Doom Builder or SLADE and save it as UDMF"
            ),
            WadError::NotFound { name } => write!(f, "the WAD has no {name}; give one that has"),
        }
    }
}

impl std::error::Error for WadError {}

impl<'a> Wad<'a> {
    /// Reads the directory of a WAD.
    ///
    /// # Errors
    /// When anything lies outside `bytes`.
    pub fn read(bytes: &'a [u8]) -> Result<Wad<'a>, WadError> {
        let kind = match bytes.get(..4) {
            Some(b"IWAD") => WadKind::Iwad,
            Some(b"PWAD") => WadKind::Pwad,
            _ => return Err(WadError::NotAWad),
        };
        let header = bytes.get(..HEADER).ok_or(WadError::NotAWad)?;
        let (lumps, offset) = (int(header, 4), int(header, 8));
        let directory = usize::try_from(lumps).ok().zip(usize::try_from(offset).ok()).and_then(
            |(lumps, offset)| {
                let end = offset.checked_add(lumps.checked_mul(ENTRY)?)?;
                bytes.get(offset..end).filter(|_| lumps <= LUMP_LIMIT)
            },
        );
        let directory =
            directory.ok_or(WadError::Directory { lumps, offset, length: bytes.len() })?;
        let entry = |(index, entry): (usize, &[u8])| {
            let name = name_of(&entry[8..]);
            let (start, length) = (int(entry, 0), int(entry, 4));
            // Markers have no contents, and often no sensible place either.
            let lump = if length == 0 {
                Some(&bytes[..0])
            } else {
                usize::try_from(start)
                    .ok()
                    .zip(usize::try_from(length).ok())
                    .and_then(|(start, length)| bytes.get(start..start.checked_add(length)?))
            };
            lump.map(|bytes| Lump { name, bytes }).ok_or(WadError::LumpOutside { index, name })
        };
        let lumps =
            directory.chunks_exact(ENTRY).enumerate().map(entry).collect::<Result<Vec<_>, _>>()?;
        Ok(Wad { kind, lumps })
    }

    /// The contents of the last lump of a name.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<&'a [u8]> {
        let name = TextureName::new(name);
        self.lumps.iter().rev().find(|lump| lump.name == name).map(|lump| lump.bytes)
    }

    /// The UDMF text of the last map called `name`.
    ///
    /// # Errors
    /// When there is none, or it is in a binary format.
    pub fn map_text(&self, name: &str) -> Result<&'a [u8], WadError> {
        let (marker, text) = (TextureName::new(name), TextureName::new("TEXTMAP"));
        let found =
            self.lumps.windows(2).rev().find(|pair| pair[0].name == marker && pair[1].name == text);
        found.map(|pair| pair[1].bytes).ok_or_else(|| match self.binary_format(name) {
            Some(format) => WadError::Binary { name: name.to_ascii_uppercase(), format },
            None => WadError::NotFound { name: format!("UDMF map {name}{}", self.other_maps()) },
        })
    }

    /// The format of a binary map: its lumps follow its name, and only Hexen's has `BEHAVIOR` among
    /// them.
    fn binary_format(&self, name: &str) -> Option<&'static str> {
        let marker = TextureName::new(name);
        let maps = self.lumps.iter().enumerate().rev().filter(|(_, lump)| lump.name == marker);
        let lumps = maps
            .map(|(at, _)| &self.lumps[at + 1..])
            .find(|lumps| lumps.first().is_some_and(is_binary))?;
        let behaviour = TextureName::new("BEHAVIOR");
        let hexen =
            lumps.iter().take_while(|lump| is_binary(lump)).any(|lump| lump.name == behaviour);
        Some(if hexen { "Hexen" } else { "Doom" })
    }

    /// Which maps the file has, in brackets; nothing if none.
    fn other_maps(&self) -> String {
        let text = TextureName::new("TEXTMAP");
        let maps = self
            .lumps
            .windows(2)
            .filter(|pair| pair[1].name == text || is_binary(&pair[1]) && !is_binary(&pair[0]));
        let names: Vec<String> = maps.take(8).map(|pair| format!("{:?}", pair[0].name)).collect();
        if names.is_empty() { String::new() } else { format!(" (it has {})", names.join(", ")) }
    }
}

/// Whether a lump is one of those that a binary map consists of.
fn is_binary(lump: &Lump<'_>) -> bool {
    const LUMPS: [&str; 11] = [
        "THINGS", "LINEDEFS", "SIDEDEFS", "VERTEXES", "SEGS", "SSECTORS", "NODES", "SECTORS",
        "REJECT", "BLOCKMAP", "BEHAVIOR",
    ];
    LUMPS.iter().any(|&name| lump.name == TextureName::new(name))
}

/// The bytes of a WAD with the given lumps.
#[must_use]
pub fn write(kind: WadKind, lumps: &[Lump<'_>]) -> Vec<u8> {
    let contents: usize = lumps.iter().map(|lump| lump.bytes.len()).sum();
    let mut out = Vec::with_capacity(HEADER + contents + lumps.len() * ENTRY);
    out.extend_from_slice(match kind {
        WadKind::Iwad => b"IWAD",
        WadKind::Pwad => b"PWAD",
    });
    let put =
        |out: &mut Vec<u8>, value: usize| out.extend_from_slice(&(value as u32).to_le_bytes());
    put(&mut out, lumps.len());
    put(&mut out, HEADER + contents);
    for lump in lumps {
        out.extend_from_slice(lump.bytes);
    }
    let mut start = HEADER;
    for lump in lumps {
        put(&mut out, start);
        put(&mut out, lump.bytes.len());
        out.extend_from_slice(&lump.name.0);
        start += lump.bytes.len();
    }
    out
}

/// A PWAD with one UDMF map, which engines of the ZDoom family load as it is (they build nodes
/// themselves). Textures that no game file has are defined by others that all have.
#[must_use]
pub fn write_map(name: &str, map: &MapSource) -> Vec<u8> {
    let text = udmf::write(map);
    let definitions = texture_definitions(map);
    let lump = |name: &str, bytes| Lump { name: TextureName::new(name), bytes };
    let mut lumps = vec![lump(name, b""), lump("TEXTMAP", text.as_bytes()), lump("ENDMAP", b"")];
    if !definitions.is_empty() {
        lumps.insert(0, lump("TEXTURES", definitions.as_bytes()));
    }
    write(WadKind::Pwad, &lumps)
}

/// The `TEXTURES` lump for the names that the map uses.
fn texture_definitions(map: &MapSource) -> String {
    let used = map.textures();
    let needed = STAND_INS.iter().filter(|(name, ..)| used.contains(&TextureName::new(name)));
    let define = |(name, stand_in, (width, height)): &(&str, &str, (u16, u16))| {
        format!("Texture {name}, {width}, {height}\n{{\n\tPatch {stand_in}, 0, 0\n}}\n")
    };
    needed.map(define).collect()
}

fn int(bytes: &[u8], at: usize) -> i32 {
    i32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]])
}

/// A lump name as stored: ends at the first zero, whatever follows.
fn name_of(bytes: &[u8]) -> TextureName {
    let mut name = [0; 8];
    for (to, from) in name.iter_mut().zip(bytes.iter().take_while(|&&byte| byte != 0)) {
        *to = from.to_ascii_uppercase();
    }
    TextureName(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lump<'a>(name: &str, bytes: &'a [u8]) -> Lump<'a> {
        Lump { name: TextureName::new(name), bytes }
    }

    #[test]
    fn what_is_written_reads_back() {
        let lumps = [
            lump("ONE", b"abc"),
            lump("MARKER", b""),
            lump("EIGHTLET", b"xyz0"),
            lump("one", b"later"),
        ];
        let bytes = write(WadKind::Iwad, &lumps);
        let wad = Wad::read(&bytes).unwrap();
        assert_eq!((wad.kind, wad.lumps.as_slice()), (WadKind::Iwad, lumps.as_slice()));
        assert_eq!(
            (wad.find("one"), wad.find("eightlet"), wad.find("two")),
            (Some(&b"later"[..]), Some(&b"xyz0"[..]), None)
        );
    }

    #[test]
    fn a_map_goes_through_a_wad() {
        let text = b"namespace = \"zdoom\";\nvertex { x = 1; y = 2; }";
        let map = udmf::read(text).unwrap();
        let bytes = write_map("MAP01", &map);
        let wad = Wad::read(&bytes).unwrap();
        let names: Vec<&str> = wad.lumps.iter().map(|lump| lump.name.as_str()).collect();
        assert_eq!(names, ["MAP01", "TEXTMAP", "ENDMAP"]);
        assert_eq!(udmf::read(wad.map_text("map01").unwrap()).unwrap(), map);
        assert!(matches!(wad.map_text("MAP02"), Err(WadError::NotFound { .. })));

        // A texture of ours comes with its definition.
        let text = b"namespace = \"zdoom\"; sector { texturefloor = \"TILES6\"; textureceiling = \"FLAT5\"; }";
        let bytes = write_map("MAP01", &udmf::read(text).unwrap());
        let definitions =
            std::str::from_utf8(Wad::read(&bytes).unwrap().find("TEXTURES").unwrap()).unwrap();
        assert_eq!(definitions, "Texture TILES6, 64, 64\n{\n\tPatch FLAT5_7, 0, 0\n}\n");
    }

    #[test]
    fn a_binary_map_is_said_to_be_one() {
        let why = |names: &[&str]| {
            let lumps: Vec<Lump<'_>> = names.iter().map(|name| lump(name, b"x")).collect();
            Wad::read(&write(WadKind::Pwad, &lumps))
                .unwrap()
                .map_text("MAP01")
                .unwrap_err()
                .to_string()
        };
        let doom = ["MAP01", "THINGS", "LINEDEFS", "SIDEDEFS", "VERTEXES", "SECTORS"];
        let error = why(&doom);
        assert!(
            error.starts_with("its MAP01 is binary, in Doom's format, and must be UDMF"),
            "{error}"
        );
        assert!(why(&[&doom[..], &["BEHAVIOR"]].concat()).contains("in Hexen's format"));
        // Another map's BEHAVIOR says nothing of this one.
        assert!(
            why(&[&doom[..], &["MAP02", "THINGS", "BEHAVIOR"]].concat())
                .contains("in Doom's format")
        );
        let other = why(&["E1M1", "TEXTMAP", "ENDMAP", "MAP02", "THINGS", "LINEDEFS"]);
        assert!(other.contains("no UDMF map MAP01 (it has E1M1, MAP02)"), "{other}");
        assert_eq!(why(&["PICTURE"]), "the WAD has no UDMF map MAP01; give one that has");
    }

    #[test]
    fn whatever_lies_outside_is_an_error() {
        let good = write(WadKind::Pwad, &[lump("ONE", b"abc")]);
        let spoiled = |at: usize, value: i32| {
            let mut bytes = good.clone();
            bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
            Wad::read(&bytes).map(|_| ()).unwrap_err()
        };
        for value in [-1, 2, i32::MAX, i32::MIN] {
            assert!(matches!(spoiled(4, value), WadError::Directory { .. }), "{value} lumps");
        }
        for value in [-1, 16, i32::MAX, i32::MIN] {
            assert!(
                matches!(spoiled(8, value), WadError::Directory { .. }),
                "directory at {value}"
            );
        }
        for value in [-1, 30, i32::MAX, i32::MIN] {
            assert!(
                matches!(spoiled(15, value), WadError::LumpOutside { index: 0, .. }),
                "lump at {value}"
            );
            assert!(
                matches!(spoiled(19, value), WadError::LumpOutside { .. }),
                "lump of {value} bytes"
            );
        }
        for length in 0..good.len() {
            assert!(Wad::read(&good[..length]).is_err(), "cut to {length} bytes");
        }
    }
}
