use super::*;

#[test]
fn a_damaged_last_line_is_passed_over_and_named() {
    let whole = "{\"frames\":4096,\"return_mean\":1.5,\"multipliers\":[0.25],\"losses\":{\"value\":2}}\n\
                 {\"frames\":8192,\"return_mean\":null,\"cost_mean\":3}\n";
    let path = Path::new("runs/a/metrics.jsonl");
    let mut warnings = Vec::new();
    let rows = parse_metrics(&format!("{whole}{{\"frames\":12288,\"retu"), path, &mut warnings);
    assert_eq!(rows.len(), 2);
    assert_eq!(rows[0].get("multipliers.0"), Some(0.25));
    assert_eq!(rows[0].get("losses.value"), Some(2.0));
    assert_eq!((rows[1].get("return_mean"), rows[1].get("cost_mean")), (None, Some(3.0)));
    assert_eq!(warnings.len(), 1);
    let line = warnings[0].to_string();
    assert!(line.starts_with("runs/a/metrics.jsonl:3: is damaged or half-written"), "{line}");
    // Wherever the file is cut, no more than the last line is lost.
    for cut in 0..whole.len() {
        let mut warnings = Vec::new();
        let rows = parse_metrics(&whole[..cut], path, &mut warnings);
        let complete = whole[..cut].matches('\n').count();
        assert!(rows.len() >= complete && rows.len() <= complete + 1, "cut at {cut}");
        assert!(warnings.len() <= 1);
    }
}

#[test]
fn a_resumed_run_replaces_what_it_repeats() {
    let line =
        |frames: u32, value: u32| format!("{{\"frames\":{frames},\"return_mean\":{value}}}\n");
    let text = line(10, 1) + &line(20, 2) + &line(30, 3) + "null\n" + &line(20, 4) + &line(30, 5);
    let mut warnings = Vec::new();
    let rows = parse_metrics(&text, Path::new("m"), &mut warnings);
    let seen: Vec<_> =
        rows.iter().map(|row| (row.frames, row.get("return_mean").unwrap())).collect();
    assert_eq!(seen, [(10.0, 1.0), (20.0, 4.0), (30.0, 5.0)]);
    assert_eq!(warnings.len(), 2);
    assert_eq!((warnings[0].line, warnings[1].line), (4, 5));
}

#[test]
fn what_makes_an_experiment_is_everything_but_machine_and_seed() {
    let parse = |extra: &str| {
        Config::parse(&format!(
            "{{\"env\":\"RemedyRushLevel2-v0\",\"algo\":\"PPOLag\",\"seed\":3,\"frames\":2000000{extra}}}"
        ))
    };
    let plain = parse("").unwrap();
    assert_eq!(
        (plain.scenario.as_str(), plain.level, plain.safety_budget, plain.frames),
        ("RemedyRush", 2, 5.0, Some(2e6))
    );
    let usual =
        parse(",\"hard\":false,\"full_actions\":false,\"safety_budget\":5.0,\"threads\":2,\"device\":\"cpu\",\"curriculum\":[]")
            .unwrap();
    assert_eq!(usual.options, plain.options);
    let other =
        parse(",\"safety_budget\":2.5,\"learning\":{\"rate\":1e-4,\"threads\":2},\"curriculum\":[1,2,3],\"hard\":true").unwrap();
    assert_eq!(other.safety_budget, 2.5);
    assert!(other.hard());
    let options: Vec<_> =
        other.options.iter().map(|(key, value)| format!("{key}={value}")).collect();
    assert_eq!(
        options,
        ["curriculum=1,2,3", "hard=true", "learning.rate=0.0001", "safety_budget=2.5"]
    );
}

/// Runs from an agent were averaged with runs from nothing.
#[test]
fn what_a_run_began_with_makes_an_experiment() {
    let began = |place: &str| {
        let text = format!(
            "{{\"env\":\"RemedyRushLevel2-v0\",\"algo\":\"PPOLag\",\"seed\":3,\
             \"init_from\":{{\"place\":\"{place}\",\"sha256\":\"0123456789abcdef\"}}}}"
        );
        Config::parse(&text).unwrap().options["init_from"].clone()
    };
    assert_eq!(began("zoo:RemedyRushLevel1"), "zoo:RemedyRushLevel1 01234567");
    assert_eq!(began("runs/base/"), "base 01234567");
    // Each seed goes on from its own.
    assert_eq!(began("runs/base/seed3"), "runs/base/seed*");
    assert_eq!(began("runs/base/seed30"), "seed30 01234567");
}

