//! Prints a built-in map as UDMF: `cargo run --example map_text remedy_rush`.

use hasard_engine::map::{Map, udmf};
use hasard_envs::scenarios;

fn main() {
    let name = std::env::args().nth(1).unwrap_or_default();
    let source = match name.as_str() {
        "remedy_rush" => scenarios::remedy_rush::map::source(),
        "detonators_dilemma" => scenarios::detonators_dilemma::map::source(1),
        other => panic!("no map `{other}`"),
    };
    let map = Map::build(&source, &name, &[]).expect("builds");
    eprintln!(
        "{} lines, {} sectors, {} segs, {} subsectors, {} things",
        map.lines.len(),
        map.sectors.len(),
        map.segs.len(),
        map.subsectors.len(),
        map.things.len()
    );
    print!("{}", udmf::write(&source));
}
