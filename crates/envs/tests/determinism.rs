//! The same seed and actions give the same bits, however the worlds are stepped; other seeds and
//! lanes give other episodes; a moment restored goes on as it would have.
//!
//! Long because each way of stepping is compared with the plain one.

use hasard_engine::math::Rng;
use hasard_engine::world::Fingerprint;
use hasard_envs::{
    ActionSpace, Autoreset, Batch, CostTerm, Env, EnvId, EnvOptions, Environment, Episode,
    FinalObservations, FrameSize, RuleSet, Step, VecEnv, VecOptions,
};
use std::collections::BTreeSet;
use std::hash::Hasher;

/// Bytes of the state's fingerprint, which goes before the picture in a batch's observation.
const STATE: usize = 8;

/// An environment whose observation begins with the fingerprint of its state, so that a batch shows
/// that too.
struct Telltale(Env);

impl Environment for Telltale {
    fn action_space(&self) -> &ActionSpace {
        self.0.action_space()
    }
    fn observation_shape(&self) -> [usize; 3] {
        [1, 1, STATE + self.0.observation_shape().iter().product::<usize>()]
    }
    fn cost_terms(&self) -> &'static [CostTerm] {
        self.0.cost_terms()
    }
    fn reset(&mut self, seed: u64) {
        self.0.reset(seed);
    }
    fn step(&mut self, actions: &[u8], deltas: &[f32]) -> Step {
        Environment::step(&mut self.0, actions, deltas)
    }
    fn step_costs(&self) -> &[f64] {
        self.0.step_costs()
    }
    fn observe(&mut self, out: &mut [u8]) {
        let (state, picture) = out.split_at_mut(STATE);
        state.copy_from_slice(&self.0.state_hash().to_le_bytes());
        self.0.observe(picture);
    }
    fn position(&self) -> [i32; 2] {
        self.0.position()
    }
    fn episode(&self) -> Episode {
        self.0.episode()
    }
}

/// What one lane shows after one step, part by part; the parts' names are for messages.
type Moment = [u64; 5];
const PARTS: [&str; 5] = ["state", "frame", "rewards and ends", "costs", "ended episode"];

fn fingerprint(bytes: &[u8]) -> u64 {
    let mut hasher = Fingerprint::default();
    hasher.write(bytes);
    hasher.finish()
}

/// Notes what each of a batch's lanes shows.
fn note(lives: &mut [Vec<Moment>], first: usize, batch: &Batch) {
    let count = batch.lanes();
    let (size, terms) = (batch.observations.len() / count, batch.cost_terms.len() / count);
    for i in 0..count {
        let (state, picture) = batch.observations[i * size..(i + 1) * size].split_at(STATE);
        let mut paid = batch.rewards[i].to_le_bytes().to_vec();
        paid.extend([u8::from(batch.terminated[i]), u8::from(batch.truncated[i])]);
        paid.extend(batch.positions[i].iter().flat_map(|side| side.to_le_bytes()));
        let mut charged = batch.costs[i].to_le_bytes().to_vec();
        charged.extend(
            batch.cost_terms[i * terms..(i + 1) * terms].iter().flat_map(|cost| cost.to_le_bytes()),
        );
        // The episode as its text, all fields; its last frame after it.
        let episode = batch.episodes.iter().find(|episode| episode.lane == first + i);
        let mut ended = episode.map_or(Vec::new(), |episode| format!("{episode:?}").into_bytes());
        let last = batch.finals().find(|(lane, _)| *lane == i);
        ended.extend(last.map_or(&[][..], |(_, last)| last));
        let state = u64::from_le_bytes(state.try_into().unwrap());
        lives[first + i].push([
            state,
            fingerprint(picture),
            fingerprint(&paid),
            fingerprint(&charged),
            fingerprint(&ended),
        ]);
    }
}

/// A random action held for four steps, drawn anew from the lane and the step alone.
fn act(batch: &mut Batch, space: &ActionSpace, first: usize, step: usize) {
    let (parts, continuous) = (space.groups.len(), space.deltas.len());
    for i in 0..batch.rewards.len() {
        let mut rng = Rng::for_lane(step as u64 / 4, (first + i) as u64);
        for (action, size) in
            batch.actions[i * parts..(i + 1) * parts].iter_mut().zip(space.sizes())
        {
            *action = rng.below(size as u32) as u8;
        }
        for delta in &mut batch.deltas[i * continuous..(i + 1) * continuous] {
            *delta = rng.between(-128, 128) as f32 / 128.0;
        }
    }
}

