//! Lanes chosen for a step or a reset live as they would in a batch of their own; memory may be
//! external; errors cost no buffers.

mod echo;

use echo::{Echo, hash};
use hasard_envs::{
    ActionSpace, Autoreset, Batch, Buffer, Env, EnvError, EnvOptions, FrameSize, LaneState,
    Restart, RuleSet, VecEnv, VecOptions,
};

fn make(options: VecOptions) -> VecEnv {
    VecEnv::from_fn(options, |_| Ok(Box::new(Echo::new(u32::MAX)))).unwrap()
}

/// Actions that depend on a step and a lane alone, for the lanes of a batch in their order.
fn act(batch: &mut Batch, worlds: &VecEnv, lanes: &[usize], step: u64) {
    let sizes = worlds.action_space().sizes();
    for (i, lane) in lanes.iter().enumerate() {
        for (part, &size) in sizes.iter().enumerate() {
            batch.actions[i * sizes.len() + part] = (hash((step, lane, part)) % size as u64) as u8;
        }
    }
}

#[test]
fn steps_of_chosen_lanes_equal_steps_of_all() {
    for (threads, autoreset) in
        [(0, Autoreset::SameStep), (2, Autoreset::SameStep), (2, Autoreset::NextStep)]
    {
        let options = VecOptions { lanes: 9, seed: 4, threads, autoreset, ..VecOptions::default() };
        let (mut whole, mut parts) = (make(options), make(options));
        let mut batch = whole.whole_batch();
        whole.reset(&mut batch).unwrap();
        let mut first = parts.whole_batch();
        parts.reset(&mut first).unwrap();
        let all: Vec<usize> = (0..9).collect();
        for step in 0..40 {
            act(&mut batch, &whole, &all, step);
            whole.step(&mut batch).unwrap();
            // Every lane is stepped, but in two calls and in an order of their own.
            for chosen in [&[7, 2, 8][..], &[0, 6, 1, 5, 3, 4]] {
                let mut some = parts.batch_of(chosen.len());
                act(&mut some, &parts, chosen, step);
                parts.step_lanes(chosen, &mut some).unwrap();
                for (i, &lane) in chosen.iter().enumerate() {
                    assert_eq!(
                        some.observations[i * 12..(i + 1) * 12],
                        batch.observations[lane * 12..(lane + 1) * 12]
                    );
                    assert_eq!(
                        (some.rewards[i], some.costs[i]),
                        (batch.rewards[lane], batch.costs[lane])
                    );
                    assert_eq!(
                        (some.terminated[i], some.truncated[i]),
                        (batch.terminated[lane], batch.truncated[lane])
                    );
                    let of_part =
                        some.finals().find(|(at, _)| *at == i).map(|(_, last)| last.to_vec());
                    let of_whole =
                        batch.finals().find(|(at, _)| *at == lane).map(|(_, last)| last.to_vec());
                    assert_eq!(of_part, of_whole);
                }
                let ended = batch.episodes.iter().filter(|episode| chosen.contains(&episode.lane));
                assert!(some.episodes.iter().eq(ended));
            }
            assert_eq!(parts.resting(), whole.resting());
        }
    }
}

#[test]
fn chosen_lanes_must_exist_and_be_named_once() {
    let mut worlds = make(VecOptions { lanes: 3, threads: 2, ..VecOptions::default() });
    let mut batch = worlds.whole_batch();
    worlds.reset(&mut batch).unwrap();
    let mut two = worlds.batch_of(2);
    for wrong in [[0, 3], [1, 1]] {
        assert!(matches!(worlds.step_lanes(&wrong, &mut two), Err(EnvError::Option { .. })));
    }
    assert!(matches!(
        worlds.step_lanes(&[0, 1, 2], &mut two),
        Err(EnvError::Action { lane: 2, .. } | EnvError::BatchSize { .. })
    ));
    two.actions[9] = 9;
    assert!(matches!(worlds.step_lanes(&[0, 2], &mut two), Err(EnvError::Action { lane: 2, .. })));
    let mut none = worlds.batch_of(0);
    worlds.step_lanes(&[], &mut none).unwrap();
}

