use super::*;
use hasard_engine::render::FrameSize;
use hasard_engine::world::Fingerprint;
use hasard_envs::{ActionSpace, Env, EnvId, EnvOptions, RuleSet};
use hasard_media::episode::EpisodeFile;
use std::hash::{Hash, Hasher};
use std::path::Path;

fn small_random(state: &mut u64) -> usize {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 33) as usize
}

fn random_action(space: &ActionSpace, state: &mut u64) -> (Vec<u8>, Vec<f32>) {
    let actions = space.sizes().iter().map(|size| (small_random(state) % size) as u8).collect();
    let deltas =
        space.deltas.iter().map(|_| (small_random(state) % 201) as f32 / 100.0 - 1.0).collect();
    (actions, deltas)
}

fn fingerprint(world: &hasard_engine::world::World) -> u64 {
    let mut hasher = Fingerprint::default();
    world.hash(&mut hasher);
    hasher.finish()
}

#[test]
fn what_is_shown_tic_by_tic_is_what_counts() {
    for id in EnvId::all() {
        for hard in [false, true] {
            let options = EnvOptions { hard, full_actions: hard, ..EnvOptions::default() };
            let mut stage = Stage::new(&id.to_string(), &options).unwrap();
            let mut alone = Env::new(&id.to_string(), &options).unwrap();
            stage.reset(3);
            alone.reset(3);
            let mut state = 11;
            for step in 0..80 {
                if stage.ended() {
                    break;
                }
                assert!(stage.wants_action());
                let (actions, deltas) = random_action(alone.action_space(), &mut state);
                stage.act(&actions, &deltas).unwrap();
                let expected = alone.step(&actions, &deltas).unwrap();
                let mut tics = 0;
                let got = loop {
                    tics += 1;
                    if let Some(step) = stage.tic() {
                        break step;
                    }
                };
                assert!(got == expected && tics <= 4, "{id} hard {hard} step {step}");
                assert_eq!(
                    fingerprint(stage.world()),
                    fingerprint(alone.world()),
                    "{id} hard {hard} step {step}"
                );
            }
        }
    }
}

#[test]
fn a_moment_come_back_to_goes_on_as_it_did() {
    let mut stage = Stage::new("DetonatorsDilemmaLevel3-v0", &EnvOptions::default()).unwrap();
    stage.reset(5);
    let mut state = 3;
    let go_on = |stage: &mut Stage, script: &[(Vec<u8>, Vec<f32>)]| {
        for (actions, deltas) in script {
            while !stage.wants_action() && !stage.ended() {
                stage.tic();
            }
            stage.act(actions, deltas).unwrap();
            stage.tic();
        }
        (fingerprint(stage.world()), stage.env().episode().length)
    };
    let script: Vec<_> =
        (0..20).map(|_| random_action(stage.env().action_space(), &mut state)).collect();
    go_on(&mut stage, &script[..8]);
    // In the middle of a step.
    assert!(!stage.wants_action() && !stage.ended());
    let (moment, here) = (stage.moment(), fingerprint(stage.world()));
    let straight = go_on(&mut stage, &script[8..]);
    stage.come_back(&moment).unwrap();
    assert_eq!(fingerprint(stage.world()), here);
    assert_eq!(go_on(&mut stage, &script[8..]), straight);
    assert_ne!(here, straight.0);
    let mut other = Stage::new("DetonatorsDilemmaLevel1-v0", &EnvOptions::default()).unwrap();
    assert!(other.come_back(&moment).is_err());
}

fn record(id: &str, options: &EnvOptions, steps: usize) -> EpisodeFile {
    let mut env = Env::new(id, options).unwrap();
    let mut recorder = Recorder::begin(&mut env, 5, "random").unwrap();
    let mut state = 77;
    for _ in 0..steps {
        let (actions, deltas) = random_action(env.action_space(), &mut state);
        let step = env.step(&actions, &deltas).unwrap();
        recorder.push(&actions, &deltas).unwrap();
        if step.ended() {
            break;
        }
    }
    recorder.finish(&env)
}

