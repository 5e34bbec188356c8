//! `hasard verify`: does a claim hold? Its episodes are played again, to the bit.

use super::claim::claims;
use crate::args::VerifyArgs;
use crate::failure::{Failure, Lines, Outcome, presentable};
use crate::settings::cores;
use hasard_learn::runs::claim::{Claim, Verdict};
use serde_json::json;
use std::path::Path;

/// Runs the command.
pub fn run(args: &VerifyArgs) -> Outcome {
    let (mut refused, mut lines) = (0, Lines::new());
    if args.claim.try_exists().is_ok_and(|there| !there) {
        return Err(Failure::bad(format!(
            "{}: there is no such claim or folder; `hasard claim` writes a claim",
            args.claim.display()
        )));
    }
    let paths = if args.claim.is_dir() { claims(&args.claim)? } else { vec![args.claim.clone()] };
    let threads = args.threads.map_or_else(cores, usize::from);
    for path in &paths {
        let folder =
            path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let checked = Claim::read(path)
            .and_then(|claim| claim.check(folder, threads).map(|verdict| (claim, verdict)));
        let (held, problems) = match checked {
            Ok((claim, Verdict::Holds(measured))) => (Some((claim, measured)), Vec::new()),
            Ok((_, Verdict::Refused(problems))) => (None, problems),
            // Of a folder, the others are checked all the same.
            Err(error) if args.claim.is_dir() => (None, vec![error.to_string()]),
            Err(error) => return Err(Failure::bad(error)),
        };
        refused += usize::from(held.is_none());
        if args.json {
            lines.say(
                json!({ "claim": path.display().to_string(), "holds": held.is_some(), "problems": problems })
            );
        } else if let Some((claim, measured)) = held {
            let line = format!(
                "{}: holds: return {:.3}, cost {:.3} of {}, {} episodes, rules {}",
                path.display(),
                claim.return_mean,
                claim.cost_mean,
                measured.budget,
                claim.episodes,
                claim.rules
            );
            lines.say(presentable(&line));
        } else {
            let line = format!("{}: does not hold: {}", path.display(), problems.join("; "));
            lines.say(presentable(&line));
        }
    }
    lines.end(match refused {
        0 => Ok(()),
        _ => Err(Failure::Negative(format!("{refused} of {} claims do not hold", paths.len()))),
    })
}
