//! The program as its user meets it: what commands write, and what they say of bad input.
//!
//! Long because each command is met once, with its bad inputs.

mod folder;

use folder::Folder;
use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// A map of ours, written and given back by name, is the built-in one; recordings distinguish the
/// two.
#[test]
fn a_map_from_a_file_is_played_and_remembered() {
    let folder = Folder::new("maps");
    folder.ok("export-wad RemedyRushLevel1-v0 -o town.wad");
    let rollout = "rollout RemedyRushLevel1-v0 --episodes 1 --json";
    let of_file = folder.ok(&format!("{rollout} --maps town.wad"));
    assert!(of_file.contains("\"maps\":true,"), "{of_file}");
    assert_eq!(of_file.replace("\"maps\":true,", ""), folder.ok(rollout));
    folder.ok("record RemedyRushLevel1-v0 -o files.episode --steps 5 --maps town.wad");
    folder.ok("record RemedyRushLevel1-v0 -o built_in.episode --steps 5");
    folder.ok("replay files.episode --maps town.wad");
    folder.ok("replay built_in.episode");
    assert!(folder.refused("replay files.episode").contains("--maps"));
    assert!(folder.refused("replay built_in.episode --maps town.wad").contains("leave --maps out"));
    folder.ok(
        "train RemedyRushLevel1-v0 --preset quick --frames 300 --envs 2 --maps town.wad --out run",
    );
    assert!(String::from_utf8(folder.read("run/config.json")).unwrap().contains("town.wad"));
    folder.ok("eval run --episodes 1");
    std::fs::remove_file(folder.0.join("town.wad")).unwrap();
    assert!(folder.refused("eval run --episodes 1").contains("town.wad"));
}

