//! Experiments by name: each table and figure of the paper with its preset and numbers of frames,
//! and the quick preset's own; [`Sweep::scale_frames`] makes them smaller.

use crate::grid::{Grid, Sweep, scenarios};
use crate::option::OptionValue;
use std::path::PathBuf;

/// An experiment.
#[derive(Clone, Copy, Debug)]
pub struct Experiment {
    /// The name by which `hasard sweep` knows it.
    pub name: &'static str,
    /// The tables and figures of the paper that it fills; empty for one of our own.
    pub fills: &'static str,
    /// What it compares.
    pub what: &'static str,
}

/// All of them.
pub const EXPERIMENTS: [Experiment; 18] = {
    const fn of(name: &'static str, fills: &'static str, what: &'static str) -> Experiment {
        Experiment { name, fills, what }
    }
    [
        of(
            "main",
            "Table 3, Figures 23 to 25",
            "six scenarios, three levels, PPO, PPOCost, PPOLag, PPOSaute, PPOPID and P3O",
        ),
        of(
            "safety-bounds",
            "Figure 4",
            "PPOLag on level 1 with half, whole and one and a half times the budget",
        ),
        of(
            "curriculum",
            "Table 4",
            "PPOPID on levels 1, 2, 3 in turn against level 3 alone, Remedy Rush and Collateral Damage",
        ),
        of(
            "segmentation",
            "Figure 6 (left)",
            "PPOPID on Armament Burden level 2 with colours and with segmentation",
        ),
        of(
            "depth",
            "Figure 6 (right)",
            "PPO and PPOPID on Precipice Plunge level 2 with and without depth",
        ),
        of(
            "heatmaps",
            "Figures 7 and 17 to 20",
            "where agents go during 100 million frames, in the five scenarios that are shown",
        ),
        of("trpo", "Table 8", "TRPO, TRPOLag and TRPOPID on level 1"),
        of(
            "cost-scale",
            "Table 9, Figure 14",
            "PPOCost on level 1 with cost scales 0.1, 0.5, 1 and 2",
        ),
        of(
            "hard",
            "Table 10, Figure 22",
            "PPO, PPOCost and PPOLag on level 1 under the hard constraint",
        ),
        of(
            "full-actions",
            "Table 12, Figure 16",
            "PPOLag on level 1 with the simplified and the full action space",
        ),
        of(
            "efficiency",
            "Table 13, Figure 21",
            "a timed run of PPOLag on Volcanic Venture level 1",
        ),
        of("human", "Table 14", "people's episodes; explains how to record them"),
        of(
            "behaviour",
            "Appendix, What Makes HASARD Complex",
            "PPOPID where weapons, decoys, goggles and barrels are counted",
        ),
        of(
            "witness",
            "Section 4, safety constraints",
            "episodes with reward at cost 0; explains how to make them",
        ),
        of(
            "all-algorithms",
            "",
            "all thirteen algorithms on Volcanic Venture and Remedy Rush level 1",
        ),
        of(
            "quick",
            "",
            "PPOPID with the quick preset on Volcanic Venture level 1, five seeds, each evaluated on 100 episodes",
        ),
        of(
            "quick-all",
            "",
            "PPOPID with the quick preset on level 1 of the six scenarios, a seed each, evaluated on 100 episodes",
        ),
        of(
            "quick-algorithms",
            "",
            "the quick preset's 2 million frames of all algorithms on Volcanic Venture level 1 and of the paper's six on Remedy Rush \
             level 1, a seed each, evaluated on 100 episodes",
        ),
    ]
};

/// What to do for an experiment that no training fills; `None` for all others.
#[must_use]
pub fn advice(name: &str) -> Option<&'static str> {
    match name {
        "human" => Some(
            "People play, nothing is trained. Ten episodes of each environment, as in the paper's Table 14:\n\
             \x20 hasard play RemedyRushLevel1-v0 --rules tables -o human\n\
             \x20 hasard report runs human        # fills the section \"Human play\"\n\
             `hasard envs` lists the environments; `hasard play --help` has the keys.",
        ),
        "witness" => Some(
            "A witness is an episode with reward at cost 0, which shows that costs can be avoided. One of each environment is in the \
             repository, found by search:\n\
             \x20 cargo run --release -p hasard-play --example witness -- witnesses\n\
             Play one yourself, or record an agent's with a seed of cost 0:\n\
             \x20 hasard play RemedyRushLevel1-v0 -o witnesses\n\
             \x20 hasard record RUN -o witnesses/witness-RemedyRush1.episode --seed N\n\
             \x20 hasard report runs witnesses    # fills the section \"Witnesses of safe reward\"\n\
             The report checks each episode and lists the levels that have none.",
        ),
        _ => None,
    }
}

/// All algorithms.
const ALGORITHMS: [&str; 13] = [
    "PPO", "PPOCost", "PPOLag", "PPOSaute", "PPOPID", "P3O", "TRPO", "TRPOLag", "TRPOPID", "CPO",
    "FOCOPS", "CUP", "IPO",
];

