//! The folder that a report is written to, and what is in it before.

mod synthetic;

use hasard_report::{write_report, write_report_and_latex};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use synthetic::{Folder, Synthetic, write_heatmaps};

fn write_run(folder: &Path, algo: &str, seed: u64) {
    let (env, end) = ("RemedyRushLevel1-v0", (30.0, 4.0, 1.0));
    Synthetic { env, algo, seed, frames: 4e6, reports: 20, options: "", end }.write(folder);
}

/// The names of all files below a folder.
fn files_below(folder: &Path) -> BTreeSet<PathBuf> {
    let mut all = BTreeSet::new();
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        match entry.path() {
            path if path.is_dir() => all.extend(files_below(&path)),
            path => drop(all.insert(path)),
        }
    }
    all
}

#[test]
fn a_folder_of_other_files_is_no_place_for_a_report() {
    let folder = Folder::new("others");
    let (run, out) = (folder.0.join("run"), folder.0.join("out"));
    write_run(&run, "PPO", 1);
    std::fs::create_dir_all(out.join("figures")).unwrap();
    for name in ["index.html", "report.md", "figures/mine.svg"] {
        std::fs::write(out.join(name), "mine").unwrap();
    }
    let before = files_below(&out);
    let error = write_report(std::slice::from_ref(&run), &out, "t").unwrap_err();
    let said = format!("{}: is not empty, and what is in it is of no report; give", out.display());
    assert!(error.starts_with(&said), "{error}");
    assert_eq!(files_below(&out), before);
    assert_eq!(std::fs::read_to_string(out.join("report.md")).unwrap(), "mine");
    // Hidden files are in nobody's way, such as what a killed program leaves.
    let hidden = folder.0.join("hidden");
    std::fs::create_dir(&hidden).unwrap();
    std::fs::write(hidden.join(".index.html.1.tmp"), "").unwrap();
    write_report(std::slice::from_ref(&run), &hidden, "t").unwrap();
}

/// A smaller report leaves nothing of the larger one, and leaves the user's files.
#[test]
fn a_report_takes_the_place_of_an_earlier_one() {
    let folder = Folder::new("place");
    let (runs, out) = (folder.0.join("runs"), folder.0.join("out"));
    for (algo, seed) in [("PPO", 1), ("PPOLag", 1), ("PPOLag", 2)] {
        let run = runs.join(format!("{algo}{seed}"));
        write_run(&run, algo, seed);
        write_heatmaps(&run);
    }
    let larger = write_report_and_latex(std::slice::from_ref(&runs), &out, "Large").unwrap();
    let written: BTreeSet<PathBuf> = larger.files.into_iter().collect();
    assert_eq!(files_below(&out), written, "it lists all that it writes");
    for name in ["notes.txt", "figures/mine.svg", "figures/mine.png"] {
        std::fs::write(out.join(name), "mine").unwrap();
    }
    let small = [runs.join("PPO1")];
    let smaller = write_report(&small, &out, "Small").unwrap();
    let mut expected: BTreeSet<PathBuf> = smaller.files.iter().cloned().collect();
    assert!(expected.len() + 3 < written.len());
    expected.extend(["notes.txt", "figures/mine.svg", "figures/mine.png"].map(|it| out.join(it)));
    assert_eq!(files_below(&out), expected);
    assert_eq!(std::fs::read_to_string(out.join("figures/mine.svg")).unwrap(), "mine");

    // A file of the user's by the name of a new one stays, and so does the whole former report.
    std::fs::write(out.join("paper.tex"), "mine").unwrap();
    let page = std::fs::read(out.join("index.html")).unwrap();
    let error = write_report_and_latex(&[runs], &out, "Large").unwrap_err();
    assert!(error.starts_with(&format!("{}/paper.tex: is not as", out.display())), "{error}");
    assert!(std::fs::read(out.join("index.html")).unwrap() == page);
    expected.insert(out.join("paper.tex"));
    assert_eq!(files_below(&out), expected);
    write_report(&small, &out, "Small").unwrap();
    assert_eq!(files_below(&out), expected);
    // A report that was cut short is known by its list, which comes first.
    let list = std::fs::read(out.join("report.md")).unwrap();
    std::fs::remove_dir_all(&out).unwrap();
    std::fs::create_dir(&out).unwrap();
    std::fs::write(out.join("report.md"), list).unwrap();
    write_report(&small, &out, "Small").unwrap();
}
