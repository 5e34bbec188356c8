//! What is named as in view has pixels, and pixels of things are named: in every environment.

use hasard_engine::render::{Buffers, FrameScratch, class};
use hasard_envs::{Env, EnvId, EnvOptions, FrameSize, Move, Policy, PolicyRun};
use std::collections::BTreeMap;

#[test]
fn things_in_view_are_those_with_a_pixel_of_their_value() {
    let (mut named, mut hidden) = (0, 0);
    let mut scratch = FrameScratch::default();
    for id in EnvId::all() {
        for size in [FrameSize { width: 160, height: 120 }, FrameSize { width: 64, height: 48 }] {
            let mut env =
                Env::new(&id.to_string(), &EnvOptions { size, ..EnvOptions::default() }).unwrap();
            let mut renderer = env.renderer(size).unwrap();
            for seed in 0..4 {
                env.reset(seed);
                let mut run =
                    PolicyRun::new("sticky:5".parse::<Policy>().unwrap(), &env, seed).unwrap();
                for _ in 0..40 {
                    if let Move::Action(actions, deltas) = run.next_move(&env) {
                        let step = env.step(actions, deltas).unwrap();
                        if step.terminated || step.truncated {
                            break;
                        }
                    }
                }
                renderer.render(
                    &mut scratch,
                    env.world(),
                    0,
                    Buffers { depth: false, labels: true },
                );
                let mut picture = vec![7; usize::from(size.width) * usize::from(size.height)];
                renderer.write_labels(&mut picture);
                let in_view = renderer.in_view();
                hidden += renderer.labels().len() - in_view.len();
                let mut counts: BTreeMap<u8, usize> = BTreeMap::new();
                picture.iter().for_each(|&value| *counts.entry(value).or_default() += 1);
                // The weapon has a value of its own, surfaces have none.
                let weapon = renderer.classes().contains(&class::WEAPON);
                assert_eq!(counts.remove(&255).is_some(), weapon, "{id}, seed {seed}");
                counts.remove(&0);
                let listed: BTreeMap<u8, usize> =
                    in_view.iter().map(|thing| (thing.value, thing.pixels)).collect();
                assert_eq!(
                    listed, counts,
                    "{id}, seed {seed}: things and their pixels, against the picture"
                );
                assert_eq!(
                    listed.len(),
                    in_view.len(),
                    "{id}, seed {seed}: each has a value of its own"
                );
                for thing in in_view {
                    let (mut left, mut right, mut top, mut bottom) = (usize::MAX, 0, usize::MAX, 0);
                    for at in (0..picture.len()).filter(|&at| picture[at] == thing.value) {
                        let (x, y) = (at % usize::from(size.width), at / usize::from(size.width));
                        (left, right, top, bottom) =
                            (left.min(x), right.max(x + 1), top.min(y), bottom.max(y + 1));
                    }
                    let label = thing.label;
                    let own = [label.x, label.x + label.width, label.y, label.y + label.height]
                        .map(usize::from);
                    assert_eq!(
                        own,
                        [left, right, top, bottom],
                        "{id}, seed {seed}: the box of {:?}",
                        label.kind
                    );
                    assert!(
                        env.world().get(label.actor).is_some_and(|actor| actor.kind == label.kind)
                    );
                    named += 1;
                }
            }
        }
    }
    assert!(
        named > 300 && hidden > 0,
        "the test sees things, and some that are hidden: {named}, {hidden}"
    );
}
