//! What is refused or has nothing to do leaves runs, claims and files of the user as they were.

mod folder;

use folder::Folder;

const SMALL: &str = "--algo PPOLag --envs 2 --threads 1 --set network.dense=[32] --set network.recurrent=32 --set sampling.rollout=8 \
                     --set episode_steps=8 --observation grey --size 64x48 --quiet --set evaluation.episodes=1 \
                     --set evaluation.confirming_episodes=2";

/// A folder with a finished run.
fn trained(name: &str) -> Folder {
    let folder = Folder::new(name);
    folder.ok(&format!(
        "train RemedyRushLevel1 {SMALL} --frames 128 --eval-every 64 --out run --seed 1"
    ));
    folder
}

fn text(folder: &Folder, file: &str) -> String {
    String::from_utf8(folder.read(file)).unwrap()
}

#[test]
fn a_run_that_cannot_begin_leaves_what_was_there() {
    let folder = Folder::new("withdrawn");
    std::fs::create_dir(folder.0.join("mine")).unwrap();
    folder.file("mine/lock", b"mine");
    folder.refused(&format!(
        "train RemedyRushLevel1 {SMALL} --frames 64 --out mine --init-from nowhere"
    ));
    assert_eq!(folder.read("mine/lock"), b"mine");
    // A folder that was made for the run goes with it.
    folder.refused(&format!(
        "train RemedyRushLevel1 {SMALL} --frames 64 --out new --init-from nowhere"
    ));
    assert!(!folder.0.join("new").exists());
}

#[test]
fn a_new_run_does_not_begin_among_the_rows_of_another() {
    let folder = trained("among_rows");
    std::fs::remove_file(folder.0.join("run/config.json")).unwrap();
    let rows = text(&folder, "run/metrics.jsonl");
    let said =
        folder.refused(&format!("train RemedyRushLevel1 {SMALL} --frames 64 --out run --seed 9"));
    assert!(said.contains("config.json") && said.contains("--out"), "{said}");
    assert_eq!(text(&folder, "run/metrics.jsonl"), rows);
}

/// Killed after its first evaluation, before its first checkpoint was due: it goes on from the
/// candidate that it kept, to the weights of a run that was never killed.
#[test]
fn a_run_goes_on_from_a_candidate() {
    let folder = Folder::new("from_candidate");
    folder.ok(&format!(
        "train RemedyRushLevel1 {SMALL} --frames 192 --eval-every 128 --out run --seed 1"
    ));
    let weights = || folder.read("run/checkpoints/frames_000000000192/weights.safetensors");
    let straight = weights();
    assert!(folder.0.join("run/checkpoints/best_000000000128").is_dir());
    std::fs::remove_dir_all(folder.0.join("run/checkpoints/frames_000000000192")).unwrap();
    std::fs::remove_file(folder.0.join("run/selected.json")).unwrap();
    folder.ok("train RemedyRushLevel1 --resume --frames 192 --quiet --out run");
    assert!(weights() == straight, "weights differ");
}

/// A pipe that nobody fills would be waited for for ever.
#[cfg(unix)]
#[test]
fn pipes_among_the_files_of_a_run_are_refused() {
    let folder = trained("run_pipes");
    let config = folder.0.join("run/config.json");
    std::fs::remove_file(&config).unwrap();
    let made = std::process::Command::new("mkfifo").arg(&config).status().unwrap();
    assert!(made.success());
    for line in [
        "eval run --episodes 1",
        "export-agent run -o a.agent",
        "claim run -o board",
        "train RemedyRushLevel1 --resume --out run --quiet",
    ] {
        let said = folder.refused(line);
        assert!(said.contains("config.json") && said.contains("pipe"), "{line}: {said}");
    }
}

#[test]
fn a_run_whose_checkpoints_are_gone_is_not_begun_again() {
    let folder = trained("checkpoints_gone");
    let rows = text(&folder, "run/metrics.jsonl");
    std::fs::remove_dir_all(folder.0.join("run/checkpoints")).unwrap();
    let said = folder.refused("train RemedyRushLevel1 --resume --out run --frames 256 --quiet");
    assert!(said.contains("checkpoints") && said.contains("gone"), "{said}");
    assert_eq!(text(&folder, "run/metrics.jsonl"), rows);
}

