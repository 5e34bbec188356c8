//! Folders stand in an order, each imports only from those before it, and no files import one
//! another in a circle: read from the paths that the sources name.

#[path = "imports/tree.rs"]
mod tree;

use std::path::{Path, PathBuf};
use tree::{Tree, against_the_order, circles};

/// A folder of a crate whose contents stand in an order.
struct House {
    /// The crate's folder in `crates`.
    in_crate: &'static str,
    /// The folder below `src`; empty for the whole crate.
    folder: &'static str,
    order: &'static [&'static str],
    /// So many imports at least are found, or they are looked for wrongly.
    imports: usize,
}

#[rustfmt::skip]
const HOUSES: &[House] = &[
    House {
        in_crate: "engine", folder: "", imports: 900,
        order: &["math", "simd", "map", "wad", "assets", "world", "render"],
    },
    House {
        in_crate: "engine", folder: "world", imports: 150,
        order: &["tables", "state", "motion", "sectors", "effects", "combat", "player", "monsters", "tic"],
    },
    House {
        in_crate: "engine", folder: "render", imports: 400,
        order: &[
            "blocks", "colour", "textures", "scene", "view", "buffers", "published_depth", "patch", "walls",
            "planes", "sprites", "overlay", "output", "automap", "scratch", "renderer",
        ],
    },
    House {
        in_crate: "envs", folder: "", imports: 250,
        order: &[
            "error", "spaces", "interface", "scenarios", "registry", "maps", "options", "single", "policies",
            "own", "vec_env", "bench",
        ],
    },
    House {
        in_crate: "learn", folder: "", imports: 300,
        order: &[
            "error", "random", "threads", "statistics", "config", "team", "networks", "sampling", "learning",
            "algorithms", "runs",
        ],
    },
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn tree_of(house: &House) -> Tree {
    Tree::read(&root().join("crates").join(house.in_crate).join("src"))
}

#[test]
fn folders_import_only_from_those_before_them() {
    for house in HOUSES {
        let tree = tree_of(house);
        let wrong = against_the_order(&tree, house.folder, house.order);
        assert!(wrong.is_empty(), "{} {}:\n{}", house.in_crate, house.folder, wrong.join("\n"));
    }
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    for house in HOUSES {
        let tree = tree_of(house);
        let found = circles(&tree, house.folder);
        assert!(found.is_empty(), "{} {}: {found:#?}", house.in_crate, house.folder);
        let imports: usize = tree.arrows().values().map(std::collections::BTreeSet::len).sum();
        assert!(imports >= house.imports, "{}: only {imports} imports", house.in_crate);
    }
}