fn make(id: &str, env: &EnvOptions, options: VecOptions) -> VecEnv {
    let first = Env::new(id, env).unwrap();
    VecEnv::from_fn(options, |_| Ok(Box::new(Telltale(first.sibling())))).unwrap()
}

/// The lives of all lanes, stepped together.
fn together(id: &str, env: &EnvOptions, options: VecOptions, steps: usize) -> Vec<Vec<Moment>> {
    let mut worlds = make(id, env, options);
    let mut lives = vec![Vec::new(); options.lanes];
    let mut batch = worlds.whole_batch();
    worlds.reset(&mut batch).unwrap();
    for step in 0..steps {
        note(&mut lives, 0, &batch);
        act(&mut batch, &worlds.action_space().clone(), 0, step);
        worlds.step(&mut batch).unwrap();
    }
    note(&mut lives, 0, &batch);
    lives
}

/// The lives of all lanes, each group sent and received by itself, the others under way meanwhile.
fn by_groups(id: &str, env: &EnvOptions, options: VecOptions, steps: usize) -> Vec<Vec<Moment>> {
    let mut worlds = make(id, env, options);
    let space = worlds.action_space().clone();
    let mut lives = vec![Vec::new(); options.lanes];
    for group in 0..options.groups {
        let batch = worlds.batch(group);
        worlds.send_reset(group, batch).unwrap();
    }
    for step in 0..=steps {
        for group in 0..options.groups {
            let mut batch = worlds.recv(group).unwrap();
            let first = worlds.group_lanes(group).start;
            note(&mut lives, first, &batch);
            if step < steps {
                act(&mut batch, &space, first, step);
                worlds.send(group, batch).unwrap();
            }
        }
    }
    lives
}

/// Names the first step, lane and part where two ways of stepping differ.
fn assert_same(found: &[Vec<Moment>], expected: &[Vec<Moment>], what: &str) {
    for step in 0..expected[0].len() {
        for (lane, (found, expected)) in found.iter().zip(expected).enumerate() {
            for part in 0..PARTS.len() {
                assert_eq!(
                    found[step][part], expected[step][part],
                    "{what}: lane {lane}, step {step}: {}",
                    PARTS[part]
                );
            }
        }
    }
}

fn small() -> EnvOptions {
    EnvOptions { size: FrameSize { width: 64, height: 48 }, ..EnvOptions::default() }
}

#[test]
fn threads_width_and_way_of_stepping_change_nothing() {
    for (index, id) in EnvId::all().enumerate() {
        let id = id.to_string();
        // Both constraints and both action spaces take their turns over the levels of each
        // scenario.
        let env = EnvOptions { hard: index % 2 == 1, full_actions: index % 3 == 1, ..small() };
        let options = VecOptions {
            seed: 21,
            final_observations: FinalObservations::Every,
            ..VecOptions::default()
        };
        let expected = together(&id, &env, VecOptions { lanes: 32, ..options }, 16);
        for threads in 1..=3 {
            for lanes in [1, 7, 32] {
                let options = VecOptions { lanes, threads, ..options };
                let what = format!("{id}, {lanes} lanes, {threads} threads");
                assert_same(
                    &together(&id, &env, options, 16),
                    &expected,
                    &format!("{what}, stepped together"),
                );
                let groups = lanes.min(2);
                let found = by_groups(&id, &env, VecOptions { groups, ..options }, 16);
                assert_same(
                    &found,
                    &expected,
                    &format!("{what}, {groups} groups sent and received"),
                );
            }
        }
    }
}

#[test]
fn ends_and_new_episodes_are_the_same_in_every_batch() {
    for id in EnvId::all().filter(|id| id.level == 1) {
        let id = id.to_string();
        // Held for a second each, an episode is over after 60 actions.
        let env = EnvOptions { frame_skip: 35, ..small() };
        for autoreset in [Autoreset::SameStep, Autoreset::NextStep] {
            let final_observations = FinalObservations::Every;
            let options = VecOptions {
                lanes: 4,
                seed: 5,
                autoreset,
                final_observations,
                ..VecOptions::default()
            };
            let expected = together(&id, &env, options, 70);
            let ends =
                expected.iter().flatten().filter(|moment| moment[4] != fingerprint(&[])).count();
            assert!(ends >= 4, "{id}: every lane's episode ends");
            let found = by_groups(&id, &env, VecOptions { threads: 3, groups: 2, ..options }, 70);
            assert_same(&found, &expected, &format!("{id}, {autoreset:?}"));
        }
    }
}

