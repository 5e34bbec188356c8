//! Maps from files: ours written and read again, a user's own, and what is said of those that
//! cannot be played.

use hasard_engine::map::{MapSource, SourceThing, TextureName};
use hasard_engine::math::Fixed;
use hasard_engine::wad::{self, Lump, WadKind};
use hasard_engine::world::ActorKind;
use hasard_envs::maps::Maps;
use hasard_envs::{Env, EnvId, EnvOptions, FrameSize, Policy, PolicyRun, RuleSet, scenarios};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A folder of its own, gone afterwards.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("hasard-maps-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    fn put(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.0.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, bytes).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        _ = std::fs::remove_dir_all(&self.0);
    }
}

fn folder_name(id: EnvId) -> &'static str {
    match id.scenario.name() {
        "ArmamentBurden" => "armament_burden",
        "CollateralDamage" => "collateral_damage",
        "DetonatorsDilemma" => "detonators_dilemma",
        "PrecipicePlunge" => "precipice_plunge",
        "RemedyRush" => "remedy_rush",
        "VolcanicVenture" => "volcanic_venture",
        other => panic!("{other} is none of the six"),
    }
}

fn options(maps: Option<&Path>) -> EnvOptions {
    let size = FrameSize { width: 64, height: 48 };
    EnvOptions {
        size,
        maps: maps.map(|place| Arc::new(Maps::new(place, None))),
        ..EnvOptions::default()
    }
}

/// Fingerprint of the state after some random steps, and the last frame.
fn played(id: EnvId, options: &EnvOptions) -> (u64, Vec<u8>) {
    let mut env = Env::new(&id.to_string(), options).unwrap();
    let policy: Policy = "sticky:5".parse().unwrap();
    env.reset(3);
    let mut run = PolicyRun::new(policy, &env, 3).unwrap();
    for _ in 0..60 {
        if let hasard_envs::Move::Action(actions, deltas) = run.next_move(&env) {
            env.step(actions, deltas).unwrap();
        }
    }
    let mut frame = vec![0; env.observation_shape().iter().product()];
    env.observe(&mut frame);
    (env.state_hash(), frame)
}

#[test]
fn our_own_maps_play_the_same_from_files() {
    let folder = Folder::new("own");
    for id in EnvId::all() {
        let (source, _) = scenarios::map_source(id, RuleSet::Paper, false);
        folder.put(
            &format!("{}/level_{}.wad", folder_name(id), id.level),
            &wad::write_map("MAP01", &source),
        );
    }
    for id in EnvId::all() {
        assert_eq!(played(id, &options(Some(&folder.0))), played(id, &options(None)), "{id}");
    }
}

#[test]
fn the_hard_map_is_taken_where_the_rules_follow_its_world() {
    let folder = Folder::new("hard");
    let id: EnvId = "VolcanicVentureLevel1-v0".parse().unwrap();
    let with_light = |light| {
        let (mut source, _) = scenarios::map_source(id, RuleSet::Paper, false);
        source.sectors.iter_mut().for_each(|sector| sector.light = light);
        wad::write_map("MAP01", &source)
    };
    folder.put("volcanic_venture/level_1.wad", &with_light(100));
    let light = |rules, hard| {
        let env =
            Env::new(&id.to_string(), &EnvOptions { rules, hard, ..options(Some(&folder.0)) })
                .unwrap();
        env.world().map.sectors[0].light
    };
    assert_eq!(light(RuleSet::Released, true), 100, "without a hard map the level's own is played");
    folder.put("volcanic_venture/level_1_hard.wad", &with_light(200));
    let lights = [
        (RuleSet::Paper, false),
        (RuleSet::Paper, true),
        (RuleSet::Released, false),
        (RuleSet::Released, true),
    ]
    .map(|(rules, hard)| light(rules, hard));
    assert_eq!(lights, [100, 100, 100, 200]);
}