#[test]
fn a_replay_ends_where_the_recording_did() {
    for (full_actions, frame_skip, steps) in [(false, 4, 600), (true, 4, 60), (true, 1, 200)] {
        let options = EnvOptions { full_actions, frame_skip, ..EnvOptions::default() };
        let file = record("DetonatorsDilemmaLevel2-v0", &options, steps);
        let bytes = file.to_bytes();
        let file = EpisodeFile::from_bytes(&bytes, Path::new("x")).unwrap();
        let recorded = file.header().steps;
        let mut replay = Replay::new(file, Path::new("x"), &EnvOptions::default()).unwrap();
        let mut tics = 1;
        while replay.tic() {
            tics += 1;
        }
        assert_eq!(replay.stage().env().episode().length, recorded);
        assert!(
            tics <= recorded * frame_skip && tics > (recorded - 1) * frame_skip,
            "{tics} tics, {recorded} steps"
        );
        assert_eq!(replay.difference(), None);
    }
}

#[test]
fn a_replay_that_differs_says_so() {
    let mut file = record("RemedyRushLevel1-v0", &EnvOptions::default(), 20);
    let mut outcome = file.header().outcome.clone().unwrap();
    outcome.state_hash = Some(1);
    file.set_outcome(outcome.clone());
    let play = |file: &EpisodeFile| {
        let mut replay =
            Replay::new(file.clone(), Path::new("a.episode"), &EnvOptions::default()).unwrap();
        while replay.tic() {}
        replay.difference()
    };
    assert!(play(&file).unwrap().starts_with("a.episode: ends in another state"));
    outcome.terminated = !outcome.terminated;
    file.set_outcome(outcome.clone());
    assert!(play(&file).unwrap().contains("ends in another way"));
    let term = outcome.costs.keys().next().unwrap().clone();
    outcome.costs.insert(term.clone(), 77.0);
    file.set_outcome(outcome.clone());
    let by = format!("was recorded with a cost of 77 by {term}, and plays now with ");
    assert!(play(&file).unwrap().contains(&by));
    outcome.episode_return += 1.0;
    file.set_outcome(outcome);
    assert!(play(&file).unwrap().contains("was recorded by version"));
    // More actions than the episode lasts.
    let mut file = record("RemedyRushLevel1-v0", &EnvOptions::default(), 600);
    assert_eq!(play(&file), None);
    let (groups, deltas) =
        file.step(0).map(|(groups, deltas)| (groups.to_vec(), deltas.to_vec())).unwrap();
    file.push(&groups, &deltas).unwrap();
    assert!(play(&file).unwrap().ends_with("ends after 525 of its 526 recorded steps"));
}

#[test]
fn files_of_other_versions_are_refused_by_name() {
    let good = record("RemedyRushLevel1-v0", &EnvOptions::default(), 3);
    let refused = |change: fn(&mut hasard_media::episode::Header)| {
        let mut header = good.header().clone();
        change(&mut header);
        let mut file = EpisodeFile::new(header).unwrap();
        file.push(&[9, 0, 0, 0], &[]).unwrap();
        Replay::new(file, Path::new("f.episode"), &EnvOptions::default()).err().unwrap().to_string()
    };
    assert!(refused(|header| header.env = "LavaLevel9-v0".into()).contains("LavaLevel9-v0"));
    assert!(
        refused(|header| drop(header.options.insert("rules".into(), "mine".into())))
            .contains("rules = mine")
    );
    assert!(
        refused(|header| drop(header.options.insert("gravity".into(), "2".into())))
            .contains("gravity = 2")
    );
    assert!(
        refused(|header| drop(header.options.insert("frame-skip".into(), "0".into())))
            .contains("frame-skip = 0")
    );
    assert!(refused(|_| ()).contains("sub-action 0 is 9"));
}

#[test]
fn options_go_through_names_and_back() {
    let options = EnvOptions {
        rules: hasard_envs::RuleSet::Released,
        hard: true,
        full_actions: true,
        frame_skip: 2,
        ..EnvOptions::default()
    };
    let back = options_from_names(&option_names(&options), &EnvOptions::default(), Path::new("x"))
        .unwrap();
    assert_eq!(
        (back.rules, back.hard, back.full_actions, back.frame_skip),
        (options.rules, true, true, 2)
    );
}