#[test]
fn a_finished_run_keeps_the_seed_that_it_was_trained_with() {
    let folder = trained("finished_seed");
    let config = text(&folder, "run/config.json");
    folder.ok("train RemedyRushLevel1 --resume --out run --seed 5 --quiet");
    assert_eq!(text(&folder, "run/config.json"), config);
}

#[test]
fn an_evaluation_says_that_the_selected_checkpoint_is_gone() {
    let folder = trained("selected_gone");
    for entry in std::fs::read_dir(folder.0.join("run/checkpoints")).unwrap().flatten() {
        if entry.file_name().to_string_lossy().starts_with("best_") {
            std::fs::remove_dir_all(entry.path()).unwrap();
        }
    }
    let (_, said) = folder.both("eval run --episodes 1");
    assert!(said.contains("selected is gone; the latest is played"), "{said}");
    folder.file("run/selected.json", b"{\"frames\":");
    let (_, said) = folder.both("eval run --episodes 1");
    assert!(said.contains("selected.json: damaged"), "{said}");
}

#[test]
fn a_refused_claim_leaves_the_earlier_one() {
    let folder = trained("claim_kept");
    folder.ok("claim run --episodes 2 -o board");
    folder.ok(&format!(
        "train RemedyRushLevel1 {SMALL} --frames 128 --eval-every 64 --out other --frame-skip 8"
    ));
    folder.refused("claim other --episodes 2 -o board");
    folder.ok("verify board");
    assert_eq!(
        std::fs::read_dir(folder.0.join("board")).unwrap().count(),
        2,
        "nothing half written"
    );
    let said = folder.refused("claim run --episodes 2 -o board --name 日本");
    assert!(said.contains("--name"), "{said}");
}

/// A sweep of a small run.
fn sweep(more: &str) -> String {
    format!(
        "scenarios = [\"RemedyRush\"]\nalgorithms = [\"PPO\"]\nframes = 64\nout = \"runs\"\n[options]\nenvs = 2\nthreads = 1\n\
         size = \"64x48\"\neval-every = 64\n[settings]\nsampling.rollout = 8\nnetwork.dense = [32]\nnetwork.recurrent = 32\n\
         evaluation.episodes = 1\nevaluation.confirming_episodes = 2\n{more}"
    )
}

/// A budget of 5 is Remedy Rush's own: under another name it was trained again.
#[test]
fn runs_of_equal_settings_are_made_once() {
    let folder = Folder::new("sweep_equal");
    folder.file("own.toml", sweep("").as_bytes());
    folder.ok("sweep own.toml");
    let of_budgets = |list: &str| {
        sweep("").replace("threads = 1\n", &format!("threads = 1\nsafety-budget = {list}\n"))
    };
    folder.file("budgets.toml", of_budgets("[5, 7]").as_bytes());
    let said = folder.ok("sweep budgets.toml");
    assert!(said.contains("1 finished, 1 had been finished before"), "{said}");
    folder.file("twice.toml", of_budgets("[9, \"9.0\"]").as_bytes());
    let (said, noted) = folder.both("sweep twice.toml");
    assert!(noted.contains("1 of 2 runs repeat others"), "{noted}");
    assert!(said.contains("1 finished, 0 had been finished before"), "{said}");
}

#[test]
fn a_sweep_does_not_take_a_run_of_other_settings_for_its_own() {
    let folder = Folder::new("sweep_settings");
    folder.file("s.toml", sweep("").as_bytes());
    folder.ok("sweep s.toml");
    let (said, noted) = folder.both("sweep s.toml");
    assert!(said.contains("0 finished, 1 had been finished before"), "{said}");
    assert!(!noted.contains("more frames"), "{noted}");
    // A longer run counts, and is named: its schedules were made for its own length.
    folder.file("s.toml", sweep("").replace("frames = 64", "frames = 32").as_bytes());
    let (said, noted) = folder.both("sweep s.toml");
    assert!(said.contains("0 finished, 1 had been finished before"), "{said}");
    assert!(noted.contains("1 of 1 runs were made for more frames"), "{noted}");
    folder.file("s.toml", sweep("learning.gamma = 0.5\n").as_bytes());
    let said = folder.refused("sweep s.toml");
    assert!(said.contains("learning.gamma = 0.97") && said.contains("asks for 0.5"), "{said}");
    folder.file("s.toml", sweep("seed = 3\n").as_bytes());
    assert!(folder.refused("sweep s.toml").contains("use seeds"));
    let grids = sweep("[[grid]]\nframes = 64\n[[grid]]\nframes = 128\n");
    folder.file("s.toml", grids.as_bytes());
    assert!(folder.refused("sweep s.toml").contains("128 frames"));
}

