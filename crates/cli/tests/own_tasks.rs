//! A task of one's own from the shell: written, checked, and taken wherever an id is taken.

mod folder;

use folder::Folder;

/// A training of one rollout of milliseconds.
const SMALL: &str = "--envs 4 --threads 1 --set network.dense=[32] --set network.recurrent=32 --frames 512 --set sampling.rollout=8 \
                     --set evaluation.episodes=2 --set evaluation.confirming_episodes=2 --eval-every 256 --size 64x48";

#[test]
fn a_task_is_written_checked_and_taken_by_every_command() {
    let folder = Folder::new("all");
    assert!(folder.ok("new lava_garden").contains("lava_garden.toml: the task LavaGarden"));
    assert!(folder.refused("new lava_garden").contains("is there already"));
    assert!(
        folder.ok("check lava_garden.toml -o map.png").contains("can be played as LavaGarden-v0")
    );
    assert!(folder.0.join("map.png").metadata().unwrap().len() > 1000);
    assert!(folder.ok("envs lava_garden.toml").contains("LavaGarden-v0"));
    let episodes = folder.ok("rollout lava_garden.toml --policy sticky:10 --episodes 2 --json");
    assert!(
        episodes.contains("\"env\":\"LavaGarden-v0\"")
            && episodes.contains("\"vials\":")
            && episodes.contains("\"lava\":")
    );
    folder.ok("render lava_garden.toml -o frame.png");
    folder.ok("bench lava_garden.toml --seconds 0.2 --envs 2 --threads 1");
    folder.ok("record lava_garden.toml --policy sticky:10 --seed 3 -o one.episode");
    // The episode has its task in it.
    let replayed = folder.ok("replay one.episode --json");
    folder.replace("lava_garden.toml", "count = 12", "count = 3");
    assert_eq!(folder.ok("replay one.episode --json"), replayed);
    assert!(replayed.contains("LavaGarden-v0"), "{replayed}");
    folder.ok("contact-sheet lava_garden.toml -o sheets");
    assert!(folder.0.join("sheets/lava_garden_sheet.png").exists());
    folder.ok("export-wad lava_garden.toml -o garden.wad");
    folder.ok("settings lava_garden.toml");
    std::fs::write(
        folder.0.join("sweep.toml"),
        "scenarios = [\"lava_garden.toml\"]\nlevels=[1]\nalgorithms=[\"PPO\"]\nseeds=[1]\nframes=512\n",
    )
    .unwrap();
    assert!(folder.ok("sweep sweep.toml --dry-run").contains("train lava_garden.toml"));
}

#[test]
fn a_run_keeps_its_task_and_says_when_the_file_has_changed() {
    let folder = Folder::new("run");
    folder.ok("new garden");
    folder.ok(&format!("train garden.toml --algo PPO --out run {SMALL}"));
    let config = std::fs::read_to_string(folder.0.join("run/config.json")).unwrap();
    assert!(config.contains("\"scenario_file\"") && config.contains("Collect vials"));
    let (first, quiet) = folder.both("eval run --episodes 2 --json");
    assert!(!quiet.contains("has changed"), "{quiet}");
    folder.ok("export-agent run -o garden.agent");
    // Another task under the same name: the run goes on as it was.
    folder.replace("garden.toml", "reward = 1.0", "reward = 7.0");
    let (second, said) = folder.both("eval run --episodes 2 --json");
    assert!(said.contains("garden.toml: has changed since the run began"), "{said}");
    let rows = |text: &str| {
        text.lines().filter(|line| !line.contains("summary")).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(rows(&first), rows(&second));
    std::fs::remove_file(folder.0.join("garden.toml")).unwrap();
    folder.ok("eval run --episodes 1");
    folder.ok("eval garden.agent --episodes 1");
    folder.ok("report run -o report");
    // The agent in a task that is named.
    folder.ok("new garden");
    folder.replace("garden.toml", "tics = 2100", "tics = 70");
    let short = folder.ok("rollout garden.toml --policy run:run --episodes 1 --json");
    assert!(short.contains("\"length\":18,"), "{short}");
}

#[test]
fn bad_files_are_refused_in_a_line_and_checked_in_full() {
    let folder = Folder::new("bad");
    folder.ok("new bad");
    folder.replace("bad.toml", "kind = \"HealthBonus\"", "kind = \"HealthBonsu\"");
    folder.replace("bad.toml", "event = \"damage\"", "event = \"damaged\"");
    let line = folder.refused("rollout bad.toml");
    assert!(
        line.contains("bad.toml:") && line.contains("HealthBonus") && line.contains("1 more"),
        "{line}"
    );
    let output = folder.run("check bad.toml");
    assert_eq!(output.status.code(), Some(1));
    let listed = String::from_utf8(output.stdout).unwrap();
    assert_eq!(listed.lines().count(), 2, "{listed}");
    assert!(folder.refused("rollout none.toml").contains("hasard new"));
    assert!(folder.refused("new two.words.toml.x").contains("letters, digits"));
    std::fs::write(folder.0.join("bytes.toml"), [0xFF, 0xFE, 0]).unwrap();
    assert!(folder.refused("check bytes.toml").contains("UTF-8"));
    std::fs::write(folder.0.join("large.toml"), vec![b'#'; 300 << 10]).unwrap();
    assert!(folder.refused("play large.toml").contains("256 KiB"));
    assert!(folder.refused("record . -o x.gif").len() < 300);
}

/// Several tasks make one batch for `bench`; what plays one environment says so.
#[test]
fn several_tasks_make_a_batch() {
    let folder = Folder::new("several-tasks");
    folder.ok("new garden");
    let line = folder.ok("bench RemedyRushLevel1,garden.toml --envs 4 --seconds 0.1 --size 64x48");
    assert!(line.starts_with("RemedyRushLevel1-v0,Garden-v0: "), "{line}");
    for line in ["rollout", "render"] {
        let error = folder.refused(&format!("{line} RemedyRushLevel1,garden.toml"));
        assert!(error.contains("it must be one id"), "{line}: {error}");
    }
}
