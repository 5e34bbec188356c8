//! The whole way from run directories to a folder of files.

use crate::chart::{pdf, rasterise, standalone_svg};
use crate::document::{Block, Document};
use crate::former::{Former, LIST, PAPER, TABLES};
use crate::group::Group;
use crate::latex::{DOCUMENT, latex};
use crate::markdown::{FIGURES, markdown};
use crate::run::{Found, Warning, discover};
use crate::sections::Baselines;
use crate::{csv, page, sections};
use hasard_media::files::write_whole;
use hasard_media::png;
use std::path::{Path, PathBuf};

/// What a report was made of and where it lies.
#[derive(Clone, Debug)]
pub struct Written {
    /// The page, to be opened in a browser.
    pub page: PathBuf,
    /// Every file written, the page first.
    pub files: Vec<PathBuf>,
    /// Number of runs that it counts.
    pub runs: usize,
    /// Number of experiments (runs that differ in seed alone).
    pub experiments: usize,
    /// What was passed over; also a section of the page.
    pub warnings: Vec<Warning>,
}

/// Reads the runs and episodes below `paths` and writes into `out`: `index.html`, `report.md`,
/// `experiments.csv`, `runs.csv`, `curves.csv`, and `figures/` with each figure as SVG and PNG and
/// the heatmaps as PNG and GIF. The same runs give the same bytes. An earlier report in `out` goes;
/// other files stay.
///
/// # Errors
/// One line that names the path and the remedy: nothing found, files in `out` and none of a report,
/// or a file that cannot be written.
pub fn write_report(paths: &[PathBuf], out: &Path, title: &str) -> Result<Written, String> {
    write(paths, out, title, false)
}

/// As [`write_report`], and beside it what a paper takes in: `tables.tex` (booktabs), `paper.tex`,
/// a document around it, and each figure as PDF.
///
/// # Errors
/// As there.
pub fn write_report_and_latex(
    paths: &[PathBuf],
    out: &Path,
    title: &str,
) -> Result<Written, String> {
    write(paths, out, title, true)
}

/// The page of [`write_report`] alone, as text. Most of a report's time goes into the pictures
/// beside it, which the page draws itself.
///
/// # Errors
/// One line that names the path and the remedy: nothing found.
pub fn report_page(paths: &[PathBuf], title: &str) -> Result<String, String> {
    Ok(page::page(&Read::of(paths, title)?.document))
}

/// The runs below some paths, and what the report says of them.
struct Read {
    found: Found,
    warnings: Vec<Warning>,
    groups: Vec<Group>,
    document: Document,
}

impl Read {
    fn of(paths: &[PathBuf], title: &str) -> Result<Read, String> {
        let mut found = discover(paths)?;
        let mut warnings = std::mem::take(&mut found.warnings);
        let groups = Group::sort(&found, &mut warnings);
        let document = sections::document(title, &found, &groups, &mut warnings);
        Ok(Read { found, warnings, groups, document })
    }
}

fn write(paths: &[PathBuf], out: &Path, title: &str, for_papers: bool) -> Result<Written, String> {
    // Before the work: reading a campaign takes minutes.
    let former = Former::of(out)?;
    let Read { found, warnings, groups, document } = Read::of(paths, title)?;
    let files = contents(&found, &groups, &document, for_papers);
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    former.give_way(out, &names)?;
    // First the list by which the next report knows the others, should this one be cut short.
    let (list, others): (Vec<_>, Vec<_>) = files.iter().partition(|(name, _)| name == LIST);
    for (name, bytes) in list.into_iter().chain(others) {
        write_whole(&out.join(name), bytes).map_err(|error| error.to_string())?;
    }
    let files = files.iter().map(|(name, _)| out.join(name)).collect();
    let runs = groups.iter().map(|group| group.runs.len()).sum();
    Ok(Written { page: out.join("index.html"), files, runs, experiments: groups.len(), warnings })
}

/// Every file of a report, by its name in the folder, the page first.
fn contents(
    found: &Found,
    groups: &[Group],
    document: &Document,
    for_papers: bool,
) -> Vec<(String, Vec<u8>)> {
    let mut files: Vec<(String, Vec<u8>)> = Vec::new();
    let mut add = |name: &str, bytes: Vec<u8>| files.push((name.to_owned(), bytes));
    add("index.html", page::page(document).into());
    add(LIST, markdown(document).into());
    add("experiments.csv", csv::experiments_csv(groups).into());
    add("runs.csv", csv::runs_csv(groups, &Baselines::new(found, groups)).into());
    add("curves.csv", csv::curves_csv(groups).into());
    if for_papers {
        add(TABLES, latex(document, FIGURES).into());
        add(PAPER, DOCUMENT.into());
    }
    for block in document.sections.iter().flat_map(|section| &section.blocks) {
        match block {
            Block::Figure(figure) => {
                let of = |end: &str| format!("{FIGURES}/{}.{end}", figure.slug);
                add(&of("svg"), standalone_svg(&figure.drawing, &figure.caption).into());
                if for_papers {
                    add(&of("pdf"), pdf(&figure.drawing));
                }
                if let Some(picture) = rasterise(&figure.drawing) {
                    add(&of("png"), png::encode(&picture));
                }
            }
            Block::Image(image) => add(&format!("{FIGURES}/{}", image.file), image.bytes.clone()),
            Block::Heading(_) | Block::Table(_) => {}
        }
    }
    files
}
