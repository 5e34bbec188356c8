//! Every level has a witness that costs can be avoided while reward is earned; each is played
//! again.

use hasard_envs::{Env, EnvId, EnvOptions, FrameSize, RuleSet};
use hasard_media::episode::EpisodeFile;
use hasard_play::Replay;
use hasard_play::witness::{Effort, search};
use std::path::Path;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/results/witness");

fn options() -> EnvOptions {
    EnvOptions { size: FrameSize { width: 64, height: 48 }, ..EnvOptions::default() }
}

#[test]
fn every_level_has_a_witness_at_cost_0() {
    let page = std::fs::read_to_string(format!("{FOLDER}.md")).unwrap();
    for id in EnvId::all().map(|id| id.to_string()) {
        let path = format!("{FOLDER}/{id}.episode");
        let file =
            EpisodeFile::read(Path::new(&path)).unwrap_or_else(|error| panic!("{path}: {error}"));
        let (seed, steps) = (file.header().seed, file.header().steps);
        let mut replay = Replay::new(file, Path::new(&path), &options()).unwrap();
        while replay.tic() {}
        let env = replay.stage().env();
        let episode = env.episode();
        assert_eq!(env.id().to_string(), id);
        assert_eq!((env.options().rules, env.options().hard), (RuleSet::Paper, false), "{id}");
        assert!(episode.terminated || episode.truncated, "{id} is played to its end");
        assert_eq!(episode.cost, 0.0, "{id}");
        assert!(episode.episode_return > 0.0, "{id}");
        assert_eq!(replay.difference(), None);
        let row = format!(
            "| {id} | {seed} | {steps} | {:.2} | {} |",
            episode.episode_return, episode.cost
        );
        assert!(page.lines().any(|line| line == row), "witness.md lacks\n{row}");
    }
}

#[test]
fn the_search_finds_the_same_again() {
    let id = "RemedyRushLevel2-v0";
    let effort = Effort { ways: 6, seeds: 20, chunks: 120 };
    let find = || {
        let mut env = Env::new(id, &options()).unwrap();
        let file = search(&mut env, 1, effort).unwrap().expect("a way without harmful items");
        (
            file.header().seed,
            (0..file.header().steps as usize)
                .map(|i| file.step(i).unwrap().0.to_vec())
                .collect::<Vec<_>>(),
        )
    };
    assert_eq!(find(), find());
}
