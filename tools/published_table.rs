//! Plays the fixed policies of the published measurements under the rules that were measured, and
//! prints both side by side.
//!
//! `cargo run --release -p hasard-envs --example published_table -- [EPISODES] [START-OF-ID]
//! [RULES]`; 200 episodes of every environment under `released` by default; the other measured
//! rules are `tables`. Deviations are in standard errors of both measurements together.

#[path = "../crates/envs/tests/published_figures/mod.rs"]
mod published_figures;

use hasard_envs::RuleSet;
use published_figures::{COLUMNS, allowed, ours, published, standard_error};

fn main() {
    let mut arguments = std::env::args().skip(1);
    let episodes = match arguments.next().map(|digits| digits.parse()) {
        None => 200,
        Some(Ok(episodes)) if (1..=1_000_000).contains(&episodes) => episodes,
        Some(_) => {
            eprintln!(
                "the first argument is the number of episodes, 1..=1000000; then, perhaps, how an id begins"
            );
            std::process::exit(2);
        }
    };
    let wanted = arguments.next().unwrap_or_default();
    let rules = match arguments.next().map_or(Ok(RuleSet::Released), |name| name.parse()) {
        Ok(rules) => rules,
        Err(error) => {
            eprintln!("{error}");
            std::process::exit(2);
        }
    };
    println!("| environment | policy | figure | published | ours | deviation | within |");
    println!("|---|---|---|--:|--:|--:|---|");
    let (mut compared, mut outside) = (0, 0);
    for row in published(rules).into_iter().filter(|row| row.id.starts_with(&wanted)) {
        let measured = ours(&row, episodes);
        for (column, name) in COLUMNS.into_iter().enumerate() {
            let (theirs, mine) = (row.columns[column], measured[column]);
            let bound = allowed(theirs, row.episodes, mine, episodes as f64);
            let difference = mine[0] - theirs[0];
            let error = standard_error(theirs, row.episodes, mine, episodes as f64);
            let deviation =
                if error > 0.0 { format!("{:+.1}", difference / error) } else { "0".to_string() };
            let within = difference.abs() <= bound;
            compared += 1;
            outside += usize::from(!within);
            println!(
                "| {}{} | {} | {name} | {:.2} ± {:.2} | {:.2} ± {:.2} | {deviation} | {} |",
                row.id,
                if row.hard {
                    " hard"
                } else if row.early {
                    " early creatures"
                } else {
                    ""
                },
                row.policy,
                theirs[0],
                theirs[1],
                mine[0],
                mine[1],
                if within { "yes" } else { "**no**" }
            );
        }
    }
    println!(
        "\n{compared} figures, {outside} of them not within three standard errors or a tenth."
    );
}