#[test]
fn bad_input_is_one_line_that_names_it_and_the_remedy() {
    let folder = Folder::new("bad");
    folder.file("empty", b"");
    folder.file("empty.toml", b"");
    folder.file("binary.episode", &[0, 159, 146, 150, 255, 3]);
    folder.file("binary.agent", &[0, 159, 146, 150, 255, 3]);
    folder.file("cut.wad", b"IWAD\x05\0\0\0\x0c\0\0\0");
    folder.file("text.wad", b"hello");
    folder.file("a.csv", b"action\nMOVE_FORWARD\n");
    std::fs::create_dir(folder.0.join("folder")).unwrap();
    for (line, words) in [
        (
            "render VolcanicVenturLevel1-v0",
            &["VolcanicVenturLevel1-v0", "VolcanicVentureLevel1-v0"][..],
        ),
        ("play RemedyRushLevel1-v0", &["no window", "display"]),
        ("play Nowhere-v0", &["Nowhere-v0"]),
        ("play RemedyRushLevel1-v0 --player", &["--player"]),
        ("render RemedyRushLevel1-v0 -o folder", &["folder", "name a file"]),
        ("render RemedyRushLevel1-v0 -o /dev/null/a.png", &["/dev/null"]),
        ("render RemedyRushLevel1-v0 -o /proc/a.png", &["/proc/a.png"]),
        ("render RemedyRushLevel1-v0 --size 9x9", &["9x9", "160x120"]),
        ("render RemedyRushLevel1-v0 --step 99999", &["--step 99999", "ends at step"]),
        ("render RemedyRushLevel1-v0 --policy fly", &["fly", "random"]),
        ("render RemedyRushLevel1-v0 --policy run:folder", &["folder"]),
        ("rollout RemedyRushLevel1-v0 --policy none.agent", &["none.agent", "export-agent"]),
        ("eval zoo:RemedyRushLevel1 --env RemedyRushLevel2", &["--env", "rollout ENV --policy"]),
        ("render RemedyRushLevel1-v0 --buffer heat", &["heat", "automap"]),
        ("render RemedyRushLevel1-v0 --iwad text.wad", &["text.wad"]),
        ("render RemedyRushLevel1-v0 --iwad cut.wad", &["cut.wad"]),
        ("render RemedyRushLevel1-v0 --iwad empty", &["empty"]),
        ("render RemedyRushLevel1-v0 --iwad folder", &["folder", "is a folder"]),
        ("render RemedyRushLevel1-v0 --iwad none.wad", &["none.wad"]),
        ("render RemedyRushLevel1-v0 --maps text.wad", &["text.wad", "not a WAD"]),
        ("rollout RemedyRushLevel1-v0 --maps folder", &["folder", "remedy_rush/level_1.wad"]),
        ("bench RemedyRushLevel1-v0 --maps none", &["none", "remedy_rush/level_1.wad"]),
        ("rollout RemedyRushLevel1-v0 --maps folder --iwad none.wad", &["folder"]),
        ("bench RemedyRushLevel1-v0 --learn --set learning.rate=fast", &["learning.rate=fast"]),
        ("bench RemedyRushLevel1-v0 --set learning.rate=1", &["--learn"]),
        (
            "bench RemedyRushLevel1-v0 --envs 65536 --size 1920x1080 --frame-stack 16",
            &["65536", "memory"],
        ),
        ("train RemedyRushLevel1-v0 --maps text.wad --out new", &["text.wad"]),
        ("record RemedyRushLevel1-v0 -o a.avi", &["a.avi", ".mp4, .gif, .episode"]),
        ("record RemedyRushLevel1-v0 -o a", &["--out a", ".mp4"]),
        ("record RemedyRushLevel1-v0 -o a.episode --policy hold:CROUCH", &["--full-actions"]),
        ("record RemedyRushLevel1-v0 -o a.episode --size 64x48", &["--size: an .episode", ".mp4"]),
        ("record RemedyRushLevel1-v0 -o a.episode --beside depth", &["--beside", "leave it out"]),
        ("record RemedyRushLevel1-v0 -o a.episode --quality 5", &["--quality", "leave it out"]),
        ("record RemedyRushLevel1-v0 -o a.episode --published-depth", &["--published-depth"]),
        (
            "record RemedyRushLevel1-v0 --size 1600x100 --beside depth -o a.gif",
            &["a film cannot be 3212x", "3072"],
        ),
        ("record folder -o a.mp4", &["folder", "config.json"]),
        ("record binary.episode -o a.mp4", &["binary.episode"]),
        ("record empty -o a.mp4", &["empty"]),
        ("replay folder", &["folder", "is a folder"]),
        ("replay empty", &["empty"]),
        ("replay binary.episode", &["binary.episode"]),
        ("replay none.episode", &["none.episode"]),
        ("replay none.episode --beside depth", &["--beside", "give an --out"]),
        ("replay none.episode -o a.png --quality 80", &["--quality", "leave it out"]),
        ("rollout RemedyRushLevel1-v0 --episodes 0", &["--episodes"]),
        ("rollout RemedyRushLevel1-v0 --seed -1", &["'-1'", "--seed", "a whole number, 0 or more"]),
        ("train RemedyRushLevel1-v0 --frames -5 --out new", &["-5", "--frames"]),
        ("trace RemedyRushLevel1-v0 --actions empty", &["empty", "action"]),
        ("trace RemedyRushLevel1-v0 --actions folder", &["folder"]),
        ("trace RemedyRushLevel1-v0", &["--actions"]),
        ("trace RemedyRushLevel1-v0 --actions empty --frame-skip 8", &["--frame-skip 8", "leave"]),
        ("trace RemedyRushLevel1-v0 --actions empty --size 64x48", &["--size 64x48", "leave"]),
        (
            "trace RemedyRushLevel1-v0 --actions a.csv --start=30000,0,0,0",
            &["off the map", "X from"],
        ),
        // In a pillar.
        ("trace RemedyRushLevel1-v0 --actions a.csv --start=0,0,0,0", &["is in rock", "Y from"]),
        (
            "trace RemedyRushLevel1-v0 --actions a.csv --start=320,320,2000,0",
            &["Z is in rock", "160"],
        ),
        ("trace RemedyRushLevel1-v0 --actions a.csv --start=320,320,-50,0", &["Z is in rock"]),
        ("eval none", &["none"]),
        ("eval zoo:nobody", &["zoo:nobody", "zoo"]),
        (
            "eval zoo:RemedyRushLevel1 --seed 18446744073709551615 --episodes 2",
            &["--seed 18446744073709551615", "give 18446744073709551614 or less"],
        ),
        ("highlights --seed 18446744073709551615 --episodes 3", &["give 18446744073709551613 or"]),
        ("eval zoo:RemedyRushLevel1 --episodes 500 --worst 1 -o /proc/x/w.mp4", &["/proc/x"]),
        ("export-agent none", &["none"]),
        ("record binary.agent -o a.mp4", &["binary.agent", "export-agent"]),
        ("eval empty", &["empty"]),
        ("report none", &["none"]),
        ("report empty", &["empty"]),
        ("sweep none.toml", &["none.toml"]),
        ("sweep mian", &["mian", "safety-bounds"]),
        ("sweep empty.toml", &["empty.toml", "`scenarios`"]),
        ("sweep quick --option help --dry-run", &["--help", "leave them out"]),
        ("sweep quick --frames 256 --out /proc/x", &["/proc/x: cannot be made", "--out DIR"]),
        ("rollout RemedyRushLevel1-v0 --policy run:", &["an empty name", "zoo:NAME"]),
        ("verify none", &["none", "hasard claim"]),
        ("scoreboard none", &["none", "hasard claim"]),
        ("check task.toml#2", &["task.toml#2", "--level 2"]),
        ("check task.toml --level 0", &["'0'", "--level"]),
        ("serve --listen localhost", &["localhost", "127.0.0.1:8350"]),
        ("train RemedyRushLevel1-v0 --curriculum 1,2,9", &["1,2,9", "1,2,3"]),
        ("train RemedyRushLevel1-v0 --algo PPOX", &["PPOX", "PPOLag"]),
        ("train RemedyRushLevel1-v0 --out empty", &["empty"]),
        ("train RemedyRushLevel1-v0 --set a.b=3", &["a.b"]),
        ("train RemedyRushLevel1-v0 --set env.hard=true", &["env.hard", "--hard"]),
        ("train RemedyRushLevel1-v0 --set preset=quick", &["preset", "--preset"]),
        (
            "train RemedyRushLevel1-v0 --algo PPOSaute --safety-budget 3 --safety-budget 4",
            &["constraints", "PPOSaute"],
        ),
        ("train RemedyRushLevel1-v0 --safety-budget rain=3 --out new", &["rain", "harmful_items"]),
        ("train RemedyRushLevel1-v0 --device tpu --out new", &["tpu", "cpu"]),
        (
            "train RemedyRushLevel1-v0 --device cpu:1 --out new",
            &["cpu:1", "no number", "write cpu"],
        ),
        ("train RemedyRushLevel1-v0 --device cpu: --out new", &["cpu:", "write cpu"]),
        ("rollout VolcanicVentureLevel1 seed 5", &["'seed'", "did you mean --seed?"]),
        ("site nosuch.mp4 -o st", &["nosuch.mp4", "hasard record"]),
        ("train RemedyRushLevel1-v0 --iwad none.wad --out new", &["none.wad"]),
        ("export-wad RemedyRushLevel1-v0 -o folder", &["folder"]),
        ("fly", &["fly"]),
    ] {
        let error = folder.refused(line);
        for word in words {
            assert!(error.contains(word), "{line}: '{word}' is missing in: {error}");
        }
    }
    let left: Vec<_> =
        std::fs::read_dir(&folder.0).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left.len(), 8, "a refused command left something behind: {left:?}");
}

