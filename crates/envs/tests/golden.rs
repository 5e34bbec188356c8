//! Every environment does today what it did before: fingerprints of 300 steps, part by part.
//!
//! `goldens.txt` holds a line for every id, rule set, constraint and action space, with a
//! fingerprint each of what is seen (frames), what is paid (rewards and ends), what is charged
//! (every cost term) and what is so (the whole state, which holds no floating-point number). A line
//! that changes is a change of the task, or of its pictures where only the frames moved: find the
//! cause, then
//!
//! ```sh
//! HASARD_BLESS=1 cargo test --release -p hasard-envs --test golden -- --nocapture
//! ```
//!
//! writes the new ones and prints what moved. Say so in the changelog.

use hasard_engine::math::Rng;
use hasard_engine::world::Fingerprint;
use hasard_envs::{Env, EnvId, EnvOptions, FrameSize, RuleSet};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::hash::Hasher;

const FILE: &str = "tests/goldens.txt";
const STEPS: u32 = 300;
const PARTS: [&str; 4] = ["frames", "rewards", "costs", "state"];
const HEAD: &str = "# Written by tests/golden.rs, which says how: id, rules, constraint, actions, then fingerprints of 300 steps.\n";

/// Fingerprints of the parts, in the order of [`PARTS`]. Each sub-action is held for a while, so
/// that the agent gets about.
fn play(id: &str, options: &EnvOptions) -> [u64; 4] {
    let mut env = Env::new(id, options).unwrap();
    let mut rng = Rng::new(7);
    let [mut frames, mut rewards, mut costs, mut state] =
        std::array::from_fn(|_| Fingerprint::default());
    let mut frame = vec![0; env.observation_shape().iter().product()];
    let sizes = env.action_space().sizes();
    let mut actions = vec![0; sizes.len()];
    let mut deltas = vec![0.0; env.action_space().deltas.len()];
    let mut episode = 0;
    env.reset(episode);
    for _ in 0..STEPS {
        for (action, &size) in actions.iter_mut().zip(&sizes) {
            if rng.below(4) == 0 {
                *action = rng.below(size as u32) as u8;
            }
        }
        for delta in &mut deltas {
            if rng.below(4) == 0 {
                *delta = rng.between(-128, 128) as f32 / 128.0;
            }
        }
        let step = env.step(&actions, &deltas).unwrap();
        rewards.write_u64(step.reward.to_bits());
        rewards.write_u8(u8::from(step.terminated) | u8::from(step.truncated) << 1);
        env.step_costs().iter().for_each(|cost| costs.write_u64(cost.to_bits()));
        state.write_u64(env.state_hash());
        env.observe(&mut frame);
        frames.write(&frame);
        if step.ended() {
            episode += 1;
            env.reset(episode);
        }
    }
    [frames, rewards, costs, state].map(|part| part.finish())
}

/// What a line is about, and its fingerprints as text.
fn parse(text: &str) -> BTreeMap<String, Vec<String>> {
    let lines = text.lines().filter(|line| !line.starts_with('#') && !line.is_empty());
    let words = lines.map(|line| line.split(' ').map(String::from).collect::<Vec<_>>());
    words.map(|words| (words[..4].join(" "), words[4..].to_vec())).collect()
}

#[test]
fn fingerprints_are_as_recorded() {
    let mut text = HEAD.to_string();
    for id in EnvId::all() {
        for rules in RuleSet::ALL {
            for (hard, constraint) in [(false, "soft"), (true, "hard")] {
                for (full_actions, actions) in [(false, "simplified"), (true, "full")] {
                    let options = EnvOptions {
                        rules,
                        hard,
                        full_actions,
                        size: FrameSize::LEARNER,
                        ..EnvOptions::default()
                    };
                    let [frames, rewards, costs, state] = play(&id.to_string(), &options);
                    writeln!(text, "{id} {rules} {constraint} {actions} {frames:016x} {rewards:016x} {costs:016x} {state:016x}")
                        .unwrap();
                }
            }
        }
    }
    let (found, recorded) =
        (parse(&text), parse(&std::fs::read_to_string(FILE).unwrap_or_default()));
    let mut moved = Vec::new();
    for (what, parts) in &found {
        let old = recorded.get(what);
        let differ = PARTS
            .iter()
            .enumerate()
            .filter(|&(i, _)| old.and_then(|old| old.get(i)) != Some(&parts[i]));
        let differ: Vec<&str> = differ.map(|(_, part)| *part).collect();
        if !differ.is_empty() {
            moved.push(format!(
                "{what}: {}{}",
                differ.join(", "),
                if old.is_none() { " (new)" } else { "" }
            ));
        }
    }
    moved.extend(
        recorded
            .keys()
            .filter(|what| !found.contains_key(*what))
            .map(|what| format!("{what}: gone")),
    );
    if std::env::var_os("HASARD_BLESS").is_some() {
        let temporary = format!("{FILE}.partial");
        std::fs::write(&temporary, &text).and_then(|()| std::fs::rename(&temporary, FILE)).unwrap();
        println!("{} of {} lines moved\n{}", moved.len(), found.len(), moved.join("\n"));
        return;
    }
    assert!(
        moved.is_empty(),
        "{} of {} lines moved; if that is intended, bless them as tests/golden.rs says:\n{}",
        moved.len(),
        found.len(),
        moved.join("\n")
    );
}
