//! Runs that went on beyond the frames they were first asked for are marked with a dagger.

mod synthetic;

use hasard_report::write_report_and_latex;
use synthetic::{Folder, Synthetic};

const EXTENDED: &str =
    ",\"changes\":[{\"frames\":4e6,\"setting\":\"frames\",\"from\":4000000,\"to\":8000000}]";

#[test]
fn only_a_run_that_went_on_has_a_dagger() {
    for (options, marked) in [(EXTENDED, true), ("", false)] {
        let folder = Folder::new(if marked { "extended" } else { "not_extended" });
        let env = "RemedyRushLevel1-v0";
        for (algo, options) in [("PPOLag", options), ("PPOPID", "")] {
            let end = (30.0, 4.0, 1.0);
            let run = Synthetic { env, algo, seed: 1, frames: 8e6, reports: 80, options, end };
            run.write(&folder.0.join("runs").join(algo));
        }
        let out = folder.0.join("report");
        let runs = [folder.0.join("runs")];
        let written = write_report_and_latex(&runs, &out, "Test").unwrap();
        let page = std::fs::read_to_string(written.page).unwrap();
        assert_eq!(page.contains('†'), marked);
        assert_eq!(page.contains("went on beyond its first target of 4M frames"), marked);
        assert_eq!(page.contains("† went on beyond the frames"), marked);
        // The one that did not has none: one cell of return is marked, and the caption explains it.
        let cells = page.matches(" †").count();
        assert!(if marked { cells >= 1 } else { cells == 0 }, "{cells}");
        let mut tex = String::new();
        gather(&out, &mut tex);
        assert_eq!(tex.contains("$\\dagger$"), marked);
    }
}

/// The text of all LaTeX files below a folder.
fn gather(folder: &std::path::Path, all: &mut String) {
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        let path = entry.path();
        if path.is_dir() {
            gather(&path, all);
        } else if path.extension().is_some_and(|ending| ending == "tex") {
            all.push_str(&std::fs::read_to_string(path).unwrap());
        }
    }
}