#[test]
fn an_episode_is_recorded_replayed_and_drawn() {
    let folder = Folder::new("episode");
    let recorded: Value = serde_json::from_str(
        &folder.ok("record CollateralDamageLevel1-v0 --policy sticky:5 --seed 3 --rules released --steps 40 -o a.episode --json"),
    )
    .unwrap();
    assert_eq!((&recorded["length"], &recorded["seed"]), (&Value::from(40), &Value::from(3)));
    let again: Value = serde_json::from_str(&folder.ok("replay a.episode --json")).unwrap();
    for key in ["env", "seed", "return", "cost", "length", "terminated", "truncated"] {
        assert_eq!(recorded[key], again[key], "{key}");
    }
    folder.ok("record a.episode --size 64x48 --steps 10 -o a.mp4 --beside depth,automap");
    folder.ok("replay a.episode --size 64x48 --frame-every 20 -o a.gif");
    assert_eq!(
        (&folder.read("a.mp4")[4..8], &folder.read("a.gif")[..3]),
        (&b"ftyp"[..], &b"GIF"[..])
    );
    // The picture of a replay is that of the episode itself.
    folder.ok("replay a.episode --size 160x120 --step 17 -o replayed.png");
    folder
        .ok("render CollateralDamageLevel1-v0 --policy sticky:5 --seed 3 --rules released --step 17 --size 160x120 -o live.png");
    assert_eq!(folder.read("replayed.png"), folder.read("live.png"));
    // A file that says otherwise is a negative result, not an error.
    let path = folder.0.join("a.episode");
    let mut file = hasard_media::episode::EpisodeFile::read(&path).unwrap();
    let mut outcome = file.header().outcome.clone().unwrap();
    outcome.cost += 1.0;
    file.set_outcome(outcome);
    file.write(&path).unwrap();
    for line in [
        "replay a.episode",
        "replay a.episode -o end.png",
        "record a.episode --size 64x48 -o b.gif",
    ] {
        assert_eq!(folder.run(line).status.code(), Some(1), "{line}");
    }
    // A part of it is no other end.
    folder.ok("record a.episode --size 64x48 --steps 3 -o b.gif");
    folder.ok("replay a.episode --step 3 -o part.png");
}

