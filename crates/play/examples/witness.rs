//! Looks for witnesses of all 18 environments (an episode of positive return at cost 0 each) and
//! keeps them in a folder; prints a table.
//!
//! `cargo run --release -p hasard-play --example witness -- DIR [START-OF-ID] [FIRST-SEED]`;
//! deterministic.

use hasard_envs::{Env, EnvId, EnvOptions, FrameSize};
use hasard_play::witness::{Effort, search};
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = PathBuf::from(
        arguments
            .next()
            .ok_or("name a folder to write into; then, perhaps, how an id begins, and a seed")?,
    );
    let wanted = arguments.next().unwrap_or_default();
    let first_seed: u64 = arguments.next().map_or(Ok(1), |digits| digits.parse())?;
    std::fs::create_dir_all(&folder)?;
    println!("| environment | seed | steps | return | cost |\n|---|--:|--:|--:|--:|");
    for id in EnvId::all().map(|id| id.to_string()).filter(|id| id.starts_with(&wanted)) {
        let mut env = Env::new(
            &id,
            &EnvOptions { size: FrameSize { width: 64, height: 48 }, ..EnvOptions::default() },
        )?;
        let Some(file) = search(&mut env, first_seed, Effort::default())? else {
            println!("| {id} | - | - | none found | - |");
            continue;
        };
        let (header, path) = (file.header(), folder.join(format!("{id}.episode")));
        let outcome = header.outcome.as_ref().ok_or("a witness has an end")?;
        println!(
            "| {id} | {} | {} | {:.2} | {} |",
            header.seed, header.steps, outcome.episode_return, outcome.cost
        );
        file.write(&path)?;
    }
    Ok(())
}
