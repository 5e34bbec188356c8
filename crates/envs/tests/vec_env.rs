//! The batch of worlds gives each lane the same life, however it is stepped.

mod echo;

use echo::{Echo, hash};
use hasard_envs::{Autoreset, Batch, EnvError, Episode, FinalObservations, VecEnv, VecOptions};

fn make(options: VecOptions) -> VecEnv {
    VecEnv::from_fn(options, |_| Ok(Box::new(Echo::new(u32::MAX)))).unwrap()
}

/// Actions that depend on the step and the lane alone.
fn act(batch: &mut Batch, worlds: &VecEnv, group: usize, step: u64) {
    let sizes = worlds.action_space().sizes();
    for (i, lane) in worlds.group_lanes(group).enumerate() {
        for (part, &size) in sizes.iter().enumerate() {
            batch.actions[i * sizes.len() + part] = (hash((step, lane, part)) % size as u64) as u8;
        }
        for part in 0..2 {
            batch.deltas[i * 2 + part] =
                (hash((step, lane, part, "delta")) % 201) as f32 / 100.0 - 1.0;
        }
    }
}

/// What a lane lived through, step by step.
type Life = Vec<(Vec<u8>, u32, u32, bool, bool, Option<Vec<u8>>, Option<Episode>)>;

fn note(lives: &mut [Life], worlds: &VecEnv, group: usize, batch: &Batch) {
    let range = worlds.group_lanes(group);
    for (i, lane) in range.clone().enumerate() {
        let last = batch.finals().find(|(l, _)| *l == i).map(|(_, o)| o.to_vec());
        lives[lane].push((
            batch.observations[i * 12..(i + 1) * 12].to_vec(),
            batch.rewards[i].to_bits(),
            batch.costs[i].to_bits(),
            batch.terminated[i],
            batch.truncated[i],
            last,
            batch.episodes.iter().find(|e| e.lane == lane).cloned(),
        ));
    }
    assert!(batch.episodes.is_sorted_by_key(|e| e.lane));
    assert_eq!(batch.cost_terms, batch.costs);
    // This world stands where its last step's cost and reward say, also when the step ended an
    // episode.
    for ((position, cost), reward) in batch.positions.iter().zip(&batch.costs).zip(&batch.rewards) {
        // An ended world that waits brings nothing and stays where it is.
        if *cost != 0.0 || *reward != 0.0 {
            assert_eq!(*position, [*cost as i32, *reward as i32]);
        }
    }
}

fn lives_by_step(options: VecOptions, steps: u64) -> Vec<Life> {
    let mut worlds = make(options);
    let mut lives = vec![Life::new(); options.lanes];
    let mut batch = worlds.whole_batch();
    worlds.reset(&mut batch).unwrap();
    for step in 0..steps {
        note(&mut lives, &worlds, options.groups, &batch);
        act(&mut batch, &worlds, options.groups, step);
        worlds.step(&mut batch).unwrap();
    }
    lives
}

fn lives_by_halves(options: VecOptions, steps: u64) -> Vec<Life> {
    let mut worlds = make(options);
    let mut lives = vec![Life::new(); options.lanes];
    for group in 0..options.groups {
        let batch = worlds.batch(group);
        worlds.send_reset(group, batch).unwrap();
    }
    for step in 0..=steps {
        for group in 0..options.groups {
            let mut batch = worlds.recv(group).unwrap();
            if step < steps {
                note(&mut lives, &worlds, group, &batch);
                act(&mut batch, &worlds, group, step);
                worlds.send(group, batch).unwrap();
            }
        }
    }
    lives
}

#[test]
fn threads_width_and_halves_change_nothing() {
    for autoreset in [Autoreset::SameStep, Autoreset::NextStep, Autoreset::Disabled] {
        let options = VecOptions { lanes: 32, seed: 5, autoreset, ..VecOptions::default() };
        let expected = lives_by_step(options, 60);
        for (lanes, threads, groups) in [
            (32, 1, 1),
            (32, 2, 1),
            (32, 3, 2),
            (7, 2, 1),
            (7, 3, 3),
            (1, 2, 1),
            (1, 0, 1),
            (5, 8, 2),
        ] {
            let options = VecOptions { lanes, threads, groups, ..options };
            assert!(lives_by_step(options, 60) == expected[..lanes], "{options:?} by step");
            assert!(lives_by_halves(options, 60) == expected[..lanes], "{options:?} by halves");
        }
    }
}

