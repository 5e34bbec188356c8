//! A report on synthetic runs, from directories to files.
//!
//! Long because it makes whole run directories and reads every file that a report writes.

mod synthetic;

use hasard_media::episode::Outcome;
use hasard_report::{report_page, write_report};
use std::path::{Path, PathBuf};
use synthetic::{Folder, Synthetic, write_episode, write_heatmaps};

const ENVS: [(&str, f64, f64); 6] = [
    ("ArmamentBurden", 9.0, 50.0),
    ("VolcanicVenture", 50.0, 50.0),
    ("RemedyRush", 48.0, 5.0),
    ("CollateralDamage", 75.0, 5.0),
    ("PrecipicePlunge", 240.0, 50.0),
    ("DetonatorsDilemma", 29.0, 5.0),
];

fn write_experiments(root: &Path) {
    for (scenario, best, budget) in ENVS {
        let algos = [
            ("PPO", 1.0, 5.0, 1.0),
            ("PPOCost", 0.6, 2.1, 1.0),
            ("PPOLag", 0.7, 0.97, 4.0),
            ("PPOPID", 0.8, 0.95, 2.0),
            ("P3O", 0.75, 0.8, 0.5),
        ];
        for (algo, share, cost, overshoot) in algos {
            for seed in 1..=3 {
                let env = format!("{scenario}Level1-v0");
                let end = (best * share, budget * cost, budget * overshoot);
                let run =
                    Synthetic { env: &env, algo, seed, frames: 4e6, reports: 80, options: "", end };
                run.write(&root.join("main").join(&env).join(algo).join(format!("seed{seed}")));
            }
        }
        if scenario == "RemedyRush" {
            for (budget, share) in [(2.5, 0.5), (7.5, 0.85)] {
                for seed in 1..=2 {
                    let options = format!(",\"safety_budget\":{budget}");
                    let end = (best * share, budget, 10.0);
                    let env = "RemedyRushLevel1-v0";
                    let run = Synthetic {
                        env,
                        algo: "PPOLag",
                        seed,
                        frames: 4e6,
                        reports: 80,
                        options: &options,
                        end,
                    };
                    run.write(&root.join(format!("bounds/{budget}-{seed}")));
                }
            }
            let other = |name: &str, env, algo, options, end| {
                let run = Synthetic { env, algo, seed: 1, frames: 4e6, reports: 60, options, end };
                run.write(&root.join(name));
            };
            other(
                "scale",
                "RemedyRushLevel1-v0",
                "PPOCost",
                ",\"cost_scale\":0.5",
                (40.0, 20.0, 5.0),
            );
            other(
                "full",
                "RemedyRushLevel1-v0",
                "PPOLag",
                ",\"full_actions\":true",
                (20.0, 8.0, 5.0),
            );
            other("hard", "RemedyRushLevel1-v0", "PPO", ",\"hard\":true", (15.0, 7.0, 5.0));
            other("alone", "RemedyRushLevel3-v0", "PPOPID", "", (6.0, 4.0, 5.0));
            other(
                "curriculum",
                "RemedyRushLevel1-v0",
                "PPOPID",
                ",\"curriculum\":[1,2,3]",
                (17.0, 5.1, 5.0),
            );
            write_heatmaps(&root.join("main/RemedyRushLevel1-v0/PPOLag/seed1"));
            write_heatmaps(&root.join("main/RemedyRushLevel1-v0/PPO/seed1"));
        }
    }
    let eval = "{\"env\":\"RemedyRushLevel1-v0\",\"episode\":0,\"return\":31,\"cost\":4,\"length\":525}\n\
                {\"env\":\"RemedyRushLevel1-v0\",\"episode\":1,\"return\":33,\"cost\":7,\"length\":525}\n\
                {\"summary\":{\"return\":32}}\n";
    std::fs::write(root.join("main/RemedyRushLevel1-v0/PPOPID/seed1/eval.jsonl"), eval).unwrap();
    for episode in 0..4u32 {
        let outcome = Outcome {
            episode_return: 40.0 + f64::from(episode),
            cost: 2.0,
            truncated: true,
            ..Outcome::default()
        };
        let path = root.join(format!("human/{episode}.episode"));
        let full = [("full-actions", "true")];
        write_episode(&path, "human", u64::from(episode), &full, 525, outcome);
    }
    let random: String = ENVS
        .iter()
        .map(|(scenario, best, budget)| {
            let (episode_return, cost) = (best * 0.1, budget * 2.0);
            format!(
                "{{\"env\":\"{scenario}Level1-v0\",\"rules\":\"tables\",\"return\":{episode_return},\"cost\":{cost},\"length\":525}}\n"
            )
        })
        .collect();
    std::fs::write(root.join("random.jsonl"), random).unwrap();
    // What a killed trainer and a full disk leave behind.
    let cut = root.join("main/RemedyRushLevel1-v0/PPO/seed3/metrics.jsonl");
    let text = std::fs::read_to_string(&cut).unwrap();
    std::fs::write(&cut, &text[..text.len() - 40]).unwrap();
    std::fs::create_dir_all(root.join("broken")).unwrap();
    std::fs::write(root.join("broken/config.json"), "{\"env\":").unwrap();
}

