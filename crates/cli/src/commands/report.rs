//! `hasard report`: tables and figures from run directories.

use crate::args::ReportArgs;
use crate::failure::{Failure, Outcome};
use serde_json::json;

/// Runs the command.
pub fn run(args: &ReportArgs) -> Outcome {
    let write = if args.latex {
        hasard_report::write_report_and_latex
    } else {
        hasard_report::write_report
    };
    let written = write(&args.runs, &args.out, &args.title).map_err(Failure::bad)?;
    for warning in &written.warnings {
        note!("hasard: {warning}");
    }
    if args.json {
        let files: Vec<String> =
            written.files.iter().map(|file| file.display().to_string()).collect();
        let page = written.page.display().to_string();
        say!(
            "{}",
            json!({ "page": page, "files": files, "runs": written.runs, "experiments": written.experiments })
        );
    } else {
        let count = |number: usize, noun: &str| {
            format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
        };
        let (runs, experiments) =
            (count(written.runs, "run"), count(written.experiments, "experiment"));
        say!(
            "{}: {runs}, {experiments}, {}",
            written.page.display(),
            count(written.files.len(), "file")
        );
    }
    Ok(())
}