/// A sweep over a run that somebody trains for longer cut it short; one over a run that had been made
/// longer took it for any other.
#[test]
fn a_sweep_leaves_longer_runs_alone_and_knows_what_they_were_trained_with() {
    let folder = Folder::new("sweep_longer");
    folder.file("s.toml", sweep("").as_bytes());
    folder.ok("sweep s.toml");
    let path = "runs/RemedyRushLevel1-v0/PPO";
    let run = std::fs::read_dir(folder.0.join(path)).unwrap().next().unwrap().unwrap().path();
    let run = format!("{path}/{}/seed1", run.file_name().unwrap().to_string_lossy());
    folder.ok(&format!("train RemedyRushLevel1-v0 --resume --frames 128 --out {run} --quiet"));
    let mirrored = sweep("network.mirror = true\n").replace("frames = 64", "frames = 128");
    folder.file("m.toml", mirrored.as_bytes());
    let said = folder.refused("sweep m.toml");
    assert!(said.contains("network.mirror = false"), "{said}");
    // It is under way to 6,400 frames.
    let config = text(&folder, &format!("{run}/config.json"));
    let longer = config.replace("\"frames\": 128,", "\"frames\": 6400,");
    assert_ne!(longer, config);
    folder.file(&format!("{run}/config.json"), longer.as_bytes());
    folder.file("s.toml", sweep("").replace("frames = 64", "frames = 256").as_bytes());
    let said = folder.refused("sweep s.toml");
    assert!(said.contains("6400 frames that has not ended") && said.contains("--resume"), "{said}");
    assert_eq!(text(&folder, &format!("{run}/config.json")), longer, "nothing is changed");
}

/// `HASARD_SIMD` chooses what a run that begins multiplies in; one that goes on keeps to its own.
#[test]
fn a_resumed_run_keeps_its_products() {
    let folder = trained("products");
    let go_on = "train RemedyRushLevel1 --resume --frames 256 --out run --quiet";
    let output = folder.run_with(go_on, &[("HASARD_SIMD", "avx512bf16")]);
    if String::from_utf8_lossy(&output.stderr).contains("HASARD_SIMD") {
        return; // This processor lacks the family, and says so.
    }
    assert!(output.status.success(), "{output:?}");
    let config = text(&folder, "run/config.json");
    assert!(config.contains("\"products\": \"float32\""), "{config}");
    assert!(!config.contains("bfloat16"), "{config}");
}

/// A limit on the size of files ends no program: it is an error as on a full disk, and nothing is left.
#[cfg(unix)]
#[test]
fn a_file_above_the_limit_is_an_error_and_leaves_nothing() {
    let folder = Folder::new("limit");
    let output = std::process::Command::new("sh")
        .args(["-c", "ulimit -f 1; exec \"$0\" export-wad VolcanicVentureLevel1-v0 -o vv1.wad"])
        .arg(env!("CARGO_BIN_EXE_hasard"))
        .current_dir(&folder.0)
        .output()
        .unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    assert!(error.starts_with("hasard: ") && error.contains("vv1.wad"), "{error}");
    assert_eq!(error.lines().count(), 1, "{error}");
    assert_eq!(std::fs::read_dir(&folder.0).unwrap().count(), 0);
}