#[test]
fn a_report_on_many_experiments() {
    let folder = Folder::new("many");
    let (runs, out) = (folder.0.join("runs"), folder.0.join("out"));
    write_experiments(&runs);
    let written = write_report(std::slice::from_ref(&runs), &out, "Synthetic runs").unwrap();
    assert_eq!((written.runs, written.experiments), (6 * 5 * 3 + 4 + 5, 30 + 2 + 5));
    let warnings: Vec<String> = written.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(warnings.len(), 2, "{warnings:?}");
    assert!(warnings[0].contains("broken/config.json: is no JSON"), "{warnings:?}");
    assert!(
        warnings[1].contains("PPO/seed3/metrics.jsonl:80: is damaged or half-written"),
        "{warnings:?}"
    );

    let page = std::fs::read_to_string(&written.page).unwrap();
    // Who wants the page alone gets the same one.
    assert!(report_page(std::slice::from_ref(&runs), "Synthetic runs").unwrap() == page);
    // Self-contained: nothing is fetched from anywhere.
    for forbidden in ["src=\"http", "href=\"http", "url(", "@import", "<link", "src=\"/", "fetch("]
    {
        assert!(!page.contains(forbidden), "{forbidden}");
    }
    for section in [
        "main",
        "paper",
        "curves",
        "safety-bounds",
        "cost-scale",
        "full-actions",
        "curriculum",
        "hard",
    ] {
        assert!(page.contains(&format!("<section id=\"{section}\">")), "{section}");
    }
    for section in [
        "aggregates",
        "safety",
        "pareto",
        "efficiency",
        "human",
        "missing",
        "players",
        "heatmaps",
        "experiments",
        "runs",
        "warnings",
        "method",
    ] {
        assert!(page.contains(&format!("<section id=\"{section}\">")), "{section}");
    }
    assert_balanced(&page);
    for file in &written.files {
        if file.extension().is_some_and(|extension| extension == "svg") {
            assert_balanced(&std::fs::read_to_string(file).unwrap());
        } else if file.extension().is_some_and(|extension| extension == "png") {
            hasard_media::png::read(file).unwrap();
        }
    }
    let figures = |ending: &str| {
        written.files.iter().filter(|file| file.extension().is_some_and(|e| e == ending)).count()
    };
    assert!(figures("svg") >= 12 && figures("png") > figures("svg") && figures("gif") == 2);
    assert!(out.join("figures/heatmaps-side-by-side-remedyrushlevel1-v0.png").is_file());

    // The mean of a cell, by hand from the same files.
    let csv = std::fs::read_to_string(out.join("experiments.csv")).unwrap();
    let row = csv
        .lines()
        .find(|line| line.starts_with("VolcanicVentureLevel1-v0,VolcanicVenture,1,PPOLag,"))
        .unwrap();
    let by_hand: f64 = (1..=3)
        .map(|seed| {
            last_ten(&runs.join(format!("main/VolcanicVentureLevel1-v0/PPOLag/seed{seed}")))
        })
        .sum::<f64>()
        / 3.0;
    let fields: Vec<&str> = row.split("\",").last().unwrap().split(',').collect();
    let mean: f64 = fields[5].parse().unwrap();
    assert!((mean - by_hand).abs() < 1e-9, "{mean} {by_hand}: {row}");

    let text = std::fs::read_to_string(out.join("report.md")).unwrap();
    let training = text.split("**Level 1, end of training").nth(1).unwrap();
    let row = |algorithm: &str| {
        training.lines().find(|line| line.starts_with(&format!("| {algorithm} |"))).unwrap()
    };
    // P3O ends at four fifths of every budget, PPOLag at 97 hundredths and scatters above it, PPO
    // far above.
    assert_eq!(row("P3O").matches(" ✓").count(), 6, "{}", row("P3O"));
    assert_eq!(
        (row("PPOLag").matches("(✓)").count(), row("PPOLag").matches(" ✓").count()),
        (6, 0),
        "{}",
        row("PPOLag")
    );
    assert!(!row("PPO").contains('✓'), "{}", row("PPO"));
    // One seed was evaluated, on two episodes that returned 31 and 33 at costs of 4 and 7: that
    // comes first.
    let headline = text.split("**Level 1, evaluation of the selected").nth(1).unwrap();
    let first = headline.lines().find(|line| line.starts_with("| PPOPID |")).unwrap();
    assert!(
        first.contains("32.00")
            && first.contains("5.50")
            && headline.contains("**Level 1, end of training"),
        "{first}"
    );

    // Volcanic Venture: random returns 5, so P3O's score is (R - 5) / (PPO - 5) of the same
    // report's own means. Nothing was evaluated: its costs have no interval, and no feasible score
    // says that they are within.
    let mean_of = |algo: &str, seed: u32| {
        last_ten(&runs.join(format!("main/VolcanicVentureLevel1-v0/{algo}/seed{seed}")))
    };
    let ppo = (1..=3).map(|seed| mean_of("PPO", seed)).sum::<f64>() / 3.0;
    let score = (1..=3).map(|seed| (mean_of("P3O", seed) - 5.0) / (ppo - 5.0)).sum::<f64>() / 3.0;
    let safety = text.split("## Safety").nth(1).unwrap();
    let row =
        safety.lines().find(|line| line.starts_with("| Volcanic Venture | 1 | P3O |")).unwrap();
    let cells: Vec<&str> = row.split(" | ").collect();
    assert!(
        cells[4..6] == ["-", "-"] && cells[6].starts_with(&format!("{score:.2}")),
        "{score}: {row}"
    );
    assert_eq!((cells[7], cells[10], cells[11]), ("end of training", "40k", "10k"), "{row}");
    let ppo_row =
        safety.lines().find(|line| line.starts_with("| Volcanic Venture | 1 | PPO |")).unwrap();
    assert!(ppo_row.contains("| - | - | 1.00 ± "), "PPO is the end of its scale: {ppo_row}");

    // Same runs, same bytes.
    let again = folder.0.join("again");
    let second = write_report(std::slice::from_ref(&runs), &again, "Synthetic runs").unwrap();
    assert_eq!(second.files.len(), written.files.len());
    for (one, two) in written.files.iter().zip(&second.files) {
        assert!(
            std::fs::read(one).unwrap() == std::fs::read(two).unwrap(),
            "{} differs",
            one.display()
        );
    }

    // Random play that returns more than PPO ever did: no scale, and the report says where.
    let high = "{\"env\":\"VolcanicVentureLevel1-v0\",\"rules\":\"tables\",\"return\":1e6,\"cost\":1,\"length\":525}\n";
    let hard = "{\"env\":\"RemedyRushLevel1-v0\",\"rules\":\"tables\",\"hard\":true,\"return\":1e6,\"cost\":1,\"length\":525}\n";
    std::fs::write(runs.join("random-more.jsonl"), (high.to_owned() + hard).repeat(40)).unwrap();
    write_report(std::slice::from_ref(&runs), &again, "Synthetic runs").unwrap();
    let text = std::fs::read_to_string(again.join("report.md")).unwrap();
    let where_not = "than a random policy: RemedyRushLevel1-v0 (hard), VolcanicVentureLevel1-v0.";
    assert!(text.contains(where_not), "{safety}");
    let row = text
        .split("## Safety")
        .nth(1)
        .unwrap()
        .lines()
        .find(|line| line.starts_with("| Volcanic Venture | 1 | P3O |"))
        .unwrap();
    let cells: Vec<&str> = row.split(" | ").collect();
    assert!(cells[4..7].iter().all(|cell| !cell.contains('.')), "{row}");
}

