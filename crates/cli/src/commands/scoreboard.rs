//! `hasard scoreboard`: a page of all claims of a folder that hold.

use super::claim::claims;
use crate::args::ScoreboardArgs;
use crate::failure::{Failure, Lines, Outcome, presentable};
use crate::settings::cores;
use hasard_learn::config::EnvConfig;
use hasard_learn::runs::checksum::sha256;
use hasard_learn::runs::claim::{Claim, LISTED_EPISODES, Verdict};
use hasard_learn::runs::temperature::Temperature;
use hasard_report::scoreboard::{Entry, write_scoreboard};
use serde_json::json;

/// Runs the command.
pub fn run(args: &ScoreboardArgs) -> Outcome {
    let paths = claims(&args.folder)?;
    let (mut entries, mut refused, mut seen) = (Vec::new(), Vec::new(), Vec::new());
    for (number, path) in paths.iter().enumerate() {
        if !args.json {
            let shown = presentable(&path.display().to_string());
            note!("hasard: {} of {}: {shown}", number + 1, paths.len());
        }
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let claim = match Claim::read(path) {
            Ok(claim) => claim,
            Err(error) => {
                refused.push((name, error.to_string()));
                continue;
            }
        };
        if !LISTED_EPISODES.contains(&claim.episodes) {
            let listed = LISTED_EPISODES.map(|number| number.to_string()).join(", ");
            refused.push((
                name,
                format!(
                    "it has {} episodes; a scoreboard lists claims of one of {listed}",
                    claim.episodes
                ),
            ));
            continue;
        }
        // The same file under another name is the same entry.
        let of = (claim.agent_sha256.clone(), claim.rules.clone(), claim.episodes);
        if let Some((_, first)) = seen.iter().find(|(known, _)| *known == of) {
            refused.push((name, format!("its agent is that of {first}")));
            continue;
        }
        match claim.check(&args.folder, cores()) {
            Ok(Verdict::Holds(measured)) => {
                seen.push((of, name));
                let (evaluation, budget) = (&measured.evaluation, measured.budget);
                let tails = evaluation.constraints.first().map(|one| one.tails).unwrap_or_default();
                let env = &measured.config.env;
                let own = env.scenario_file.and_then(|own| own.scenario().file);
                entries.push(Entry {
                    sees: sees(env),
                    text: own.map(|file| sha256(file.text.as_bytes())),
                    acts: acts(env, measured.temperature),
                    environment: claim.environment,
                    rules: claim.rules,
                    hard: claim.hard,
                    name: claim.name,
                    algorithm: claim.algorithm,
                    frames: claim.frames as f64,
                    returns: (evaluation.episode_return.mean, evaluation.episode_return.half_width),
                    cost: (evaluation.cost.mean, evaluation.cost.half_width),
                    cost_high: evaluation.cost.high(),
                    budget,
                    worst_tenth: tails.cvar,
                    over: tails.over_budget.unwrap_or(0.0),
                    episodes: claim.episodes as usize,
                    agent: claim.agent,
                    how: claim.how,
                });
            }
            Ok(Verdict::Refused(problems)) => refused.push((name, problems.join("; "))),
            Err(error) => refused.push((name, error.to_string())),
        }
    }
    let page = write_scoreboard(&args.title, entries, &refused, &args.folder.join("index.html"))
        .map_err(Failure::bad)?;
    let mut lines = Lines::new();
    if args.json {
        let list: Vec<_> =
            refused.iter().map(|(claim, why)| json!({ "claim": claim, "why": why })).collect();
        lines.say(
            json!({ "page": page.display().to_string(), "hold": paths.len() - refused.len(), "refused": list })
        );
    } else {
        let listed = paths.len() - refused.len();
        lines.say(format!("{}: lists {listed} of {} claims", page.display(), paths.len()));
    }
    lines.end(match refused.len() {
        0 => Ok(()),
        1 => Err(Failure::Negative("1 claim is not listed; the page says why".into())),
        count => {
            Err(Failure::Negative(format!("{count} claims are not listed; the page says why")))
        }
    })
}

/// An agent's action space, and its temperature where it has another than that of training.
fn acts(env: &EnvConfig, temperature: Temperature) -> String {
    let space = if env.full_actions { "full" } else { "simplified" };
    if temperature.is_as_trained() {
        return space.into();
    }
    format!("{space}, temperature {temperature}")
}

/// What an agent sees; its size and number of pictures where they are not the usual ones.
fn sees(env: &EnvConfig) -> String {
    let usual = EnvConfig::new(&env.id);
    let mut text = env.observation.clone();
    if env.size != usual.size {
        text += &format!(", {}x{}", env.size.0, env.size.1);
    }
    if env.frame_stack != usual.frame_stack {
        text += &format!(", {} pictures", env.frame_stack);
    }
    text
}
