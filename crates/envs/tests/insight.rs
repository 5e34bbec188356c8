//! What learners see beside pictures: it is true of the world, and changes no picture.

use hasard_engine::render::{Buffers, class};
use hasard_envs::insight::{CELLS, GRID, STATE, THINGS, thing_group};
use hasard_envs::{
    Batch, Env, EnvId, EnvOptions, FrameSize, Insight, Layout, Move, ObservationKind, Policy,
    PolicyRun, VecEnv, VecOptions,
};

const ALL: Insight = Insight { state: true, in_view: true, depth: true, labels: true };

fn options(observation: ObservationKind) -> EnvOptions {
    EnvOptions { size: FrameSize { width: 64, height: 48 }, observation, ..EnvOptions::default() }
}

/// Every picture is what it is without, of every kind and stacked, and each part of a row is the
/// same whatever else is asked for.
#[test]
fn insight_changes_no_picture_and_no_other_part() {
    use ObservationKind::{Grey, Rgb, RgbDepth, Segmented};
    for kind in [Rgb, RgbDepth, Segmented, Grey] {
        for (frame_stack, layout) in [(1, Layout::Hwc), (1, Layout::Chw), (3, Layout::Chw)] {
            let options = EnvOptions { frame_stack, layout, ..options(kind) };
            let mut env = Env::new("DetonatorsDilemmaLevel1-v0", &options).unwrap();
            let size: usize = env.observation_shape().iter().product();
            let (mut plain, mut with) = (vec![0; size], vec![0; size]);
            for seed in 0..4 {
                env.reset(seed);
                env.observe(&mut plain);
                let mut whole = vec![7; ALL.bytes()];
                env.observe_with(&mut with, ALL, &mut whole);
                assert!(plain == with, "{kind:?}");
                for index in 0..4 {
                    let what = Insight {
                        state: index == 0,
                        in_view: index == 1,
                        depth: index == 2,
                        labels: index == 3,
                    };
                    let mut row = vec![9; what.bytes()];
                    env.observe_with(&mut with, what, &mut row);
                    assert!(plain == with, "{kind:?}");
                    assert_eq!(row, whole[ALL.places()[index].clone()], "{kind:?} {what:?}");
                }
            }
        }
    }
}

/// Length of a vector of fixed-point numbers.
fn length(x: i32, y: i32) -> f64 {
    let (x, y) = (f64::from(x), f64::from(y));
    (x * x + y * y).sqrt() / 65536.0
}