/// The last ten of five hundred points: they lie on the lines between a run's last reports.
fn last_ten(run: &Path) -> f64 {
    let text = std::fs::read_to_string(run.join("metrics.jsonl")).unwrap();
    let value = |line: &str| {
        let after = line.split("\"return_mean\":").nth(1).unwrap();
        after.split(',').next().unwrap().parse::<f64>().unwrap()
    };
    let returns: Vec<f64> = text.lines().map(value).collect();
    let at = |point: f64| {
        let place = point / 500.0 * returns.len() as f64 - 1.0;
        let left = (place.floor() as usize).min(returns.len() - 2);
        returns[left] + (returns[left + 1] - returns[left]) * (place - left as f64)
    };
    (491..=500).map(|point| at(f64::from(point))).sum::<f64>() / 10.0
}

/// Two terms with a budget each: a run that keeps the one and breaks the other is not within its
/// budgets, and each term stands beside its own.
#[test]
fn each_term_stands_beside_its_own_budget() {
    let folder = Folder::new("terms");
    let constraints = ",\"constraints\":[{\"term\":\"lava\",\"budget\":30.0},{\"term\":\"falls\",\"budget\":2.5}]";
    for seed in 1..=2 {
        let run = folder.0.join(format!("run{seed}"));
        let env = "VolcanicVentureLevel1-v0";
        let end = (20.0, 31.0, 0.0);
        Synthetic {
            env,
            algo: "PPOLag",
            seed,
            frames: 1e6,
            reports: 20,
            options: constraints,
            end,
        }
        .write(&run);
        let metrics = run.join("metrics.jsonl");
        let text = std::fs::read_to_string(&metrics).unwrap();
        let text = text
            .replace(",\"length_mean\"", ",\"cost/lava\":28.0,\"cost/falls\":3.0,\"length_mean\"");
        std::fs::write(&metrics, text).unwrap();
        let eval = "{\"return\":20,\"cost\":31,\"costs\":{\"lava\":28,\"falls\":3}}\n\
                    {\"return\":20,\"cost\":10,\"costs\":{\"lava\":8,\"falls\":2}}\n";
        std::fs::write(run.join("eval.jsonl"), eval).unwrap();
        std::fs::write(run.join("hand_out.json"), "{\"frames\":123000,\"closing\":null}").unwrap();
    }
    let out = folder.0.join("out");
    write_report(std::slice::from_ref(&folder.0), &out, "Terms").unwrap();
    let text = std::fs::read_to_string(out.join("report.md")).unwrap();
    let line = |start: &str| {
        text.lines().find(|line| line.contains(start)).unwrap_or_else(|| panic!("{start}: {text}"))
    };
    // In evaluation 18 and 2.5, in training 28 and 3.
    let cells = |term: &str| {
        line(term)
            .split(" | ")
            .skip(6)
            .map(|cell| cell.trim_end_matches(" |").to_owned())
            .collect::<Vec<_>>()
    };
    assert_eq!(cells("| lava | 30 |"), ["18.00 ± 0.00 ✓ (n=2)", "28.00 ± 0.00 ✓ (n=2)"]);
    assert_eq!(cells("| falls | 2.5 |"), ["2.50 ± 0.00 ✓ (n=2)", "3.00 ± 0.00 (n=2)"]);
    assert!(line("PPOLag, seed 1").ends_with("| 50 % |"), "{}", line("PPOLag, seed 1"));
    let selected = line("lava 30, falls 2.5 |");
    assert!(selected.contains("lava 18.00 ± 127") && selected.contains("| 123k |"), "{selected}");
    assert!(selected.contains("| 50 % | 28.00, 3.00 |"), "{selected}");
    let mean = line("mean of 2");
    assert!(mean.contains("20.00 ± 0.00 | lava 18.00 ± 0.00, falls 2.50 ± 0.00"), "{mean}");
    let csv = std::fs::read_to_string(out.join("experiments.csv")).unwrap();
    assert!(csv.contains(",true,true,"), "{csv}");
    assert!(std::fs::read_to_string(out.join("index.html")).unwrap().contains("cost: falls"));
}

