//! The trained agents of the folder `zoo` become part of the program, whatever their number.

use std::fmt::Write;
use std::path::Path;

fn main() {
    // Asked for now, not when this was compiled: clones may share a target folder.
    let crate_folder =
        std::env::var_os("CARGO_MANIFEST_DIR").expect("Cargo names the crate's folder");
    let folder = Path::new(&crate_folder).join("../../zoo");
    println!("cargo::rerun-if-changed={}", folder.display());
    let mut files: Vec<_> = std::fs::read_dir(&folder)
        .expect("the folder zoo is there")
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|ending| ending == "agent"))
        .collect();
    files.sort();
    let mut list = String::from("&[");
    for path in files {
        let name = path.file_stem().expect("it has a name").to_string_lossy();
        let path = path.canonicalize().expect("the file is there");
        write!(list, "({name:?}, include_bytes!({path:?})),").expect("a text takes any text");
    }
    list.push(']');
    let out = std::env::var("OUT_DIR").expect("Cargo names a folder");
    std::fs::write(Path::new(&out).join("zoo.rs"), list).expect("that folder can be written to");
}
