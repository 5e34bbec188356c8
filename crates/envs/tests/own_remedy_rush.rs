//! Remedy Rush written as a file plays as the built-in one does, bit for bit: what can be said in a
//! file is what the engine does.

use hasard_envs::{Env, EnvOptions, FrameSize, Policy, PolicyRun, RuleSet, own};
use std::path::Path;

fn file() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/remedy_rush.toml");
    std::fs::read_to_string(path).unwrap()
}

#[test]
fn remedy_rush_from_a_file_is_remedy_rush() {
    let own = own::register("remedy_rush.toml", &file()).unwrap();
    let size = FrameSize { width: 64, height: 48 };
    let (mut frames, mut built_in_frames) = (vec![0; 64 * 48 * 3], vec![0; 64 * 48 * 3]);
    let mut charged = 0.0;
    for rules in RuleSet::ALL {
        for hard in [false, true] {
            for level in 1..=3 {
                let options = EnvOptions { rules, hard, size, ..EnvOptions::default() };
                let id = format!("RemedyRushLevel{level}-v0");
                let mut built_in = Env::new(&id, &options).unwrap();
                let options = EnvOptions { scenario: Some(own), ..options };
                let mut env =
                    Env::new(&format!("RemedyRushFileLevel{level}-v0"), &options).unwrap();
                assert_eq!(env.action_space(), built_in.action_space());
                assert_eq!(env.cost_terms(), built_in.cost_terms());
                for seed in 0..3 {
                    env.reset(seed);
                    built_in.reset(seed);
                    let policy: Policy = "sticky:8".parse().unwrap();
                    let mut run = PolicyRun::new(policy, &env, seed).unwrap();
                    for step in 0..160 {
                        let what = format!("{id} {rules} hard={hard} seed {seed} step {step}");
                        assert_eq!(
                            env.world().state_hash(),
                            built_in.world().state_hash(),
                            "{what}"
                        );
                        let made = run.next_move(&env);
                        let (one, other) =
                            (built_in.make_move(made).unwrap(), env.make_move(made).unwrap());
                        assert_eq!(
                            (one, built_in.step_costs()),
                            (other, env.step_costs()),
                            "{what}"
                        );
                        if step % 20 == 0 {
                            env.observe(&mut frames);
                            built_in.observe(&mut built_in_frames);
                            assert!(frames == built_in_frames, "{what}: pictures differ");
                        }
                        if one.ended() {
                            break;
                        }
                    }
                    charged += env.episode().cost;
                    let stats = built_in.stats();
                    for (name, value) in env.stats() {
                        assert_eq!(
                            stats.iter().find(|(known, _)| *known == name),
                            Some(&(name, value)),
                            "{id} {name}"
                        );
                    }
                }
            }
        }
    }
    assert!(charged > 10.0, "so few harmful items were taken that nothing was compared: {charged}");
}