#[test]
fn restarted_lanes_begin_anew_and_the_others_stay() {
    for threads in [0, 2] {
        let options = VecOptions { lanes: 5, seed: 8, threads, ..VecOptions::default() };
        let (mut worlds, mut undisturbed) = (make(options), make(options));
        let (mut batch, mut other) = (worlds.whole_batch(), undisturbed.whole_batch());
        worlds.reset(&mut batch).unwrap();
        undisturbed.reset(&mut other).unwrap();
        let how =
            [Restart::Stay, Restart::Seed(77), Restart::Next, Restart::Stay, Restart::Seed(77)];
        worlds.restart(&how, &mut batch).unwrap();
        let row =
            |batch: &Batch, lane: usize| batch.observations[lane * 12..(lane + 1) * 12].to_vec();
        assert_eq!((row(&batch, 0), row(&batch, 3)), (row(&other, 0), row(&other, 3)));
        assert_eq!(row(&batch, 1), row(&batch, 4), "an equal seed, wherever the lane stands");
        // A seed stands for the whole stream of episodes: that of lane 0 of a batch of that seed.
        let mut single = make(VecOptions { lanes: 1, seed: 77, threads: 0, ..options });
        let mut one = single.whole_batch();
        for _ in 0..3 {
            single.reset(&mut one).unwrap();
            assert_eq!(row(&batch, 4), row(&one, 0));
            worlds.reset(&mut batch).unwrap();
        }
        assert!(worlds.restart(&how[1..], &mut batch).is_err());
    }
}

#[test]
fn resting_lanes_are_reported_until_they_are_reset() {
    for threads in [0, 2] {
        let autoreset = Autoreset::Disabled;
        let mut worlds =
            make(VecOptions { lanes: 6, seed: 3, threads, autoreset, ..VecOptions::default() });
        let mut batch = worlds.whole_batch();
        worlds.reset(&mut batch).unwrap();
        let mut rests = 0;
        for _ in 0..60 {
            worlds.step(&mut batch).unwrap();
            let ended: Vec<bool> =
                batch.terminated.iter().zip(&batch.truncated).map(|(a, b)| *a || *b).collect();
            assert_eq!(worlds.resting(), ended);
            if ended.iter().filter(|end| **end).count() >= 2 {
                rests += 1;
                let how: Vec<Restart> = ended
                    .iter()
                    .map(|end| if *end { Restart::Next } else { Restart::Stay })
                    .collect();
                worlds.restart(&how, &mut batch).unwrap();
                assert_eq!(worlds.resting(), [false; 6]);
            }
        }
        assert!(rests > 5);
    }
}

#[test]
fn external_memory_is_written_as_owned_memory_is() {
    for threads in [0, 3] {
        let options = VecOptions { lanes: 7, groups: 2, seed: 2, threads, ..VecOptions::default() };
        let (mut worlds, mut twins) = (make(options), make(options));
        let (mut external, mut owned) = (worlds.whole_batch(), twins.whole_batch());
        external.observations = Buffer::external(vec![0; 7 * 12].into_boxed_slice());
        external.rewards = Buffer::external(vec![0.0; 7]);
        external.truncated = Buffer::external(vec![false; 7]);
        let address = external.observations.as_ptr();
        worlds.reset(&mut external).unwrap();
        twins.reset(&mut owned).unwrap();
        for step in 0..30 {
            assert_eq!(external, owned);
            act(&mut external, &worlds, &[0, 1, 2, 3, 4, 5, 6], step);
            owned.actions.clone_from(&external.actions);
            worlds.step(&mut external).unwrap();
            twins.step(&mut owned).unwrap();
        }
        assert_eq!(external.observations.as_ptr(), address, "written in place");
        assert!(external.observations.is_external());
        assert!(!external.clone().observations.is_external());
        external.rewards = Buffer::external(vec![0.0; 6]);
        assert!(matches!(
            worlds.step(&mut external),
            Err(EnvError::BatchSize { field: "rewards", .. })
        ));
    }
}

