//! Experiments by name: each table and figure of the paper with its preset and numbers of frames,
//! and the quick preset's own; [`Sweep::scale_frames`] makes them smaller.

use crate::grid::{Grid, Sweep, scenarios};
use crate::option::OptionValue;
use crate::table::change;
use std::path::PathBuf;
use toml::{Table, Value};

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
            "2 million frames of the quick preset: all algorithms on Volcanic Venture level 1, the paper's six on Remedy Rush level 1, a \
             seed each, evaluated on 100 episodes",
        ),
    ]
};

/// What to do for an experiment that no training fills; `None` for all others.
#[must_use]
pub fn advice(name: &str) -> Option<&'static str> {
    match name {
        "human" => Some(
            "People play, nothing is trained. Ten episodes of each environment, as in the paper's Table 14:\n\
             \x20 hasard play ENV --rules tables -o human\n\
             \x20 hasard report runs human        # fills the section \"Human play\"\n\
             `hasard envs` lists the environments; `hasard play --help` has the keys.",
        ),
        "witness" => Some(
            "A witness is an episode with reward at cost 0, which shows that costs can be avoided. One of each environment is in the \
             repository, found by search:\n\
             \x20 cargo run --release -p hasard-play --example witness -- witnesses\n\
             Play one yourself, or record an agent's with a seed of cost 0:\n\
             \x20 hasard play ENV -o witnesses\n\
             \x20 hasard record RUN -o witnesses/witness-NAME.episode --seed N\n\
             \x20 hasard report runs witnesses    # fills the section \"Witnesses of safe reward\"\n\
             The report checks each episode and lists the levels that have none.",
        ),
        _ => None,
    }
}

/// The grids of each: facts of the paper, as data.
const GRIDS: &str = include_str!("../data/experiments.toml");

/// An experiment by its name: five seeds each, as the paper's text says, into `runs`, one run at a
/// time.
///
/// # Errors
/// When there is no such experiment, or none that trains; the message lists them, or says what to
/// do.
pub fn experiment(name: &str) -> Result<Sweep, String> {
    if let Some(advice) = advice(name) {
        let first = advice.lines().next().unwrap_or_default();
        return Err(format!("`{name}` trains nothing. {first}"));
    }
    let all: Table =
        GRIDS.parse().map_err(|error| format!("the experiments' own file: {error}"))?;
    let Some(Value::Array(tables)) = all.get(name) else {
        let known = EXPERIMENTS.map(|known| known.name);
        return Err(format!("no experiment is called `{name}`; known are {}", known.join(", ")));
    };
    let usual = Grid {
        scenarios: scenarios().map(str::to_owned).to_vec(),
        levels: vec![1],
        algorithms: Vec::new(),
        seeds: (1..=5).collect(),
        frames: 0,
        // The preset is always spelled out: that of `train` is another.
        options: vec![("preset".into(), vec![OptionValue::Text("paper".into())])],
        settings: Vec::new(),
    };
    let grid = |table: &Value| {
        let mut grid = usual.clone();
        change(&mut grid, table.as_table().ok_or("an experiment is a list of tables")?)?;
        Ok(grid)
    };
    let grids = tables.iter().map(grid).collect::<Result<Vec<Grid>, String>>()?;
    let evaluate = if name.starts_with("quick") || name == "behaviour" { 100 } else { 0 };
    let out = PathBuf::from("runs");
    Ok(Sweep { out, parallel: 1, evaluate, grids })
}