/// Every element that is opened is closed, in order.
fn assert_balanced(markup: &str) {
    let body = markup.split("<script>").next().unwrap();
    let mut open: Vec<&str> = Vec::new();
    for part in body.split('<').skip(1) {
        let tag = part.split('>').next().unwrap();
        let name = tag.trim_start_matches('/').split([' ', '/']).next().unwrap();
        if tag.starts_with('!') || tag.ends_with('/') || ["meta", "img"].contains(&name) {
            continue;
        }
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name), "at <{}", &part[..part.len().min(80)]);
        } else {
            open.push(name);
        }
    }
    assert!(open.iter().all(|name| ["html", "body"].contains(name)), "{open:?}");
}

#[test]
fn one_short_run_is_enough() {
    let folder = Folder::new("one");
    let run = folder.0.join("a|b<c");
    let synthetic = Synthetic {
        env: "Custom-v0",
        algo: "Mine<x>",
        seed: 1,
        frames: 1000.0,
        reports: 1,
        options: ",\"note\":\"a,b\\\"|<\"",
        end: (1.0, 2.0, 0.0),
    };
    synthetic.write(&run);
    let written = write_report(&[run.clone(), run], &folder.0.join("out"), "One <run>").unwrap();
    assert_eq!((written.runs, written.warnings.len()), (1, 0), "{:?}", written.warnings);
    let page = std::fs::read_to_string(&written.page).unwrap();
    assert!(page.contains("Mine&lt;x&gt;") && !page.contains("Mine<x>"));
    assert_balanced(&page);
}

