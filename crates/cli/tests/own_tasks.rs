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
    folder.ok("record run -o garden.episode");
    assert!(!folder.both("replay garden.episode").1.contains("has changed"));
    // Another task under the same name: the run goes on as it was.
    folder.replace("garden.toml", "reward = 1.0", "reward = 7.0");
    let (second, said) = folder.both("eval run --episodes 2 --json");
    assert!(said.contains("garden.toml: has changed since the run began"), "{said}");
    let (_, said) = folder.both("replay garden.episode");
    assert!(said.contains("garden.toml: has changed since the episode was recorded"), "{said}");
    let rows = |text: &str| {
        text.lines().filter(|line| !line.contains("summary")).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(rows(&first), rows(&second));
    std::fs::remove_file(folder.0.join("garden.toml")).unwrap();
    folder.ok("eval run --episodes 1");
    folder.ok("train garden --resume --out run --frames 1024");
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

/// A run keeps the text of its task, so it goes on by the name of a file that is gone.
#[test]
fn a_run_goes_on_without_its_tasks_file() {
    let folder = Folder::new("gone");
    folder.ok("new garden");
    folder.replace("garden.toml", "tics = 2100", "tics = 70");
    folder.ok(&format!("train garden.toml --algo PPO --out run {SMALL}"));
    folder.ok(&format!("train RemedyRushLevel1,garden.toml --algo PPO --out both {SMALL}"));
    std::fs::remove_file(folder.0.join("garden.toml")).unwrap();
    let said = folder.refused("train garden.toml --resume");
    assert!(said.contains("hasard train garden.toml --resume --out RUN"), "{said}");
    for (line, named) in [
        ("train garden.toml --out new", "garden.toml: cannot be read"),
        ("train garden.toml --resume --out new", "garden.toml: cannot be read"),
        ("train other.toml --resume --out run", "hasard train Garden-v0 --resume --out run"),
        ("train garden.toml#2 --resume --out run", "hasard train Garden-v0 --resume --out run"),
        ("train garden.toml --resume --out both", "of RemedyRushLevel1-v0,Garden-v0"),
    ] {
        let said = folder.refused(line);
        assert!(said.contains(named), "{line}: {said}");
    }
    assert!(!folder.0.join("new").exists());
    let frames = |run: &str| {
        let config: serde_json::Value =
            serde_json::from_slice(&folder.read(&format!("{run}/config.json"))).unwrap();
        config["frames"].as_u64()
    };
    folder.ok("train garden.toml --resume --out run --frames 1024");
    folder.ok("train elsewhere/garden.toml --resume --out run --frames 1536");
    folder.ok("train RemedyRushLevel1,garden.toml --resume --out both --frames 1024");
    assert_eq!((frames("run"), frames("both")), (Some(1536), Some(1024)));
}

/// One network acts in all lessons, and one name is one task: both are refused before anything is
/// written.
#[test]
fn tasks_that_cannot_be_trained_together_are_refused_before_the_first_frame() {
    let folder = Folder::new("apart");
    folder.ok("new garden");
    let text = String::from_utf8(folder.read("garden.toml")).unwrap();
    let more = "\n[levels.2]\nscenario.actions = [[\"TURN_LEFT\", \"TURN_RIGHT\"], [\"MOVE_FORWARD\"], [\"JUMP\"], [\"USE\"]]\n";
    let levels = text.clone() + more;
    folder.file("levels.toml", levels.as_bytes());
    let line = folder.refused("train levels.toml --curriculum 1:64,2:64 --out run");
    assert!(line.contains("level 2 has other buttons than level 1"), "{line}");
    // As many choices, but of other buttons: outputs would change what they stand for.
    let swapped = more.replace("], [\"USE\"]]", "]]").replace("MOVE_FORWARD", "MOVE_BACKWARD");
    folder.file("swapped.toml", (text.clone() + &swapped).as_bytes());
    let line = folder.refused("train swapped.toml --curriculum 1:64,2:64 --out run");
    assert!(line.contains("level 2 has other buttons than level 1"), "{line}");
    // A side without the other has no mirror image.
    let lame = text.replace("[\"TURN_LEFT\", \"TURN_RIGHT\"]", "[\"TURN_LEFT\"], [\"TURN_RIGHT\"]");
    assert_ne!(lame, text);
    folder.file("lame.toml", lame.as_bytes());
    let line = folder.refused("train lame.toml --frames 64 --set network.mirror=true --out run");
    assert!(
        line.contains("TURN_LEFT has no TURN_RIGHT") && line.contains("in one group"),
        "{line}"
    );
    std::fs::write(folder.0.join("other.toml"), text + "\n# another file\n").unwrap();
    let line = folder.refused("train garden.toml,other.toml --frames 64 --out run");
    assert!(line.contains("garden.toml and other.toml are both"), "{line}");
    folder.file("another.toml", (levels.clone() + "# of two levels\n").as_bytes());
    let line = folder.refused("train levels.toml#1,another.toml#2 --frames 64 --out run");
    assert!(line.contains("levels.toml#1 and another.toml#2 are both"), "{line}");
    assert!(!folder.0.join("run").exists());
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

/// A name that the next command would not take, or an ending that says another kind of picture.
#[test]
fn files_have_the_endings_of_their_kind() {
    let folder = Folder::new("endings-of-tasks");
    for name in ["ok.txt", "a#2.toml", "a,b.toml"] {
        let line = folder.refused(&format!("new ok -o {name}"));
        assert!(line.contains(name), "{line}");
    }
    assert!(folder.refused("new ok --out=-ok.toml").contains("./"));
    folder.ok("new ok");
    for command in ["check ok.toml -o x.gif", "render ok.toml -o x.gif"] {
        assert!(folder.refused(command).contains("ends in .png"), "{command}");
    }
    folder.file("task", &folder.read("ok.toml"));
    for command in ["check task", "rollout task", "train task"] {
        assert!(folder.refused(command).contains("ends in .toml"), "{command}");
    }
    let left = std::fs::read_dir(&folder.0).unwrap().count();
    assert_eq!(left, 2, "a refused command left something behind");
}

/// Nobody trains for hours on a task that `check` would have said is none.
#[test]
fn a_task_without_reward_says_so_before_it_is_played() {
    let folder = Folder::new("without-reward");
    folder.ok("new task");
    folder.replace("task.toml", "reward = 1.0\n", "reward = 0\n");
    let said =
        "hasard: task.toml:1:1: warning: no [[when]] gives a reward: there is nothing to learn";
    let train = format!("train task.toml --algo PPO --out run {SMALL}");
    for command in ["rollout task.toml --episodes 1", &train] {
        let (_, error) = folder.both(command);
        assert_eq!(error.matches(said).count(), 1, "{command}: {error}");
    }
    let (_, quiet) =
        folder.both(&format!("train task.toml --algo PPO --quiet --out other {SMALL}"));
    assert!(!quiet.contains("warning"), "{quiet}");
}

/// The line that `--maps` has: once, from whatever plays the task, and `check` lists it.
#[test]
fn what_a_tasks_map_leaves_out_is_said() {
    let folder = Folder::new("left-out-of-tasks");
    folder.file(
        "yard.udmf",
        br#"namespace = "zdoom";
thing { x = 128.0; y = 128.0; type = 1; single = true; skill3 = true; }
thing { x = 64.0; y = 64.0; type = 31337; single = true; skill3 = true; }
vertex { x = 0.0; y = 0.0; } vertex { x = 0.0; y = 256.0; }
vertex { x = 256.0; y = 256.0; } vertex { x = 256.0; y = 0.0; }
linedef { v1 = 0; v2 = 1; sidefront = 0; special = 12; playeruse = true; }
linedef { v1 = 1; v2 = 2; sidefront = 1; } linedef { v1 = 2; v2 = 3; sidefront = 2; }
linedef { v1 = 3; v2 = 0; sidefront = 3; }
sidedef { sector = 0; } sidedef { sector = 0; } sidedef { sector = 0; } sidedef { sector = 0; }
sector { heightceiling = 128; texturefloor = "FLAT5"; textureceiling = "FLAT5"; damageamount = 20; damageinterval = 10; }
"#,
    );
    folder.file(
        "yard.toml",
        b"[scenario]\nname = \"Yard\"\ntics = 70\n[map]\nudmf = \"yard.udmf\"\n\
          [[when]]\nevent = \"timer\"\nevery = 35\nreward = 1.0\n",
    );
    let parts = ["thing type 31337 (1)", "line special 12 (1)", "sector field damageamount (1)"];
    let (listed, quiet) = folder.both("check yard.toml");
    assert!(listed.contains("yard.toml:5:8: warning: left out: ") && quiet.is_empty(), "{listed}");
    for command in ["rollout yard.toml --episodes 3", "render yard.toml -o a.png"] {
        let (_, said) = folder.both(command);
        assert!(said.starts_with("hasard: yard.toml: left out: "), "{command}: {said}");
        assert_eq!(said.matches("left out").count(), 1, "{command}: {said}");
        for part in parts {
            assert!(said.contains(part) && listed.contains(part), "{command}: {part}: {said}");
        }
    }
}

/// What never ends or never begins is turned away before it is read.
#[cfg(unix)]
#[test]
fn devices_are_no_files() {
    let folder = Folder::new("devices");
    std::os::unix::fs::symlink("/dev/zero", folder.0.join("zero.toml")).unwrap();
    folder.ok("new ok");
    folder.replace("ok.toml", "tile = 64", "wad = \"/dev/zero\"");
    for command in [
        "check zero.toml",
        "train zero.toml",
        "check ok.toml",
        "verify /dev/zero",
        "replay /dev/zero",
        "rollout RemedyRushLevel1-v0 --iwad /dev/zero",
    ] {
        let line = folder.refused(command);
        assert!(line.contains("is a pipe or a device; name a regular file"), "{command}: {line}");
    }
}