#[test]
fn a_saved_batch_of_real_worlds_goes_on_as_before() {
    for id in EnvId::all().filter(|id| id.level == 2) {
        let id = id.to_string();
        let env = EnvOptions { full_actions: true, ..small() };
        let options = VecOptions { lanes: 5, threads: 2, seed: 13, ..VecOptions::default() };
        let (mut worlds, mut others) = (
            make(&id, &env, options),
            make(&id, &env, VecOptions { seed: 99, threads: 0, ..options }),
        );
        let space = worlds.action_space().clone();
        let mut batch = worlds.whole_batch();
        worlds.reset(&mut batch).unwrap();
        for step in 0..30 {
            act(&mut batch, &space, 0, step);
            worlds.step(&mut batch).unwrap();
        }
        let mut copy = others.whole_batch();
        others.restore(worlds.save().unwrap(), &mut copy).unwrap();
        assert_eq!(copy.observations, batch.observations, "{id}");
        for step in 30..60 {
            act(&mut batch, &space, 0, step);
            act(&mut copy, &space, 0, step);
            worlds.step(&mut batch).unwrap();
            others.step(&mut copy).unwrap();
            assert!(copy == batch, "{id}: step {step}");
        }
    }
}

/// Whether seeds change what is seen. Level 1 of Precipice Plunge is a fixed stair, in the original
/// too: only the random stream of its worlds differs, and nothing there draws from it.
fn varies(id: EnvId) -> bool {
    id != "PrecipicePlungeLevel1-v0".parse().unwrap()
}

/// What an episode of a seed shows when the same keys are pressed whatever is seen: pictures,
/// rewards, costs, positions.
fn outlook(env: &mut Env, seed: u64) -> u64 {
    env.reset(seed);
    let mut hasher = Fingerprint::default();
    let mut frame = vec![0; env.observation_shape().iter().product()];
    for (step, keys) in ["MOVE_FORWARD", "MOVE_FORWARD+TURN_LEFT", "ATTACK", "TURN_LEFT"]
        .iter()
        .cycle()
        .take(60)
        .enumerate()
    {
        let paid = env.step_buttons(hasard_envs::parse_command(keys).unwrap());
        hasher.write_u64(paid.reward.to_bits());
        hasher.write_u64(paid.cost.to_bits());
        if step % 6 == 5 {
            env.observe(&mut frame);
            // The face in the status bar, below row 40, glances about by chance everywhere.
            hasher.write(&frame[..64 * 40 * 3]);
        }
    }
    hasher.finish()
}

#[test]
fn other_seeds_give_other_episodes_and_equal_seeds_equal_ones() {
    for id in EnvId::all() {
        for (rules, hard) in
            [(RuleSet::Paper, false), (RuleSet::Paper, true), (RuleSet::Released, false)]
        {
            let mut env =
                Env::new(&id.to_string(), &EnvOptions { rules, hard, ..small() }).unwrap();
            let seeds = [0, 1, 2, 3, u64::MAX, 1 << 32, 1 << 63, 12_345_678_901_234_567];
            let outlooks = seeds.map(|seed| outlook(&mut env, seed));
            let distinct: BTreeSet<u64> = outlooks.into_iter().collect();
            let different = if varies(id) { seeds.len() } else { 1 };
            assert_eq!(
                distinct.len(),
                different,
                "{id}, {rules:?}, hard {hard}: different episodes of {} seeds",
                seeds.len()
            );
            let mut other =
                Env::new(&id.to_string(), &EnvOptions { rules, hard, ..small() }).unwrap();
            assert_eq!(
                outlook(&mut other, 3),
                outlooks[3],
                "{id}: an equal seed in another instance"
            );
        }
    }
}

