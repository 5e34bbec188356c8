//! A static page of agents whose claims hold: the best within the budget first.

use crate::document::{Block, Cell, Document, Mark, Section, Table, count, frames, slug};
use crate::group::{scenario_name, scenario_order};
use crate::page;
use crate::run::{Kept, scenario_and_level};
use hasard_media::files::write_whole;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// An agent whose claim holds.
#[derive(Clone, PartialEq, Debug)]
pub struct Entry {
    /// Id of the environment.
    pub environment: String,
    /// SHA-256 of the text of a task of one's own, which two tasks of one name do not share.
    pub text: Option<String>,
    /// The rule set.
    pub rules: String,
    /// The hard constraint.
    pub hard: bool,
    /// Who or what it is.
    pub name: String,
    /// The algorithm that trained it.
    pub algorithm: String,
    /// What it sees: `rgb`, `rgb+depth`, `segmented` or `grey`, with size and number of pictures
    /// where these are not the usual ones.
    pub sees: String,
    /// Its action space: `simplified` or `full`; its temperature where it is not that of training.
    pub acts: String,
    /// Frames of its training.
    pub frames: f64,
    /// Mean return and half-width of its 95 % interval.
    pub returns: (f64, f64),
    /// The same of the cost.
    pub cost: (f64, f64),
    /// Upper end of the cost's interval.
    pub cost_high: f64,
    /// The budget.
    pub budget: f64,
    /// Mean cost of the worst tenth of the episodes.
    pub worst_tenth: f64,
    /// Share of the episodes that cost more than the budget.
    pub over: f64,
    /// Number of episodes.
    pub episodes: usize,
    /// The agent's file.
    pub agent: String,
    /// The command that trained it.
    pub how: String,
}

impl Entry {
    fn kept(&self) -> Kept {
        match (self.cost_high <= self.budget, self.cost.0 <= self.budget) {
            (true, _) => Kept::Surely,
            (false, true) => Kept::ByMean,
            (false, false) => Kept::Over,
        }
    }

    /// Agents surely within the budget come first, then those within it by their mean; the higher
    /// return before the lower.
    fn rank(&self) -> (u8, f64) {
        let group = match self.kept() {
            Kept::Surely => 0,
            Kept::ByMean => 1,
            _ => 2,
        };
        (group, -self.returns.0)
    }
}

/// Writes the page; gives its path.
///
/// # Errors
/// One line when the file cannot be written.
pub fn write_scoreboard(
    title: &str,
    entries: Vec<Entry>,
    refused: &[(String, String)],
    out: &Path,
) -> Result<PathBuf, String> {
    write_whole(out, page::page(&document(title, entries, refused)).as_bytes())
        .map_err(|error| error.to_string())?;
    Ok(out.to_path_buf())
}

fn document(title: &str, entries: Vec<Entry>, refused: &[(String, String)]) -> Document {
    let subtitle = format!("{} whose claims hold", count(entries.len(), "agent"));
    let own = entries.iter().any(|entry| entry.text.is_some());
    // Tasks of one's own come after the benchmark's, by their names.
    let mut groups = BTreeMap::<_, Vec<Entry>>::new();
    for entry in entries {
        let (scenario, level) = scenario_and_level(&entry.environment);
        let order = scenario_order(&scenario);
        let task = (order, scenario, entry.text.clone(), level);
        groups.entry((task, entry.hard, entry.rules.clone())).or_default().push(entry);
    }
    let mut sections: Vec<Section> = groups.into_values().map(section).collect();
    if !refused.is_empty() {
        let rows =
            refused.iter().map(|(claim, why)| vec![Cell::text(claim), Cell::text(why)]).collect();
        let table =
            Table { heads: ["claim", "why"].map(String::from).to_vec(), rows, ..Table::default() };
        let text = vec!["Why these claims are not listed.".to_owned()];
        sections.push(Section {
            slug: "not-listed".into(),
            title: "Not listed".into(),
            text,
            blocks: vec![Block::Table(table)],
        });
    }
    if let Some(first) = sections.first_mut() {
        first.text.insert(
            0,
            "Return, cost and what follows from them were measured by `hasard verify`: the agent's file played the same \
             episodes again, to the bit. Algorithm, frames and command are what the agent's file and its author say; frames \
             are those of its own run, without those of an agent that it began with. \
             Green: the cost's mean is within the budget, on green ground up to the upper end of its 95 % interval."
                .to_owned(),
        );
        let files = "A task of one's own bears the first digits of the SHA-256 of its file, which its agents keep.";
        first.text.extend(own.then(|| files.to_owned()));
    }
    Document { title: title.to_owned(), subtitle, sections }
}

