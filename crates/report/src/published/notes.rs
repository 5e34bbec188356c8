//! What a reader must know about a published value before comparing it with one of ours.

use super::Published;

/// One note a line: its kind, the tables, algorithms, scenarios and levels that it is for (`*` for
/// all, `a|b` for several), and its text. Of the notes on seeds the first that fits counts.
const NOTES: &str = include_str!("../../data/published_notes.csv");

/// The notes on a cell; `data/README.md` has them in full.
pub(super) fn of(cell: &Published) -> Vec<String> {
    let level = cell.level.to_string();
    let of_cell = [&cell.table, &cell.algorithm, &cell.scenario, &level].map(String::as_str);
    let fitting = |kind: &'static str| {
        NOTES.lines().skip(1).filter_map(move |line| {
            let fields: Vec<&str> = line.splitn(6, ',').collect();
            let [of_kind, fits @ .., note] = &fields[..] else { return None };
            let fits = fits.iter().zip(of_cell).all(|(allowed, one)| {
                *allowed == "*" || allowed.split('|').any(|allowed| allowed == one)
            });
            (*of_kind == kind && fits).then(|| (*note).to_owned())
        })
    };
    let corrected = (cell.episode_return != cell.printed_return).then(|| {
        format!("printed as {}: the penalty was added back at scale 1", cell.printed_return)
    });
    fitting("seeds").take(1).chain(corrected).chain(fitting("also")).collect()
}
