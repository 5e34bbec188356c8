//! Maps and pictures from the user's files.

use crate::failure::Failure;
use hasard_engine::assets::Assets;
use hasard_envs::EnvOptions;
use hasard_envs::maps::{Maps, find_iwad, find_maps, pictures_beside};
use std::path::Path;
use std::sync::Arc;

/// Largest IWAD that is read, bytes.
const LARGEST_IWAD: u64 = 256 << 20;

/// Otherwise usual options with the maps of `--maps` and the pictures of `--iwad`; without them the
/// built-in ones. What of a map is left out is written to the terminal.
pub fn looks(maps: Option<&Path>, iwad: Option<&Path>) -> Result<EnvOptions, Failure> {
    looks_reporting(maps, iwad, |left_out| note!("hasard: {left_out}"))
}

/// The same; `report` is given what of a map is left out.
pub fn looks_reporting(
    maps: Option<&Path>,
    iwad: Option<&Path>,
    report: fn(&str),
) -> Result<EnvOptions, Failure> {
    let auto = |given: &Path| given == Path::new("auto");
    let iwad = match iwad {
        Some(given) if auto(given) => Some(find_iwad(maps.is_some()).map_err(Failure::bad)?),
        given => given.map(Path::to_owned),
    };
    let Some(maps) = maps else {
        return Ok(EnvOptions {
            assets: iwad.as_deref().map(assets).transpose()?,
            ..EnvOptions::default()
        });
    };
    let place = if auto(maps) { find_maps().map_err(Failure::bad)? } else { maps.to_owned() };
    // The maps are read, and laid over the IWAD, when it is known which is played.
    let maps = Maps::new(&place, iwad.as_deref()).reporting_to(report);
    Ok(EnvOptions { maps: Some(Arc::new(maps)), ..EnvOptions::default() })
}

/// The pictures of an IWAD, with those of ViZDoom's own file where that lies beside
/// it.
fn assets(path: &Path) -> Result<Arc<Assets>, Failure> {
    let bytes = hasard_media::files::read_limited(path, LARGEST_IWAD).map_err(Failure::bad)?;
    let engine = pictures_beside(path).map_err(Failure::bad)?;
    let additions: Vec<&[u8]> = engine.as_deref().into_iter().collect();
    let assets = Assets::from_wads(&bytes, &additions, &|_| true)
        .map_err(|error| Failure::bad(format!("{}: {error}", path.display())))?;
    Ok(Arc::new(assets))
}
