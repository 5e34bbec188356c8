//! What a seed scores, as `runs.csv` has it: by its last policy, on the scale of its task.

mod synthetic;

use hasard_media::episode::Outcome;
use hasard_report::write_report;
use synthetic::{Folder, Synthetic, write_episode};

/// By hand: random play returns 2 and PPO 12, so that 7 is half of the way; 4.5 with a half-width
/// of 0.4 keeps a budget of 5, with 0.6 it does not.
#[test]
fn a_seed_scores_by_its_last_policy_whatever_it_sees() {
    let folder = Folder::new("scores");
    let runs = folder.0.join("runs");
    let seeds = [
        ("PPO", "", 1, 12.0, 40.0, 1.0),
        ("PPO", ",\"observation\":\"segmented\"", 1, 22.0, 40.0, 1.0),
        ("PPOPID", "", 1, 7.0, 4.5, 0.4),
        ("PPOPID", "", 2, 7.0, 4.5, 0.6),
        ("PPOPID", ",\"observation\":\"segmented\"", 1, 9.0, 4.5, 0.4),
    ];
    for (k, (algo, options, seed, episode_return, cost, half)) in seeds.into_iter().enumerate() {
        let run = runs.join(k.to_string());
        let env = "RemedyRushLevel1-v0";
        Synthetic { env, algo, seed, frames: 1e6, reports: 20, options, end: (30.0, 9.0, 0.0) }
            .write(&run);
        let evaluation = format!(
            "\"episodes\":200,\"episode_return\":{{\"mean\":{episode_return},\"half_width\":0.1}},\
             \"cost\":{{\"mean\":{cost},\"half_width\":{half}}},\"length\":{{\"mean\":525,\"half_width\":0}}"
        );
        let selected = format!("{{\"frames\":1000000,\"closing\":null,\"last\":{{{evaluation}}}}}");
        std::fs::write(run.join("selected.json"), selected).unwrap();
    }
    let episodes: String = [1.0, 2.0, 3.0]
        .iter()
        .map(|earned| {
            format!(
                "{{\"env\":\"RemedyRushLevel1-v0\",\"player\":\"random\",\"rules\":\"tables\",\"episode\":0,\"seed\":{earned},\
                 \"return\":{earned},\"cost\":1,\"length\":525}}\n"
            )
        })
        .collect();
    // Of another action space, and of actions that are held longer: not what chance returns to these agents.
    for (word, name) in [("\"full_actions\":true", "full"), ("\"frame_skip\":8", "skip8")] {
        let other = episodes.replace("\"return\":", &format!("{word},\"return\":100"));
        std::fs::write(runs.join(format!("random-{name}.jsonl")), other).unwrap();
    }
    for (option, value) in [("full-actions", "true"), ("frame-skip", "8")] {
        let options = [("rules", "tables"), (option, value)];
        let outcome = Outcome { episode_return: 1000.0, ..Outcome::default() };
        write_episode(&runs.join(format!("{option}.episode")), "random", 1, &options, 1, outcome);
    }
    std::fs::write(runs.join("random-RemedyRushLevel1-v0-tables.jsonl"), episodes).unwrap();
    let out = folder.0.join("out");
    write_report(&[runs], &out, "Scores").unwrap();
    let text = std::fs::read_to_string(out.join("runs.csv")).unwrap();
    let rows: Vec<&str> = text.lines().skip(1).collect();
    let ends = |algo: &str| -> Vec<&str> {
        let own = rows.iter().filter(|row| row.contains(&format!(",{algo},")));
        own.map(|row| row.split_once("last policy,").expect("judged by the last policy").1)
            .collect()
    };
    assert_eq!(ends("PPO"), ["22,40,41,2,0", "12,40,41,1,0"], "{text}");
    assert_eq!(
        ends("PPOPID"),
        ["9,4.5,4.9,0.7,0.7", "7,4.5,4.9,0.5,0.5", "7,4.5,5.1,0.5,0"],
        "{text}"
    );
}