#[test]
fn every_view_is_drawn() {
    let folder = Folder::new("views");
    let mut sizes = Vec::new();
    for view in ["rgb", "depth", "segmented", "labels", "grey", "automap"] {
        let line = format!(
            "render DetonatorsDilemmaLevel1-v0 --step 5 --size 160x120 --buffer {view} -o {view}.png --json"
        );
        let report: Value = serde_json::from_str(&folder.ok(&line)).unwrap();
        let labels = report["labels"].as_array().map(Vec::len);
        assert_eq!(labels.is_some(), view == "labels" || view == "segmented", "{report}");
        let picture = hasard_media::png::read(&folder.0.join(format!("{view}.png"))).unwrap();
        assert_eq!((picture.width(), picture.height()), (160, 120));
        let grey =
            picture.rgb().chunks_exact(3).all(|pixel| pixel[0] == pixel[1] && pixel[1] == pixel[2]);
        assert_eq!(grey, ["depth", "labels", "grey"].contains(&view), "{view}");
        assert!(
            picture.rgb().iter().any(|byte| *byte != picture.rgb()[0]),
            "{view} is of one colour"
        );
        sizes.push(picture);
    }
    folder.ok("render DetonatorsDilemmaLevel1-v0 --step 5 --size 160x120 --buffer segmented --published-colours -o p.png");
    assert_ne!(hasard_media::png::read(&folder.0.join("p.png")).unwrap(), sizes[2]);
}

/// The smallest network and a single rollout for each lesson: a run's directory with its automaps,
/// its agent on film, and a report with its heatmaps.
#[test]
fn a_curriculum_leaves_automaps_an_agent_and_a_report() {
    let folder = Folder::new("curriculum");
    let small = "--envs 4 --threads 1 --set network.dense=[32] --set network.recurrent=32 --set sampling.rollout=8 \
                 --set reporting.report_seconds=0 --set episode_steps=8 --observation grey --size 64x48";
    let line = format!(
        "train RemedyRushLevel1-v0 --algo PPOPID --curriculum 1:300,3:300 --out run --json {small}"
    );
    let rows = folder.ok(&line);
    let levels: Vec<Value> = rows
        .lines()
        .map(|row| serde_json::from_str::<Value>(row).unwrap()["level"].clone())
        .collect();
    assert_eq!(
        (levels.first(), levels.last()),
        (Some(&Value::from(1)), Some(&Value::from(3))),
        "{rows}"
    );
    assert!(
        folder.0.join("run/automap-level1.png").is_file()
            && folder.0.join("run/automap-level3.png").is_file()
    );
    let config: Value = serde_json::from_slice(&folder.read("run/config.json")).unwrap();
    assert_eq!(config["env"]["id"], "RemedyRushLevel3-v0");
    // Asked again with another level it is the same run, and at its end.
    folder.ok(&format!("train RemedyRushLevel2-v0 --resume --out run --json {small}"));
    folder.ok("record run --size 64x48 --steps 3 -o agent.gif");
    folder.ok("record RemedyRushLevel2-v0 --policy run:run --steps 3 -o agent.episode");
    folder.ok("replay agent.episode");
    let refusal = folder.refused("record run --hard -o agent.gif");
    assert!(refusal.contains("--policy run:run"), "{refusal}");
    let refusal = folder.refused("train VolcanicVentureLevel3-v0 --resume --out run");
    assert!(refusal.contains("RemedyRushLevel3-v0"), "{refusal}");
    folder.ok("report run agent.episode -o report");
    assert!(Path::new(&folder.0.join("report/index.html")).is_file());
}

