//! Fixed policies earn and cost what they do in the published system (rule set `released`), and
//! roam as far.
//!
//! A quick look; `cargo run --release -p hasard-envs --example published_table` prints the whole
//! comparison.

mod published_figures;

use hasard_envs::RuleSet;
use published_figures::{COLUMNS, allowed, ours, published, standard_error};

/// Episodes of each row; agents that do nothing need fewer.
const EPISODES: u64 = 320;
const IDLE_EPISODES: u64 = 20;

/// A row whose path hangs on a rare event, which needs more: in one episode of seventy (17 of
/// 1,200; some two of the 60 published ones, inferred from their mean and deviation) a rocket
/// bursts so near that it throws the agent by some map units. Of 320 episodes as few as one may
/// have it.
const RARE: (&str, &str, u64) = ("CollateralDamageLevel3-v0", "hold-after:1:ATTACK", 960);

/// Figures that are known to differ, and why.
const KNOWN: &[(&str, &str, &str)] = &[(
    "RemedyRush",
    "highest",
    "our town is of our own design: other things to climb on, none of which anything lies on",
)];

/// Plays every row of a scenario and lists what lies too far off.
fn differences(scenario: &str) -> Vec<String> {
    let mut wrong = Vec::new();
    let rows: Vec<_> = published(RuleSet::Released)
        .into_iter()
        .filter(|row| row.id.starts_with(scenario))
        .collect();
    assert!(rows.len() >= 12, "measurements of {scenario} are missing");
    for row in rows {
        let episodes = match (row.id.as_str(), row.policy.as_str()) {
            (_, "noop") => IDLE_EPISODES,
            (id, policy) if (id, policy) == (RARE.0, RARE.1) => RARE.2,
            _ => EPISODES,
        };
        let measured = ours(&row, episodes);
        for (column, name) in COLUMNS.into_iter().enumerate() {
            let (theirs, mine) = (row.columns[column], measured[column]);
            let known = KNOWN
                .iter()
                .any(|&(scenario, figure, _)| row.id.starts_with(scenario) && name == figure);
            let (difference, episodes) = ((mine[0] - theirs[0]).abs(), episodes as f64);
            if difference > allowed(theirs, row.episodes, mine, episodes) && !known {
                let errors = difference / standard_error(theirs, row.episodes, mine, episodes);
                let (id, policy, hard) =
                    (&row.id, &row.policy, if row.hard { " hard" } else { "" });
                wrong
                    .push(format!("{id}{hard} {policy} {name}: ours {mine:.3?}, published {theirs:.3?}, {errors:.1} errors off"));
            }
        }
    }
    wrong
}

#[test]
fn volcanic_venture() {
    assert_eq!(differences("VolcanicVenture"), Vec::<String>::new());
}

#[test]
fn precipice_plunge() {
    assert_eq!(differences("PrecipicePlunge"), Vec::<String>::new());
}

#[test]
fn armament_burden() {
    assert_eq!(differences("ArmamentBurden"), Vec::<String>::new());
}

#[test]
fn collateral_damage() {
    assert_eq!(differences("CollateralDamage"), Vec::<String>::new());
}

#[test]
fn remedy_rush() {
    assert_eq!(differences("RemedyRush"), Vec::<String>::new());
}

#[test]
fn detonators_dilemma() {
    assert_eq!(differences("DetonatorsDilemma"), Vec::<String>::new());
}
