//! `hasard claim`: what an agent scores on the episodes of a scoreboard, as a file that anybody can
//! check.

use super::export_agent::export_selected;
use crate::args::ClaimArgs;
use crate::commands::train_again;
use crate::failure::{Failure, Outcome};
use crate::settings::cores;
use crate::zoo;
use hasard_learn::config::TrainConfig;
use hasard_learn::runs::agent::run_config;
use hasard_learn::runs::agent_file::AgentFile;
use hasard_learn::runs::checksum::sha256;
use hasard_learn::runs::claim::{Claim, measure, wrong_words};
use hasard_learn::runs::temperature::Temperature;
use hasard_media::files::{Scratch, write_whole};
use hasard_report::document::count;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Ending of a claim's file.
pub const ENDING: &str = "claim.json";

/// Runs the command.
pub fn run(args: &ClaimArgs) -> Outcome {
    let agent = zoo::find(&args.agent)?;
    let config = run_config(&agent).map_err(Failure::bad)?;
    let bytes = if agent.is_dir() {
        export_selected(&agent)
    } else {
        AgentFile::read_whole(&agent).map(|(bytes, _)| bytes)
    };
    let bytes = bytes.map_err(Failure::bad)?;
    let rules = args.rules.map(hasard_envs::RuleSet::from);
    let under = rules.map_or(config.env.rules.as_str(), |rules| rules.name()).to_string();
    let id = config.env.id.trim_end_matches("-v0").to_string();
    let slug = hasard_report::document::slug(&args.name);
    if slug.is_empty() {
        return Err(Failure::bad(format!(
            "--name '{}': has no letter or digit that a file's name can have; give it one of a to z or 0 to 9",
            args.name
        )));
    }
    let given = args.how.as_deref().unwrap_or_default();
    if let Some(problem) = wrong_words(&args.name, given) {
        return Err(Failure::bad(format!("--name and --how of a claim: {problem}")));
    }
    let hard = if config.env.hard { ".hard" } else { "" };
    let stem = format!("{id}.{under}{hard}.{slug}");
    let (file, path) =
        (format!("{stem}.{}", zoo::ENDING), args.out.join(format!("{stem}.{ENDING}")));
    if let Ok(there) = Claim::read(&path)
        && there.name != args.name
    {
        return Err(Failure::bad(format!(
            "--name '{}': {} is the claim of '{}'; give a name with other letters, or another --out",
            args.name,
            path.display(),
            there.name
        )));
    }
    // The same agent, measured again, takes the place of what it was.
    if let Ok(there) = Claim::read(&path)
        && there.agent_sha256 != sha256(&bytes)
    {
        return Err(Failure::bad(format!(
            "{}: is the claim of another agent; give another --name or --out, or remove that claim",
            path.display()
        )));
    }
    // The agent first: what is claimed is measured from the very file that is given away.
    // Under another name until it is measured, so that an earlier claim stays whole until then.
    let (kept, new) = (args.out.join(&file), args.out.join(format!("{file}.partial")));
    write_whole(&new, &bytes).map_err(Failure::bad)?;
    let scratch = Scratch::new(new.clone());
    let measured = measure(&new, rules, args.episodes, cores()).map_err(Failure::bad);
    let measured = measured.and_then(|measured| {
        let named = std::fs::rename(&new, &kept);
        let unnamed =
            |error| Failure::bad(format!("{}: cannot be written: {error}", kept.display()));
        named.map(|()| measured).map_err(unnamed)
    });
    drop(scratch);
    let measured = measured?;
    let how = args.how.clone().unwrap_or_else(|| made_again(&config, measured.temperature));
    let claim = Claim::new(&args.name, &file, &bytes, &how, &measured);
    write_whole(&path, format!("{:#}\n", json!(claim)).as_bytes()).map_err(Failure::bad)?;
    let verified = format!("hasard verify {}", hasard_media::shell::quote(&path));
    if args.json {
        say!(
            "{}",
            json!({ "claim": path.display().to_string(), "agent": kept.display().to_string(), "holds": true })
        );
    } else {
        let (evaluation, budget) = (&measured.evaluation, measured.budget);
        say!(
            "{}: return {:.3}, cost {:.3} of {budget} over {}; anybody can check it: {verified}",
            path.display(),
            evaluation.episode_return.mean,
            evaluation.cost.mean,
            count(evaluation.episodes, "episode")
        );
    }
    Ok(())
}

/// The commands that make an agent again.
fn made_again(config: &TrainConfig, temperature: Temperature) -> String {
    let train = train_again::command(config);
    if temperature.is_as_trained() {
        return train;
    }
    format!("{train}; hasard export-agent RUN --temperature {temperature}")
}

/// The claims of a folder, by name; one without any is refused.
pub fn claims(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let unread = |error| {
        Failure::bad(format!(
            "{}: cannot be read: {error}; name a folder of claims, which `hasard claim --out` writes",
            folder.display()
        ))
    };
    let mut found: Vec<PathBuf> =
        std::fs::read_dir(folder).map_err(unread)?.flatten().map(|entry| entry.path()).collect();
    found.retain(|path| {
        path.file_name().is_some_and(|name| name.to_string_lossy().ends_with(&format!(".{ENDING}")))
    });
    found.sort();
    if found.is_empty() {
        return Err(Failure::bad(format!(
            "{}: has no file that ends in .{ENDING}; `hasard claim` writes one",
            folder.display()
        )));
    }
    Ok(found)
}
