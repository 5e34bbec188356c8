//! A task's map may lie in a file of its own, which comes with the task's text from then on.

use hasard_engine::map::{TextureName, udmf};
use hasard_engine::wad::{self, Lump, WadKind};
use hasard_envs::{Env, EnvOptions, FrameSize, Policy, PolicyRun, own};
use std::path::{Path, PathBuf};

const REST: &str = r#"
[scenario]
name = "NAME"
actions = [["TURN_LEFT", "TURN_RIGHT"], ["MOVE_FORWARD"], ["SPEED"]]
[player]
in = [-320, 128, 352, 1024]
[[spawn]]
kind = "HealthBonus"
count = 20
in = [-608, -224, 1056, 1312]
[[when]]
event = "pickup"
of = "HealthBonus"
reward = 1.0
"#;

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("hasard-maps-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    /// Writes a task with a map of these words and opens it.
    fn open(&self, name: &str, map: &str) -> Result<String, String> {
        let text = REST.replace("NAME", name) + "[map]\n" + map;
        let path = self.0.join(format!("{name}.toml"));
        std::fs::write(&path, text).unwrap();
        let id = own::open(path.to_str().unwrap()).map_err(|error| error.to_string())?;
        Ok(id.to_string())
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Hashes of an episode's states.
fn life(id: &str) -> Vec<u64> {
    let size = FrameSize { width: 64, height: 48 };
    let mut env = Env::new(id, &EnvOptions { size, ..EnvOptions::default() }).unwrap();
    env.reset(5);
    let mut run = PolicyRun::new("sticky:8".parse::<Policy>().unwrap(), &env, 5).unwrap();
    let state = |env: &Env| env.world().state_hash();
    (0..200)
        .map(|_| {
            env.make_move(run.next_move(&env)).unwrap();
            state(&env)
        })
        .collect()
}

/// The map of Remedy Rush, as UDMF.
fn text() -> String {
    let built_in = REST.replace("NAME", "Source") + "[map]\nbuiltin = \"RemedyRush\"\n";
    udmf::write(&own::check(&built_in).map(1).unwrap())
}

fn wad_file(path: &Path, map: &str) {
    let lumps = [
        Lump { name: TextureName::new("MAP07"), bytes: b"" },
        Lump { name: TextureName::new("TEXTMAP"), bytes: map.as_bytes() },
        Lump { name: TextureName::new("ENDMAP"), bytes: b"" },
    ];
    std::fs::write(path, wad::write(WadKind::Pwad, &lumps)).unwrap();
}

#[test]
fn a_map_from_a_file_plays_as_the_built_in_one() {
    let folder = Folder::new("same");
    std::fs::create_dir_all(folder.0.join("maps")).unwrap();
    std::fs::write(folder.0.join("maps/yard.udmf"), text()).unwrap();
    wad_file(&folder.0.join("yard.wad"), &text());
    let built_in = life(&folder.open("FromProgram", "builtin = \"RemedyRush\"\n").unwrap());
    let from_text = folder.open("FromText", "udmf = \"maps/yard.udmf\"\n").unwrap();
    let from_wad = folder.open("FromWad", "wad = \"yard.wad#MAP07\"\n").unwrap();
    let inline = folder.open("FromWords", &format!("udmf = '''\n{}'''\n", text())).unwrap();
    for id in [&from_text, &from_wad, &inline] {
        assert_eq!(life(id), built_in, "{id}");
    }
    assert!(built_in.windows(2).any(|pair| pair[0] != pair[1]));
}

#[test]
fn the_map_comes_with_the_text() {
    let folder = Folder::new("kept");
    wad_file(&folder.0.join("yard.wad"), &text());
    let id = folder.open("Kept", "wad = \"yard.wad#MAP07\"\n").unwrap();
    let alive = life(&id);
    let whole = own::read_text(&folder.0.join("Kept.toml")).unwrap();
    std::fs::remove_file(folder.0.join("yard.wad")).unwrap();
    let again = whole.replace("\"Kept\"", "\"KeptAgain\"");
    own::register("elsewhere.toml", &again).unwrap();
    assert_eq!(life("KeptAgain-v0"), alive);
    // What was laid beneath stays as it is.
    std::fs::write(folder.0.join("whole.toml"), &whole).unwrap();
    assert_eq!(own::read_text(&folder.0.join("whole.toml")).unwrap(), whole);
}

#[test]
fn another_level_may_have_another_map() {
    let folder = Folder::new("levels");
    wad_file(&folder.0.join("yard.wad"), &text());
    let map = "wad = \"yard.wad#MAP07\"\n[levels.2]\nmap = { wad = \"second.wad\" }\n";
    std::fs::copy(folder.0.join("yard.wad"), folder.0.join("second.wad")).unwrap();
    let error = folder.open("Levels", map).unwrap_err();
    assert!(error.contains("second.wad") && error.contains("MAP01"), "{error}");
    let map = map.replace("second.wad", "second.wad#MAP07");
    let first = folder.open("Levels", &map).unwrap();
    assert_eq!(first, "LevelsLevel1-v0");
    assert_eq!(life("LevelsLevel2-v0"), life(&first));
}

/// A room without a start.
fn small() -> String {
    let corners = [(0, 0), (0, 64), (64, 64), (64, 0)];
    let vertices = corners.map(|(x, y)| format!("vertex {{ x = {x}.0; y = {y}.0; }}\n")).concat();
    let lines: String = (0..4)
        .map(|i| format!("linedef {{ v1 = {i}; v2 = {}; sidefront = {i}; }}\n", (i + 1) % 4))
        .collect();
    let sides = "sidedef { sector = 0; texturemiddle = \"STONE5\"; }\n".repeat(4);
    let looks = "texturefloor = \"FLAT5\"; textureceiling = \"FLAT5\"; lightlevel = 200;";
    format!("{vertices}{lines}{sides}sector {{ heightfloor = 0; heightceiling = 128; {looks} }}\n")
}

#[test]
fn wrong_maps_are_named_in_a_line() {
    let folder = Folder::new("wrong");
    std::fs::write(folder.0.join("no.udmf"), "namespace = \"zdoom\"; vertex { x = ; }").unwrap();
    std::fs::write(folder.0.join("small.udmf"), format!("namespace = \"zdoom\";\n{}", small()))
        .unwrap();
    std::fs::write(folder.0.join("no.wad"), b"PK\x03\x04").unwrap();
    for (map, words) in [
        ("udmf = \"absent.udmf\"\n", "absent.udmf"),
        ("udmf = \"no.udmf\"\n", "no.udmf"),
        ("wad = \"no.wad\"\n", "no.wad"),
        ("wad = \"\"\n", "wad = \"\""),
        ("udmf = \"small.udmf\"\n", "start"),
        ("udmf = '''vertex {'''\n", "cannot be read"),
        ("wad = \"a.wad\"\nbuiltin = \"RemedyRush\"\n", "a.wad"),
    ] {
        let error = folder.open("Wrong", map).unwrap_err();
        assert!(error.contains(words) && error.lines().count() == 1, "{map}: {error}");
    }
    let path = folder.0.join("Inline.toml");
    let inline = format!("map = {{ udmf = \"small.udmf\" }}\n{}", REST.replace("NAME", "Inline"));
    std::fs::write(&path, inline).unwrap();
    let error = own::read_text(&path).unwrap_err().to_string();
    assert!(error.contains("write [map] on a line of its own"), "{error}");
    // A check lists maps that cannot be read among the mistakes, each where it is named.
    let maps = "[map]\nudmf = \"absent\\u0007.udmf\"\n[levels.2]\nmap = { wad = \"no.wad\" }\ncolour = 1\n";
    let path = folder.0.join("Listed.toml");
    std::fs::write(&path, REST.replace("NAME", "Listed") + maps).unwrap();
    assert!(own::read_text(&path).unwrap_err().to_string().contains("[map] udmf"));
    let checked = own::check(&own::read_to_check(&path).unwrap().0);
    let mistakes: Vec<String> = checked.mistakes.iter().map(ToString::to_string).collect();
    let first = REST.lines().count() + 2;
    for (line, column, words) in [
        (first, 8, "cannot be read: No such file or directory (os error 2); the path leads from"),
        (first + 2, 15, "[map] wad = \"no.wad\": "),
        (first + 3, 1, "`colour` is unknown"),
    ] {
        let beginning = format!("{line}:{column}: ");
        let listed = mistakes.iter().any(|one| one.starts_with(&beginning) && one.contains(words));
        assert!(listed, "{beginning}{words}: {mistakes:#?}");
    }
    // A text alone cannot bring a file.
    let text = REST.replace("NAME", "Alone") + "[map]\nwad = \"yard.wad\"\n";
    let error = own::register("alone.toml", &text).unwrap_err().to_string();
    assert!(error.contains("is in another file"), "{error}");
}

/// What a map asks for in vain is named: of a text, of a file, and of a file that is gone.
#[test]
fn what_a_map_leaves_out_is_named() {
    let folder = Folder::new("left-out");
    assert!(
        own::check(&(REST.replace("NAME", "Nothing") + "[map]\n" + &inline(&text())))
            .mistakes
            .is_empty()
    );
    let odd = text()
        .replacen(
            "\nsector // 0\n{",
            "\nsector // 0\n{\ndamageamount = 20; damageinterval = 10;",
            1,
        )
        .replacen("\nlinedef // 0\n{", "\nlinedef // 0\n{\nspecial = 12; playeruse = true;", 1)
        + "thing { x = 0.0; y = 256.0; type = 31337; skill3 = true; single = true; }\n";
    std::fs::write(folder.0.join("odd.udmf"), &odd).unwrap();
    wad_file(&folder.0.join("odd.wad"), &odd);
    let parts = ["thing type 31337 (1)", "sector field damageamount (1)", "line special 12 (1)"];
    for (name, map) in [
        ("OddText", inline(&odd)),
        ("OddFile", "udmf = \"odd.udmf\"\n".to_owned()),
        ("OddWad", "wad = \"odd.wad#MAP07\"\n".to_owned()),
    ] {
        let id = folder.open(name, &map).unwrap();
        let whole = own::read_text(&folder.0.join(format!("{name}.toml"))).unwrap();
        let mistakes = own::check(&whole).mistakes;
        let env = Env::new(&id, &EnvOptions::default()).unwrap();
        let said = env.left_out().unwrap();
        for part in parts {
            let named = mistakes.iter().filter(|one| one.warning && one.text.contains(part));
            assert_eq!(named.count(), 1, "{name}: {part}: {mistakes:#?}");
            assert!(said.contains(part), "{name}: {said}");
        }
        assert!(mistakes[0].text.starts_with("left out: ") && mistakes[0].line > 1, "{mistakes:?}");
    }
}

fn inline(map: &str) -> String {
    format!("udmf = '''\n{map}'''\n")
}

/// The line of a task that is played: once, however many worlds are made.
#[test]
fn a_task_that_is_played_says_what_its_map_leaves_out() {
    static SAID: std::sync::Mutex<Vec<String>> = std::sync::Mutex::new(Vec::new());
    hasard_envs::maps::report_tasks_to(|line| SAID.lock().unwrap().push(line.to_owned()));
    let folder = Folder::new("said");
    let odd =
        text() + "thing { x = 0.0; y = 256.0; type = 31338; skill3 = true; single = true; }\n";
    std::fs::write(folder.0.join("odd.udmf"), odd).unwrap();
    let id = folder.open("Said", "udmf = \"odd.udmf\"\n").unwrap();
    for hard in [false, true, false] {
        Env::new(&id, &EnvOptions { hard, ..EnvOptions::default() }).unwrap();
    }
    let said = SAID.lock().unwrap();
    let lines: Vec<&String> = said.iter().filter(|line| line.contains("31338")).collect();
    assert_eq!(lines.len(), 1, "{said:?}");
    assert!(lines[0].ends_with("Said.toml: left out: thing type 31338 (1)"), "{said:?}");
}

#[cfg(unix)]
#[test]
fn devices_are_no_maps_and_no_tasks() {
    let folder = Folder::new("devices");
    for map in ["wad = \"/dev/zero\"\n", "udmf = \"/dev/zero\"\n"] {
        let error = folder.open("Device", map).unwrap_err();
        assert!(error.contains("/dev/zero") && error.contains("name a regular file"), "{error}");
    }
    let error = own::read_text(Path::new("/dev/zero")).unwrap_err().to_string();
    assert!(error.contains("name a regular file") && error.lines().count() == 1, "{error}");
}
