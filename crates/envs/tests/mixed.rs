//! Batches of different tasks: each lane plays what it would play alone.

use hasard_envs::{ActionSpace, Batch, EnvOptions, LaneState, VecEnv, VecOptions, own};

const FILE: &str = r#"
[scenario]
name = "MixedYard"
budget = 2
actions = [["TURN_RIGHT"], ["MOVE_BACKWARD", "MOVE_FORWARD"]]
[map]
ascii = """
#####
#.@.#
#...#
#####"""
[[spawn]]
kind = "HealthBonus"
count = 3
respawn = 0
[[when]]
event = "pickup"
of = "HealthBonus"
reward = 1.0
cost.greed = 0.5
count = "vials"
"#;

const IDS: [&str; 3] = ["RemedyRushLevel1-v0", "CollateralDamageLevel1-v0", "MixedYard-v0"];

fn options(lanes: usize, threads: usize) -> VecOptions {
    VecOptions { lanes, threads, statistics: true, ..VecOptions::default() }
}

fn make(ids: &str, lanes: usize, threads: usize, full: bool) -> VecEnv {
    own::register("mixed_yard.toml", FILE).unwrap();
    let env_options = EnvOptions { full_actions: full, ..EnvOptions::default() };
    VecEnv::new(ids, &env_options, options(lanes, threads)).unwrap()
}

/// Choices that follow from a step and a lane.
fn choose(space: &ActionSpace, step: usize, lane: usize) -> (Vec<u8>, Vec<f32>) {
    let draw = |place: usize| (step * 7 + lane * 13 + place * 5 + step * step / 3) as u32;
    let sizes = space.sizes();
    let actions = sizes.iter().enumerate().map(|(i, &size)| (draw(i) % size as u32) as u8);
    let deltas = (0..space.deltas.len()).map(|i| (draw(i + 9) % 21) as f32 / 10.0 - 1.0);
    (actions.collect(), deltas.collect())
}

/// The action of `own` that presses the buttons of an action of `space` which `own` has.
fn translated(space: &ActionSpace, own: &ActionSpace, actions: &[u8]) -> Vec<u8> {
    let mut pressed = Vec::new();
    for (group, &choice) in space.groups.iter().zip(actions) {
        pressed.extend(usize::from(choice).checked_sub(1).map(|i| group.buttons[i].0));
    }
    let choice = |buttons: &[(&str, _)]| {
        buttons.iter().position(|(name, _)| pressed.contains(name)).map_or(0, |i| i as u8 + 1)
    };
    own.groups.iter().map(|group| choice(&group.buttons)).collect()
}

fn fill(worlds: &VecEnv, batch: &mut Batch, step: usize) {
    let space = worlds.action_space();
    let (groups, deltas) = (space.groups.len(), space.deltas.len());
    for lane in 0..worlds.lanes() {
        let (own, turned) = choose(space, step, lane);
        batch.actions[lane * groups..][..groups].copy_from_slice(&own);
        batch.deltas[lane * deltas..][..deltas].copy_from_slice(&turned);
    }
}

/// Steps a mixed batch beside one batch a task, each lane with the buttons that its task has.
fn beside_plain_batches(full: bool, steps: usize) {
    const LANES: usize = 6;
    let mut mixed = make(&IDS.join(","), LANES, 2, full);
    let mut plain: Vec<VecEnv> = IDS.iter().map(|id| make(id, LANES, 0, full)).collect();
    let (mut batch, mut batches) = (mixed.whole_batch(), Vec::new());
    mixed.reset(&mut batch).unwrap();
    for worlds in &mut plain {
        let mut own = worlds.whole_batch();
        worlds.reset(&mut own).unwrap();
        batches.push(own);
    }
    let mut brought = [[0.0; 2]; 3];
    let space = mixed.action_space().clone();
    for step in 0..steps {
        fill(&mixed, &mut batch, step);
        for (worlds, own) in plain.iter_mut().zip(&mut batches) {
            let groups = worlds.action_space().groups.len();
            let deltas = worlds.action_space().deltas.len();
            for lane in 0..LANES {
                let (actions, turned) = choose(&space, step, lane);
                let actions = translated(&space, worlds.action_space(), &actions);
                own.actions[lane * groups..][..groups].copy_from_slice(&actions);
                own.deltas[lane * deltas..][..deltas].copy_from_slice(&turned[..deltas]);
            }
            worlds.step(own).unwrap();
        }
        mixed.step(&mut batch).unwrap();
        let pixels: usize = mixed.observation_shape().iter().product();
        for lane in 0..LANES {
            let task = mixed.task_of(lane);
            assert_eq!(task, lane % 3);
            let own = &batches[task];
            let seen = |batch: &Batch| {
                let picture = batch.observations[lane * pixels..][..pixels].to_vec();
                (picture, batch.rewards[lane], batch.costs[lane], batch.positions[lane])
            };
            assert_eq!(seen(&batch), seen(own), "step {step}, lane {lane}");
            brought[task][0] += batch.rewards[lane];
            brought[task][1] += batch.costs[lane];
            let terms = plain[task].cost_terms();
            for (place, term) in mixed.cost_terms().iter().enumerate() {
                let found = batch.cost_terms[lane * mixed.cost_terms().len() + place];
                let own = terms.iter().position(|one| one == term);
                let alone = match own {
                    Some(at) => batches[task].cost_terms[lane * terms.len() + at],
                    None if term.name == IDS[task] => batches[task].costs[lane],
                    None => 0.0,
                };
                assert_eq!(found, alone, "step {step}, lane {lane}, {}", term.name);
            }
            let names = plain[task].statistics();
            for (place, name) in mixed.statistics().iter().enumerate() {
                let found = batch.statistics[lane * mixed.statistics().len() + place];
                let at = names.iter().position(|one| one == name);
                let alone = at.map_or(0.0, |at| batches[task].statistics[lane * names.len() + at]);
                assert_eq!(found, alone, "step {step}, lane {lane}, {name}");
            }
        }
        for episode in &batch.episodes {
            let task = mixed.task_of(episode.lane);
            let alone = batches[task].episodes.iter().find(|one| one.lane == episode.lane).unwrap();
            assert_eq!(
                (episode.seed, episode.episode_return, episode.cost, episode.length),
                (alone.seed, alone.episode_return, alone.cost, alone.length)
            );
            // Its own terms, the whole cost under the task's id, and no other's.
            let (whole, own) = episode.costs.split_last().unwrap();
            assert_eq!((own, &episode.stats), (&alone.costs[..], &alone.stats));
            assert_eq!((whole.name, whole.counted, whole.cost), (IDS[task], false, alone.cost));
            assert_eq!(episode.task, Some(IDS[task]));
        }
    }
    assert!(brought.iter().flatten().all(|sum| *sum != 0.0), "all earn and cost: {brought:?}");
}