/// The tails of what episodes cost, the worst of them filmed, and whether the critic of the cost
/// expected it.
#[test]
fn an_evaluation_shows_the_tails() {
    let folder = Folder::new("tails");
    let small = "--algo PPOLag --preset quick --envs 2 --threads 1 --set network.dense=[32] --set network.recurrent=32 \
                 --observation grey --size 64x48 --frames 600 --quiet";
    folder.ok(&format!("train RemedyRushLevel1-v0 --safety-budget 3 --out run {small}"));
    let output =
        folder.ok("eval run --episodes 11 --json --worst 2 -o worst.gif --calibration table.csv");
    let lines: Vec<Value> =
        output.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let mut costs: Vec<f64> =
        lines[..11].iter().map(|line| line["cost"].as_f64().unwrap()).collect();
    let summary = &lines[11]["summary"];
    // The worst tenth of eleven episodes is the worst, and a tenth of the next.
    let filmed = summary["filmed"]["seeds"].as_array().unwrap();
    let of_seed = |seed: &Value| {
        lines.iter().find(|line| line["seed"] == *seed).unwrap()["cost"].as_f64().unwrap()
    };
    costs.sort_by(|a, b| b.total_cmp(a));
    assert_eq!(filmed.iter().map(of_seed).collect::<Vec<_>>(), costs[..2]);
    let tails = &summary["constraints"][0]["tails"];
    assert_eq!(
        (tails["worst"].as_f64(), tails["median"].as_f64()),
        (Some(costs[0]), Some(costs[5]))
    );
    assert!(
        (tails["cvar10"].as_f64().unwrap() - (costs[0] + 0.1 * costs[1]) / 1.1).abs() < 1e-9,
        "{tails}"
    );
    let over = costs.iter().filter(|cost| **cost > 3.0).count() as f64 / 11.0;
    assert!((tails["over_budget"].as_f64().unwrap() - over).abs() < 1e-9, "{tails}");
    // Every statistic of the scenario has its mean.
    let names = |value: &Value| value.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&summary["stats"]), names(&lines[0]["stats"]));
    assert!(folder.read("worst.gif").len() > 10_000);
    let table = String::from_utf8(folder.read("table.csv")).unwrap();
    let steps: u64 = lines[..11].iter().map(|line| line["length"].as_u64().unwrap()).sum();
    assert_eq!(table.lines().count() as u64, steps + 1);
    let bins = summary["calibration"][0]["bins"].as_array().unwrap();
    assert!(
        bins.len() == 10 && summary["calibration"][0]["steps"].as_u64().unwrap() > 500,
        "{summary}"
    );
    // An agent's file knows what returns were like too.
    folder.ok("export-agent run --latest -o run.agent");
    let of_file = folder.ok("eval run.agent --episodes 2 --json --calibration file.csv");
    let summary: Value = serde_json::from_str(of_file.lines().last().unwrap()).unwrap();
    assert_eq!(summary["summary"]["calibration"][0]["bins"].as_array().unwrap().len(), 10);
    let plain = folder.ok("eval run --episodes 3");
    assert!(
        plain.contains("mean of the worst tenth")
            && plain.contains("over the budget of 3")
            && plain.contains("goggles"),
        "{plain}"
    );
    folder.ok(&format!("train RemedyRushLevel1-v0 --out plain {}", small.replace("PPOLag", "PPO")));
    assert!(folder.refused("eval plain --calibration table.csv").contains("critics of costs"));
    assert!(folder.refused("eval run --worst 1 -o worst.avi").contains(".mp4"));
    let many = folder.refused("eval run --episodes 2 --worst 3");
    assert!(many.contains("--worst 3") && many.contains("--episodes 2"), "{many}");
}

