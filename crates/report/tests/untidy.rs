//! Folders less tidy than a campaign's: runs that went on, experiments that print alike, files of
//! other runs. Nothing of them may stand in a table under another's name.

mod synthetic;

use hasard_report::{Written, write_report};
use std::path::{Path, PathBuf};
use synthetic::{Folder, Synthetic};

const ENV: &str = "RemedyRushLevel1-v0";

/// A run whose training ends at a return of 30 and a cost of 9.
fn run(folder: &Folder, name: &str, env: &str, algo: &str, frames: f64, options: &str) -> PathBuf {
    let path = folder.0.join("runs").join(name);
    Synthetic { env, algo, seed: 1, frames, reports: 20, options, end: (30.0, 9.0, 0.0) }
        .write(&path);
    path
}

/// What a run says of its selected and its last policy: a return, at a cost of 4 ± 0.5.
fn close(run: &Path, earned: f64, frames: f64, half_width: f64) {
    let estimate = |mean: f64, half: f64| format!("{{\"mean\":{mean},\"half_width\":{half}}}");
    let all = format!(
        "\"episodes\":200,\"episode_return\":{},\"cost\":{},\"length\":{}",
        estimate(earned, 0.1),
        estimate(4.0, half_width),
        estimate(525.0, 0.0)
    );
    let text = format!(
        "{{\"frames\":{frames},\"closing\":{{{all}}},\"last\":{{\"frames\":{frames},{all}}}}}"
    );
    std::fs::write(run.join("selected.json"), text).unwrap();
}

fn episodes(run: &Path, file: &str, lines: &[(&str, u64, f64)]) {
    let line = |(env, seed, earned): &(&str, u64, f64)| {
        format!(
            "{{\"env\":\"{env}\",\"seed\":{seed},\"rules\":\"tables\",\"return\":{earned},\"cost\":1,\"length\":525}}\n"
        )
    };
    std::fs::write(run.join(file), lines.iter().map(line).collect::<String>()).unwrap();
}

/// Random play that returns 1, 2 and 3 in an environment.
fn chance(folder: &Folder, env: &str) {
    let file = format!("random-{env}-tables.jsonl");
    episodes(&folder.0.join("runs"), &file, &[(env, 1, 1.0), (env, 2, 2.0), (env, 3, 3.0)]);
}

fn report(folder: &Folder) -> (Written, String, Vec<String>) {
    let out = folder.0.join("out");
    let written = write_report(&[folder.0.join("runs")], &out, "Untidy").unwrap();
    let text = std::fs::read_to_string(out.join("report.md")).unwrap();
    let csv = std::fs::read_to_string(out.join("runs.csv")).unwrap();
    (written, text, csv.lines().skip(1).map(String::from).collect())
}

fn problems(written: &Written) -> String {
    written.warnings.iter().map(|one| format!("{}\n", one.problem)).collect()
}

/// The episodes of a policy that the run has left behind are not those of the run.
#[test]
fn a_run_that_went_on_is_not_judged_by_what_closed_it_before() {
    let folder = Folder::new("went-on");
    let path = run(&folder, "one", ENV, "PPOPID", 3e6, "");
    episodes(&path, "closing_episodes.jsonl", &[(ENV, 1, 5.0), (ENV, 2, 5.0)]);
    close(&path, 5.0, 3e6, 0.5);
    let (_, _, rows) = report(&folder);
    assert!(rows[0].contains(",last policy,5,"), "{rows:?}");
    close(&path, 5.0, 2e6, 0.5);
    let (written, text, rows) = report(&folder);
    assert!(problems(&written).contains("the run went on to 3000000"), "{}", problems(&written));
    assert!(rows[0].contains(",end of training,"), "{rows:?}");
    assert!(!text.contains("5.00"), "{text}");
}