fn thing(kind: i32, x: f64, y: f64, id: i32, next: i32) -> SourceThing {
    SourceThing { x, y, kind, id, args: [next, 0, 0, 0, 0], ..SourceThing::default() }
}

fn one_map(folder: &Folder, id: &str, change: impl FnOnce(&mut MapSource)) -> Result<Env, String> {
    let (mut source, _) = scenarios::map_source(id.parse().unwrap(), RuleSet::Paper, false);
    change(&mut source);
    let path = folder.put("one.wad", &wad::write_map("MAP01", &source));
    Env::new(id, &options(Some(&path))).map_err(|error| error.to_string())
}

#[test]
fn the_walkers_of_collateral_damage_use_the_map_s_own_patrol_points() {
    let folder = Folder::new("points");
    let mut env = one_map(&folder, "CollateralDamageLevel1-v0", |source| {
        source.things.extend([thing(9024, 0.0, 300.0, 11, 12), thing(9024, 0.0, -300.0, 12, 11)]);
    })
    .unwrap();
    for seed in 0..3 {
        env.reset(seed);
        let points: Vec<_> = env
            .world()
            .actors
            .iter()
            .filter(|a| !a.removed && a.kind == ActorKind::PatrolPoint)
            .collect();
        assert_eq!(points.len(), 2, "the map's own and no others");
        assert_eq!(
            (points[0].x, points[0].y + points[1].y, points[0].next_goal),
            (points[1].x, Fixed::ZERO, 12)
        );
        assert_eq!(points[0].y, Fixed::from_int(608));
    }
}

#[test]
fn one_agent_plays_whatever_other_starts_the_map_has() {
    let folder = Folder::new("starts");
    let env = one_map(&folder, "RemedyRushLevel1-v0", |source| {
        source.things.extend((2..=4).map(|kind| thing(kind, 224.0, 20.0, 0, 0)));
    });
    assert_eq!(env.unwrap().world().players.len(), 1);
}

#[test]
fn what_is_left_out_is_said_in_one_line() {
    let folder = Folder::new("left-out");
    let env = one_map(&folder, "RemedyRushLevel1-v0", |source| {
        source.lines[0].special = 160;
        // A door that nobody can open, as nothing sets it off.
        source.lines[1].special = 12;
        source.sectors[0].special = 9;
        source.things.push(thing(9080, 224.0, 20.0, 0, 0));
    });
    let found = env.unwrap().left_out().unwrap();
    let line = ": left out: line special 160 (1), sector special 9 (1), thing type 9080 (1)";
    assert!(found.ends_with(line) && found.contains("one.wad"), "{found}");
    let left_out = |change: fn(&mut MapSource)| {
        one_map(&folder, "RemedyRushLevel1-v0", change).unwrap().left_out()
    };
    assert_eq!(left_out(|_| ()), None);
    // The numbers of an older game's line types, where they are: every one of them acts.
    let found = left_out(|source| {
        (source.namespace, source.lines[1].special, source.sectors[0].special) =
            ("doom".into(), 12, 1);
    })
    .unwrap();
    assert!(found.ends_with(": left out: line special 12 (1), sector special 1 (1)"), "{found}");
}

#[test]
fn precipice_plunge_plays_where_some_tags_are_missing_but_not_where_all_are() {
    let folder = Folder::new("tags");
    let id = "PrecipicePlungeLevel1-v0";
    let without = |tags: std::ops::Range<i32>| {
        one_map(&folder, id, |source| {
            source.sectors.iter_mut().filter(|s| tags.contains(&s.tag)).for_each(|s| s.tag = 0)
        })
    };
    let mut env = without(200..202).unwrap();
    env.reset(1);
    let error = without(1..1000).map(|_| ()).unwrap_err();
    assert!(error.contains("needs sectors with the tags 128 to 372"), "{error}");
}