#[test]
fn seeds_that_never_came_within_are_counted() {
    let folder = Folder::new("never");
    let (env, runs) = ("RemedyRushLevel1-v0", folder.0.join("runs"));
    for (seed, cost) in [(1, 4.0), (2, 4000.0)] {
        let end = (10.0, cost, 20.0);
        let run =
            Synthetic { env, algo: "PPOPID", seed, frames: 4e6, reports: 80, options: "", end };
        run.write(&runs.join(seed.to_string()));
    }
    write_report(&[runs], &folder.0.join("out"), "Two seeds").unwrap();
    let text = std::fs::read_to_string(folder.0.join("out/report.md")).unwrap();
    let row = text.split("## Safety").nth(1).unwrap();
    let row = row.lines().find(|line| line.starts_with("| Remedy Rush | 1 | PPOPID |")).unwrap();
    assert_eq!(row.matches("(1 of 2 seeds)").count(), 2, "{row}");
}

#[test]
fn a_run_without_any_report_is_shown_as_such() {
    let folder = Folder::new("empty");
    let run = folder.0.join("run");
    Synthetic {
        env: "RemedyRushLevel1-v0",
        algo: "PPO",
        seed: 1,
        frames: 1e6,
        reports: 0,
        options: "",
        end: (0.0, 0.0, 0.0),
    }
    .write(&run);
    let written = write_report(std::slice::from_ref(&run), &folder.0.join("out"), "t").unwrap();
    assert!(std::fs::read_to_string(&written.page).unwrap().contains("no report yet"));
    std::fs::remove_file(run.join("metrics.jsonl")).unwrap();
    let written = write_report(&[run], &folder.0.join("out"), "t").unwrap();
    assert!(
        written.warnings[0].to_string().contains("metrics.jsonl: cannot read"),
        "{:?}",
        written.warnings
    );
}

/// A run of three reports, where any run will do.
fn write_short_run(folder: &Path) {
    Synthetic {
        env: "RemedyRushLevel1-v0",
        algo: "PPO",
        seed: 1,
        frames: 1e6,
        reports: 3,
        options: "",
        end: (1.0, 1.0, 0.0),
    }
    .write(folder);
}

/// A folder that was named is not passed over in silence, and one that lies in another is no other.
#[test]
fn a_named_folder_without_runs_is_warned_of() {
    let folder = Folder::new("empty");
    let (run, empty) = (folder.0.join("runs/a"), folder.0.join("empty"));
    write_short_run(&run);
    std::fs::create_dir(&empty).unwrap();
    let paths = [folder.0.join("runs"), run, empty.clone()];
    let written = write_report(&paths, &folder.0.join("out"), "t").unwrap();
    let lines: Vec<String> = written.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(lines, [format!("{}: no run and no episode is here", empty.display())]);
}

