//! The program's help: commands in groups, each command's with examples at its end.

use crate::args::Cli;
use clap::{Command, CommandFactory};
use hasard_envs::Scenario;

/// Groups of commands, in the order in which people come to need them.
const GROUPS: [(&str, &[&str]); 5] = [
    ("Try", &["envs", "render", "rollout", "play", "serve"]),
    ("Your own task", &["new", "check"]),
    ("Train", &["train", "sweep", "settings", "metrics"]),
    (
        "Analyse",
        &[
            "eval",
            "report",
            "record",
            "replay",
            "highlights",
            "verify",
            "scoreboard",
            "bench",
            "trace",
        ],
    ),
    ("Export", &["export-agent", "claim", "export-wad", "contact-sheet", "site", "completions"]),
];

/// What is typed for each command, and what comes of it. `{env}` and `{other}` stand for two
/// environments, `{scenario}` for a scenario.
const EXAMPLES: &[(&str, &[(&str, &str)])] = &[
    (
        "envs",
        &[
            ("hasard envs", "ids, budgets, actions"),
            ("hasard envs --json", "the same with the names of the buttons"),
        ],
    ),
    ("new", &[("hasard new my_task", "my_task.toml, which every command takes in place of an id")]),
    (
        "check",
        &[
            ("hasard check my_task.toml", "all its mistakes, with line, column and remedy"),
            ("hasard check my_task.toml --level 2 -o map.png", "its second level from above"),
        ],
    ),
    ("play", &[("hasard play {other}", "play, and keep each episode in human/")]),
    (
        "rollout",
        &[
            ("hasard rollout {env} --episodes 20", "a random policy"),
            (
                "hasard rollout {env} --policy zoo:{env}",
                "a trained agent, here or in another level",
            ),
        ],
    ),
    (
        "trace",
        &[(
            "hasard trace {other} --actions actions.csv",
            "position, velocity and view after each tic of a recorded input",
        )],
    ),
    (
        "bench",
        &[
            ("hasard bench {env} --envs 32 --threads 2", "steps/s of the environments"),
            ("hasard bench {env} --learn --threads 2", "steps/s of the whole training loop"),
        ],
    ),
    (
        "render",
        &[
            ("hasard render {env} --step 50 -o frame.png", "what the agent sees, in large"),
            (
                "hasard render {other} --beside depth,segmented,automap",
                "the same moment in every view",
            ),
        ],
    ),
    (
        "train",
        &[
            ("hasard train {env} --out runs/vv1", "PPOPID for 10 million frames"),
            ("hasard train {env} --resume --out runs/vv1 --frames 20M", "go on with it"),
            (
                "hasard train {other} --algo P3O --safety-budget 10 --seed 2",
                "another algorithm, budget and seed",
            ),
            (
                "hasard train {env} --algo PPOLag --preset paper",
                "the paper's settings: 500 million frames",
            ),
        ],
    ),
    (
        "eval",
        &[
            ("hasard eval zoo:{env}", "an agent that comes with the program"),
            (
                "hasard eval runs/vv1 --episodes 100 --worst 3 -o worst.mp4",
                "a run's agent, and a film of its worst episodes",
            ),
        ],
    ),
    (
        "record",
        &[
            ("hasard record zoo:{other} -o agent.mp4", "a film of an agent"),
            ("hasard record runs/vv1 -o agent.episode", "a few kB that hasard replay plays again"),
        ],
    ),
    (
        "highlights",
        &[
            ("hasard highlights --levels", "six seconds of each zoo agent, and all levels in one"),
            ("hasard highlights runs/vv1 --seconds 10", "ten seconds of a run's agent"),
        ],
    ),
    (
        "replay",
        &[
            ("hasard replay agent.episode", "play it again and check its result"),
            ("hasard replay agent.episode --size 1280x720 -o large.mp4", "draw it at another size"),
        ],
    ),
    (
        "report",
        &[(
            "hasard report runs -o report",
            "one page of all runs below a folder: report/index.html",
        )],
    ),
    ("serve", &[("hasard serve runs", "http://127.0.0.1:8350: follow runs, watch agents, play")]),
    (
        "sweep",
        &[
            (
                "hasard sweep main --dry-run",
                "what an experiment of the paper would run, and how long",
            ),
            (
                "hasard sweep main --preset quick --levels 1 --seeds 1-3 --frames 8M",
                "a part of it with the quick preset",
            ),
            ("hasard sweep my.toml", "a sweep of your own"),
        ],
    ),
    (
        "export-agent",
        &[("hasard export-agent runs/vv1 -o zoo/Mine.agent", "then: hasard eval zoo:Mine")],
    ),
    (
        "claim",
        &[(
            "hasard claim runs/vv1 --name mine -o scoreboard",
            "200 episodes that everybody plays; writes claim and agent",
        )],
    ),
    (
        "verify",
        &[
            ("hasard verify scoreboard", "every claim of the folder, to the bit"),
            ("hasard verify theirs.claim.json", "one claim, its agent beside it"),
        ],
    ),
    (
        "scoreboard",
        &[(
            "hasard scoreboard scoreboard",
            "a page of the claims that hold: scoreboard/index.html",
        )],
    ),
    ("export-wad", &[("hasard export-wad {env} -o vv1.wad", "a map for any UDMF editor")]),
    (
        "contact-sheet",
        &[("hasard contact-sheet {scenario}", "every level in every view, in the folder sheets")],
    ),
    (
        "settings",
        &[
            ("hasard settings", "of what hasard train does without options"),
            (
                "hasard settings {other} --algo P3O --preset paper",
                "of another algorithm and preset",
            ),
        ],
    ),
    ("metrics", &[("hasard metrics", "every key of a run's metrics.jsonl")]),
    ("site", &[("hasard site -o public", "the book, the scoreboard and the films as plain HTML")]),
    (
        "completions",
        &[(
            "hasard completions bash > ~/.local/share/bash-completion/completions/hasard",
            "complete commands and flags by Tab",
        )],
    ),
];