/// Under other rules than a run's own its default budget is theirs; one that was asked for stays.
#[test]
fn an_agent_is_evaluated_under_other_rules() {
    let folder = Folder::new("other_rules");
    let small = "--algo PPOLag --envs 2 --threads 1 --set network.dense=[32] --set network.recurrent=32 --set sampling.rollout=8 \
                 --set episode_steps=8 --observation grey --size 64x48 --frames 64 --quiet";
    for (own, asked, budget) in [("usual", "", 5.0), ("asked", "--safety-budget 7", 7.0)] {
        folder.ok(&format!("train ArmamentBurdenLevel1-v0 --out {own} {asked} {small}"));
        let output =
            folder.ok(&format!("eval {own} --latest --episodes 1 --rules released --json"));
        let lines: Vec<Value> =
            output.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        // There every step costs that ends with USE held.
        assert!(lines[0]["costs"]["discard"].as_f64().unwrap() > 0.0, "{output}");
        assert_eq!(lines[1]["summary"]["constraints"][0]["budget"], budget, "{output}");
    }
    // In Remedy Rush SPEED and JUMP change places; the agent presses what it was trained to press,
    // as in a rollout.
    folder.ok(&format!("train RemedyRushLevel1-v0 --out rush {small}"));
    let evaluated = folder.ok("eval rush --episodes 1 --seed 5 --rules tables --json");
    let rolled = folder.ok(
        "rollout RemedyRushLevel1-v0 --policy run:rush --episodes 1 --seed 5 --rules tables --json",
    );
    let first = |text: &str| serde_json::from_str::<Value>(text.lines().next().unwrap()).unwrap();
    let (evaluated, rolled) = (first(&evaluated), first(&rolled));
    for what in ["return", "cost", "length", "stats"] {
        assert_eq!(evaluated[what], rolled[what], "{what}");
    }
    let output = folder.ok("eval usual --latest --episodes 1 --json");
    assert!(output.contains("\"budget\":50.0") && output.contains("\"discard\":0.0"), "{output}");
}

/// A1: a budget on a term that the scalar cost does not count binds, is reported, and is judged by
/// what was measured.
#[test]
fn a_budget_on_an_uncounted_term_binds_and_is_judged() {
    let folder = Folder::new("uncounted");
    let small = "--preset quick --algo PPOLag --envs 4 --threads 1 --set network.dense=[32] --set network.recurrent=32 \
                 --observation grey --size 64x48 --frames 12000 --json";
    for (id, budget, term, most) in [
        ("VolcanicVentureLevel1-v0", "jumps=2", "jumps", 2.0),
        // An agent that has learned nothing comes by the zone now and then.
        ("ArmamentBurdenLevel1-v0", "zone_visits=0.01", "zone_visits", 0.01),
    ] {
        let output =
            folder.ok(&format!("train {id} --safety-budget {budget} --out {term} {small}"));
        let last: Value = serde_json::from_str(output.lines().last().unwrap()).unwrap();
        let measured = last["constraint_costs"][0].as_f64().unwrap();
        assert!(measured > most, "{last}");
        assert_eq!(last[format!("cost/{term}")].as_f64().unwrap(), measured, "{last}");
        assert!(last["multiplier"].as_f64().unwrap() > 0.0, "{last}");
        let output = folder.ok(&format!("eval {term} --episodes 12 --json"));
        let lines: Vec<Value> =
            output.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        assert_eq!(lines[0]["uncounted"], serde_json::json!([term]), "{output}");
        let costs = lines.iter().filter_map(|line| line["costs"][term].as_f64());
        let (count, sum) = costs.fold((0.0, 0.0), |(count, sum), cost| (count + 1.0, sum + cost));
        let judged = &lines[12]["summary"]["constraints"][0];
        assert_eq!(judged["term"], term);
        assert!(
            (judged["cost_mean"].as_f64().unwrap() - sum / count).abs() < 1e-9
                && sum / count > most,
            "{output}"
        );
        assert_eq!(
            (&judged["within_budget"], &lines[12]["summary"]["within_budget"]),
            (&false.into(), &false.into()),
            "{output}"
        );
    }
    assert!(
        folder
            .refused("train RemedyRushLevel1-v0 --safety-budget jumps=2")
            .contains("harmful_items")
    );
    // In words the budget stands beside the term that it is of.
    let output = folder.run(&format!(
        "train VolcanicVentureLevel1-v0 --safety-budget jumps=2 --out words {}",
        small.replace("--json", "")
    ));
    let words = String::from_utf8(output.stderr).unwrap();
    assert!(words.contains("budget of an episode: jumps 2, device"), "{words}");
    assert!(
        words.lines().any(|line| line.contains(", jumps ") && line.contains(" of 2, multiplier")),
        "{words}"
    );
}

