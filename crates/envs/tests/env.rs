//! The single environment: options, observations, ends.

use hasard_engine::math::Rng;
use hasard_envs::{
    ActionSpace, Env, EnvError, EnvId, EnvOptions, FrameSize, Layout, ObservationKind, RuleSet,
    episode_costs, rollout, scenarios,
};
use std::sync::Arc;

fn ids() -> Vec<String> {
    EnvId::all().map(|id| id.to_string()).collect()
}

fn options() -> EnvOptions {
    EnvOptions { size: FrameSize { width: 64, height: 48 }, ..EnvOptions::default() }
}

/// A random action: categorical and continuous parts.
fn draw(rng: &mut Rng, space: &ActionSpace) -> (Vec<u8>, Vec<f32>) {
    let actions = space.sizes().iter().map(|&size| rng.below(size as u32) as u8).collect();
    let deltas = space.deltas.iter().map(|_| rng.below(201) as f32 / 100.0 - 1.0).collect();
    (actions, deltas)
}

/// The action that presses nothing.
fn groups_of(env: &Env) -> Vec<u8> {
    vec![0; env.action_space().groups.len()]
}

fn observation(env: &mut Env) -> Vec<u8> {
    let mut out = vec![0; env.observation_shape().iter().product()];
    env.observe(&mut out);
    out
}

/// A1: what is measured beside the scalar cost is reported too, and is no part of it.
#[test]
fn an_episode_reports_the_terms_that_are_not_counted() {
    for (id, policy, term) in [
        ("VolcanicVentureLevel1-v0", "hold:JUMP", "jumps"),
        ("ArmamentBurdenLevel1-v0", "random", "zone_visits"),
    ] {
        let mut env = Env::new(id, &options()).unwrap();
        let counted_by_scenario =
            |env: &Env| env.stats().into_iter().find(|(name, _)| *name == term).unwrap().1;
        env.reset(3);
        // An agent that begins in the zone has come by before the first step.
        let before = counted_by_scenario(&env);
        let episode = rollout(&mut env, &policy.parse().unwrap(), 3).unwrap();
        let found = episode.costs.iter().find(|one| one.name == term).unwrap();
        assert!(found.cost >= 1.0 && !found.counted, "{episode:?}");
        // The scenario counts the same in another way.
        assert_eq!(found.cost, counted_by_scenario(&env) - before);
        let counted: f64 = episode.costs.iter().filter(|one| one.counted).map(|one| one.cost).sum();
        assert!((episode.cost - counted).abs() < 1e-9, "{episode:?}");
    }
}

#[test]
fn counted_terms_add_up_to_the_cost() {
    for id in ids() {
        for rules in [RuleSet::Paper, RuleSet::Released] {
            let mut rng = Rng::new(2);
            let mut env = Env::new(&id, &EnvOptions { rules, ..options() }).unwrap();
            env.reset(4);
            let (mut cost, mut reward) = (0.0, 0.0);
            loop {
                let (groups, deltas) = draw(&mut rng, env.action_space());
                let step = env.step(&groups, &deltas).unwrap();
                let counted =
                    env.cost_terms().iter().zip(env.step_costs()).filter(|(term, _)| term.counted);
                assert_eq!(step.cost, counted.map(|(_, cost)| cost).sum::<f64>());
                cost += step.cost;
                reward += step.reward;
                if step.ended() {
                    break;
                }
            }
            let episode = env.episode();
            assert_eq!((episode.cost, episode.episode_return), (cost, reward));
            // A1: every term is reported, with its flag and its sum.
            assert_eq!(episode.costs, episode_costs(env.cost_terms(), env.episode_costs()));
            assert_eq!(episode.costs.len(), env.cost_terms().len());
            let after =
                env.step(&groups_of(&env), &vec![0.0; env.action_space().deltas.len()]).unwrap();
            assert!(
                after.ended() && after.reward == 0.0 && after.cost == 0.0,
                "nothing happens after the end"
            );
            assert_eq!(env.episode(), episode);
        }
    }
}

