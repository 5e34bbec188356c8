//! What fixed policies did in the published system and with the code behind the paper's tables, and
//! what they do in ours.

use hasard_envs::{Env, EnvOptions, Policy, PolicyRun, RuleSet};

/// What is compared of an episode, in the order of the columns.
pub const COLUMNS: [&str; 8] =
    ["return", "cost", "length", "path length", "farthest", "lowest", "highest", "least health"];

/// One line of the published measurements.
#[derive(Clone, Debug)]
pub struct Published {
    /// The environment.
    pub id: String,
    /// Rules.
    pub rules: RuleSet,
    /// Hard constraint.
    pub hard: bool,
    /// The creatures of the first runs.
    pub early: bool,
    /// The policy, in our words.
    pub policy: String,
    /// Episodes measured.
    pub episodes: f64,
    /// Mean and standard deviation of each column.
    pub columns: [[f64; 2]; COLUMNS.len()],
}

/// Every measurement of a rule set that was measured.
pub fn published(rules: RuleSet) -> Vec<Published> {
    let text = match rules {
        RuleSet::Paper => "",
        RuleSet::Released => include_str!("figures.tsv"),
        RuleSet::Tables => include_str!("tables.tsv"),
    };
    text.lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| {
            let words: Vec<&str> = line.split('\t').collect();
            let number = |i: usize| words[i].parse().unwrap();
            Published {
                id: words[0].to_string(),
                rules,
                hard: words[1] == "hard",
                early: words[1] == "early",
                policy: words[2].to_string(),
                episodes: number(3),
                columns: std::array::from_fn(|i| [number(4 + 2 * i), number(5 + 2 * i)]),
            }
        })
        .collect()
}

/// Plays an episode and measures it as the published system was measured: places, heights and
/// health are looked at after the reset and after every step but the last.
fn play(env: &mut Env, policy: Policy, seed: u64) -> [f64; COLUMNS.len()] {
    env.reset(seed);
    let mut run = PolicyRun::new(policy, env, seed).unwrap();
    let look = |env: &Env| {
        let world = env.world();
        let body = world.get(world.players[0].actor).unwrap();
        ([body.x, body.y, body.z].map(|at| at.to_f64()), f64::from(body.health))
    };
    let ([start_x, start_y, start_z], start_health) = look(env);
    let (mut path, mut farthest, mut lowest, mut highest, mut health) =
        (0.0, 0.0f64, start_z, start_z, start_health);
    let (mut last_x, mut last_y) = (start_x, start_y);
    loop {
        let step = env.make_move(run.next_move(env)).unwrap();
        if step.ended() {
            let episode = env.episode();
            return [
                episode.episode_return,
                episode.cost,
                f64::from(episode.length),
                path,
                farthest,
                lowest,
                highest,
                health,
            ];
        }
        let ([x, y, z], points) = look(env);
        let distance = |x: f64, y: f64| (x * x + y * y).sqrt();
        path += distance(x - last_x, y - last_y);
        (last_x, last_y) = (x, y);
        farthest = farthest.max(distance(x - start_x, y - start_y));
        (lowest, highest, health) = (lowest.min(z), highest.max(z), health.min(points));
    }
}

/// Mean and standard deviation of each column over episodes of ours.
pub fn ours(published: &Published, episodes: u64) -> [[f64; 2]; COLUMNS.len()] {
    let Published { rules, hard, early, .. } = *published;
    let options = EnvOptions { rules, hard, early_creatures: early, ..EnvOptions::default() };
    let mut env = Env::new(&published.id, &options).unwrap();
    let policy: Policy = published.policy.parse().unwrap();
    let all: Vec<_> = (0..episodes).map(|seed| play(&mut env, policy, 1000 + seed)).collect();
    std::array::from_fn(|column| {
        let count = all.len() as f64;
        let mean = all.iter().map(|episode| episode[column]).sum::<f64>() / count;
        let variance =
            all.iter().map(|episode| (episode[column] - mean).powi(2)).sum::<f64>() / count;
        [mean, variance.sqrt()]
    })
}

/// The standard error of the difference of two means, each with its deviation and its number of
/// episodes, if both measure the same thing: from the deviation of all episodes together. (Twenty
/// episodes without an event say little about how rare it is.)
pub fn standard_error(
    published: [f64; 2],
    published_episodes: f64,
    ours: [f64; 2],
    episodes: f64,
) -> f64 {
    let squares = published[1].powi(2) * published_episodes + ours[1].powi(2) * episodes;
    (squares / (published_episodes + episodes) * (1.0 / published_episodes + 1.0 / episodes)).sqrt()
}

/// How far two means may lie apart: three standard errors or a tenth of the published one,
/// whichever is larger. The tiny rest is for figures that were written with four decimals.
pub fn allowed(published: [f64; 2], published_episodes: f64, ours: [f64; 2], episodes: f64) -> f64 {
    let error = standard_error(published, published_episodes, ours, episodes);
    (3.0 * error).max(0.1 * published[0].abs()) + 1e-3
}
