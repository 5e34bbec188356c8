//! Every command line that a page shows is one that the program takes.

use crate::help::program;

#[path = "../tests/pages/mod.rs"]
mod pages;

use pages::{pages, shell_commands, words};

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
            if let Err(error) =
                program().try_get_matches_from(std::iter::once("hasard".into()).chain(words))
            {
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
    assert_eq!(found, ["a --b", "d"]);
}