#[test]
fn keys_become_actions() {
    let space =
        ActionSpace::of("RemedyRushLevel1-v0".parse().unwrap(), RuleSet::Paper, false, false); // turn, forward, speed, jump
    let mut controls = Controls::default();
    controls.press(Key::Forward);
    controls.press(Key::TurnLeft);
    controls.press(Key::TurnRight);
    assert_eq!(controls.action(&space, 4).0, [2, 1, 0, 0], "the latest key wins");
    controls.release(Key::TurnRight);
    controls.press(Key::Jump);
    controls.release(Key::Jump);
    assert_eq!(controls.action(&space, 4).0, [1, 1, 0, 1], "a short press counts once");
    assert_eq!(controls.action(&space, 4).0, [1, 1, 0, 0]);
    controls.release_all();
    controls.press(Key::Left);
    assert_eq!(controls.action(&space, 4).0, [1, 0, 0, 0], "without side steps, their keys turn");
    controls.release_all();
    controls.move_mouse(40.0, 0.0);
    assert_eq!(controls.action(&space, 4).0, [2, 0, 0, 0]);
    assert_eq!(controls.action(&space, 4).0, [0, 0, 0, 0]);
}

#[test]
fn the_mouse_turns_by_just_as_much_as_it_moved() {
    let space =
        ActionSpace::of("RemedyRushLevel1-v0".parse().unwrap(), RuleSet::Paper, false, true);
    let mut controls = Controls::default();
    controls.move_mouse(500.0, -100.0); // 60 degrees right, 12 up
    let (mut turned, mut looked) = (0.0, 0.0);
    for _ in 0..4 {
        let (_, deltas) = controls.action(&space, 4);
        assert!(deltas.iter().all(|delta| (-1.0..=1.0).contains(delta)));
        looked += deltas[0] * 7.5 * 4.0;
        turned += deltas[1] * 7.5 * 4.0;
    }
    assert!((turned - 60.0).abs() < 0.01 && (looked - 12.0).abs() < 0.01, "{turned} {looked}");
    controls.press(Key::TurnLeft);
    assert!(controls.action(&space, 4).1[1] < -0.3, "keys turn too");
}

#[test]
fn views_and_panel_have_their_sizes() {
    let mut stage = Stage::new("VolcanicVentureLevel1-v0", &EnvOptions::default()).unwrap();
    stage.reset(1);
    for _ in 0..40 {
        if stage.wants_action() {
            stage.act(&[0, 1, 0, 0], &[]).unwrap();
        }
        stage.tic();
    }
    let size = FrameSize { width: 320, height: 240 };
    let every = [
        ViewKind::Colour,
        ViewKind::Depth,
        ViewKind::Segmented,
        ViewKind::Labels,
        ViewKind::Grey,
        ViewKind::Phase,
        ViewKind::Automap,
    ];
    let mut views = Views::new(&stage, size, &every).unwrap();
    let all = views.draw(&stage);
    let alone = Views::new(&stage, size, &[]).unwrap().draw(&stage);
    assert_eq!((alone.width(), alone.height()), (320, 240));
    assert!(all.width() > 5 * 320 && all.height() > 240);
    assert_eq!(all.get(4 + 100, 4 + 100), alone.get(100, 100));
    // As files, made quickly, they are the same pictures, even reduced.
    for size in [size, FrameSize { width: 128, height: 72 }] {
        let mut views = Views::new(&stage, size, &every).unwrap();
        let pictures = views.pictures(stage.world());
        let files = views.png_files(stage.world());
        assert_eq!(files.iter().map(|(kind, _)| *kind).collect::<Vec<_>>(), every);
        for ((kind, file), picture) in files.iter().zip(&pictures) {
            assert!(
                hasard_media::png::decode(file, Path::new("memory")).unwrap() == *picture,
                "{kind:?}"
            );
        }
    }
    let panel = Panel::of(&stage, "P: pause");
    let whole = with_panel(&alone, &panel);
    assert_eq!(whole.height(), 240 + Panel::HEIGHT);
    assert!((panel.seconds - 40.0 / 35.0).abs() < 1e-9, "{panel:?}");
    if let Some(place) = std::env::var_os("HASARD_KEEP_PICTURES") {
        hasard_media::png::write(&all, &Path::new(&place).join("views.png")).unwrap();
        hasard_media::png::write(&whole, &Path::new(&place).join("panel.png")).unwrap();
    }
}

