//! `hasard site`: the project's pages as plain HTML.

use crate::args::SiteArgs;
use crate::failure::{Failure, Outcome};
use hasard_report::site::{Sources, write_site};
use serde_json::json;

/// Runs the command.
pub fn run(args: &SiteArgs) -> Outcome {
    let fits = |path: &&std::path::PathBuf| {
        path.extension().is_some_and(|ending| ending == "mp4" || ending == "gif")
    };
    if let Some(other) = args.films.iter().find(|path| !fits(path)) {
        return Err(Failure::bad(format!(
            "{}: a film of the site ends in .mp4 or .gif",
            other.display()
        )));
    }
    if let Some(missing) = args.films.iter().find(|path| !path.is_file()) {
        let why = "there is no such film; `hasard record` makes one";
        return Err(Failure::bad(format!("{}: {why}", missing.display())));
    }
    let sources = Sources { root: args.root.clone(), films: args.films.clone() };
    let written = write_site(&sources, &args.out).map_err(Failure::bad)?;
    let page = written.page.display().to_string();
    if args.json {
        say!(
            "{}",
            json!({ "page": page, "pages": written.pages, "files": written.files, "lost": written.lost })
        );
    } else {
        for lost in &written.lost {
            note!("hasard: {lost}: is not there; the link is left out");
        }
        say!("{page}: {} pages, {} files", written.pages, written.files);
    }
    Ok(())
}