#[test]
fn what_cannot_be_played_is_named_in_one_line() {
    let folder = Folder::new("wrong");
    let lump = |name, bytes| Lump { name: TextureName::new(name), bytes };
    let wads: [(&[u8], &str); 4] = [
        (b"nothing at all", "not a WAD"),
        (&wad::write(WadKind::Pwad, &[lump("MAP02", b"")]), "no UDMF map MAP01"),
        (&wad::write(WadKind::Pwad, &[lump("MAP01", b""), lump("TEXTMAP", b"sector {")]), "line 1"),
        (
            &wad::write(
                WadKind::Pwad,
                &[lump("MAP01", b""), lump("TEXTMAP", b"namespace = \"zdoom\";")],
            ),
            "no vertices",
        ),
    ];
    for (bytes, expected) in wads {
        let path = folder.put("map\u{1b}[1m.wad", bytes);
        let error = Env::new("VolcanicVentureLevel1-v0", &options(Some(&path)))
            .map(|_| ())
            .unwrap_err()
            .to_string();
        assert!(
            error.contains(expected)
                && error.contains("[1m.wad")
                && !error.contains(char::is_control),
            "{error}"
        );
    }
}

/// A WAD with one map of this text.
fn text_wad(text: &str) -> Vec<u8> {
    let lump = |name, bytes| Lump { name: TextureName::new(name), bytes };
    wad::write(WadKind::Pwad, &[lump("MAP01", b"".as_slice()), lump("TEXTMAP", text.as_bytes())])
}

#[test]
fn fields_that_are_not_played_are_reported_with_the_file() {
    let folder = Folder::new("fields");
    let (source, _) =
        scenarios::map_source("CollateralDamageLevel1-v0".parse().unwrap(), RuleSet::Paper, false);
    let text = hasard_engine::map::udmf::write(&source).replacen(
        "heightceiling",
        "damageamount = 20;\nmoreids = \"5\";\nheightceiling",
        1,
    );
    let path = folder.put("fields.wad", &text_wad(&text));
    let left_out =
        Env::new("CollateralDamageLevel1-v0", &options(Some(&path))).unwrap().left_out().unwrap();
    let expected = format!(
        "{}: left out: sector field damageamount (1), sector field moreids (1)",
        path.display()
    );
    assert_eq!(left_out, expected);
}

/// Whatever a map lacks, the message names its file.
#[test]
fn every_message_of_a_map_names_its_file() {
    let folder = Folder::new("named");
    let lump = |name, bytes| Lump { name: TextureName::new(name), bytes };
    let binary = wad::write(
        WadKind::Pwad,
        &[lump("MAP01", b"".as_slice()), lump("THINGS", b"x"), lump("LINEDEFS", b"x")],
    );
    let path = folder.put("binary.wad", &binary);
    let error =
        Env::new("RemedyRushLevel1-v0", &options(Some(&path))).map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("its MAP01 is binary") && error.contains("must be UDMF"), "{error}");
    let spoils: [fn(&mut MapSource); 5] = [
        |source| source.things.clear(),
        // Starts of deathmatches are none for a single agent.
        |source| source.things.iter_mut().for_each(|thing| thing.kind = 11),
        |source| source.lines.truncate(3),
        |source| source.vertices[0].x = 1e6,
        |source| source.sides[0].sector = 100_000,
    ];
    for id in EnvId::all().filter(|id| id.level == 2) {
        for (number, spoil) in spoils.into_iter().enumerate() {
            let error = one_map(&folder, &id.to_string(), spoil).map(|_| ()).unwrap_err();
            assert!(
                error.contains("one.wad") && !error.contains('\n'),
                "{id}, fault {number}: {error}"
            );
        }
        // A bare room: what the scenario's rules look for is not there. Where they look for
        // nothing, it is played.
        let bare = one_map(&folder, &id.to_string(), |source| {
            source.sectors.iter_mut().for_each(|sector| sector.tag = 0);
            source.things.retain(|thing| thing.kind == 1);
        });
        if let Err(error) = bare {
            assert!(error.contains("one.wad") && !error.contains('\n'), "{id}: {error}");
        }
    }
}