#[test]
fn errors_and_panics_give_the_batch_back() {
    for threads in [0, 2] {
        let options = VecOptions { lanes: 4, groups: 2, threads, ..VecOptions::default() };
        let fragile =
            |lane| Ok(Box::new(Echo::new(if lane == 3 { 1 } else { u32::MAX })) as Box<_>);
        let mut worlds = VecEnv::from_fn(options, fragile).unwrap();
        let mut marked = worlds.batch(0);
        marked.actions[0] = 9;
        assert!(worlds.send(0, marked.clone()).is_err());
        assert_eq!(worlds.reclaim(0).as_ref(), Some(&marked), "refused for its action");
        assert_eq!(worlds.reclaim(0), None);
        worlds.send_reset(0, worlds.batch(0)).unwrap();
        assert!(matches!(worlds.send_reset(0, marked.clone()), Err(EnvError::Turn { .. })));
        assert_eq!(
            worlds.reclaim(0).as_ref(),
            Some(&marked),
            "refused out of turn, while another is under way"
        );
        assert!(worlds.send(5, marked.clone()).is_err());
        assert_eq!(worlds.reclaim(2).as_ref(), Some(&marked), "refused for its group");
        let batch = worlds.recv(0).unwrap();
        worlds.send(0, batch).unwrap();
        worlds.recv(0).unwrap();
        worlds.send_reset(1, worlds.batch(1)).unwrap();
        let batch = worlds.recv(1).unwrap();
        worlds.send(1, batch).unwrap();
        assert!(matches!(worlds.recv(1), Err(EnvError::Panicked { .. })));
        assert_eq!(worlds.reclaim(1).map(|batch| batch.observations.len()), Some(2 * 12));
        let mut whole = worlds.whole_batch();
        assert!(worlds.step(&mut whole).is_err());
        assert_eq!(whole.observations.len(), 4 * 12);
        let mut worlds = VecEnv::from_fn(VecOptions { groups: 1, ..options }, fragile).unwrap();
        worlds.reset(&mut whole).unwrap();
        assert!(matches!(worlds.step(&mut whole), Err(EnvError::Panicked { .. })));
        assert_eq!(whole.observations.len(), 4 * 12, "after a panic too");
    }
}

#[test]
fn environments_that_are_not_alike_are_refused() {
    let size =
        |width| EnvOptions { size: FrameSize { width, height: 48 }, ..EnvOptions::default() };
    let first = ("RemedyRushLevel1-v0", size(64));
    for (second, what) in [
        (("RemedyRushLevel1-v0", size(80)), "observation shape"),
        (("DetonatorsDilemmaLevel1-v0", size(64)), "action space"),
        (("ArmamentBurdenLevel1-v0", size(64)), "action space"),
        (("VolcanicVentureLevel1-v0", size(64)), "action space"),
    ] {
        let make = |lane| {
            let (id, options) = if lane == 2 { &second } else { &first };
            Ok(Box::new(Env::new(id, options)?) as Box<_>)
        };
        let error = VecEnv::from_fn(VecOptions { lanes: 4, ..VecOptions::default() }, make)
            .err()
            .expect(what);
        assert_eq!(error, EnvError::Unlike { lane: 2, what }, "{error}");
    }
    let nothing = || Echo::in_space(ActionSpace { groups: Vec::new(), deltas: Vec::new() }, 9);
    assert!(matches!(
        VecEnv::from_fn(VecOptions::default(), |_| Ok(Box::new(nothing()))),
        Err(EnvError::Unlike { .. })
    ));
}

#[test]
fn worlds_without_categorical_parts_are_saved_too() {
    let full =
        ActionSpace::of("VolcanicVentureLevel1-v0".parse().unwrap(), RuleSet::Paper, false, true);
    let deltas = || Echo::in_space(ActionSpace { groups: Vec::new(), ..full.clone() }, u32::MAX);
    let options = VecOptions { lanes: 3, seed: 6, threads: 2, ..VecOptions::default() };
    let make = || VecEnv::from_fn(options, |_| Ok(Box::new(deltas()))).unwrap();
    let (mut worlds, mut others) = (make(), make());
    let (mut batch, mut copy) = (worlds.whole_batch(), others.whole_batch());
    worlds.reset(&mut batch).unwrap();
    for step in 0..23 {
        batch
            .deltas
            .iter_mut()
            .enumerate()
            .for_each(|(i, delta)| *delta = (step as f32 + i as f32) / 40.0);
        worlds.step(&mut batch).unwrap();
    }
    // By way of bytes, as a file would hold them.
    let states = LaneState::from_bytes(&LaneState::to_bytes(&worlds.save().unwrap())).unwrap();
    others.restore(states.clone(), &mut copy).unwrap();
    assert_eq!(copy.observations, batch.observations);
    let mut spoiled = states;
    spoiled[1].deltas.push(0.5);
    assert!(matches!(
        others.restore(spoiled.clone(), &mut copy),
        Err(EnvError::Action { lane: 1, .. })
    ));
    *spoiled[1].deltas.last_mut().unwrap() = f32::NAN;
    spoiled[1].deltas.push(0.5);
    assert!(matches!(others.restore(spoiled, &mut copy), Err(EnvError::Action { lane: 1, .. })));
}

