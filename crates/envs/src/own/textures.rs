//! Names of textures: those of the embedded set, which live as long as the program.

use super::mistakes::{Mistakes, unknown};
use hasard_engine::assets::Assets;
use std::sync::OnceLock;

/// Every name, sorted.
fn names() -> &'static [String] {
    static NAMES: OnceLock<Vec<String>> = OnceLock::new();
    NAMES.get_or_init(|| {
        let mut names: Vec<String> =
            Assets::embedded().textures.keys().map(|name| name.as_str().to_owned()).collect();
        names.push("F_SKY1".to_owned());
        names.sort();
        names.dedup();
        names
    })
}

/// The texture of a name.
pub(super) fn named(name: &str, at: usize, mistakes: &mut Mistakes) -> Option<&'static str> {
    let found = names().iter().find(|known| known.eq_ignore_ascii_case(name));
    if found.is_none() {
        mistakes.add(at, unknown("texture", name, names().iter().map(String::as_str)));
    }
    found.map(String::as_str)
}
