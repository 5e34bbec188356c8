//! Every command line that a page shows is one that the program takes.

use crate::help::program;
use std::path::{Path, PathBuf};

/// Pages for users: the README and the documentation, without raw results, which keep the commands
/// of their day.
fn pages() -> Vec<PathBuf> {
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
    all
}

/// The commands of a page's blocks of shell: comments and redirections left out, continued lines
/// joined.
fn shell_commands(page: &str) -> Vec<String> {
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
                .map(|part| part.trim().to_string()),
        );
    }
    commands
}

/// The words after the program's name, if a command is the program's.
fn words(command: &str) -> Option<Vec<String>> {
    let command = command.split(" > ").next()?.split(" 2>").next()?;
    let rest = command
        .strip_prefix("hasard ")
        .or_else(|| command.strip_prefix("cargo run --release -p hasard -- "))
        .or_else(|| command.strip_prefix("nohup hasard "))?;
    Some(
        std::iter::once("hasard")
            .chain(rest.split_whitespace())
            .map(|word| word.trim_matches(['\'', '"']).to_string())
            .collect(),
    )
}

#[test]
fn commands_of_the_pages_are_understood() {
    let mut tried = 0;
    for page in pages() {
        let text = std::fs::read_to_string(&page).unwrap();
        for command in shell_commands(&text) {
            let Some(mut words) = words(&command) else { continue };
            // A task's file is read with the words; those of the pages are the reader's own.
            for word in words.iter_mut().filter(|word| word.contains(".toml")) {
                *word = "../../scenarios/remedy_rush.toml".into();
            }
            if let Err(error) = program().try_get_matches_from(&words) {
                assert!(!error.use_stderr(), "{}: {command}: {error}", page.display());
            }
            tried += 1;
        }
    }
    assert!(tried > 60, "only {tried} commands were found");
}

#[test]
fn commands_are_found_in_shell_blocks() {
    let page = "```sh\nhasard a \\\n  --b   # why\nHASARD_SIMD=avx2 hasard c && hasard d | head\n```\n```text\nhasard e\n```";
    let found: Vec<_> = shell_commands(page)
        .iter()
        .filter_map(|command| words(command))
        .map(|words| words.join(" "))
        .collect();
    assert_eq!(found, ["hasard a --b", "hasard d"]);
}