/// A small run from its evaluations to its agent in a file: what is selected, judged by each
/// constraint's own budget.
#[test]
fn a_run_selects_an_agent_that_fits_in_a_file() {
    let folder = Folder::new("selection");
    let small = "--envs 4 --threads 1 --set network.dense=[32] --set network.recurrent=32 --set sampling.rollout=8 \
                 --set episode_steps=8 --observation grey --size 64x48 --set evaluation.episodes=2 \
                 --set evaluation.confirming_episodes=3 --eval-every 128";
    let budgets = "--safety-budget 1000 --safety-budget harmful_items=2000";
    let output = folder.ok(&format!(
        "train RemedyRushLevel1-v0 --algo ppolag --frames 256 --json {budgets} {small}"
    ));
    // The directory has the algorithm's own name, and the run says what it selects.
    assert!(folder.0.join("runs/RemedyRushLevel1-v0-PPOLag-seed1/selected.json").is_file());
    let last: Value = serde_json::from_str(output.lines().last().unwrap()).unwrap();
    let closing = &last["selection"]["closing"];
    assert_eq!(
        (&closing["episodes"], &closing["constraints"][1]["budget"]),
        (&Value::from(3), &Value::from(2000.0)),
        "{output}"
    );
    assert_eq!(
        output.lines().filter(|line| line.contains("eval/cost/harmful_items")).count(),
        2,
        "{output}"
    );
    let run = "runs/RemedyRushLevel1-v0-PPOLag-seed1";
    let summary = |line: &str| -> Value {
        let output = folder.ok(line);
        serde_json::from_str::<Value>(output.lines().last().unwrap()).unwrap()["summary"].clone()
    };
    let judged = summary(&format!("eval {run} --episodes 2 --json"));
    assert_eq!(judged["constraints"][1]["term"], "harmful_items", "{judged}");
    assert_eq!(judged["within_budget"], true, "{judged}");
    // Four or eight bits a weight: the file acts, and is small.
    std::fs::create_dir(folder.0.join("zoo")).unwrap();
    folder.ok(&format!("export-agent {run} -o zoo/Small.agent"));
    let weights = std::fs::read_dir(folder.0.join(run).join("checkpoints"))
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let weights = weights
        .map(|path| std::fs::metadata(path.join("weights.safetensors")).unwrap().len())
        .max()
        .unwrap();
    let file = std::fs::metadata(folder.0.join("zoo/Small.agent")).unwrap().len();
    assert!(file < weights / 3, "{file} bytes of {weights}");
    assert_eq!(summary("eval zoo:small --episodes 2 --json")["episodes"], 2);
    assert!(folder.refused("eval zoo:large").contains("zoo:Small"));
    folder.ok("record zoo:Small --size 64x48 --steps 3 -o agent.gif");
    folder.ok("record RemedyRushLevel2-v0 --policy zoo:Small --steps 3 -o agent.episode");
    folder.ok("rollout RemedyRushLevel1-v0 --policy run:zoo/Small.agent --episodes 1");
    // It goes on with another seed and learning rate, and for longer: kept in the run.
    folder.ok(&format!("train RemedyRushLevel1-v0 --resume --out {run} --frames 512 --seed 9 --set learning.rate=1e-5 --quiet"));
    let config: Value =
        serde_json::from_slice(&folder.read(&format!("{run}/config.json"))).unwrap();
    assert_eq!((&config["frames"], &config["seed"]), (&Value::from(512), &Value::from(9)));
    // A learning rate of its own is a constant one: its end changes too.
    assert_eq!(config["changes"].as_array().unwrap().len(), 4, "{config}");
}