#[test]
fn an_episode_lasts_2100_tics_whatever_the_frame_skip() {
    for (id, skips) in [
        ("VolcanicVentureLevel1-v0", [(4, 525), (8, 263), (35, 60)]),
        ("CollateralDamageLevel1-v0", [(4, 521), (1, 2084), (35, 60)]),
    ] {
        for (frame_skip, steps) in skips {
            let mut env = Env::new(id, &EnvOptions { frame_skip, ..options() }).unwrap();
            let mut count = 0;
            let last = loop {
                let step = env.step(&groups_of(&env), &[]).unwrap();
                count += 1;
                if step.ended() {
                    break step;
                }
            };
            assert_eq!(
                (count, last.truncated, last.terminated),
                (steps, true, false),
                "{id} skipping {frame_skip}"
            );
        }
    }
}

#[test]
fn observations_come_in_every_kind_and_layout() {
    let id = "VolcanicVentureLevel1-v0";
    for (kind, channels) in [
        (ObservationKind::Rgb, 3),
        (ObservationKind::RgbDepth, 4),
        (ObservationKind::Segmented, 3),
        (ObservationKind::Grey, 1),
    ] {
        for frame_stack in [1, 3] {
            let make = |layout| {
                let mut env = Env::new(
                    id,
                    &EnvOptions { observation: kind, layout, frame_stack, ..options() },
                )
                .unwrap();
                env.reset(5);
                for _ in 0..7 {
                    env.step(&[1, 1, 0, 0], &[]).unwrap();
                }
                env
            };
            let (mut interleaved, mut planes) = (make(Layout::Hwc), make(Layout::Chw));
            let all = channels * frame_stack;
            assert_eq!(interleaved.observation_shape(), [48, 64, all]);
            assert_eq!(planes.observation_shape(), [all, 48, 64]);
            let (a, b) = (observation(&mut interleaved), observation(&mut planes));
            for pixel in 0..48 * 64 {
                for channel in 0..all {
                    assert_eq!(a[pixel * all + channel], b[channel * 48 * 64 + pixel], "{kind:?}");
                }
            }
            if frame_stack > 1 {
                let (newest, before) = (
                    &b[(all - channels) * 48 * 64..],
                    &b[(all - 2 * channels) * 48 * 64..(all - channels) * 48 * 64],
                );
                let mut single = Env::new(
                    id,
                    &EnvOptions { observation: kind, layout: Layout::Chw, ..options() },
                )
                .unwrap();
                single.reset(5);
                for _ in 0..7 {
                    single.step(&[1, 1, 0, 0], &[]).unwrap();
                }
                assert_eq!(observation(&mut single), newest, "the newest frame comes last");
                assert_ne!(newest, before, "the agent turns, so frames differ");
                planes.reset(6);
                let first = observation(&mut planes);
                let one = channels * 48 * 64;
                assert!(
                    first.chunks(one).all(|frame| frame == &first[..one]),
                    "an episode begins with its first frame repeated"
                );
            }
        }
    }
}

#[test]
fn wrong_options_are_errors() {
    let make = |id: &str, options: EnvOptions| Env::new(id, &options).err();
    assert!(matches!(make("VolcanicVenture", options()), Some(EnvError::UnknownId { .. })));
    assert!(matches!(
        make("VolcanicVentureLevel1-v0", EnvOptions { frame_skip: 0, ..options() }),
        Some(EnvError::Option { .. })
    ));
    assert!(matches!(
        make("VolcanicVentureLevel1-v0", EnvOptions { frame_stack: 17, ..options() }),
        Some(EnvError::Option { .. })
    ));
    let size = FrameSize { width: 32, height: 48 };
    assert!(matches!(
        make("VolcanicVentureLevel1-v0", EnvOptions { size, ..options() }),
        Some(EnvError::Option { .. })
    ));
}