/// Width that the list of commands is wrapped to.
const WIDTH: usize = 80;

/// The program with its help.
pub fn program() -> Command {
    let program = Cli::command();
    let list = list(&program);
    let template = format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n{list}\nOptions:\n{{options}}{{after-help}}"
    );
    program.help_template(template).mut_subcommands(|command| {
        let examples = examples(command.get_name());
        let before = command.get_after_help().map(|text| format!("{text}\n\n")).unwrap_or_default();
        if examples.is_empty() {
            command
        } else {
            command.after_help(format!("{before}{examples}"))
        }
    })
}

/// The commands, group by group; what is in no group stands in a last one.
fn list(program: &Command) -> String {
    let about = |name: &str| {
        let command =
            program.get_subcommands().find(|one| one.get_name() == name && !one.is_hide_set())?;
        Some((name.to_string(), command.get_about().map(ToString::to_string).unwrap_or_default()))
    };
    let grouped = |name: &str| GROUPS.iter().any(|(_, names)| names.contains(&name));
    let others = program.get_subcommands().map(Command::get_name).filter(|name| !grouped(name));
    let groups = GROUPS.iter().map(|(title, names)| (*title, names.to_vec()));
    let mut text = String::new();
    for (title, names) in groups.chain([("More", others.collect())]) {
        let rows: Vec<(String, String)> = names.into_iter().filter_map(about).collect();
        if rows.is_empty() {
            continue;
        }
        text += &format!("\n{title}:\n");
        for (name, about) in rows {
            text += &wrapped(&format!("  {name:<14}"), &about);
        }
    }
    text
}

/// A text after its head, in lines of at most `WIDTH` letters.
fn wrapped(head: &str, text: &str) -> String {
    let mut lines = vec![head.to_string()];
    for word in text.split_whitespace() {
        let last = lines.len() - 1;
        if lines[last].chars().count() + 1 + word.chars().count() > WIDTH {
            lines.push(" ".repeat(head.chars().count()));
        }
        let line = lines.last_mut().expect("there is a line");
        line.push(' ');
        line.push_str(word);
    }
    lines.join("\n") + "\n"
}

/// An example with the names of environments.
fn named(line: &str) -> String {
    let first = |scenario: Scenario| format!("{}Level1", scenario.name());
    line.replace("{env}", &first(Scenario::EXAMPLE))
        .replace("{other}", &first(Scenario::OTHER_EXAMPLE))
        .replace("{scenario}", Scenario::OTHER_EXAMPLE.name())
}

fn examples(name: &str) -> String {
    let Some((_, examples)) = EXAMPLES.iter().find(|(known, _)| *known == name) else {
        return String::new();
    };
    let lines: Vec<String> =
        examples.iter().map(|(line, what)| format!("  {}\n      {what}", named(line))).collect();
    format!("Examples:\n{}", lines.join("\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every command has an example that the program takes, and stands in the list once.
    #[test]
    fn commands_are_listed_once_and_have_examples_that_parse() {
        let program = program();
        let list = list(&program);
        for command in
            program.get_subcommands().map(Command::get_name).filter(|name| *name != "help")
        {
            assert_eq!(
                list.lines().filter(|line| line.starts_with(&format!("  {command} "))).count(),
                1,
                "{command}: {list}"
            );
            let examples = EXAMPLES
                .iter()
                .find(|(name, _)| *name == command)
                .unwrap_or_else(|| panic!("{command} has no example"))
                .1;
            for (line, _) in examples {
                let line = named(line);
                let words = line.split(" > ").next().unwrap().split_whitespace();
                let parsed = super::program()
                    .try_get_matches_from(words)
                    .unwrap_or_else(|error| panic!("{line}: {error}"));
                assert_eq!(parsed.subcommand_name(), Some(command), "{line}");
            }
        }
        for (_, names) in GROUPS {
            for name in names {
                assert!(program.find_subcommand(name).is_some(), "{name} is no command");
            }
        }
        assert!(list.lines().all(|line| line.chars().count() <= WIDTH), "{list}");
    }
}
