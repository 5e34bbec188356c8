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
    /// Below it, the folders without circles: itself alone if it has none.
    without_circles: &'static [&'static str],
    /// So many imports at least are found, or they are looked for wrongly.
    imports: usize,
}

#[rustfmt::skip]
const HOUSES: &[House] = &[
    House {
        in_crate: "engine", folder: "", without_circles: &["math", "simd", "world", "render"], imports: 900,
        order: &["math", "simd", "map", "wad", "assets", "world", "render"],
    },
    House {
        in_crate: "engine", folder: "world", without_circles: &["world"], imports: 150,
        order: &["tables", "parts", "state", "motion", "sectors", "effects", "combat", "player", "monsters", "tic"],
    },
    House {
        in_crate: "engine", folder: "render", without_circles: &["render"], imports: 400,
        order: &[
            "blocks", "colour", "textures", "scene", "published_depth", "view", "buffers", "patch", "walls",
            "planes", "sprites", "overlay", "output", "automap", "scratch", "renderer",
        ],
    },
    House {
        in_crate: "envs", folder: "", without_circles: &[""], imports: 250,
        order: &[
            "error", "machine_memory", "spaces", "interface", "scenarios", "registry", "maps", "options", "single",
            "policies", "own", "vec_env", "bench",
        ],
    },
    House {
        in_crate: "learn", folder: "", without_circles: &[""], imports: 300,
        order: &[
            "error", "random", "threads", "statistics", "config", "team", "networks", "sampling", "learning",
            "algorithms", "runs",
        ],
    },
    House {
        in_crate: "envs", folder: "vec_env", without_circles: &["vec_env"], imports: 250,
        order: &[
            "chosen", "options", "lane_state", "alike", "checks", "lane", "job", "handover", "worker", "crew",
            "mixed", "worlds",
        ],
    },
    House {
        in_crate: "serve", folder: "", without_circles: &[""], imports: 60,
        order: &[
            "answer", "asked", "door", "pages", "catalogue", "stages", "shared", "guard", "runs", "episodes", "show",
            "server",
        ],
    },
    House {
        in_crate: "sweep", folder: "", without_circles: &[""], imports: 8,
        order: &["option", "job", "grid", "table", "paper", "file", "execute"],
    },
    House {
        in_crate: "python", folder: "", without_circles: &[""], imports: 25,
        order: &[
            "errors", "pool", "memory", "arguments", "actions", "resets", "lane", "inner", "facts", "events",
            "batch", "bind", "registry", "worlds", "program", "agent",
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
        let wrong = against_the_order(&tree, &tree.arrows(), house.folder, house.order);
        assert!(wrong.is_empty(), "{} {}:\n{}", house.in_crate, house.folder, wrong.join("\n"));
    }
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    for house in HOUSES {
        let tree = tree_of(house);
        let arrows = tree.arrows();
        for folder in house.without_circles {
            let found = circles(&arrows, folder);
            assert!(found.is_empty(), "{} {folder}: {found:#?}", house.in_crate);
        }
        let imports: usize = arrows.values().map(std::collections::BTreeSet::len).sum();
        assert!(imports >= house.imports, "{}: only {imports} imports", house.in_crate);
    }
}

#[test]
fn no_folder_of_the_renderer_is_a_heap() {
    fn check(folder: &Path) {
        let entries: Vec<_> =
            std::fs::read_dir(folder).expect("the folder is there").flatten().collect();
        let files = entries.iter().filter(|entry| entry.path().is_file()).count();
        assert!(files <= 17, "{} holds {files} files", folder.display());
        entries.iter().filter(|entry| entry.path().is_dir()).for_each(|entry| check(&entry.path()));
    }
    check(&root().join("crates/engine/src/render"));
}

/// An invented crate: `plan` stands before `walls`, and a folder re-exports what it defines.
fn invented(files: &[(&str, &str)]) -> Tree {
    let mut tree = Tree::default();
    tree.add("lib.rs", "pub mod plan;\npub mod walls;\n");
    tree.add("plan/mod.rs", "mod size;\npub use size::{Size, Area};\n");
    tree.add("plan/size.rs", "pub struct Size;\npub struct Area;\n");
    tree.add("walls/mod.rs", "mod brick;\nmod wall;\npub use wall::Wall;\n");
    tree.add("walls/brick.rs", "use crate::plan::Size;\npub struct Brick(Size);\n");
    tree.add("walls/wall.rs", "use super::brick::Brick;\npub struct Wall(Brick);\n");
    files.iter().for_each(|(file, text)| tree.add(file, text));
    tree
}

const INVENTED_ORDER: &[&str] = &["plan", "walls"];

#[test]
fn a_tree_in_order_is_found_to_be_so() {
    let tree = invented(&[]);
    assert_eq!(against_the_order(&tree, &tree.arrows(), "", INVENTED_ORDER), Vec::<String>::new());
    assert!(circles(&tree.arrows(), "").is_empty());
    let arrows = tree.arrows();
    // Through the folder's re-export, and by the path from the folder above.
    assert!(
        arrows["walls/brick"].contains("plan/size") && arrows["walls/wall"].contains("walls/brick")
    );
}

#[test]
fn arrows_back_and_circles_are_found() {
    // By a re-export, in a list, in an expression, over the folder above.
    for text in [
        "use crate::walls::Wall;\npub struct Size(Wall);\n",
        "use crate::{plan, walls::{brick::Brick, wall}};\npub struct Size(Brick);\n",
        "pub fn size() -> usize { crate::walls::Wall::count() }\n",
        "use super::super::walls::wall::Wall;\npub struct Size(Wall);\n",
    ] {
        let tree = invented(&[("plan/size.rs", text)]);
        assert_eq!(
            against_the_order(&tree, &tree.arrows(), "", INVENTED_ORDER).len(),
            1 + usize::from(text.contains("brick::Brick")),
            "{text}"
        );
        assert!(circles(&tree.arrows(), "").contains_key("plan/size"), "{text}");
    }
    let within =
        invented(&[("walls/brick.rs", "use crate::walls::Wall;\npub struct Brick(Wall);\n")]);
    assert!(against_the_order(&within, &within.arrows(), "", INVENTED_ORDER).is_empty());
    assert_eq!(circles(&within.arrows(), "walls").len(), 2);
    let stranger = invented(&[("roof.rs", "pub struct Roof;\n")]);
    assert_eq!(against_the_order(&stranger, &stranger.arrows(), "", INVENTED_ORDER).len(), 1);
}

#[test]
fn comments_and_tests_may_name_anything() {
    let tree = invented(&[
        (
            "plan/size.rs",
            "// crate::walls::Wall\npub struct Size;\n#[cfg(test)]\nmod tests {\n    use crate::walls::Wall;\n}\n",
        ),
        ("plan/size_tests.rs", "use crate::walls::Wall;\n"),
    ]);
    assert!(
        against_the_order(&tree, &tree.arrows(), "", INVENTED_ORDER).is_empty()
            && circles(&tree.arrows(), "").is_empty()
    );
}