#[test]
fn a_lane_plays_what_its_task_plays_alone() {
    beside_plain_batches(false, 700);
}

#[test]
fn with_the_full_space_too() {
    beside_plain_batches(true, 560);
}

#[test]
fn the_space_has_the_buttons_of_all_and_masks_say_what_does_nothing() {
    let worlds = make(&IDS.join(","), 3, 0, false);
    let names: Vec<Vec<&str>> = worlds
        .action_space()
        .groups
        .iter()
        .map(|group| group.buttons.iter().map(|(name, _)| *name).collect())
        .collect();
    let expected: [&[&str]; 5] = [
        &["TURN_LEFT", "TURN_RIGHT"],
        &["MOVE_FORWARD", "MOVE_BACKWARD"],
        &["SPEED"],
        &["JUMP"],
        &["ATTACK"],
    ];
    assert_eq!(names, expected);
    let masks: Vec<Vec<u8>> = worlds
        .tasks()
        .iter()
        .map(|task| task.mask.iter().map(|does| u8::from(*does)).collect())
        .collect();
    // Nothing, left, right; nothing, ahead, back; nothing, run; nothing, jump; nothing, attack.
    assert_eq!(masks[0], [1, 1, 1, 1, 1, 0, 1, 1, 1, 1, 1, 0]);
    assert_eq!(masks[1], [1, 1, 1, 1, 0, 0, 1, 0, 1, 0, 1, 1]);
    assert_eq!(masks[2], [1, 0, 1, 1, 1, 1, 1, 0, 1, 0, 1, 0]);
    assert_eq!(worlds.tasks().iter().map(|task| task.id.to_string()).collect::<Vec<_>>(), IDS);
}

#[test]
fn lanes_go_on_where_they_were_saved() {
    let ids = IDS.join(",");
    let (mut straight, mut again) = (make(&ids, 5, 0, false), make(&ids, 5, 1, false));
    let mut batch = straight.whole_batch();
    straight.reset(&mut batch).unwrap();
    for step in 0..90 {
        fill(&straight, &mut batch, step);
        straight.step(&mut batch).unwrap();
    }
    let bytes = LaneState::to_bytes(&straight.save().unwrap());
    let mut restored = again.whole_batch();
    again.restore(LaneState::from_bytes(&bytes).unwrap(), &mut restored).unwrap();
    assert_eq!(restored.observations, batch.observations);
    for step in 90..130 {
        fill(&straight, &mut batch, step);
        restored.actions.clone_from(&batch.actions);
        straight.step(&mut batch).unwrap();
        again.step(&mut restored).unwrap();
        assert_eq!(restored, batch, "step {step}");
    }
}

#[test]
fn one_name_for_a_counted_and_an_uncounted_cost_is_refused() {
    let beside = FILE.replace("MixedYard", "MixedBeside") + "[costs.greed]\ncounted = false\n";
    own::register("beside.toml", &beside).unwrap();
    own::register("mixed_yard.toml", FILE).unwrap();
    let ids = "MixedYard-v0,MixedBeside-v0";
    let Err(error) = VecEnv::new(ids, &EnvOptions::default(), options(2, 0)) else {
        panic!("one name means two things");
    };
    let line = error.to_string();
    assert!(line.contains("greed") && line.contains("MixedBeside"), "{line}");
}
