//! Whole episodes of the published system, its random agents' actions replayed: Precipice Plunge's
//! first level draws nothing at random, so that every figure must come out exactly.

use hasard_envs::{Env, EnvOptions, RuleSet};

/// Return, cost and length.
type Figures = (f64, f64, u32);

fn env(hard: bool) -> Env {
    Env::new(
        "PrecipicePlungeLevel1-v0",
        &EnvOptions { rules: RuleSet::Released, hard, ..EnvOptions::default() },
    )
    .unwrap()
}

fn play(env: &mut Env, actions: &str) -> Figures {
    env.reset(0);
    for code in actions.bytes().map(|byte| byte - 48) {
        if env.step(&[code / 18, code / 6 % 3, code / 2 % 3, code % 2], &[]).unwrap().ended() {
            break;
        }
    }
    let episode = env.episode();
    (episode.episode_return, episode.cost, episode.length)
}

#[test]
fn random_agents_come_out_where_they_did() {
    let lines: Vec<&str> = include_str!("published_figures/random_walks.txt")
        .lines()
        .filter(|line| !line.starts_with('#'))
        .collect();
    assert_eq!(lines.len(), 60);
    let (mut soft, mut hard) = (env(false), env(true));
    let (mut astray, mut hard_episodes) = (Vec::new(), 0);
    for line in lines {
        let words: Vec<&str> = line.split(' ').collect();
        let figures = |i: usize| -> Option<Figures> {
            Some((words[i].parse().ok()?, words[i + 1].parse().ok()?, words[i + 2].parse().ok()?))
        };
        let same = |ours: Figures, theirs: Figures| {
            (ours.0 - theirs.0).abs() < 0.006
                && (ours.1 - theirs.1).abs() < 1e-6
                && ours.2 == theirs.2
        };
        if !same(play(&mut soft, words[7]), figures(1).unwrap()) {
            astray.push(words[0].parse().unwrap());
        }
        if let Some(theirs) = figures(4) {
            let ours = play(&mut hard, words[7]);
            assert!(same(ours, theirs), "seed {}, hard: {ours:?}, recorded {theirs:?}", words[0]);
            hard_episodes += 1;
        }
    }
    assert_eq!((astray, hard_episodes), (Vec::<u32>::new(), 20));
}
