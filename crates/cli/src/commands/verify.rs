//! `hasard verify`: does a claim hold? Its episodes are played again, to the bit.

use super::claim::claims;
use crate::args::VerifyArgs;
use crate::failure::{Failure, Outcome};
use crate::settings::cores;
use hasard_learn::runs::claim::{Claim, Verdict};
use serde_json::json;
use std::path::Path;

/// Runs the command.
pub fn run(args: &VerifyArgs) -> Outcome {
    let mut refused = 0;
    let paths = if args.claim.is_dir() { claims(&args.claim)? } else { vec![args.claim.clone()] };
    let threads = args.threads.map_or_else(cores, usize::from);
    for path in &paths {
        let claim = match Claim::read(path) {
            Ok(claim) => claim,
            Err(error) if args.claim.is_dir() => {
                refused += 1;
                say_verdict(args.json, path, &[error.to_string()])?;
                continue;
            }
            Err(error) => return Err(Failure::bad(error)),
        };
        let folder =
            path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let verdict = match claim.check(folder, threads) {
            Ok(verdict) => verdict,
            // Of a folder, the others are checked all the same.
            Err(error) if args.claim.is_dir() => Verdict::Refused(vec![error.to_string()]),
            Err(error) => return Err(Failure::bad(error)),
        };
        let problems = match &verdict {
            Verdict::Holds(_) => Vec::new(),
            Verdict::Refused(problems) => problems.clone(),
        };
        refused += usize::from(!problems.is_empty());
        if let (Verdict::Holds(measured), false) = (&verdict, args.json) {
            say!(
                "{}: holds: return {:.3}, cost {:.3} of {}, {} episodes, rules {}",
                path.display(),
                claim.return_mean,
                claim.cost_mean,
                measured.budget,
                claim.episodes,
                claim.rules
            );
        } else {
            say_verdict(args.json, path, &problems)?;
        }
    }
    match refused {
        0 => Ok(()),
        _ => Err(Failure::Negative(format!("{refused} of {} claims do not hold", paths.len()))),
    }
}

/// Says whether a claim holds; with a reason where it does not.
fn say_verdict(as_json: bool, path: &Path, problems: &[String]) -> Outcome {
    if as_json {
        let (claim, holds) = (path.display().to_string(), problems.is_empty());
        say!("{}", json!({ "claim": claim, "holds": holds, "problems": problems }));
    } else {
        say!("{}: does not hold: {}", path.display(), problems.join("; "));
    }
    Ok(())
}