/// Three of five lines count: one is of another environment, one of a seed that was there before.
#[test]
fn a_later_evaluation_counts_by_the_runs_own_episodes() {
    let folder = Folder::new("own_episodes");
    let run = folder.0.join("runs/one");
    let (env, end) = ("RemedyRushLevel1-v0", (30.0, 9.0, 0.0));
    Synthetic { env, algo: "PPOLag", seed: 1, frames: 1e6, reports: 20, options: "", end }
        .write(&run);
    let line = |env: &str, seed: u64, earned: f64| {
        format!(
            "{{\"env\":\"{env}\",\"seed\":{seed},\"rules\":\"tables\",\"return\":{earned},\"cost\":1,\"length\":525}}\n"
        )
    };
    let lines = [
        line(env, 1, 10.0),
        line(env, 2, 20.0),
        line(env, 2, 20.0),
        line("VolcanicVentureLevel1-v0", 3, 99.0),
        line(env, 4, 30.0),
    ];
    std::fs::write(run.join("eval.jsonl"), lines.concat()).unwrap();
    let out = folder.0.join("out");
    let written = write_report(&[folder.0.join("runs")], &out, "Own").unwrap();
    let mut problems: Vec<&str> = written.warnings.iter().map(|one| one.problem.as_str()).collect();
    problems.sort();
    assert_eq!(
        problems,
        [
            "1 of 5 episodes are of a seed that stands there before; left out",
            "1 of 5 episodes are of another environment or other rules than the run's; left out"
        ]
    );
    let text = std::fs::read_to_string(out.join("report.md")).unwrap();
    assert!(text.contains("| 3 | 20.00 ± "), "{text}");
}

/// Other creatures, other maps, another file of an own task: what random play and PPO return in the
/// usual ones is no scale for them. Nor has a run that is still training a score.
#[test]
fn another_task_of_the_same_name_and_unfinished_training_have_no_score() {
    let folder = Folder::new("other_tasks");
    let runs = folder.0.join("runs");
    let env = "DetonatorsDilemmaLevel1-v0";
    let early = ",\"early_creatures\":true";
    let maps = ",\"maps\":\"/my maps\"";
    let hash = ",\"env.scenario_file.hash\":\"7\"";
    let run = |name: &str, algo: &str, options: &str, seed: u64, reached: f64| {
        let directory = runs.join(name);
        let end = if algo == "PPO" { (12.0, 40.0, 0.0) } else { (7.0, 4.5, 0.0) };
        Synthetic { env, algo, seed, frames: reached, reports: 20, options, end }.write(&directory);
        let config = directory.join("config.json");
        let text = std::fs::read_to_string(&config).unwrap();
        let frames = |frames: f64| format!("\"frames\":{frames}");
        std::fs::write(&config, text.replace(&frames(reached), &frames(1e6))).unwrap();
    };
    run("ppo", "PPO", "", 1, 1e6);
    run("usual", "PPOPID", "", 1, 1e6);
    run("unfinished", "PPOPID", "", 2, 5e5);
    for (name, options) in [("early", early), ("maps", maps), ("file", hash)] {
        run(name, "PPOPID", options, 1, 1e6);
    }
    // Of these only the first plays the usual task.
    for (k, (word, earned)) in
        [("", 2), (",\"early_creatures\":true", 100), (",\"maps\":true", 100)].iter().enumerate()
    {
        let line = |seed: u64| {
            format!(
                "{{\"env\":\"{env}\",\"rules\":\"tables\",\"seed\":{seed},\"return\":{earned},\"cost\":1,\"length\":525{word}}}\n"
            )
        };
        std::fs::write(runs.join(format!("random-{k}.jsonl")), line(1) + &line(2)).unwrap();
    }
    let out = folder.0.join("out");
    write_report(std::slice::from_ref(&runs), &out, "Other tasks").unwrap();
    let text = std::fs::read_to_string(out.join("runs.csv")).unwrap();
    let scores: Vec<(&str, &str)> = text
        .lines()
        .filter(|row| row.contains(",PPOPID,"))
        .map(|row| {
            let directory = row.split(",Deton").next().unwrap().rsplit('/').next().unwrap();
            (directory, row.split_once("end of training,").unwrap().1)
        })
        .collect();
    for (directory, row) in &scores {
        assert_eq!(row.ends_with(",,"), *directory != "usual", "{directory}: {row}");
    }
    assert_eq!(scores.len(), 5, "{text}");
    // What is missing is named with its options, the path in quotes.
    write_report(&[runs.join("maps")], &out, "Other maps").unwrap();
    let page = std::fs::read_to_string(out.join("report.md")).unwrap();
    let command = format!(
        "hasard rollout {env} --policy random --episodes 100 --rules tables --maps '/my maps' --json"
    );
    assert!(page.contains(&command), "{page}");
}