#[test]
fn paths_without_runs_are_errors_that_say_what_to_do() {
    let folder = Folder::new("none");
    let error =
        write_report(std::slice::from_ref(&folder.0), &folder.0.join("out"), "t").unwrap_err();
    assert!(error.contains("no run directory") && error.contains("hasard train --out"), "{error}");
    let error = write_report(&[PathBuf::from("/no/such")], &folder.0.join("out"), "t").unwrap_err();
    assert!(error.starts_with("/no/such: no such file or folder"), "{error}");
    let run = folder.0.join("run");
    write_short_run(&run);
    let error = write_report(&[run], Path::new("/dev/null/out"), "t").unwrap_err();
    assert!(error.starts_with("/dev/null/out"), "{error}");
}

/// What a person played is held against the budget of the rules and constraint that the episode was
/// played under.
#[test]
fn a_persons_budget_follows_the_episodes_options() {
    let folder = Folder::new("people");
    for (player, option, cost) in [
        ("soft", ("hard", "false"), 4.0),
        ("strict", ("hard", "true"), 4.0),
        ("short", ("frame-skip", "1"), 6.0),
    ] {
        let path = folder.0.join(format!("{player}.episode"));
        write_episode(&path, player, 1, &[option], 1, Outcome { cost, ..Outcome::default() });
    }
    for (name, episode_return, cost) in
        [("witness-RemedyRush1", 12.0, 0.0), ("witness-failed", 12.0, 3.0)]
    {
        let outcome = Outcome { episode_return, cost, ..Outcome::default() };
        write_episode(&folder.0.join(format!("{name}.episode")), "search", 1, &[], 1, outcome);
    }
    let out = folder.0.join("out");
    write_report(std::slice::from_ref(&folder.0), &out, "People").unwrap();
    let text = std::fs::read_to_string(out.join("report.md")).unwrap();
    let line = |player: &str| {
        text.lines().find(|line| line.starts_with(&format!("| {player} "))).unwrap().to_owned()
    };
    let witness = text.split("## Witnesses of safe reward").nth(1).unwrap();
    assert!(
        witness.contains("| search |  | 12.00 | 0.00 ✓ | 1 | yes |")
            && witness.contains("| 12.00 | 3.00 | 1 | no |"),
        "{witness}"
    );
    assert!(
        witness.contains("Without a witness here: Armament Burden 1")
            && !witness.contains("Remedy Rush 1,"),
        "{witness}"
    );
    assert!(
        line("soft").ends_with("100 % |") && !line("soft").contains("hard"),
        "{}",
        line("soft")
    );
    assert!(
        line("strict").ends_with("| 0 % |") && line("strict").contains("hard true"),
        "{}",
        line("strict")
    );
    assert!(
        line("short").ends_with("| 0 % |") && line("short").contains("frame-skip 1"),
        "{}",
        line("short")
    );
}

/// The paper's tables ran rules of their own: beside a run under others the report says so, and
/// shows no published value.
#[test]
fn published_values_stand_beside_the_tables_rules_alone() {
    let folder = Folder::new("rules");
    for rules in ["tables", "paper"] {
        let run = folder.0.join(format!("runs-{rules}/one"));
        let end = (45.0, 50.0, 10.0);
        let env = "VolcanicVentureLevel1-v0";
        Synthetic { env, algo: "PPOPID", seed: 1, frames: 12e6, reports: 60, options: "", end }
            .write(&run);
        let config = run.join("config.json");
        let text = std::fs::read_to_string(&config).unwrap();
        std::fs::write(
            &config,
            text.replace("\"rules\":\"tables\"", &format!("\"rules\":\"{rules}\"")),
        )
        .unwrap();
        let out = folder.0.join(format!("out-{rules}"));
        write_report(&[folder.0.join(format!("runs-{rules}"))], &out, "Rules").unwrap();
        let text = std::fs::read_to_string(out.join("report.md")).unwrap();
        let tables = rules == "tables";
        assert_eq!(text.contains("45.23"), tables, "{text}");
        assert_eq!(
            text.contains("ran under other rules (paper) than the paper's tables"),
            !tables,
            "{text}"
        );
        // At 10 million frames the paper's curve stands at 17.61 @ 50.59.
        assert_eq!(text.contains("17.61 @ 50.59"), tables, "{text}");
    }
}