#[test]
fn a_measurement_of_beginnings_alone_says_so() {
    let folder = Folder::new("bench");
    let stderr = |line: &str| String::from_utf8(folder.run(line).stderr).unwrap();
    let short = stderr("bench ArmamentBurdenLevel1-v0 --envs 256 --seconds 0.02");
    assert!(short.lines().count() == 1 && short.contains("--seconds "), "{short}");
    let episode: f64 =
        short.split("--seconds ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!(episode >= 1.0, "{short}");
    assert_eq!(stderr("bench ArmamentBurdenLevel1-v0 --envs 1 --seconds 2"), "");
}

/// Row 15 of first contact: the program has its agents wherever it is, with no clone beside it.
#[test]
fn agents_of_the_zoo_are_part_of_the_program() {
    let folder = Folder::new("zoo");
    let program = folder.0.join("alone");
    // By another process: a child of another test's thread could hold open what this one writes,
    // and then nothing may run it.
    let copied = Command::new("cp").arg(env!("CARGO_BIN_EXE_hasard")).arg(&program).status();
    assert!(copied.unwrap().success());
    let elsewhere = folder.0.join("elsewhere");
    std::fs::create_dir(&elsewhere).unwrap();
    let mut command = Command::new(&program);
    let words = ["eval", "zoo:remedyrushlevel1-v0", "--episodes", "1", "--json"];
    let output =
        command.args(words).current_dir(&elsewhere).env_remove("HASARD_ZOO").output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let row: Value =
        serde_json::from_slice(output.stdout.split(|byte| *byte == b'\n').next().unwrap()).unwrap();
    assert_eq!(
        (&row["env"], &row["length"]),
        (&Value::from("RemedyRushLevel1-v0"), &Value::from(525))
    );
    // A folder's agent of the same name comes first; a recorded episode says who played.
    folder.ok("record zoo:RemedyRushLevel1 --steps 3 -o agent.episode");
    let episode =
        hasard_media::episode::EpisodeFile::read(&folder.0.join("agent.episode")).unwrap();
    assert_eq!(episode.header().player, "zoo:RemedyRushLevel1");
    std::fs::create_dir(folder.0.join("zoo")).unwrap();
    folder.file("zoo/RemedyRushLevel1.agent", b"spoiled");
    assert!(folder.refused("eval zoo:RemedyRushLevel1").contains("zoo/RemedyRushLevel1.agent"));
}

/// Rows 26, 30, 33 and 34: a folder of runs lists them, a name that is nearly right is named, and
/// what is made or unlikely is said.
#[test]
fn people_are_met_half_way() {
    let folder = Folder::new("half-way");
    for run in ["runs/one", "runs/more/two"] {
        std::fs::create_dir_all(folder.0.join(run)).unwrap();
        folder.file(&format!("{run}/config.json"), b"{}");
    }
    for line in ["eval runs", "record runs -o a.mp4", "export-agent runs"] {
        let error = folder.refused(line);
        assert!(error.contains("runs/one") && error.contains("runs/more/two"), "{line}: {error}");
    }
    assert!(folder.refused("eval runs/onne").contains("did you mean runs/one?"));
    let nothing = folder.refused("record nothere");
    assert!(nothing.contains("nothere is neither an environment, a run nor a file"), "{nothing}");
    assert!(nothing.contains("`hasard envs`") && !nothing.contains("RemedyRush"), "{nothing}");
    let nearly = folder.refused("record RemdyRushLevel1");
    assert!(nearly.contains("did you mean RemedyRushLevel1-v0?"), "{nearly}");
    assert_eq!(
        folder.ok("render RemedyRushLevel1 --size 64x48 -o new/folder/a.png"),
        "new/folder/a.png: 64x48\nmade the folder new/folder\n"
    );
    assert_eq!(
        folder.ok("render RemedyRushLevel1 --size 64x48 -o new/folder/a.png"),
        "new/folder/a.png: 64x48\n"
    );
    let stderr = |line: &str| String::from_utf8(folder.run(line).stderr).unwrap();
    let warning =
        stderr("rollout RemedyRushLevel2 --policy zoo:VolcanicVentureLevel1 --episodes 1");
    assert!(
        warning.lines().count() == 1
            && warning
                .contains("was trained in VolcanicVentureLevel1-v0, not in RemedyRushLevel2-v0")
    );
    assert_eq!(stderr("rollout RemedyRushLevel2 --policy zoo:RemedyRushLevel1 --episodes 1"), "");
    let error = stderr("rollout RemedyRushLevel2 --policy zoo:ArmamentBurdenLevel1 --episodes 1");
    assert!(error.contains("there is no USE; play it in its own scenario"), "{error}");
    assert!(folder.ok("sweep quick --frames 1.5M --dry-run").contains("--frames 1500000"));
    assert!(folder.ok("sweep human --dry-run --json").starts_with("{\"advice\":\""));
    folder.ok("contact-sheet RemedyRush");
    assert!(folder.0.join("sheets/remedy_rush_sheet.png").is_file());
}