#[test]
fn lanes_and_successive_episodes_differ_under_equal_actions() {
    for id in EnvId::all() {
        let options = VecOptions { lanes: 8, seed: 4, ..VecOptions::default() };
        let mut worlds = make(&id.to_string(), &small(), options);
        let (mut batch, space) = (worlds.whole_batch(), worlds.action_space().clone());
        let (mut lives, mut states) = (BTreeSet::new(), BTreeSet::new());
        for episode in 0..3 {
            worlds.reset(&mut batch).unwrap();
            let mut pictures = vec![Vec::new(); options.lanes];
            for step in 0..40 {
                act(&mut batch, &space, 0, step);
                let parts = space.groups.len();
                let (same, others) = batch.actions.split_at_mut(parts);
                others.chunks_exact_mut(parts).for_each(|actions| actions.copy_from_slice(same));
                worlds.step(&mut batch).unwrap();
                let size = batch.observations.len() / options.lanes;
                for (lane, shown) in pictures.iter_mut().zip(batch.observations.chunks_exact(size))
                {
                    let (state, picture) = shown.split_at(STATE);
                    lane.push(fingerprint(picture));
                    assert!(states.insert(state.to_vec()), "{id}: a state came twice");
                }
            }
            for (lane, life) in pictures.into_iter().enumerate() {
                let new = lives.insert(life) || !varies(id);
                assert!(new, "{id}: lane {lane}, episode {episode} looks like one before");
            }
        }
    }
}

/// A random action for a tic or more.
fn draw(rng: &mut Rng, space: &ActionSpace) -> (Vec<u8>, Vec<f32>) {
    let actions = space.sizes().iter().map(|&size| rng.below(size as u32) as u8).collect();
    let deltas = space.deltas.iter().map(|_| rng.between(-128, 128) as f32 / 128.0).collect();
    (actions, deltas)
}

/// Everything that an environment shows, to compare.
fn whole(env: &mut Env, frame: &mut [u8]) -> (u64, u64, Vec<u64>, Vec<u64>, Episode) {
    env.observe(frame);
    let bits = |costs: &[f64]| costs.iter().map(|cost| cost.to_bits()).collect();
    (
        env.state_hash(),
        fingerprint(frame),
        bits(env.step_costs()),
        bits(env.episode_costs()),
        env.episode(),
    )
}

#[test]
fn a_restored_moment_goes_on_as_before() {
    let mut rng = Rng::new(3);
    for id in EnvId::all() {
        for variant in 0..8 {
            let (hard, full_actions, released) =
                (variant & 1 != 0, variant & 2 != 0, variant & 4 != 0);
            let rules = if released { RuleSet::Released } else { RuleSet::Paper };
            // One tic a step: the moment may be any tic. Now and then several frames are
            // remembered.
            let frame_stack = 1 + usize::from(rng.below(4) == 0);
            let options =
                EnvOptions { rules, hard, full_actions, frame_skip: 1, frame_stack, ..small() };
            let mut env = Env::new(&id.to_string(), &options).unwrap();
            // The moment is brought into a sibling in the midst of another episode, into an
            // environment made anew, and back into the one that it was taken from.
            let mut others = [env.sibling(), Env::new(&id.to_string(), &options).unwrap()];
            let space = env.action_space().clone();
            let mut frame = vec![0; env.observation_shape().iter().product()];
            env.reset(u64::from(rng.below(1 << 20)));
            let at = rng.below(500);
            let mut held = draw(&mut rng, &space);
            for tic in 0..at {
                if tic % 8 == 0 {
                    held = draw(&mut rng, &space);
                }
                env.step(&held.0, &held.1).unwrap();
            }
            let what = format!("{id}, {options:?}, snapshot at tic {at}");
            let snapshot = env.snapshot();
            let actions: Vec<_> = (0..15).map(|_| draw(&mut rng, &space)).collect();
            let mut go_on = |env: &mut Env| {
                let mut shown = vec![(Step::default(), whole(env, &mut frame))];
                for (actions, deltas) in actions.iter().flat_map(|action| [action; 8]) {
                    shown.push((env.step(actions, deltas).unwrap(), whole(env, &mut frame)));
                }
                shown
            };
            let expected = go_on(&mut env);
            for _ in 0..rng.below(100) {
                others[0].step(&held.0, &held.1).unwrap();
            }
            for (which, other) in others.iter_mut().chain([&mut env]).enumerate() {
                other.restore(&snapshot).unwrap();
                for (tic, (found, expected)) in go_on(other).iter().zip(&expected).enumerate() {
                    assert_eq!(found, expected, "{what}, copy {which}, {tic} tics after");
                }
            }
        }
    }
}
