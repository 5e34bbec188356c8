//! Episodes by given actions: `beside_published.py` drives it.
//!
//! Arguments: a folder of maps (or `-` for the built-in ones) and an id, then `hard` or `soft`; the
//! rules are `released`. Standard input: for every episode a line with its seed and the chosen
//! sub-actions of each step, a word of digits a step. Standard output: return, cost and steps of
//! each.

use hasard_envs::maps::Maps;
use hasard_envs::{Env, EnvOptions, FrameSize, RuleSet};
use std::error::Error;
use std::io::{BufRead, Write};
use std::path::Path;
use std::sync::Arc;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [maps, id, constraint] = words.as_slice() else {
        return Err("give a folder of maps or -, an id, hard or soft".into());
    };
    let maps = (maps != "-").then(|| Arc::new(Maps::new(Path::new(maps), None)));
    let size = FrameSize { width: 64, height: 48 };
    let options = EnvOptions {
        rules: RuleSet::Released,
        hard: constraint == "hard",
        size,
        maps,
        ..EnvOptions::default()
    };
    let mut env = Env::new(id, &options)?;
    for line in std::io::stdin().lock().lines() {
        let line = line?;
        let mut words = line.split_whitespace();
        env.reset(words.next().ok_or("a line without a seed")?.parse()?);
        for word in words {
            let actions: Vec<u8> = word.bytes().map(|digit| digit.wrapping_sub(b'0')).collect();
            if env.step(&actions, &[])?.ended() {
                break;
            }
        }
        let episode = env.episode();
        let mut out = std::io::stdout().lock();
        writeln!(out, "{} {} {}", episode.episode_return, episode.cost, episode.length)?;
        out.flush()?;
    }
    Ok(())
}