/// The automap beside a view has the map's proportions; alone it takes the size asked for. Both
/// show the player.
#[test]
fn the_automap_shows_the_player() {
    let mut stage = Stage::new("RemedyRushLevel1-v0", &EnvOptions::default()).unwrap();
    stage.reset(1);
    let size = FrameSize { width: 320, height: 240 };
    let alone = Views::new(&stage, size, &[ViewKind::Automap]).unwrap().draw(&stage);
    assert_eq!((alone.width(), alone.height()), (320, 240));
    let blue = |picture: &hasard_media::Picture| {
        picture.rgb().chunks_exact(3).filter(|pixel| pixel == &[60, 150, 255]).count()
    };
    assert!(blue(&alone) > 10);
    let beside =
        Views::new(&stage, size, &[ViewKind::Colour, ViewKind::Automap]).unwrap().draw(&stage);
    let [west, south, east, north] = stage.env().extent().map(|side| side as usize as isize);
    let expected = 240 * (east - west) / (north - south);
    assert!(
        (beside.width() as isize - 320 - expected - 12).abs() <= 2,
        "{} {expected}",
        beside.width()
    );
}

/// A film has a frame for its first moment, one every so many tics, and the last moment.
#[test]
fn a_film_shows_first_and_last_moments() {
    let path = std::env::temp_dir().join(format!("hasard-film-{}.gif", std::process::id()));
    let file = record("RemedyRushLevel1-v0", &EnvOptions::default(), 6);
    let mut replay = Replay::new(file, Path::new("x"), &EnvOptions::default()).unwrap();
    let size = FrameSize { width: 64, height: 48 };
    let mut film = Film::begin(replay.stage(), &path, size, &[ViewKind::Colour], 5).unwrap();
    loop {
        let more = replay.tic();
        film.tic(replay.stage()).unwrap();
        if !more {
            break;
        }
    }
    let (frames, (width, _)) = film.finish().unwrap();
    assert_eq!((frames, width), (1 + 24 / 5, 64));
    assert_eq!(&std::fs::read(&path).unwrap()[..3], b"GIF");
    std::fs::remove_file(path).unwrap();
}

/// A replay can be looked at from any step on.
#[test]
fn a_replay_skips_to_a_step() {
    let file = record("RemedyRushLevel1-v0", &EnvOptions::default(), 30);
    let mut replay = Replay::new(file.clone(), Path::new("x"), &EnvOptions::default()).unwrap();
    replay.skip_to(12);
    assert_eq!(replay.stage().env().episode().length, 12);
    assert_eq!(fingerprint(replay.stage().world()), fingerprint(replay.stage().env().world()));
    replay.skip_to(u32::MAX);
    assert_eq!(replay.stage().env().episode().length, 30);
    assert_eq!(replay.difference(), None);
}

/// Each part of the picture has the colour of what drew it: status bar below, a thing where a label
/// is, floor beneath and sky above where they are seen.
#[test]
fn phases_are_coloured_by_what_drew_them() {
    let mut stage = Stage::new("RemedyRushLevel1-v0", &EnvOptions::default()).unwrap();
    stage.reset(3);
    let size = FrameSize { width: 320, height: 240 };
    let mut views = Views::new(&stage, size, &[ViewKind::Phase]).unwrap();
    let picture = views.draw(&stage);
    let classes = views.renderer().classes();
    let mut seen = std::collections::BTreeMap::new();
    for y in 0..240 {
        for x in 0..320 {
            *seen.entry(picture.get(x, y)).or_insert(0u32) += 1;
            let thing = classes[y * 320 + x] >= hasard_engine::render::class::FIRST_ACTOR;
            assert_eq!(thing, picture.get(x, y) == [208, 64, 160], "{x} {y}");
        }
    }
    assert_eq!(picture.get(160, 239), [112, 112, 112]);
    for part in [[208, 64, 160], [72, 128, 72], [176, 92, 48], [136, 200, 240]] {
        assert!(seen.get(&part).is_some_and(|count| *count > 50), "{part:?} of {seen:?}");
    }
}
