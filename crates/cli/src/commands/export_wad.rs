//! `hasard export-wad`: a built-in map as a WAD.

use crate::args::ExportWadArgs;
use crate::failure::{Failure, Outcome};
use crate::settings;
use std::path::PathBuf;

/// Runs the command.
pub fn run(args: &ExportWadArgs) -> Outcome {
    let id = settings::env_id(&args.env)?;
    let (source, _) = hasard_envs::scenarios::map_source(id, args.rules.into(), args.hard);
    let bytes = hasard_engine::wad::write_map("MAP01", &source);
    let path = args.out.clone().unwrap_or_else(|| PathBuf::from(format!("{id}.wad")));
    if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("wad")) {
        let shown = path.display();
        return Err(Failure::bad(format!("--out {shown}: give a name that ends in .wad")));
    }
    hasard_media::files::write_whole(&path, &bytes).map_err(Failure::bad)?;
    say!(
        "{}: {} bytes, MAP01 with {} sectors and {} lines",
        path.display(),
        bytes.len(),
        source.sectors.len(),
        source.lines.len()
    );
    Ok(())
}
