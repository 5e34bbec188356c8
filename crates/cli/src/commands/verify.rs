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
        let claim = Claim::read(path).map_err(Failure::bad)?;
        let folder =
            path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let verdict = claim.check(folder, threads).map_err(Failure::bad)?;
        let problems = match &verdict {
            Verdict::Holds(_) => Vec::new(),
            Verdict::Refused(problems) => problems.clone(),
        };
        refused += usize::from(!problems.is_empty());
        if args.json {
            say!(
                "{}",
                json!({ "claim": path.display().to_string(), "holds": problems.is_empty(), "problems": problems })
            );
        } else if let Verdict::Holds(measured) = &verdict {
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
            say!("{}: does not hold: {}", path.display(), problems.join("; "));
        }
    }
    match refused {
        0 => Ok(()),
        _ => Err(Failure::Negative(format!("{refused} of {} claims do not hold", paths.len()))),
    }
}