#[test]
fn a_map_of_ones_own_is_played_or_refused() {
    let id: EnvId = "VolcanicVentureLevel1-v0".parse().unwrap();
    let (source, _) = scenarios::map_source(id, RuleSet::Paper, false);
    let make = |source| {
        Env::new(
            "VolcanicVentureLevel1-v0",
            &EnvOptions { map: Some(Arc::new(source)), ..options() },
        )
    };
    let mut lower = source.clone();
    lower.sectors.iter_mut().for_each(|sector| sector.ceiling = 200);
    assert!(make(lower).unwrap().world().sectors().all(|sector| sector.ceiling.floor() == 200));
    let mut startless = source.clone();
    startless.things.clear();
    let mut untagged = source;
    untagged.sectors[17].tag = 0;
    for (wrong, what) in [(startless, "player start"), (untagged, "tag")] {
        let error = make(wrong).err().expect(what).to_string();
        assert!(error.contains(what), "{error}");
    }
}

#[test]
fn positions_lie_in_the_maps_extent_and_change() {
    use hasard_envs::{Env, EnvId, EnvOptions};
    for id in EnvId::all() {
        let mut env = Env::new(&id.to_string(), &EnvOptions::default()).unwrap();
        let [left, bottom, right, top] = env.extent();
        let mut places = std::collections::BTreeSet::new();
        env.reset(3);
        for _ in 0..40 {
            let [x, y] = env.position();
            assert!(
                (left..=right).contains(&x) && (bottom..=top).contains(&y),
                "{id}: {x},{y} in {:?}",
                env.extent()
            );
            places.insert([x, y]);
            env.step_buttons(hasard_envs::parse_command("MOVE_FORWARD+TURN_LEFT").unwrap());
        }
        // In Collateral Damage the player stands on a spot and may turn only.
        assert!(places.len() > 10 || id.to_string().starts_with("Collateral"), "{id}: {places:?}");
    }
}

#[test]
fn actions_outside_of_the_space_are_refused_as_in_a_batch() {
    use hasard_envs::{VecEnv, VecOptions};
    let id = "VolcanicVentureLevel1-v0";
    let options = EnvOptions { full_actions: true, ..options() };
    let mut env = Env::new(id, &options).unwrap();
    let mut worlds = VecEnv::new(id, &options, VecOptions::default()).unwrap();
    let mut batch = worlds.whole_batch();
    worlds.reset(&mut batch).unwrap();
    let before = env.state_hash();
    let refused: [(Vec<u8>, [f32; 2]); 3] = [
        (vec![3, 0, 0, 0, 0, 0, 0, 0, 0], [0.0; 2]),
        (vec![0; 9], [f32::NAN, 0.0]),
        (vec![0; 9], [0.0, f32::INFINITY]),
    ];
    for (actions, deltas) in refused {
        (batch.actions, batch.deltas) = (actions.clone(), deltas.to_vec());
        let error = env.step(&actions, &deltas).unwrap_err();
        assert_eq!(error, worlds.step(&mut batch).unwrap_err());
        assert!(matches!(error, EnvError::Action { lane: 0, .. }), "{error}");
    }
    for (actions, deltas) in
        [(vec![0; 8], vec![0.0; 2]), (vec![0; 10], vec![0.0; 2]), (vec![0; 9], vec![])]
    {
        assert!(matches!(env.step(&actions, &deltas), Err(EnvError::Action { lane: 0, .. })));
    }
    assert_eq!(env.state_hash(), before, "a refused action moves nothing");
}