/// A curriculum's or a mixture's PPO says nothing of what PPO reaches in the level alone.
#[test]
fn the_scale_is_of_ppo_on_the_task_alone() {
    let folder = Folder::new("scale");
    for (name, algo, frames, options, earned) in [
        ("ppo", "PPO", 1e6, "", 12.0),
        ("pid", "PPOPID", 1e6, "", 7.0),
        ("curriculum", "PPO", 9e6, ",\"curriculum\":[3,2,1]", 300.0),
    ] {
        close(&run(&folder, name, ENV, algo, frames, options), earned, frames, 0.5);
    }
    chance(&folder, ENV);
    let (_, _, rows) = report(&folder);
    let pid = rows.iter().find(|row| row.contains(",PPOPID,")).unwrap();
    assert!(pid.ends_with(",last policy,7,4,4.5,0.5,0.5"), "{pid}");
}

/// Frames that are rounded alike, and the two usual budgets of Armament Burden under `released`.
#[test]
fn experiments_that_print_alike_all_have_a_table() {
    let folder = Folder::new("alike");
    for (name, frames, earned) in [("a", 2_000_000.0, 41.0), ("b", 2_002_944.0, 43.0)] {
        close(&run(&folder, name, ENV, "PPO", frames, ""), earned, frames, 0.5);
    }
    let burden = "ArmamentBurdenLevel1-v0";
    for (name, budget, earned) in [("c", 50, 45.0), ("d", 5, 47.0)] {
        let options = format!(",\"rules\":\"released\",\"safety_budget\":{budget}");
        let path = run(&folder, name, burden, "PPOLag", 1e6, &options);
        // The key that the helper writes comes first, and the last of two counts.
        let text = std::fs::read_to_string(path.join("config.json")).unwrap();
        std::fs::write(path.join("config.json"), text.replace("\"rules\":\"tables\",", ""))
            .unwrap();
        close(&path, earned, 1e6, 0.5);
    }
    let (_, text, _) = report(&folder);
    let main = text.split("## Results").nth(1).unwrap().split("\n## ").next().unwrap();
    for earned in ["41.00", "43.00", "45.00", "47.00"] {
        assert!(main.contains(earned), "{earned} is missing: {main}");
    }
    assert!(
        main.contains("2M frames, exactly 2000000;") && main.contains("1M frames, budget 50;"),
        "{main}"
    );
}

/// Agents of one algorithm and seed that were trained under other options: each says under which.
#[test]
fn selected_checkpoints_say_what_options_they_are_of() {
    let folder = Folder::new("options");
    for (name, options, earned) in
        [("soft", "", 41.0), ("hard", ",\"hard\":true", 43.0), ("skip", ",\"frame_skip\":2", 45.0)]
    {
        close(&run(&folder, name, ENV, "PPO", 1e6, options), earned, 1e6, 0.5);
    }
    let (_, text, _) = report(&folder);
    let own = text.split("## Selected checkpoints").nth(1).unwrap().split("\n## ").next().unwrap();
    for (options, earned) in [("hard true", "43.00"), ("frame_skip 2", "45.00")] {
        let row = own.lines().find(|line| line.contains(earned)).expect(own);
        assert!(row.contains(&format!("| PPO | {options} |")), "{row}");
    }
    // What all share stands above the table.
    assert!(own.contains("preset paper, rules tables"), "{own}");
}

/// Each task of a mixture has its own episodes; those of a third are nobody's.
#[test]
fn episodes_of_several_tasks_count_by_task() {
    let folder = Folder::new("tasks");
    let other = "VolcanicVentureLevel1-v0";
    let path = run(&folder, "both", &format!("{ENV},{other}"), "PPOPID", 1e6, "");
    let third = "DetonatorsDilemmaLevel1-v0";
    let all =
        [(ENV, 1, 10.0), (ENV, 2, 12.0), (other, 1, 20.0), (other, 2, 22.0), (third, 1, 99.0)];
    episodes(&path, "eval.jsonl", &all);
    let (written, _, rows) = report(&folder);
    assert!(
        problems(&written).starts_with("1 of 5 episodes are of another environment"),
        "{}",
        problems(&written)
    );
    for (env, earned) in [(ENV, 11), (other, 21)] {
        let row = rows.iter().find(|row| row.contains(&format!(",{env},"))).unwrap();
        assert!(row.contains(&format!(",selected checkpoint,{earned},1,")), "{row}");
    }
}

