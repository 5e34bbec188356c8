//! What ViZDoom showed and reported of chosen moments.

use crate::Any;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// The moments of one level.
#[derive(Deserialize)]
pub struct Level {
    /// The scenario's name in the published package.
    pub scenario: String,
    /// 1 to 3.
    pub level: u32,
    /// Size of the pictures.
    pub width: u16,
    pub height: u16,
    /// The level's file.
    pub wad: String,
    /// The art that it is laid over.
    pub iwad: String,
    pub scenes: Vec<Moment>,
}

/// One moment.
#[derive(Deserialize)]
pub struct Moment {
    pub number: usize,
    pub tic: u32,
    /// By the names of ViZDoom.
    pub variables: BTreeMap<String, f64>,
    /// Of each sector.
    pub floors: Vec<f64>,
    pub ceilings: Vec<f64>,
    /// What ViZDoom's own chance began with in the episode, if it was noted, and the
    /// number of the episode.
    #[serde(default)]
    pub chance: Option<u32>,
    #[serde(default)]
    pub episode: u32,
    /// Where rockets have burst since the episode began, and the way that they flew, degrees.
    #[serde(default)]
    pub bursts: Vec<[f64; 4]>,
    /// How rockets have flown since the episode began, in the order in which they were thrown.
    #[serde(default)]
    pub flights: Vec<Flight>,
    /// The things in view.
    pub labels: Vec<Thing>,
}

/// How a rocket flew.
#[derive(Deserialize)]
pub struct Flight {
    /// Its first tic, and where it was then.
    pub tic: u32,
    pub place: [f64; 3],
    pub velocity: [f64; 3],
    /// Tics that it flew before the one in which it burst, if it has.
    pub tics: Option<u32>,
}

/// A thing in view.
#[derive(Deserialize)]
pub struct Thing {
    pub name: String,
    pub value: u8,
    pub px: f64,
    pub py: f64,
    pub pz: f64,
    pub angle: f64,
}

impl Level {
    pub fn read(folder: &Path) -> Any<Level> {
        let path = folder.join("scenes.json");
        let bytes = std::fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        Ok(serde_json::from_slice(&bytes)
            .map_err(|error| format!("{}: {error}", path.display()))?)
    }
}

impl Moment {
    /// A variable; what was not reported is 0.
    pub fn value(&self, name: &str) -> f64 {
        self.variables.get(name).copied().unwrap_or(0.0)
    }
}

/// The buffers of a moment.
pub struct Pictures {
    pub rgb: Vec<u8>,
    pub labels: Vec<u8>,
    pub depth: Vec<u8>,
}

impl Pictures {
    pub fn read(folder: &Path, number: usize) -> Any<Pictures> {
        let [rgb, labels, depth] = ["rgb", "labels", "depth"]
            .map(|kind| read_png(&folder.join(format!("{number:02}_{kind}.png"))));
        Ok(Pictures { rgb: rgb?, labels: labels?, depth: depth? })
    }
}

fn read_png(path: &Path) -> Any<Vec<u8>> {
    let file = std::fs::File::open(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info()?;
    let mut pixels = vec![0; reader.output_buffer_size().ok_or("a picture too large")?];
    let info = reader.next_frame(&mut pixels)?;
    pixels.truncate(info.buffer_size());
    Ok(pixels)
}