#[test]
fn seeds_lanes_and_episodes_differ() {
    let options = VecOptions { lanes: 16, seed: 1, ..VecOptions::default() };
    let (one, other) =
        (lives_by_step(options, 40), lives_by_step(VecOptions { seed: 2, ..options }, 40));
    let mut seeds = std::collections::BTreeSet::new();
    for life in one.iter().chain(&other) {
        let episodes: Vec<&Episode> = life.iter().filter_map(|row| row.6.as_ref()).collect();
        assert!(!episodes.is_empty());
        for episode in episodes {
            assert!(seeds.insert(episode.seed), "seed {} came twice", episode.seed);
        }
    }
}

#[test]
fn a_batch_that_begins_at_a_lane_lives_that_lanes_life() {
    let options = VecOptions { lanes: 8, seed: 9, ..VecOptions::default() };
    let mut whole = make(options);
    let mut part = make(VecOptions { lanes: 3, first_lane: 4, threads: 2, ..options });
    let (mut a, mut b) = (whole.whole_batch(), part.whole_batch());
    whole.reset(&mut a).unwrap();
    part.reset(&mut b).unwrap();
    for _ in 0..40 {
        assert_eq!(a.observations[4 * 12..7 * 12], b.observations[..]);
        assert_eq!(a.truncated[4..7], b.truncated[..]);
        whole.step(&mut a).unwrap();
        part.step(&mut b).unwrap();
    }
}

#[test]
fn last_observations_are_kept_and_are_not_the_next_first() {
    let options = VecOptions { lanes: 16, seed: 3, threads: 2, ..VecOptions::default() };
    for keep in [FinalObservations::Truncated, FinalObservations::Every] {
        let lives = lives_by_step(VecOptions { final_observations: keep, ..options }, 60);
        let ends: Vec<_> = lives.iter().flatten().filter(|row| row.3 || row.4).collect();
        assert!(ends.iter().any(|row| row.3) && ends.iter().any(|row| row.4));
        for row in ends {
            assert_eq!(row.5.is_some(), row.4 || keep == FinalObservations::Every);
            assert_ne!(row.5.as_ref(), Some(&row.0));
        }
    }
}

#[test]
fn modes_treat_the_step_after_the_end_as_they_say() {
    let options = VecOptions { lanes: 8, seed: 3, ..VecOptions::default() };
    for life in lives_by_step(VecOptions { autoreset: Autoreset::NextStep, ..options }, 60) {
        for pair in life.windows(2).filter(|pair| pair[0].3 || pair[0].4) {
            assert_eq!((pair[1].1, pair[1].2, pair[1].3, pair[1].4), (0, 0, false, false));
        }
    }
    for life in lives_by_step(VecOptions { autoreset: Autoreset::Disabled, ..options }, 60) {
        for pair in life.windows(2).filter(|pair| pair[0].3 || pair[0].4) {
            assert_eq!((pair[1].1, pair[1].3, pair[1].4), (0, pair[0].3, pair[0].4));
            assert_eq!(pair[0].0, pair[1].0);
        }
    }
}

#[test]
fn a_saved_batch_continues_exactly() {
    for threads in [0, 2] {
        for autoreset in [Autoreset::SameStep, Autoreset::NextStep] {
            let options = VecOptions {
                lanes: 9,
                groups: 2,
                seed: 11,
                threads,
                autoreset,
                ..VecOptions::default()
            };
            let mut worlds = make(options);
            let mut batch = worlds.whole_batch();
            worlds.reset(&mut batch).unwrap();
            for step in 0..23 {
                act(&mut batch, &worlds, 2, step);
                worlds.step(&mut batch).unwrap();
            }
            let states = worlds.save().unwrap();
            let mut other = make(VecOptions { seed: 99, threads: 3, ..options });
            let mut copy = other.whole_batch();
            other.restore(states, &mut copy).unwrap();
            assert_eq!(copy.observations, batch.observations);
            for step in 23..60 {
                act(&mut batch, &worlds, 2, step);
                act(&mut copy, &worlds, 2, step);
                worlds.step(&mut batch).unwrap();
                other.step(&mut copy).unwrap();
                assert_eq!(copy, batch, "step {step}");
            }
        }
    }
}