fn section(mut entries: Vec<Entry>) -> Section {
    entries.sort_by(|a, b| {
        let (a, b) = (a.rank(), b.rank());
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    let first = &entries[0];
    let (scenario, level) = scenario_and_level(&first.environment);
    let constraint = if first.hard { ", hard constraint" } else { "" };
    let text: Option<String> = first.text.as_ref().map(|digest| digest.chars().take(8).collect());
    let file = text.map_or_else(String::new, |digits| format!(", task file {digits}"));
    let title =
        format!("{} {level}{file}, rules {}{constraint}", scenario_name(&scenario), first.rules);
    let spread = |(mean, half): (f64, f64)| Cell {
        sort: Some(mean),
        ..Cell::text(format!("{mean:.2} ± {half:.2}"))
    };
    let rows = entries.iter().map(|one| {
        vec![
            Cell { title: one.how.clone(), ..Cell::text(&one.name) },
            Cell::text(&one.algorithm),
            Cell::text(&one.sees),
            Cell::text(&one.acts),
            Cell { sort: Some(one.frames), ..Cell::text(frames(one.frames)) },
            spread(one.returns),
            Cell { mark: Mark::of(one.kept()), ..spread(one.cost) },
            Cell::number(one.budget),
            Cell::number(one.worst_tenth),
            Cell { sort: Some(one.over), ..Cell::text(format!("{:.0} %", 100.0 * one.over)) },
            Cell { sort: Some(one.episodes as f64), ..Cell::text(one.episodes.to_string()) },
            Cell::text(&one.agent),
        ]
    });
    let heads = [
        "agent",
        "algorithm",
        "sees",
        "actions",
        "frames",
        "return",
        "cost",
        "budget",
        "worst tenth",
        "over",
        "episodes",
        "file",
    ];
    let table =
        Table { heads: heads.map(String::from).to_vec(), rows: rows.collect(), ..Table::default() };
    Section { slug: slug(&title), title, text: Vec::new(), blocks: vec![Block::Table(table)] }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(name: &str, returns: f64, cost: f64, cost_high: f64) -> Entry {
        Entry {
            environment: "RemedyRushLevel1-v0".into(),
            text: None,
            rules: "paper".into(),
            hard: false,
            name: name.into(),
            algorithm: "PPOPID".into(),
            sees: "rgb".into(),
            acts: "simplified".into(),
            frames: 1e7,
            returns: (returns, 1.0),
            cost: (cost, cost_high - cost),
            cost_high,
            budget: 5.0,
            worst_tenth: 9.0,
            over: 0.3,
            episodes: 200,
            agent: "one.agent".into(),
            how: "hasard train".into(),
        }
    }

    /// Each has a table of its own, under its name and the digest of its file.
    #[test]
    fn tasks_of_ones_own_are_not_mixed() {
        let own = |name: &str, id: &str, text: &str| Entry {
            environment: id.into(),
            text: Some(text.into()),
            ..entry(name, 1.0, 1.0, 2.0)
        };
        let entries = vec![
            own("c", "ZooLevel1-v0", "0123456789"),
            own("b", "MazeLevel1-v0", "9876543210"),
            own("a", "MazeLevel1-v0", "0123456789"),
            own("d", "MazeLevel1-v0", "0123456789"),
            entry("first", 1.0, 1.0, 2.0),
        ];
        let document = document("Scores", entries, &[]);
        let titles: Vec<&str> =
            document.sections.iter().map(|section| section.title.as_str()).collect();
        assert_eq!(titles.len(), 4, "{titles:?}");
        assert!(titles[0].starts_with("Remedy Rush 1, rules paper"), "{titles:?}");
        assert!(titles[1].contains("Maze") && titles[1].contains("01234567,"), "{titles:?}");
        assert!(titles[2].contains("Maze") && titles[2].contains("98765432,"), "{titles:?}");
        assert!(titles[3].contains("Zoo"), "{titles:?}");
    }

    #[test]
    fn what_is_surely_within_comes_first_and_then_the_higher_return() {
        let entries = vec![
            entry("over", 50.0, 6.0, 6.5),
            entry("by its mean", 40.0, 4.9, 5.2),
            entry("second", 20.0, 4.0, 4.5),
            entry("first", 30.0, 4.0, 4.5),
        ];
        let document = document(
            "Scores",
            entries,
            &[("bad.claim.json".into(), "its episodes were others".into())],
        );
        let Block::Table(table) = &document.sections[0].blocks[0] else { panic!("no table") };
        let names: Vec<&str> = table.rows.iter().map(|row| row[0].text.as_str()).collect();
        assert_eq!(names, ["first", "second", "by its mean", "over"]);
        assert_eq!(document.sections.last().unwrap().title, "Not listed");
    }
}
