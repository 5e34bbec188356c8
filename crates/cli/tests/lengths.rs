//! Files of code of more than 400 lines say at their head why they are long.

use std::path::{Path, PathBuf};

const MOST_LINES: usize = 400;

/// How the reason begins, in the lines of documentation at the file's head.
const REASON: &str = "//! Long because ";

/// What is wrong with a file's length, if anything.
fn fault(text: &str) -> Option<String> {
    let lines = text.lines().count();
    let head = text.lines().take_while(|line| line.starts_with("//!"));
    let reason = head.clone().any(|line| line.len() > REASON.len() && line.starts_with(REASON));
    match (lines > MOST_LINES, reason) {
        (true, false) => Some(format!(
            "{lines} lines: split it, or say at its head why it is long: `{REASON}...`"
        )),
        (false, true) => Some(format!("{lines} lines: no reason is needed, take it out")),
        _ => None,
    }
}

fn check(folder: &Path, faults: &mut Vec<String>, seen: &mut usize) {
    for entry in std::fs::read_dir(folder).expect("the folder is there").flatten() {
        let path = entry.path();
        if path.is_dir() {
            if path.file_name().is_some_and(|name| name != "target") {
                check(&path, faults, seen);
            }
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            *seen += 1;
            let text = std::fs::read_to_string(&path).expect("the source is text");
            faults.extend(fault(&text).map(|fault| format!("{}: {fault}", path.display())));
        }
    }
}

#[test]
fn long_files_say_why() {
    let root: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let (mut faults, mut seen) = (Vec::new(), 0);
    for folder in ["crates", "tools"] {
        check(&root.join(folder), &mut faults, &mut seen);
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(seen > 300, "only {seen} files");
}

#[test]
fn a_long_file_without_a_reason_is_found() {
    let long = "let x = 1;\n".repeat(MOST_LINES);
    assert_eq!(fault(&long), None);
    assert!(fault(&format!("//! Short.\n{long}")).is_some());
    assert!(fault(&format!("//! Much.\n//!\n//! Long because it is one table.\n{long}")).is_none());
    assert!(fault(&format!("//! Much.\n//! Long because \n{long}")).is_some());
    assert!(fault("//! Long because it was long once.\n").is_some());
}