#[test]
fn closing_episodes_of_another_run_and_spoiled_intervals_count_for_nothing() {
    let folder = Folder::new("spoiled");
    let path = run(&folder, "one", ENV, "PPOPID", 1e6, "");
    let other = "VolcanicVentureLevel1-v0";
    let lines = [(ENV, 1, 10.0), (ENV, 2, 12.0), (ENV, 2, 12.0), (other, 3, 99.0)];
    episodes(&path, "closing_episodes.jsonl", &lines);
    let (written, _, rows) = report(&folder);
    assert!(rows[0].contains(",selected checkpoint,11,1,"), "{rows:?}");
    assert_eq!(written.warnings.len(), 2, "{}", problems(&written));
    close(&path, 10.0, 1e6, -3.0);
    let (written, _, rows) = report(&folder);
    assert!(problems(&written).contains("does not say which checkpoint"), "{}", problems(&written));
    assert!(rows[0].contains(",end of training,"), "{rows:?}");
}

/// An algorithm that was run in one environment of two is not ranked among means over both.
#[test]
fn means_over_environments_are_over_the_same_ones() {
    let folder = Folder::new("over");
    let other = "VolcanicVentureLevel1-v0";
    for (env, algo, earned) in [
        (ENV, "PPO", 12.0),
        (other, "PPO", 12.0),
        (ENV, "PPOPID", 7.0),
        (other, "PPOPID", 4.0),
        (ENV, "CUP", 9.0),
    ] {
        close(&run(&folder, &format!("{env}{algo}"), env, algo, 1e6, ""), earned, 1e6, 0.5);
    }
    [ENV, other].iter().for_each(|env| chance(&folder, env));
    let (_, text, _) = report(&folder);
    let over = text.split("## Over environments").nth(1).unwrap().split("\n## ").next().unwrap();
    let (both, alone) = over.split_once("RemedyRushLevel1-v0 alone").expect(over);
    // 0.5 and 0.2 of the way from chance to PPO.
    assert!(
        both.contains("| 1 | PPOPID | 0.35 (n=2) | 2 of 2 | 0.35 (n=2) |")
            && !both.contains("| CUP |"),
        "{both}"
    );
    assert!(
        alone.contains("| 1 | PPOPID | 0.50 (n=1) |") && alone.contains("| 1 | CUP | 0.70 (n=1) |"),
        "{alone}"
    );
}

/// What `hasard serve --edit` has thrown away counts nowhere, at any depth; named itself, it does.
#[test]
fn runs_in_the_trash_count_nowhere() {
    let folder = Folder::new("trash");
    close(&run(&folder, "kept", ENV, "PPO", 1e6, ""), 12.0, 1e6, 0.5);
    for name in [".trash/gone", "deeper/.trash/gone"] {
        close(&run(&folder, name, ENV, "PPOPID", 1e6, ""), 99.0, 1e6, 0.5);
    }
    let (_, text, rows) = report(&folder);
    assert!(rows.len() == 1 && !text.contains("99.00"), "{rows:?}");
    let trash = folder.0.join("runs/.trash");
    let written = write_report(&[trash], &folder.0.join("out2"), "Trash").unwrap();
    assert_eq!(written.runs, 1);
}

/// PPO is 1 among runs of its own length, whatever longer ones stand in the report.
#[test]
fn longer_runs_change_no_score() {
    let folder = Folder::new("lengths");
    for (name, algo, frames, earned) in
        [("ppo", "PPO", 1e6, 12.0), ("pid", "PPOPID", 1e6, 7.0), ("far", "PPOPID", 4e6, 22.0)]
    {
        close(&run(&folder, name, ENV, algo, frames, ""), earned, frames, 0.5);
    }
    chance(&folder, ENV);
    let score_of = |rows: &[String], name: &str| -> String {
        let row = rows.iter().find(|row| row.contains(&format!("/{name},"))).unwrap();
        row.rsplit(',').next().unwrap().to_owned()
    };
    let (_, text, rows) = report(&folder);
    assert_eq!([score_of(&rows, "pid"), score_of(&rows, "far")], ["0.5", "2"]);
    let said = "for want of one as long: RemedyRushLevel1-v0 (4M, PPO 1M).";
    assert!(text.contains(said), "{text}");
    close(&run(&folder, "ppo-far", ENV, "PPO", 4e6, ""), 42.0, 4e6, 0.5);
    let (_, text, rows) = report(&folder);
    assert_eq!([score_of(&rows, "pid"), score_of(&rows, "far")], ["0.5", "0.5"]);
    assert!(!text.contains("for want of one as long"), "{text}");
}

