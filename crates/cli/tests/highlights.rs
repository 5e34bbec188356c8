//! `hasard highlights`: small GIFs of agents at their best.

mod folder;

use folder::Folder;
use serde_json::Value;

#[test]
fn an_agents_best_moment_is_a_small_gif_and_the_same_twice() {
    let folder = Folder::new("highlights");
    let line = "highlights zoo:VolcanicVentureLevel1 --seconds 1 --episodes 2 --seed 18446744073709551614 --size 160x120 --json";
    let said: Value = serde_json::from_str(&folder.ok(&format!("{line} -o a"))).unwrap();
    assert_eq!(said["file"], "a/volcanic_venture.gif");
    assert!(said["return"].as_f64().unwrap() > 5.0 && said["cost"].as_f64().unwrap() <= 50.0);
    assert_eq!(said["pictures"], 18);
    folder.ok(&format!("{line} -o b"));
    let read =
        |name: &str| std::fs::read(folder.0.join(name).join("volcanic_venture.gif")).unwrap();
    let whole = read("a");
    assert_eq!(whole, read("b"));
    assert!(whole.starts_with(b"GIF89a") && whole.len() as u64 == said["bytes"].as_u64().unwrap());
    // 160x120 and the strip below.
    assert_eq!(whole[6..10], [160, 0, 140, 0]);
    // Where it must be smaller, colours are coarser; where that does not do, it says so.
    let megabytes = whole.len() as f64 / 1e6;
    let small: Value =
        serde_json::from_str(&folder.ok(&format!("{line} -o c --most-mb {:.3}", 0.8 * megabytes)))
            .unwrap();
    assert!(small["colours_off"].as_u64() > said["colours_off"].as_u64(), "{small}");
    assert!(small["bytes"].as_f64().unwrap() <= 0.8e6 * megabytes + 1000.0);
    assert!(folder.refused(&format!("{line} -o d --most-mb 0.001")).contains("smaller or shorter"));
    assert!(!folder.0.join("d/volcanic_venture.gif").exists());
}

#[test]
fn levels_stand_in_one_animation_and_mistakes_are_named() {
    let folder = Folder::new("highlights-levels");
    let line = "highlights zoo:RemedyRushLevel1 --seconds 0.5 --episodes 1 --size 64x48 --levels";
    let said = folder.ok(&format!("{line} -o h"));
    assert!(said.contains("h/levels.gif: 3 levels, 35 pictures"), "{said}");
    assert!(folder.0.join("h/remedy_rush.gif").is_file());
    // Each level is its own agent's, also where the zoo is a folder, as in the repository.
    let levels = folder.read("h/levels.gif");
    std::fs::create_dir(folder.0.join("zoo")).unwrap();
    for level in 1..=3 {
        let name = format!("RemedyRushLevel{level}.agent");
        std::fs::copy(format!("../../zoo/{name}"), folder.0.join("zoo").join(name)).unwrap();
    }
    folder.ok(&format!("{line} -o f"));
    assert!(folder.read("f/levels.gif") == levels, "the same agents in a folder");
    for (line, why) in [
        ("highlights --seconds 0", "0.5 to 60"),
        ("highlights --most-mb -1", "--most-mb"),
        ("highlights zoo:nobody", "the zoo has"),
        ("highlights nothere", "no such run"),
        ("highlights zoo:RemedyRushLevel1 nothere --out films", "no such run"),
        ("highlights --size 1x1", "64x48"),
        (
            "highlights zoo:RemedyRushLevel1 zoo:RemedyRushLevel1 --out films",
            "both of RemedyRushLevel1",
        ),
    ] {
        let said = folder.refused(line);
        assert!(said.contains(why), "{line}: {said}");
    }
    assert!(!folder.0.join("films").exists(), "the first film was made before the mistake");
}

#[test]
fn a_site_needs_a_clone() {
    let folder = Folder::new("site");
    assert!(folder.refused("site").contains("--root"));
    assert!(folder.refused("site film.avi").contains(".mp4 or .gif"));
}
