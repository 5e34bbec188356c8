//! Options of `hasard train` that a sweep's own command line gives.

use crate::args::SweepArgs;
use crate::failure::Failure;
use hasard_sweep::{OptionValue, Sweep};
use std::collections::BTreeSet;

/// Gives them to every run, over what the file says of them.
///
/// # Errors
/// When one is given twice, of which a run could have only the last, or sets what the sweep sets.
pub fn give(sweep: &mut Sweep, args: &SweepArgs) -> Result<(), Failure> {
    let mut names = BTreeSet::new();
    if let Some(preset) = &args.preset {
        names.insert("preset");
        sweep.set_option("preset", &OptionValue::Text(preset.clone()));
    }
    for option in &args.option {
        let refuse = |why: String| Err(Failure::bad(format!("--option {option}: {why}")));
        let (name, value) = match option.split_once('=') {
            Some((name, value)) => (name, OptionValue::Text(value.to_owned())),
            None => (option.as_str(), OptionValue::Switch(true)),
        };
        if !names.insert(name) {
            let several =
                if name == "set" { "; several go under [settings] of a sweep file" } else { "" };
            return refuse(format!("{name} is given twice; leave one of them out{several}"));
        }
        if let (OptionValue::Text(text), "set") = (&value, name) {
            let setting = text.split('=').next().unwrap_or_default();
            let mut known = sweep.grids.iter().flat_map(|grid| &grid.settings);
            if known.any(|(known, _)| known == setting) {
                return refuse(format!(
                    "the sweep has {setting} under [settings]; change it there"
                ));
            }
        }
        sweep.set_option(name, &value);
    }
    Ok(())
}