/// What stands side by side but was not trained alike says in what.
#[test]
fn settings_that_differ_are_named() {
    let folder = Folder::new("unlike");
    let slow = ",\"learning\":{\"rate\":0.0001}";
    let (fast, hard) =
        (",\"learning\":{\"rate\":0.0005}", ",\"hard\":true,\"learning\":{\"rate\":0.0005}");
    for (name, algo, options) in
        [("ppo", "PPO", slow), ("lag", "PPOLag", fast), ("hard", "PPO", hard)]
    {
        close(&run(&folder, name, ENV, algo, 1e6, options), 12.0, 1e6, 0.5);
    }
    let (_, text, _) = report(&folder);
    let unlike = "| learning.rate | 0.0001: PPO; 0.0005: PPOLag |";
    assert!(text.contains(unlike), "{text}");
    let compared = text.split("## Hard constraint").nth(1).unwrap();
    for row in ["| soft | learning.rate 0.0001 |", "| hard | learning.rate 0.0005 |"] {
        assert!(compared.contains(row), "{row}: {compared}");
    }
}

/// Episodes of `hasard eval` that the run has outgrown are not its own; of the others its summary
/// has the interval, which is a bootstrap's where costs are skewed.
#[test]
fn a_later_evaluation_counts_by_its_summary_and_until_the_run_goes_on() {
    let folder = Folder::new("outgrown");
    let path = run(&folder, "one", ENV, "PPOPID", 1e6, "");
    let lines = [(ENV, 1, 10.0), (ENV, 2, 20.0)];
    let write = |frames: f64| {
        episodes(&path, "eval.jsonl", &lines);
        let text = std::fs::read_to_string(path.join("eval.jsonl")).unwrap();
        let summary = format!(
            "{{\"summary\":{{\"episodes\":2,\"return_mean\":15,\"return_ci95\":3.5,\"cost_mean\":1,\"cost_ci95\":0,\
             \"cost_interval\":[0.5,5.5],\"length_mean\":525,\"length_ci95\":0,\"run_frames\":{frames}}}}}\n"
        );
        std::fs::write(path.join("eval.jsonl"), text + &summary).unwrap();
    };
    write(1e6);
    let (written, text, rows) = report(&folder);
    assert_eq!(problems(&written), "");
    assert!(rows[0].contains(",selected checkpoint,15,1,5.5,"), "{rows:?}");
    assert!(text.contains("15.00 ± 3.50"), "{text}");
    write(5e5);
    let (written, _, rows) = report(&folder);
    let said = "is of a run of 500000 frames, which went on to 1000000; passed over";
    assert!(problems(&written).contains(said), "{}", problems(&written));
    assert!(rows[0].contains(",end of training,"), "{rows:?}");
}

/// By whatever names, and through links in a circle.
#[cfg(unix)]
#[test]
fn what_is_named_twice_counts_once() {
    let folder = Folder::new("twice");
    close(&run(&folder, "one", ENV, "PPO", 1e6, ""), 12.0, 1e6, 0.5);
    chance(&folder, ENV);
    let runs = folder.0.join("runs");
    for name in ["a", "b", "c", "d"] {
        std::os::unix::fs::symlink(".", runs.join(name)).unwrap();
    }
    let file = runs.join(format!("random-{ENV}-tables.jsonl"));
    let named = [runs.clone(), runs.join("one"), file.clone(), runs.join("a"), file];
    let out = folder.0.join("out");
    let written = write_report(&named, &out, "Twice").unwrap();
    let text = std::fs::read_to_string(out.join("report.md")).unwrap();
    assert_eq!(written.runs, 1);
    // Returns of 1, 2 and 3: 4.3027 / sqrt(3).
    assert!(text.contains("| 2.00 ± 2.48 (n=3) |"), "{text}");
}

