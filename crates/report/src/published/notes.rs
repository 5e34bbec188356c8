//! What a reader must know about a published value before comparing it with one of ours.

use super::Published;

const SMALL_BUDGETS: [&str; 3] = ["RemedyRush", "CollateralDamage", "DetonatorsDilemma"];

/// The notes on a cell; `data/README.md` has them in full.
pub(super) fn of(cell: &Published) -> Vec<String> {
    let (table, algorithm, scenario) =
        (cell.table.as_str(), cell.algorithm.as_str(), cell.scenario.as_str());
    let mut notes = Vec::new();
    notes.push(
        match (table, algorithm, scenario, cell.level) {
            ("human", ..) => "ten episodes of one person",
            ("full-actions", ..) | ("main", "PPOCost", "VolcanicVenture", 1) => "one seed",
            ("cost-scale", ..) => "two seeds",
            ("hard", ..) => "three seeds, 300M frames",
            ("curriculum", ..) => "300M frames",
            _ => "three seeds, not the five of the text",
        }
        .to_owned(),
    );
    if cell.episode_return != cell.printed_return {
        notes.push(format!(
            "printed as {}: the penalty was added back at scale 1",
            cell.printed_return
        ));
    }
    if algorithm == "PPOLag" && ["main", "full-actions"].contains(&table) {
        let budget = if SMALL_BUDGETS.contains(&scenario) { "5.25, not 5" } else { "52.5, not 50" };
        notes.push(format!("PPOLag was trained to a budget of {budget}"));
    }
    if table == "hard" && scenario == "ArmamentBurden" {
        notes.push("the cost is that of the episode's last step alone".into());
        if algorithm == "PPO" {
            notes.push("the return counts every weapon twice".into());
        }
    }
    if scenario == "DetonatorsDilemma" && cell.level == 1 && ["main", "trpo"].contains(&table) {
        notes.push(match algorithm {
            "PPO" | "PPOCost" | "PPOLag" => {
                "met lost souls, chaingunners and revenants; PPOPID, P3O and the TRPO family met other creatures".into()
            }
            "PPOSaute" => "which of the two sets of creatures it met is not known".into(),
            _ => "met shotgunners, imps and revenants; PPO, PPOCost and PPOLag met other creatures".into(),
        });
    }
    let random_start =
        scenario == "ArmamentBurden" || scenario == "VolcanicVenture" && cell.level < 3;
    if table == "trpo" && random_start {
        notes.push("started at random places; the PPO family started at a fixed one".into());
    }
    notes
}