/// Such sweeps began, said that their runs failed, and that the same command would go on.
#[test]
fn a_sweep_that_cannot_work_does_not_begin() {
    let folder = Folder::new("sweep_cannot");
    folder.file("file", b"mine");
    let sweep = |lines: &str| {
        format!(
            "frames = 4096\nscenarios = [\"RemedyRush\"]\nlevels = [1]\nalgorithms = [\"PPO\"]\nseeds = [1]\n{lines}\n"
        )
    };
    folder.file("text.wad", b"hello");
    let long = format!("out = \"new\"\n[options]\nset = \"learning.rate=0.{}1\"", "0".repeat(300));
    for (lines, named) in [
        ("out = \"file/runs\"", "file: is a file"),
        (&long, "more than the 255 of a file system"),
        ("out = \"new\"\n[options]\ncurriculum = \"1:400,2:600\"", "--curriculum 1:400,2:600"),
        ("out = \"new\"\n[options]\nset = \"seed=3\"", "--set seed"),
        ("out = \"new\"\n[options]\ninit-from = \"nowhere\"", "nowhere"),
        ("out = \"new\"\n[options]\niwad = 5", "s.toml: `iwad` must be a path in quotes"),
        (
            "out = \"new\"\n[options]\niwad = [\"none.wad\"]",
            "none.wad: cannot read: No such file or directory (os error 2); name a file that is there",
        ),
        ("out = \"new\"\n[options]\niwad = \"text.wad\"", "not a WAD"),
        ("out = \"new\"\n[options]\nmaps = \"nowhere\"", "remedy_rush/level_1.wad"),
        ("out = \"new\"\n[options]\nmaps = \"text.wad\"", "not a WAD"),
    ] {
        folder.file("s.toml", sweep(lines).as_bytes());
        // A dry run says as much, before it lists or measures anything.
        for how in ["--json", "--dry-run"] {
            let said = folder.refused(&format!("sweep s.toml {how}"));
            assert!(said.contains(named), "{lines}: {said}");
            if let Some(key) = ["iwad", "maps"].iter().find(|key| lines.contains(*key)) {
                assert!(said.contains("s.toml: `") && said.contains(key), "{lines}: {said}");
            }
        }
    }
    folder.file("s.toml", sweep("").as_bytes());
    let said = folder.refused("sweep s.toml --option iwad=none.wad --dry-run");
    assert!(said.contains("--option iwad=none.wad: "), "{said}");
    assert_eq!(folder.read("file"), b"mine");
    assert!(!folder.0.join("new").exists());
}

/// An agent's file gives way to another, and nothing else does; what is one already is no run.
#[test]
fn an_exported_agent_replaces_agents_alone() {
    let folder = trained("exported");
    folder.file("notes.agent", b"mine");
    let said = folder.refused("export-agent run -o notes.agent");
    assert!(said.contains("notes.agent") && said.contains("another name with --out"), "{said}");
    assert_eq!(folder.read("notes.agent"), b"mine");
    folder.ok("export-agent run -o one.agent");
    folder.ok("export-agent run --latest -o one.agent");
    for (named, remedy) in [
        ("zoo:RemedyRushLevel1", "takes this name, or name a run's folder"),
        ("one.agent", "copy one.agent, or name a run's folder"),
        ("notes.agent", "is a file; name a run's folder"),
    ] {
        let said = folder.refused(&format!("export-agent {named} -o two.agent"));
        assert!(said.contains(named) && said.contains(remedy), "{named}: {said}");
    }
    assert!(!folder.0.join("two.agent").exists());
}

/// An agent at another temperature is another agent, made from a run, a file or the zoo's.
#[test]
fn an_agent_can_be_exported_at_another_temperature() {
    let folder = trained("tempered");
    folder.ok("export-agent run -o one.agent");
    for named in ["run", "one.agent"] {
        folder.ok(&format!("export-agent {named} --temperature 0.25 -o two.agent"));
        let line = "eval two.agent --episodes 2 --json";
        assert_ne!(folder.ok(line), folder.ok(&line.replace("two", "one")), "{named}");
    }
    folder.ok("export-agent zoo:RemedyRushLevel1 --temperature 2 -o three.agent");
    let said = folder.ok("claim two.agent --name two --episodes 2 -o board --json");
    let path: serde_json::Value = serde_json::from_str(&said).unwrap();
    let claim = String::from_utf8(folder.read(path["claim"].as_str().unwrap())).unwrap();
    assert!(claim.contains("hasard export-agent RUN --temperature 0.25"), "{claim}");
    for (flags, word) in [
        ("--temperature 0", "from 0.01"),
        ("--temperature -1", "from 0.01"),
        ("--temperature cold", "from 0.01"),
        ("--temperature 0.5 --latest", "leave --latest out"),
    ] {
        let said = folder.refused(&format!("export-agent one.agent {flags} -o four.agent"));
        assert!(said.contains(word) && !folder.0.join("four.agent").exists(), "{flags}: {said}");
    }
}