/// An experiment by its name: five seeds each, as the paper's text says, into `runs`, one run at a
/// time.
///
/// # Errors
/// When there is no such experiment, or none that trains; the message lists them, or says what to
/// do.
pub fn experiment(name: &str) -> Result<Sweep, String> {
    let six = &ALGORITHMS[..6];
    let level_1 = |algorithms: &[&str], frames| grid(&scenarios(), &[1], algorithms, frames);
    let text = |value: &str| OptionValue::Text(value.to_owned());
    let one_seed = |grid: Grid| Grid { seeds: vec![1], ..grid };
    let grids = match name {
        "main" => vec![grid(&scenarios(), &[1, 2, 3], six, 500_000_000)],
        "trpo" => vec![level_1(&["TRPO", "TRPOLag", "TRPOPID"], 500_000_000)],
        "safety-bounds" => scenarios()
            .iter()
            .map(|scenario| {
                let budgets =
                    if ["RemedyRush", "CollateralDamage", "DetonatorsDilemma"].contains(scenario) {
                        ["2.5", "5", "7.5"]
                    } else {
                        ["25", "50", "75"]
                    };
                // Always spelled out: the rule sets disagree about Armament Burden's own budget.
                with(
                    "safety-budget",
                    budgets.map(text).to_vec(),
                    grid(&[scenario], &[1], &["PPOLag"], 500_000_000),
                )
            })
            .collect(),
        "cost-scale" => {
            let scales = ["0.1", "0.5", "1", "2"].map(text).to_vec();
            vec![with("cost-scale", scales, level_1(&["PPOCost"], 500_000_000))]
        }
        "curriculum" => {
            let alone = grid(&["RemedyRush", "CollateralDamage"], &[3], &["PPOPID"], 300_000_000);
            vec![with("curriculum", vec![text("1,2,3")], alone.clone()), alone]
        }
        "hard" => {
            vec![with(
                "hard",
                vec![OptionValue::Switch(true)],
                level_1(&["PPO", "PPOCost", "PPOLag"], 500_000_000),
            )]
        }
        "full-actions" => {
            let both = [false, true].map(OptionValue::Switch).to_vec();
            vec![with("full-actions", both, level_1(&["PPOLag"], 200_000_000))]
        }
        // The paper's text says PPO, the script that came with it PPOPID.
        "depth" => vec![observed(
            grid(&["PrecipicePlunge"], &[2], &["PPO", "PPOPID"], 200_000_000),
            "rgb+depth",
        )],
        "segmentation" => {
            vec![observed(grid(&["ArmamentBurden"], &[2], &["PPOPID"], 500_000_000), "segmented")]
        }
        "heatmaps" => [
            ("RemedyRush", &[1][..], &["PPOPID"][..]),
            ("PrecipicePlunge", &[1], &["PPO", "PPOPID"]),
            ("ArmamentBurden", &[1, 2, 3], &["PPOPID"]),
            ("DetonatorsDilemma", &[2], &["PPOPID"]),
            ("VolcanicVenture", &[1], &["PPO", "PPOPID"]),
        ]
        .map(|(scenario, levels, algorithms)| {
            one_seed(grid(&[scenario], levels, algorithms, 100_000_000))
        })
        .to_vec(),
        // Half an hour or so on two cores: the paper's figures are of two hours.
        "efficiency" => vec![one_seed(grid(&["VolcanicVenture"], &[1], &["PPOLag"], 20_000_000))],
        "behaviour" => [
            ("ArmamentBurden", &[1, 2, 3][..]),
            ("RemedyRush", &[2, 3]),
            ("DetonatorsDilemma", &[3]),
        ]
        .map(|(scenario, levels)| grid(&[scenario], levels, &["PPOPID"], 500_000_000))
        .to_vec(),
        "all-algorithms" => {
            vec![grid(&["VolcanicVenture", "RemedyRush"], &[1], &ALGORITHMS, 500_000_000)]
        }
        "quick" => vec![quick(grid(&["VolcanicVenture"], &[1], &["PPOPID"], 10_000_000))],
        "quick-all" => vec![one_seed(quick(grid(&scenarios(), &[1], &["PPOPID"], 12_000_000)))],
        "quick-algorithms" => [("VolcanicVenture", &ALGORITHMS[..]), ("RemedyRush", six)]
            .map(|(scenario, algorithms)| {
                one_seed(quick(grid(&[scenario], &[1], algorithms, 2_000_000)))
            })
            .to_vec(),
        _ => {
            if let Some(advice) = advice(name) {
                return Err(format!(
                    "`{name}` trains nothing. {}",
                    advice.lines().next().unwrap_or_default()
                ));
            }
            let known = EXPERIMENTS.map(|known| known.name);
            return Err(format!(
                "no experiment is called `{name}`; known are {}",
                known.join(", ")
            ));
        }
    };
    let evaluate = if name.starts_with("quick") || name == "behaviour" { 100 } else { 0 };
    Ok(Sweep { out: PathBuf::from("runs"), parallel: 1, evaluate, grids })
}

fn grid(scenarios: &[&str], levels: &[u32], algorithms: &[&str], frames: u64) -> Grid {
    Grid {
        scenarios: scenarios.iter().map(|name| (*name).to_owned()).collect(),
        levels: levels.to_vec(),
        algorithms: algorithms.iter().map(|name| (*name).to_owned()).collect(),
        seeds: (1..=5).collect(),
        frames,
        options: vec![preset("paper")],
    }
}

/// The preset is always spelled out: that of `train` is another.
fn preset(name: &str) -> (String, Vec<OptionValue>) {
    ("preset".into(), vec![OptionValue::Text(name.into())])
}

fn with(name: &str, values: Vec<OptionValue>, mut grid: Grid) -> Grid {
    grid.options.push((name.into(), values));
    grid
}

fn quick(grid: Grid) -> Grid {
    Grid { options: vec![preset("quick")], ..grid }
}

fn observed(grid: Grid, observation: &str) -> Grid {
    let kinds = ["rgb", observation].map(|kind| OptionValue::Text(kind.to_owned())).to_vec();
    with("observation", kinds, grid)
}
