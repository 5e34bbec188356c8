//! `hasard envs`: the list of environments.

use crate::args::EnvsArgs;
use crate::failure::Outcome;
use hasard_envs::{ActionSpace, EnvId};
use serde_json::{Value, json};
use std::io::Write;

/// Runs the command.
pub fn run(args: &EnvsArgs) -> Outcome {
    let mut ids: Vec<EnvId> =
        if args.files.is_empty() { EnvId::all().collect() } else { Vec::new() };
    for file in &args.files {
        ids.extend(crate::settings::env_id(file)?.scenario.environments());
    }
    let mut out = std::io::stdout().lock();
    if !args.json {
        writeln!(out, "{:<28} {:>6}  {:<40} full", "id", "budget", "simplified actions")?;
    }
    for id in ids {
        let budget = id.scenario.safety_budget(args.rules.into());
        let space = |full| ActionSpace::of(id, args.rules.into(), false, full);
        let (simplified, full) = (space(false), space(true));
        if args.json {
            let object = json!({
                "id": id.to_string(),
                "scenario": id.scenario.name(),
                "level": id.level,
                "safety_budget": budget,
                "hard_budget": 0.0,
                "actions": { "simplified": groups(&simplified), "full": groups(&full) },
            });
            writeln!(out, "{object}")?;
        } else {
            let sizes = |space: &ActionSpace| {
                let sizes: Vec<String> = space.sizes().iter().map(usize::to_string).collect();
                let total: usize = space.sizes().iter().product();
                let deltas = if space.deltas.is_empty() {
                    String::new()
                } else {
                    format!(" + {} continuous", space.deltas.len())
                };
                format!("{} = {total}{deltas}", sizes.join("x"))
            };
            writeln!(
                out,
                "{:<28} {budget:>6}  {:<40} {}",
                id.to_string(),
                sizes(&simplified),
                sizes(&full)
            )?;
        }
    }
    Ok(())
}

/// The sub-actions as lists of button names; a continuous one is a list of its one name.
fn groups(space: &ActionSpace) -> Value {
    let categorical = space
        .groups
        .iter()
        .map(|group| group.buttons.iter().map(|&(name, _)| name).collect::<Vec<_>>());
    let continuous = space.deltas.iter().map(|delta| vec![delta.name()]);
    Value::from(categorical.chain(continuous).map(Value::from).collect::<Vec<Value>>())
}
