//! Where the lanes of a run that begins with an agent are in their first episodes.

mod tiny;

use hasard_learn::config::AlgorithmKind;
use hasard_learn::runs::trainer::Start;
use std::fs;

/// An agent without a budget takes the risk in all ten steps, random play in half of them. A run
/// that goes on from the agent, and has learned nothing yet, costs ten from its first episode on,
/// though its lanes begin spread over the time of one.
#[test]
fn first_episodes_are_the_agents_own() {
    let config = tiny::config(AlgorithmKind::Ppo);
    let first = tiny::directory("first-steps-agent");
    tiny::run(Start::Fresh(config.clone()), &first).0.unwrap();

    let mut after = config;
    after.learning.rate = 0.0;
    after.sampling.rollout = 5;
    after.frames = after.frames_per_rollout();
    let costs = |start: Start, name: &str| {
        let path = tiny::directory(name);
        let (_, reports, _) = tiny::run(start, &path);
        fs::remove_dir_all(path).unwrap();
        let report = &reports[0];
        assert!((12..=20).contains(&report.episodes), "{} of 32 end in 5 steps", report.episodes);
        report.means.unwrap().1
    };
    let fresh = costs(Start::Fresh(after.clone()), "first-steps-fresh");
    assert!(fresh < 7.0, "random play: {fresh}");
    let own = costs(Start::From(after.clone(), first.clone()), "first-steps-from");
    assert!(own > 9.5, "the agent's own play: {own}");

    // The number of samplers changes nothing.
    after.sampling.samplers = 1;
    assert_eq!(costs(Start::From(after, first.clone()), "first-steps-one"), own);
    fs::remove_dir_all(first).unwrap();
}