#[test]
fn reseeding_starts_the_seeds_anew() {
    let mut worlds = make(VecOptions { lanes: 4, seed: 1, threads: 2, ..VecOptions::default() });
    let mut first = worlds.whole_batch();
    worlds.reset(&mut first).unwrap();
    let mut second = worlds.whole_batch();
    worlds.reset(&mut second).unwrap();
    assert_ne!(first.observations, second.observations);
    worlds.seed(1).unwrap();
    worlds.reset(&mut second).unwrap();
    assert_eq!(first.observations, second.observations);
}

#[test]
fn wrong_use_is_an_error_not_a_panic() {
    let options = VecOptions { lanes: 4, groups: 2, ..VecOptions::default() };
    for threads in [0, 2] {
        let mut worlds = make(VecOptions { threads, ..options });
        let batch = worlds.batch(0);
        assert!(matches!(worlds.recv(0), Err(EnvError::Turn { .. })), "nothing was sent");
        worlds.send_reset(0, batch.clone()).unwrap();
        assert!(matches!(worlds.send(0, batch.clone()), Err(EnvError::Turn { .. })), "sent twice");
        let mut whole = worlds.whole_batch();
        assert!(
            matches!(worlds.step(&mut whole), Err(EnvError::Turn { .. })),
            "a group is under way"
        );
        assert_eq!(whole.rewards.len(), 4, "the batch is not lost");
        worlds.recv(0).unwrap();
        let mut wrong = batch.clone();
        wrong.rewards.to_mut().pop();
        assert!(matches!(worlds.send(0, wrong), Err(EnvError::BatchSize { field: "rewards", .. })));
        let mut wrong = batch.clone();
        wrong.actions[0] = 3;
        assert!(matches!(worlds.send(0, wrong), Err(EnvError::Action { lane: 0, .. })));
        assert!(matches!(worlds.recv(2), Err(EnvError::Option { .. })));
    }
    assert!(
        VecEnv::from_fn(VecOptions { lanes: 0, ..options }, |_| Ok(Box::new(Echo::new(9))))
            .is_err()
    );
    assert!(
        VecEnv::from_fn(VecOptions { groups: 5, ..options }, |_| Ok(Box::new(Echo::new(9))))
            .is_err()
    );
}

#[test]
fn a_panicking_environment_is_reported_and_does_not_hang() {
    for threads in [0, 2] {
        let options = VecOptions { lanes: 4, threads, ..VecOptions::default() };
        let mut worlds = VecEnv::from_fn(options, |lane| {
            Ok(Box::new(Echo::new(if lane == 3 { 2 } else { u32::MAX })))
        })
        .unwrap();
        let mut batch = worlds.whole_batch();
        worlds.reset(&mut batch).unwrap();
        worlds.step(&mut batch).unwrap();
        let error = worlds.step(&mut batch).unwrap_err();
        assert!(
            matches!(&error, EnvError::Panicked { message } if message.contains("asked to panic")),
            "{error}"
        );
        let mut batch = worlds.whole_batch();
        assert!(matches!(worlds.reset(&mut batch), Err(EnvError::Panicked { .. })));
    }
}

/// A1: a term that an episode does not report would pass for one that cost nothing.
#[test]
fn an_episode_that_does_not_report_every_cost_term_is_an_error() {
    for threads in [0, 2] {
        let options = VecOptions { lanes: 2, threads, ..VecOptions::default() };
        let make = |_| {
            let mut world = Echo::new(u32::MAX);
            world.reports_costs = false;
            Ok(Box::new(world) as Box<dyn hasard_envs::Environment>)
        };
        let mut worlds = VecEnv::from_fn(options, make).unwrap();
        let mut batch = worlds.whole_batch();
        worlds.reset(&mut batch).unwrap();
        // Its episodes have 18 steps at most.
        let error = (0..18).find_map(|_| worlds.step(&mut batch).err()).unwrap();
        assert!(
            matches!(&error, EnvError::Panicked { message } if message.contains("cost term")),
            "{error}"
        );
    }
}
