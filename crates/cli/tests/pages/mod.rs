//! The commands that pages for users show.

#![allow(dead_code, reason = "each test uses some of it")]

use std::path::{Path, PathBuf};

/// Pages for users: the README and the documentation, without raw results, which keep the commands
/// of their day.
pub fn pages() -> Vec<PathBuf> {
    fn gather(folder: &Path, into: &mut Vec<PathBuf>) {
        for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            let raw = path.ends_with("results") || path.ends_with("tried");
            if path.is_dir() && !raw {
                gather(&path, into);
            } else if path.extension().is_some_and(|ending| ending == "md") {
                into.push(path);
            }
        }
    }
    let mut all = vec![PathBuf::from("../../README.md"), PathBuf::from("../../CONTRIBUTING.md")];
    gather(Path::new("../../docs"), &mut all);
    all.sort();
    all
}

/// The commands of a page's blocks of shell: comments and redirections left out, continued lines
/// joined.
pub fn shell_commands(page: &str) -> Vec<String> {
    let mut commands = Vec::new();
    let mut shell = false;
    let mut continued = String::new();
    for line in page.lines() {
        if line.trim_start().starts_with("```") {
            shell = line.trim() == "```sh";
            continue;
        }
        if !shell {
            continue;
        }
        let line = line.split(" #").next().unwrap_or_default().trim();
        if let Some(part) = line.strip_suffix('\\') {
            continued += part;
            continue;
        }
        let whole = std::mem::take(&mut continued) + line;
        commands.extend(
            whole
                .split("&&")
                .flat_map(|part| part.split(" | "))
                .map(|part| part.trim().to_string())
                .filter(|part| !part.is_empty()),
        );
    }
    commands
}

/// The words after the program's name, if a command is the program's.
pub fn words(command: &str) -> Option<Vec<String>> {
    let command = command.split(" > ").next()?.split(" 2>").next()?;
    let rest = command
        .strip_prefix("hasard ")
        .or_else(|| command.strip_prefix("cargo run --release -p hasard -- "))
        .or_else(|| command.strip_prefix("nohup hasard "))?;
    Some(rest.split_whitespace().map(|word| word.trim_matches(['\'', '"']).to_string()).collect())
}