#[test]
fn statistics_come_with_every_step() {
    let env = EnvOptions {
        size: FrameSize { width: 64, height: 48 },
        frame_skip: 35,
        ..EnvOptions::default()
    };
    for autoreset in [Autoreset::SameStep, Autoreset::NextStep] {
        let options = VecOptions { lanes: 2, statistics: true, autoreset, ..VecOptions::default() };
        let mut worlds = VecEnv::new("VolcanicVentureLevel1-v0", &env, options).unwrap();
        assert_eq!(worlds.statistics(), ["items", "jumps", "health"]);
        let mut batch = worlds.whole_batch();
        worlds.reset(&mut batch).unwrap();
        assert_eq!((batch.statistics[0], batch.statistics[3]), (0.0, 0.0), "no items yet");
        let (mut ends, mut healths) = (0, Vec::new());
        for _ in 0..130 {
            worlds.step(&mut batch).unwrap();
            healths.push(batch.statistics[2]);
            for episode in &batch.episodes {
                let stats: Vec<f64> = episode.stats.iter().map(|(_, value)| *value).collect();
                assert_eq!(batch.statistics[episode.lane * 3..(episode.lane + 1) * 3], stats);
                ends += 1;
            }
        }
        assert!(ends >= 2);
        assert!(
            healths.iter().any(|health| *health != healths[0]),
            "health goes with every step: {healths:?}"
        );
    }
    let plain = VecEnv::new("VolcanicVentureLevel1-v0", &env, VecOptions::default()).unwrap();
    assert!(plain.whole_batch().statistics.is_empty(), "only who asks for them pays for them");
}

/// Lanes of another level, or with another option that decides what happens, are no moment of these.
#[test]
fn lanes_saved_from_another_environment_are_refused() {
    let size = FrameSize { width: 64, height: 48 };
    let make = |id: &str, more: EnvOptions| {
        let options = VecOptions { lanes: 2, ..VecOptions::default() };
        VecEnv::new(id, &EnvOptions { size, ..more }, options).unwrap()
    };
    let plain = EnvOptions::default;
    let mut worlds = make("RemedyRushLevel1-v0", plain());
    let mut batch = worlds.whole_batch();
    worlds.reset(&mut batch).unwrap();
    let shown = batch.observations.to_vec();
    for (id, options) in [
        ("RemedyRushLevel2-v0", plain()),
        ("VolcanicVentureLevel1-v0", plain()),
        ("RemedyRushLevel1-v0", EnvOptions { rules: RuleSet::Tables, ..plain() }),
        ("RemedyRushLevel1-v0", EnvOptions { hard: true, ..plain() }),
        ("RemedyRushLevel1-v0", EnvOptions { frame_skip: 2, ..plain() }),
    ] {
        let mut other = make(id, options);
        let bytes = LaneState::to_bytes(&other.save().unwrap());
        let refused = worlds.restore(LaneState::from_bytes(&bytes).unwrap(), &mut batch);
        assert!(matches!(refused, Err(EnvError::Saved { .. })), "{id}: {refused:?}");
        assert_eq!(batch.observations[..], shown[..], "{id}");
    }
    let mut alike = make("RemedyRushLevel1-v0", plain());
    worlds.restore(alike.save().unwrap(), &mut batch).unwrap();
}

/// A batch that is stepped at once plays what one plays that was reset first.
#[test]
fn lanes_that_were_never_reset_begin_their_first_episodes() {
    let options = VecOptions { lanes: 3, seed: 11, ..VecOptions::default() };
    let (mut reset, mut straight) = (make(options), make(options));
    let (mut first, mut second) = (reset.whole_batch(), straight.whole_batch());
    reset.reset(&mut first).unwrap();
    for step in 0..5 {
        act(&mut first, &reset, &[0, 1, 2], step);
        act(&mut second, &straight, &[0, 1, 2], step);
        reset.step(&mut first).unwrap();
        straight.step(&mut second).unwrap();
        assert_eq!(first.observations[..], second.observations[..]);
    }
    assert_eq!(reset.save().unwrap(), straight.save().unwrap());
}

/// A picture goes into a buffer of its size alone, of one frame or several.
#[test]
fn observations_need_buffers_of_their_size() {
    let size = FrameSize { width: 64, height: 48 };
    for frame_stack in [1, 2] {
        let options = EnvOptions { size, frame_stack, ..EnvOptions::default() };
        let mut env = Env::new("RemedyRushLevel1-v0", &options).unwrap();
        let length: usize = env.observation_shape().iter().product();
        env.observe(&mut vec![0; length]);
        for wrong in [0, length / 2, length - 1, length + 1, 2 * length] {
            let drawn = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
                env.observe(&mut vec![0; wrong]);
            }));
            assert!(drawn.is_err(), "{frame_stack} frames in {wrong} bytes");
        }
    }
    assert!(matches!(VecEnv::of_envs(&[], VecOptions::default()), Err(EnvError::Option { .. })));
}