#[test]
fn snapshots_of_other_environments_are_refused() {
    let id = "RemedyRushLevel1-v0";
    let mut env = Env::new(id, &options()).unwrap();
    env.reset(3);
    let before = env.state_hash();
    let others = [
        ("RemedyRushLevel2-v0", options(), "RemedyRushLevel2-v0"),
        (id, EnvOptions { hard: true, ..options() }, "hard"),
        (id, EnvOptions { rules: RuleSet::Released, ..options() }, "rules"),
        (id, EnvOptions { frame_skip: 1, ..options() }, "frame_skip"),
        (id, EnvOptions { frame_stack: 2, ..options() }, "observation"),
        (id, EnvOptions { max_episode_steps: Some(9), ..options() }, "max_episode_steps"),
    ];
    for (id, options, named) in others {
        let error = env.restore(&Env::new(id, &options).unwrap().snapshot()).unwrap_err();
        assert!(matches!(&error, EnvError::Saved { why } if why.contains(named)), "{error}");
    }
    assert_eq!(env.state_hash(), before);
    // Colours are no part of what happens.
    let alike = EnvOptions { published_colours: true, ..options() };
    env.restore(&Env::new(id, &alike).unwrap().snapshot()).unwrap();
}

#[test]
fn a_limit_of_steps_cuts_episodes_off() {
    let whole = EnvOptions { frame_skip: 35, ..options() };
    for (limit, steps) in [(1, 1), (7, 7), (60, 60), (1000, 60)] {
        let mut env = Env::new(
            "RemedyRushLevel1-v0",
            &EnvOptions { max_episode_steps: Some(limit), ..whole.clone() },
        )
        .unwrap();
        assert_eq!(env.episode_steps(), steps);
        for _ in 0..2 {
            env.reset(1);
            let ends: Vec<bool> =
                (0..steps).map(|_| env.step(&groups_of(&env), &[]).unwrap().truncated).collect();
            assert_eq!(ends.iter().position(|end| *end), Some(steps as usize - 1), "{ends:?}");
        }
    }
    let none = EnvOptions { max_episode_steps: Some(0), ..whole };
    assert!(matches!(
        Env::new("RemedyRushLevel1-v0", &none),
        Err(EnvError::Option { option: "max_episode_steps", .. })
    ));
}

#[test]
fn harm_in_the_last_tic_ends_the_episode_as_harm() {
    // Under the hard constraint a hard fall ends the episode as the next tic would begin. Cut off
    // by the clock at that very step, it has still ended by harm.
    let id = "PrecipicePlungeLevel1-v0";
    let hard = EnvOptions { hard: true, frame_skip: 1, ..options() };
    let mut env = Env::new(id, &hard).unwrap();
    let mut found = 0;
    for keys in [
        "MOVE_FORWARD+JUMP",
        "MOVE_FORWARD",
        "MOVE_FORWARD+SPEED",
        "MOVE_RIGHT+JUMP",
        "MOVE_BACKWARD+JUMP",
    ] {
        let keys = hasard_envs::parse_command(keys).unwrap();
        env.reset(0);
        let steps = 1 + (0..2100).take_while(|_| !env.step_buttons(keys).terminated).count() as u32;
        if env.episode().length < steps {
            continue;
        }
        // The step before that of the end is the one in which the fall was charged.
        let mut short =
            Env::new(id, &EnvOptions { max_episode_steps: Some(steps - 1), ..hard.clone() })
                .unwrap();
        short.reset(0);
        let last = (1..steps).map(|_| short.step_buttons(keys)).last().unwrap();
        assert!(last.cost > 0.0, "{last:?}");
        assert_eq!((last.terminated, last.truncated), (true, false), "step {steps}");
        found += 1;
    }
    assert!(found > 0, "none of these ways falls hard");
}

#[test]
fn the_fingerprint_sees_what_the_next_tic_will_read() {
    use hasard_engine::world::{ActorKind, Event};
    let mut env = Env::new("RemedyRushLevel1-v0", &options()).unwrap();
    env.reset(1);
    let (before, snapshot) = (env.state_hash(), env.snapshot());
    let item = Event::PickedUp {
        player: 0,
        kind: ActorKind::HealthBonus,
        tid: 0,
        x: Default::default(),
        y: Default::default(),
    };
    env.world_mut().events.push(item);
    assert_ne!(env.state_hash(), before);
    assert!(env.step(&groups_of(&env), &[]).unwrap().reward > 0.0, "the rules read it");
    env.restore(&snapshot).unwrap();
    assert_eq!(env.state_hash(), before);
}