/// In every environment: the state is the player's, depth and labels are those of the picture's own
/// buffers, counted pixel by pixel, and what is in view is what the engine lists.
#[test]
fn insight_is_true_of_the_world() {
    let (mut things, mut near) = (0, 0);
    for id in EnvId::all() {
        let mut env = Env::new(&id.to_string(), &options(ObservationKind::Rgb)).unwrap();
        let (width, height) = (64, 48);
        for seed in 0..3 {
            env.reset(seed);
            let mut run =
                PolicyRun::new("sticky:5".parse::<Policy>().unwrap(), &env, seed).unwrap();
            for _ in 0..30 {
                if let Move::Action(actions, deltas) = run.next_move(&env) {
                    let step = env.step(actions, deltas).unwrap();
                    if step.terminated || step.truncated {
                        break;
                    }
                }
            }
            let mut row = vec![0; ALL.bytes()];
            env.observe_with(&mut vec![0; width * height * 3], ALL, &mut row);
            let [state, in_view, depth, labels] = ALL.places().map(|place| row[place].to_vec());
            let player = &env.world().players[0];
            let body = *env.world().get(player.actor).unwrap();
            assert_eq!(i32::from(state[0]), body.health.clamp(0, 255), "{id}");
            let [west, south, east, north] = env.extent();
            let [x, y] = env.position();
            for (byte, at, from, to) in [(state[2], x, west, east), (state[3], y, south, north)] {
                let share = f64::from(at - from) / f64::from(to - from);
                assert!((f64::from(byte) / 255.0 - share).abs() < 0.005, "{id}: {state:?}");
            }
            let turn = f64::from(body.angle.0) / f64::from(u32::MAX) * 256.0;
            assert!((f64::from(state[5]) - turn.floor()).abs() < 0.5, "{id}");
            let speed = length(body.vx.0, body.vy.0);
            assert!((f64::from(state[6]) / 4.0 - speed).abs() < 0.3, "{id}: {speed}");
            let renderer = env.render(Buffers { depth: true, labels: true });
            let mut sums = vec![(0u32, 0u32); CELLS];
            let mut groups = vec![[0usize; THINGS + 1]; CELLS];
            for (at, (&value, &class)) in
                renderer.depth().iter().zip(renderer.classes()).enumerate()
            {
                let cell = (at / width) * GRID[0] / height * GRID[1] + at % width * GRID[1] / width;
                sums[cell] = (sums[cell].0 + u32::from(value), sums[cell].1 + 1);
                if class >= class::FIRST_ACTOR {
                    let label = renderer.labels()[usize::from(class - class::FIRST_ACTOR)];
                    groups[cell][usize::from(thing_group(label.kind))] += 1;
                }
            }
            for cell in 0..CELLS {
                assert_eq!(u32::from(depth[cell]), sums[cell].0 / sums[cell].1, "{id}, {cell}");
                let own = groups[cell][usize::from(labels[cell])];
                let most = groups[cell].iter().copied().max().unwrap();
                assert!(labels[cell] > 0 || most == 0, "{id}, {cell}");
                assert!(labels[cell] == 0 || own == most, "{id}, {cell}: {:?}", groups[cell]);
            }
            let mut shares = [0.0f64; THINGS + 1];
            let mut nearest = [f64::INFINITY; THINGS + 1];
            for thing in renderer.in_view() {
                let group = usize::from(thing_group(thing.label.kind));
                shares[group] += thing.pixels as f64 / (width * height) as f64;
            }
            let drawn: Vec<_> = renderer.labels().to_vec();
            for label in drawn {
                let thing = env.world().get(label.actor).unwrap();
                let (dx, dy) = (thing.x.0 - body.x.0, thing.y.0 - body.y.0);
                let distance = length(dx, dy);
                let own = &mut nearest[usize::from(thing_group(label.kind))];
                *own = own.min(distance);
            }
            for group in 1..=THINGS {
                let [share, nearness] =
                    [0, 1].map(|part| f64::from(in_view[2 * (group - 1) + part]) / 255.0);
                assert!((share - shares[group].sqrt()).abs() < 0.01, "{id}, group {group}");
                things += usize::from(share > 0.0);
                let expected =
                    if shares[group] > 0.0 { 64.0 / (64.0 + nearest[group]) } else { 0.0 };
                assert!((nearness - expected).abs() < 0.02, "{id}, group {group}: {nearness}");
                near += usize::from(nearness > 0.3);
            }
        }
    }
    assert!(things > 50 && near > 5, "{things} {near}");
    assert_eq!(Insight::default().bytes(), 0);
    assert_eq!(ALL.bytes(), STATE + 2 * THINGS + 2 * CELLS);
}

/// A batch shows the same with any number of threads and groups, of last observations too, and
/// after it came back to saved states.
#[test]
fn a_batch_shows_the_same_however_it_is_stepped() {
    let play = |threads: usize| {
        let vec = VecOptions { lanes: 5, threads, seed: 3, insight: ALL, ..VecOptions::default() };
        let options = EnvOptions { max_episode_steps: Some(7), ..options(ObservationKind::Grey) };
        let mut worlds = VecEnv::new("RemedyRushLevel1-v0", &options, vec).unwrap();
        let mut batch = worlds.whole_batch();
        worlds.reset(&mut batch).unwrap();
        let mut shown = vec![batch.insight.to_vec()];
        for step in 0..20 {
            let groups = batch.actions.len() / 5;
            for (index, action) in batch.actions.iter_mut().enumerate() {
                *action = u8::from((step + index / groups + index % groups).is_multiple_of(3));
            }
            worlds.step(&mut batch).unwrap();
            shown.extend([batch.insight.to_vec(), batch.final_insight.clone()]);
            assert_eq!(batch.final_insight.len(), batch.final_lanes.len() * ALL.bytes());
            if let Some(last) = batch.final_lanes.len().checked_sub(1) {
                assert_eq!(batch.final_insight(last).len(), ALL.bytes());
            }
        }
        let states = worlds.save().unwrap();
        let mut again = Batch { insight: vec![1; batch.insight.len()].into(), ..batch.clone() };
        worlds.restore(states, &mut again).unwrap();
        assert!(again.insight == batch.insight, "a lane came back to another row");
        shown
    };
    let alone = play(0);
    assert!(alone.iter().flatten().any(|&byte| byte > 0));
    assert!(play(1) == alone && play(3) == alone);
}
