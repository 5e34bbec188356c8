//! An agent of several tasks from the shell: trained, resumed, evaluated, reported, filmed.

mod folder;

use folder::Folder;
use serde_json::Value;

/// The paper's examples of budgets 5 and 50, and a task of one's own.
const TASKS: [&str; 3] = ["RemedyRushLevel1-v0", "VolcanicVentureLevel1-v0", "LavaGarden-v0"];

/// A training of a few rollouts of milliseconds.
const SMALL: &str = "--set network.dense=[32] --set network.recurrent=32 --frames 7680 --set sampling.rollout=32 \
                     --set evaluation.episodes=4 --set evaluation.confirming_episodes=4 --size 64x48 --set reporting.report_seconds=0";

fn rows(text: &str) -> Vec<Value> {
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// A critic that is shown the time that is left must be shown its own task's.
#[test]
fn the_time_left_is_for_episodes_of_one_length() {
    let folder = Folder::new("time_left");
    folder.ok("new lava_garden");
    let file = folder.0.join("lava_garden.toml");
    let text = std::fs::read_to_string(&file).unwrap();
    std::fs::write(&file, text.replace("tics = 2100", "tics = 700")).unwrap();
    let seen = r#"--set learning.critic_inputs=["time-left"] --envs 2 --out run"#;
    let said = folder.refused(&format!("train RemedyRushLevel1,lava_garden.toml {SMALL} {seen}"));
    assert!(said.contains("time-left") && said.contains("differ in length"), "{said}");
    folder.ok(&format!("train lava_garden.toml {SMALL} {seen} --quiet"));
}

/// What a run learned and wrote, but for the time that it took.
fn story(folder: &Folder, run: &str) -> Vec<Value> {
    let text = std::fs::read_to_string(folder.0.join(run).join("metrics.jsonl")).unwrap();
    let mut rows = rows(&text);
    for row in &mut rows {
        for name in ["wall_s", "fps", "threads", "seconds_waiting", "seconds_learning"] {
            row.as_object_mut().unwrap().remove(name);
        }
    }
    rows
}

#[test]
fn an_agent_of_several_tasks_goes_the_whole_way() {
    let folder = Folder::new("mixed");
    folder.ok("new lava_garden");
    let tasks = "RemedyRushLevel1,VolcanicVentureLevel1,lava_garden.toml";
    let train = |out: &str, more: &str| {
        folder.ok(&format!("train {tasks} --envs 6 --eval-every 3840 --out {out} {SMALL} {more}"));
    };
    train("one", "--threads 1");
    train("two", "--threads 2");
    assert_eq!(story(&folder, "one"), story(&folder, "two"), "whatever the threads");

    // Each task has its own budget, its own numbers in the reports, and its own verdict.
    let config = std::fs::read_to_string(folder.0.join("one/config.json")).unwrap();
    let config: Value = serde_json::from_str(&config).unwrap();
    let budgets: Vec<(&str, f64)> = config["constraints"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| (one["term"].as_str().unwrap(), one["budget"].as_f64().unwrap()))
        .collect();
    assert_eq!(budgets[..2], [(TASKS[0], 5.0), (TASKS[1], 50.0)]);
    assert_eq!(budgets[2].0, TASKS[2]);
    assert!(config["env"]["scenario_files"][0]["text"].as_str().unwrap().contains("vials"));
    let last = story(&folder, "one").pop().unwrap();
    for (at, task) in TASKS.iter().enumerate() {
        let own = last[format!("task/{task}/cost")].as_f64().unwrap();
        let held = last["constraint_costs"][at].as_f64().unwrap();
        assert!((own - held).abs() < 1e-9, "{task}: {own} against {held}");
        assert!(last[format!("eval/task/{task}/return")].is_number(), "{task}");
    }
    assert!(last["stats/jumps"].is_null() || last["cost/jumps"].is_number());

    // Episodes have the tasks in turn, however many are played at once.
    let all = rows(&folder.ok("eval one --episodes 7 --seed 40 --json"));
    let (summary, episodes) = all.split_last().unwrap();
    for (number, episode) in episodes.iter().enumerate() {
        assert_eq!(episode["env"], TASKS[number % 3]);
    }
    let counts: Vec<u64> = summary["summary"]["tasks"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| one["episodes"].as_u64().unwrap())
        .collect();
    assert_eq!(counts, [3, 2, 2]);
    let table = folder.ok("eval one --episodes 3");
    assert!(TASKS.iter().all(|task| table.contains(task)), "{table}");

    // The agent alone in one of its tasks plays the episode that it plays there in the mixture.
    let alone = rows(&folder.ok(&format!(
        "rollout {} --policy run:one --seed 41 --episodes 1 --json --size 64x48",
        TASKS[1]
    )));
    for name in ["return", "cost", "length", "stats", "terminated"] {
        assert_eq!(alone[0][name], episodes[1][name], "{name}");
    }
    folder.ok(&format!("record {} --policy run:one --seed 41 -o one.episode", TASKS[1]));
    let replayed = folder.ok("replay one.episode --json");
    assert!(replayed.contains(&alone[0]["return"].to_string()), "{replayed}");
    let (_, said) = folder.both("record one --seed 1 -o first.episode");
    assert!(said.contains("several tasks") && said.contains(TASKS[0]), "{said}");

    // A file of the agent, whose weights are rounded, plays all of the tasks too.
    folder.ok("export-agent one -o one.agent");
    let filed = rows(&folder.ok("eval one.agent --episodes 3 --seed 40 --json"));
    let played: Vec<&str> = filed.iter().filter_map(|row| row["env"].as_str()).collect();
    assert_eq!(played, TASKS);

    // The report has a row for each task.
    folder.ok("report one -o report");
    let tables = std::fs::read_to_string(folder.0.join("report/report.md")).unwrap();
    for task in ["Remedy Rush", "Volcanic Venture", "RemedyRushLevel1 + VolcanicVentureLevel1"] {
        assert!(tables.contains(task), "{task}:\n{tables}");
    }
}

#[test]
fn a_run_of_several_tasks_goes_on_where_it_stopped() {
    let folder = Folder::new("mixed_resume");
    let tasks = "RemedyRushLevel1,CollateralDamageLevel1";
    let begin = format!("train {tasks} --envs 4 --threads 1 --eval-every 0 {SMALL}");
    folder.ok(&format!("{begin} --out straight"));
    folder.ok(&format!("{begin} --out halves")
        .replace("--frames 7680", "--frames 3840 --set learning.schedule_frames=7680"));
    folder.ok(&format!("train {tasks} --resume --frames 7680 --out halves"));
    let (straight, halves) = (story(&folder, "straight"), story(&folder, "halves"));
    let loss = |rows: &[Value]| -> Vec<(Value, Value)> {
        rows.iter().map(|row| (row["frames"].clone(), row["policy_loss"].clone())).collect()
    };
    assert!(straight.len() > 4 && straight[0]["policy_loss"].is_number());
    assert_eq!(loss(&straight), loss(&halves));
}

#[test]
fn what_several_tasks_cannot_have_is_refused() {
    let folder = Folder::new("mixed_refused");
    let tasks = "train RemedyRushLevel1,VolcanicVentureLevel1 --out no";
    for (flags, words) in [
        ("--preset released", "episode-mean"),
        ("--envs 1 --set learning.minibatches=1", "at least 2"),
        ("--curriculum 1,2", "curriculum"),
        ("--safety-budget RemedyRushLevel2-v0=3", "RemedyRushLevel2-v0"),
        ("--safety-budget RemedyRushLevel1-v0=3", "--safety-budget VolcanicVentureLevel1-v0=COST"),
        (
            "--algo PPOSaute --safety-budget RemedyRushLevel1-v0=3 --safety-budget VolcanicVentureLevel1-v0=3",
            "PPOSaute",
        ),
    ] {
        let line = folder.refused(&format!("{tasks} {flags} {SMALL}"));
        assert!(line.contains(words), "{flags}: {line}");
        assert!(!folder.0.join("no").exists(), "{flags}");
    }
    let line = folder.refused("train RemedyRushLevel1,NoSuchTask --out no");
    assert!(line.contains("NoSuchTask") || line.contains("nearest"), "{line}");
}