/// What a run's closing evaluation says is its headline; its episodes give tails and behaviour, its
/// critics' calibration a figure.
#[test]
fn a_closing_evaluation_is_the_headline() {
    let folder = Folder::new("closing");
    let run = folder.0.join("runs/one");
    let (env, end) = ("ArmamentBurdenLevel1-v0", (6.0, 60.0, 0.0));
    Synthetic { env, algo: "PPOPID", seed: 1, frames: 1e6, reports: 20, options: "", end }
        .write(&run);
    let estimate = |mean: f64, half: f64| {
        format!("{{\"mean\":{mean},\"half_width\":{half},\"bootstrap\":null}}")
    };
    let evaluation = |episode_return: f64, cost: f64| {
        let (episode_return, cost) = (estimate(episode_return, 0.5), estimate(cost, 4.0));
        format!(
            "\"episodes\":20,\"episode_return\":{episode_return},\"cost\":{cost},\"length\":{}",
            estimate(525.0, 0.0)
        )
    };
    let selected = format!(
        "{{\"frames\":800000,\"closing\":{{{}}},\"last\":{{\"frames\":1000000,{}}}}}",
        evaluation(7.5, 41.0),
        evaluation(8.5, 58.0)
    );
    std::fs::write(run.join("selected.json"), selected).unwrap();
    let episodes: String = (0..20)
        .map(|k| {
            let (cost, discarded) = (if k < 2 { 70.0 + f64::from(k) } else { 38.0 }, u8::from(k == 3) * 2);
            format!(
                "{{\"return\":7.5,\"cost\":{cost},\"length\":525,\"stats\":{{\"weapons_discarded\":{discarded},\"load\":1}}}}\n"
            )
        })
        .collect();
    std::fs::write(run.join("closing_episodes.jsonl"), episodes).unwrap();
    std::fs::write(run.join("eval.jsonl"), "{\"return\":1,\"cost\":1}\n").unwrap();
    let critic = "{\"frames\":800000,\"constraints\":[{\"term\":null,\"gamma\":0.99,\"steps\":900,\"bias\":-0.25,\"error\":1.5,\
                  \"bins\":[{\"steps\":450,\"predicted\":1,\"observed\":1.5},{\"steps\":450,\"predicted\":4,\"observed\":4.5}]}]}";
    std::fs::write(run.join("calibration.json"), critic).unwrap();
    let out = folder.0.join("out");
    let written = write_report(&[folder.0.join("runs")], &out, "Closing").unwrap();
    assert!(written.warnings.is_empty(), "{:?}", written.warnings);
    let text = std::fs::read_to_string(out.join("report.md")).unwrap();
    let line = |start: &str| {
        text.lines()
            .find(|line| line.starts_with(start))
            .unwrap_or_else(|| panic!("{start}: {text}"))
    };
    // 41 with an upper end of 45 of 50; nothing of the later eval.jsonl.
    assert_eq!(line("| PPOPID |"), "| PPOPID | **7.50** | 41.00 ✓ |");
    // The paper selects none: what stands beside its values is of the end of training.
    let beside = text.split("## Beside the paper").nth(1).unwrap();
    let row = beside.lines().find(|line| line.starts_with("| Armament Burden |")).unwrap();
    let end = last_ten(&run);
    let shown = format!("| training | {end:.2} (n=1) | *8.99* | {:.2} |", end / 8.99);
    assert!(row.contains(&shown), "{row}");
    let row = line("| Armament Burden | 1 | PPOPID | preset paper, rules tables, 1M frames | 1 |");
    assert!(
        row.contains("| 800k | 20 | 7.50 ± 0.50 | 41.00 ± 4.00 ✓ | 45.00 | 50 | 10 % | 70.50 |"),
        "{row}"
    );
    assert!(
        text.contains(
            "| weapons discarded | weapons thrown away rather than carried | 0.10 | 5 % |"
        ),
        "{text}"
    );
    assert!(text.contains("| whole cost | 0.99 | 900 | -0.25 | 1.50 |"), "{text}");
    assert!(out.join("figures/calibration.svg").is_file());
    // What it has is not listed as missing, what it has not is.
    let missing = text.split("## Not here yet").nth(1).unwrap();
    assert!(
        !missing.contains("| calibration |") && missing.contains("| safety-bounds |"),
        "{missing}"
    );
}