#[test]
fn the_lessons_of_a_curriculum_are_listed_by_their_levels() {
    let parse = |lessons: &str| {
        let text = format!(
            "{{\"env\":\"RemedyRushLevel3-v0\",\"algo\":\"PPOPID\",\"seed\":1,\"curriculum\":{lessons}}}"
        );
        Config::parse(&text).map(|config| (config.options["curriculum"].clone(), config.level))
    };
    let equal = r#"[{"level":1,"frames":33},{"level":2,"frames":33},{"level":3,"frames":34}]"#;
    assert_eq!(parse(equal), Ok(("1,2,3".into(), 3)));
    assert_eq!(
        parse(r#"[{"level":1,"frames":50},{"level":2,"frames":20}]"#),
        Ok(("1:50,2:20".into(), 2))
    );
    assert!(parse(r#"[{"level":1}]"#).unwrap_err().contains("curriculum"));
}

#[test]
fn an_unusable_config_says_why() {
    for (text, part) in [
        ("", "is no JSON"),
        ("[1]", "not a JSON object"),
        ("{\"algo\":\"PPO\",\"seed\":1}", "lacks the key \"env\""),
        ("{\"env\":\"X\",\"algo\":\"PPO\",\"seed\":-1}", "seed -1"),
        (
            "{\"env\":\"X\",\"algo\":\"PPO\",\"seed\":1,\"safety_budget\":\"much\"}",
            "safety_budget much",
        ),
    ] {
        let problem = Config::parse(text).unwrap_err();
        assert!(problem.contains(part), "{text}: {problem}");
    }
}

#[test]
fn ids_are_taken_apart() {
    assert_eq!(scenario_and_level("ArmamentBurdenLevel3-v0"), ("ArmamentBurden".into(), 3));
    assert_eq!(
        scenario_and_level("VolcanicVentureLevel1Hard-v0"),
        ("VolcanicVentureHard".into(), 1)
    );
    assert_eq!(scenario_and_level("Other-v1"), ("Other".into(), 1));
}

#[test]
fn hostile_heatmaps_are_passed_over() {
    let good = "{\"frames\":1,\"episodes\":2,\"extent\":[0,0,2,1],\"columns\":2,\"rows\":1,\"steps\":[1,0]}";
    let bad = [
        "{\"frames\":2,\"episodes\":2,\"extent\":[0,0,2,1],\"columns\":2,\"rows\":1,\"steps\":[1]}",
        "{\"frames\":2,\"episodes\":2,\"extent\":[0,0,2,1],\"columns\":99999999999,\"rows\":1,\"steps\":[1]}",
        "{\"frames\":2,\"episodes\":2,\"extent\":[5,0,2,1],\"columns\":2,\"rows\":1,\"steps\":[1,0]}",
        "{\"frames\":2,\"episodes\":2,\"extent\":[0,0,2,1],\"columns\":2,\"rows\":1,\"steps\":[1,-4]}",
    ];
    let mut warnings = Vec::new();
    let maps = heatmap::parse_heatmaps(
        &format!("{good}\n{}\n", bad.join("\n")),
        Path::new("h"),
        &mut warnings,
    );
    assert_eq!((maps.len(), warnings.len()), (1, 4));
}

#[test]
fn the_trainers_own_layout_is_understood() {
    let text = r#"{"algorithm":"PPOCost","preset":"released","env":{"id":"ArmamentBurdenLevel2-v0","rules":"released","hard":false,
        "full_actions":true,"frame_skip":4,"size":[128,72],"observation":"rgb+depth","frame_stack":1},"seed":4,"frames":2000000,
        "device":"cpu","episode_steps":525,"constraints":[{"term":null,"budget":5.0},{"term":"zone","budget":2.5}],
        "network":{"convolutions":[{"channels":32}],"dense":[512],"recurrent":null},
        "sampling":{"lanes":32,"samplers":2,"world_threads":1},"learning":{"rate":1e-4,"threads":2},
        "algorithm_settings":{"penalty_scale":0.1},"reporting":{"window":100}}"#;
    let config = Config::parse(text).unwrap();
    assert_eq!(
        (config.env.as_str(), config.algo.as_str(), config.seed),
        ("ArmamentBurdenLevel2-v0", "PPOCost", 4)
    );
    assert_eq!((config.safety_budget, config.cost_scale, config.frames), (5.0, 0.1, Some(2e6)));
    let shown: Vec<String> = config
        .options
        .iter()
        .filter(|(key, _)| SHOWN.contains(&key.as_str()))
        .map(|(key, value)| format!("{key}={value}"))
        .collect();
    assert_eq!(
        shown,
        [
            "constraints=zone:2.5",
            "full_actions=true",
            "observation=rgb+depth",
            "preset=released",
            "rules=released"
        ]
    );
    let rest: Vec<&str> =
        config.options.keys().map(String::as_str).filter(|key| !SHOWN.contains(key)).collect();
    assert_eq!(
        rest,
        [
            "env.size",
            "episode_steps",
            "learning.rate",
            "network.convolutions",
            "network.dense",
            "sampling.lanes"
        ]
    );
}

/// What the file says is usual is not named among the options, so that the run stands in the
/// tables.
#[test]
fn a_task_of_ones_own_has_its_files_budget() {
    let text = hasard_envs::own::template("ReportGarden");
    let file = serde_json::json!({ "path": "garden.toml", "hash": "", "text": text });
    let parse = |env: serde_json::Value, constraints: serde_json::Value| {
        let config = serde_json::json!({ "algorithm": "PPOPID", "env": env, "seed": 1, "constraints": constraints });
        Config::parse(&config.to_string()).unwrap()
    };
    let alone = serde_json::json!({ "id": "ReportGarden-v0", "scenario_file": file });
    for (budget, named) in [(25.0, false), (50.0, true)] {
        let constraints = serde_json::json!([{ "term": null, "budget": budget }]);
        let config = parse(alone.clone(), constraints);
        assert_eq!(config.options.contains_key("safety_budget"), named, "{budget}");
        assert_eq!((config.safety_budget, config.task()), (budget, "garden.toml"));
    }
    let both = serde_json::json!({ "id": "RemedyRushLevel1-v0,ReportGarden-v0", "scenario_files": [file] });
    let constraints = serde_json::json!([
        { "term": "RemedyRushLevel1-v0", "budget": 5.0 }, { "term": "ReportGarden-v0", "budget": 25.0 },
    ]);
    let config = parse(both, constraints);
    assert!(!config.options.contains_key("constraints"), "{:?}", config.options);
    assert_eq!(config.own.file("ReportGarden"), Some("garden.toml"));
    let run = Run {
        path: "x".into(),
        config,
        rows: vec![],
        evaluation: vec![],
        summary: None,
        selected: None,
        calibration: vec![],
        heatmaps: vec![],
    };
    for task in run.by_task() {
        let named = task.config.options.get("safety_budget");
        assert_eq!(named, None, "{} has its own budget", task.config.env);
    }
}

/// The end of a run is its last fiftieth of frames, however many reports the clock put there.
#[test]
fn the_last_ten_points_are_cut_by_frames() {
    let run = |frames: &[f64]| {
        let text = "{\"env\":\"RemedyRushLevel1-v0\",\"algo\":\"PPO\",\"seed\":1}";
        let rows =
            frames.iter().map(|&at| Row::new(at, vec![("return_mean".into(), at / 1e4)])).collect();
        Run {
            path: "x".into(),
            config: Config::parse(text).unwrap(),
            rows,
            evaluation: vec![],
            summary: None,
            selected: None,
            calibration: vec![],
            heatmaps: vec![],
        }
    };
    // A curve that rises by 1 with every 10,000 frames: points at 500,000, 499,000, ... 491,000
    // frames.
    let seldom: Vec<f64> = (1..=10).map(|k| f64::from(k) * 5e4).collect();
    let often: Vec<f64> = (1..=500).map(|k| f64::from(k) * 1e3).collect();
    // A machine that grew fast near the end and reported a hundred times within the last thousand
    // frames.
    let uneven: Vec<f64> = seldom[..9]
        .iter()
        .copied()
        .chain((0..=100).map(|k| 499_000.0 + f64::from(k) * 10.0))
        .collect();
    for frames in [seldom, often, uneven] {
        let end = run(&frames).final_mean("return_mean").unwrap();
        assert!((end - 49.55).abs() < 1e-9, "{end} from {} reports", frames.len());
    }
    assert_eq!(run(&[7.0]).final_mean("return_mean"), Some(7e-4));
    assert_eq!(run(&[7.0]).final_mean("cost_mean"), None);
}

/// A2: what older versions called PPOLag with damping is PPOPID's rule, and is compared with
/// PPOPID.
#[test]
fn damped_multipliers_are_called_what_they_are() {
    for (algo, damping, expected) in [
        ("PPOLag", "1.5", "PPOPID"),
        ("TRPOLag", "1.5", "TRPOPID"),
        ("PPOLag", "0.0", "PPOLag"),
        ("CUP", "1.5", "CUP"),
    ] {
        let text = format!(
            "{{\"algorithm\":\"{algo}\",\"env\":{{\"id\":\"RemedyRushLevel1-v0\"}},\"seed\":1,\
             \"algorithm_settings\":{{\"multiplier_damping\":{damping}}}}}"
        );
        assert_eq!(Config::parse(&text).unwrap().algo, expected, "{algo} {damping}");
    }
}

/// A run of an older version lacks settings that a newer one writes down at their usual values:
/// the two are one experiment.
#[test]
fn settings_at_their_usual_values_distinguish_nothing() {
    let run = |more: &str| {
        let text = format!(
            r#"{{"env":{{"id":"RemedyRushLevel1-v0"}},"algorithm":"PPO","seed":1,"learning":{{"rate":0.1{more}}}}}"#
        );
        Config::parse(&text).unwrap()
    };
    let newer = r#","products":"float32","recompute_advantages":false,"value_phase_passes":6,
        "value_phase_clone":1.0,"auxiliary_depth":0.0,"auxiliary_labels":0.0"#;
    assert_eq!(run(""), run(newer));
    assert_ne!(run(""), run(r#","auxiliary_depth":0.5"#));
    assert_ne!(run(""), run(r#","products":"bfloat16""#));
}
