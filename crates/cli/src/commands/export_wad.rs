//! `hasard export-wad`: a built-in map as a WAD.

use crate::args::ExportWadArgs;
use crate::failure::{Failure, Outcome};
use crate::settings;
use serde_json::json;
use std::path::PathBuf;

/// The map's name in the WAD.
const MAP: &str = "MAP01";

/// Runs the command.
pub fn run(args: &ExportWadArgs) -> Outcome {
    let id = settings::env_id(&args.env)?;
    let (source, _) = hasard_envs::scenarios::map_source(id, args.rules.into(), args.hard);
    let bytes = hasard_engine::wad::write_map(MAP, &source);
    let path = args.out.clone().unwrap_or_else(|| PathBuf::from(format!("{id}.wad")));
    if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("wad")) {
        let shown = path.display();
        return Err(Failure::bad(format!("--out {shown}: give a name that ends in .wad")));
    }
    hasard_media::files::write_whole(&path, &bytes).map_err(Failure::bad)?;
    let (sectors, lines) = (source.sectors.len(), source.lines.len());
    if args.json {
        let file = path.display().to_string();
        let bytes = bytes.len();
        let of_map = json!({ "env": id.to_string(), "file": file, "bytes": bytes, "map": MAP, "sectors": sectors, "lines": lines });
        say!("{of_map}");
        return Ok(());
    }
    say!(
        "{}: {} bytes, {MAP} with {sectors} sectors and {lines} lines",
        path.display(),
        bytes.len()
    );
    Ok(())
}