/// Two versions of the program may learn differently.
#[test]
fn seeds_of_two_versions_are_named() {
    let folder = Folder::new("versions");
    for (seed, version) in [(1, "0.1.0"), (2, "0.2.0")] {
        let options = format!(",\"version\":\"{version}\"");
        let (env, algo, end) = (ENV, "PPOPID", (30.0, 9.0, 0.0));
        Synthetic { env, algo, seed, frames: 1e6, reports: 20, options: &options, end }
            .write(&folder.0.join(format!("runs/{seed}")));
    }
    let (written, text, _) = report(&folder);
    let said = "was trained by version 0.2.0, seed 1 of the same experiment by 0.1.0";
    assert!(problems(&written).contains(said), "{}", problems(&written));
    assert!(text.contains("2 runs of 1 experiment"), "{text}");
}

/// Their means are over unlike agents, although all learned alike.
#[test]
fn seeds_whose_checkpoints_were_selected_by_other_settings_are_named() {
    let folder = Folder::new("selected-otherwise");
    let write = |seed: u64, options: &str| {
        let path = folder.0.join(format!("runs/{seed}"));
        let (env, algo, end) = (ENV, "PPOPID", (30.0, 9.0, 0.0));
        Synthetic { env, algo, seed, frames: 1e6, reports: 20, options, end }.write(&path);
    };
    // An older version had no such switch, and named fewer numbers.
    write(1, "");
    write(2, ",\"evaluation\":{\"surely\":false,\"episodes\":32}");
    assert_eq!(problems(&report(&folder).0), "");
    write(3, ",\"evaluation\":{\"surely\":true,\"episodes\":32}");
    write(4, ",\"evaluation\":{\"episodes\":64}");
    let (written, text, _) = report(&folder);
    let expected = "evaluation.surely is true here and not given in seed 1 of the same experiment";
    assert!(problems(&written).contains(expected), "{}", problems(&written));
    assert_eq!(written.warnings.len(), 1);
    assert!(text.contains("4 runs of 1 experiment"), "{text}");
}

/// Whatever spoils its settings, a run is a run: its episodes are no play of anybody's.
#[test]
fn a_damaged_run_is_named_and_alone_it_is_an_error() {
    let folder = Folder::new("damaged");
    let (runs, out) = (folder.0.join("runs"), folder.0.join("out"));
    let damaged = run(&folder, "damaged", ENV, "PPO", 1e6, "");
    episodes(&damaged, "eval.jsonl", &[(ENV, 1, 10.0)]);
    std::fs::remove_file(damaged.join("config.json")).unwrap();
    std::fs::create_dir(damaged.join("config.json")).unwrap();
    let named = format!("{}: is a folder", damaged.join("config.json").display());
    let alone = || write_report(std::slice::from_ref(&runs), &out, "Damaged").unwrap_err();
    assert!(alone().starts_with("no run below ") && alone().contains(&named), "{}", alone());
    // Random play beside it makes no report of runs either.
    chance(&folder, ENV);
    assert!(alone().contains(&named) && !out.exists(), "{}", alone());
    run(&folder, "whole", ENV, "PPO", 1e6, "");
    let written = report(&folder).0;
    assert_eq!((written.runs, written.warnings.len()), (1, 1));
    assert!(written.warnings[0].to_string().starts_with(&named), "{:?}", written.warnings);
}

/// A link to itself stands for what the system does not show: that is not "no such file".
#[cfg(unix)]
#[test]
fn what_cannot_be_seen_is_not_said_to_be_absent() {
    use std::os::unix::fs::symlink;
    let folder = Folder::new("closed");
    let path = run(&folder, "one", ENV, "PPO", 1e6, "");
    std::fs::remove_file(path.join("config.json")).unwrap();
    symlink("config.json", path.join("config.json")).unwrap();
    symlink("circle", folder.0.join("circle")).unwrap();
    for (named, said) in [("circle", "circle: cannot read: "), ("runs", "json: cannot read: ")] {
        let out = folder.0.join("out");
        let error = write_report(&[folder.0.join(named)], &out, "Closed").unwrap_err();
        assert!(error.contains(said), "{error}");
    }
}
