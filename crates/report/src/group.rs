//! Runs of one experiment that differ in their seed alone.

use crate::run::{Config, Found, Kept, Run, SHOWN, Warning};
use crate::statistics::Estimate;
use hasard_envs::Scenario;
use std::collections::BTreeMap;

/// One experiment: the same environment, algorithm and options, a run a seed. Nothing else is ever
/// averaged.
#[derive(Clone, Debug)]
pub struct Group {
    /// The runs, in the order of their seeds, no seed twice.
    pub runs: Vec<Run>,
    /// The options that stand beside its results: see [`SHOWN`].
    pub shown: BTreeMap<String, String>,
}

/// Where the numbers of a table come from.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Source {
    /// Episodes of the selected checkpoint that training has not seen.
    Evaluation,
    /// Recent episodes of training, at its end.
    Training,
}

impl Group {
    /// Sorts runs into experiments, in the order scenario, level, algorithm, frames (most first),
    /// options. Of several runs with equal configuration and seed the one that got furthest is
    /// kept.
    pub fn sort(found: &Found, warnings: &mut Vec<Warning>) -> Vec<Group> {
        let mut groups: BTreeMap<String, Vec<Run>> = BTreeMap::new();
        for run in &found.runs {
            let config = &run.config;
            let place = scenario_order(&config.scenario);
            let frames = u64::MAX - config.frames.unwrap_or(0.0).max(0.0) as u64;
            let key = format!(
                "{place:02} {} {} {:02} {} {frames:020} {:?} {:?}",
                config.scenario,
                config.level,
                algorithm_order(&config.algo),
                config.algo.to_ascii_lowercase(),
                config.options,
                config.safety_budget
            );
            groups.entry(key).or_default().push(run.clone());
        }
        let mut groups: Vec<Group> = groups
            .into_values()
            .map(|mut runs| {
                runs.sort_by(|a, b| a.config.seed.cmp(&b.config.seed).then(b.frames().total_cmp(&a.frames())));
                let mut kept: Vec<Run> = Vec::new();
                for run in runs {
                    match kept.last() {
                        Some(last) if last.config.seed == run.config.seed => warnings.push(Warning {
                            problem: format!(
                                "repeats the configuration and seed {} of {}, which got further or as far; left out",
                                run.config.seed,
                                last.path.display()
                            ),
                            path: run.path,
                            line: 0,
                        }),
                        _ => kept.push(run),
                    }
                }
                warnings.extend(kept.iter().find_map(|run| selected_otherwise(&kept[0], run)));
                warnings.extend(kept.iter().find_map(|run| of_another_version(&kept[0], run)));
                let shown = kept[0].config.options.iter().filter(|(key, _)| SHOWN.contains(&key.as_str()));
                Group { shown: shown.map(|(key, value)| (key.clone(), value.clone())).collect(), runs: kept }
            })
            .collect();
        distinguish(&mut groups);
        groups
    }

    /// What all its runs share.
    #[must_use]
    pub fn config(&self) -> &crate::run::Config {
        &self.runs[0].config
    }

    /// A metric at the end of training: per seed the mean of its last points, then the mean over
    /// seeds.
    #[must_use]
    pub fn final_estimate(&self, metric: &str) -> Option<Estimate> {
        Estimate::of(&self.final_samples(metric))
    }

    /// A metric at the end of training, a number a seed.
    #[must_use]
    pub fn final_samples(&self, metric: &str) -> Vec<f64> {
        self.runs.iter().filter_map(|run| run.final_mean(metric)).collect()
    }

    /// Where its headline comes from: evaluation, if any of its runs was evaluated.
    #[must_use]
    pub fn headline(&self) -> Source {
        let evaluated = self.runs.iter().any(|run| run.evaluated("return_mean").is_some());
        if evaluated { Source::Evaluation } else { Source::Training }
    }

    /// A metric from one of the sources, a number a seed.
    #[must_use]
    pub fn samples(&self, source: Source, metric: &str) -> Vec<f64> {
        match source {
            Source::Training => self.final_samples(metric),
            Source::Evaluation => self
                .runs
                .iter()
                .filter_map(|run| run.evaluated(metric))
                .map(|one| one.mean)
                .collect(),
        }
    }

    /// A metric from one of the sources, the mean over seeds.
    #[must_use]
    pub fn estimate(&self, source: Source, metric: &str) -> Option<Estimate> {
        Estimate::of(&self.samples(source, metric))
    }

    /// How its costs stand to its budgets, over seeds. Of a single evaluated seed the spread over
    /// episodes decides; of a single seed in training nothing is known about the spread.
    #[must_use]
    pub fn kept(&self, source: Source) -> Kept {
        let kept = self.config().constraints.iter().map(|one| {
            let over_seeds = self.estimate(source, &one.metric());
            let single = (source == Source::Evaluation
                && over_seeds.is_some_and(|cost| cost.n == 1))
            .then(|| self.runs.iter().find_map(|run| run.evaluated(&one.metric())))
            .flatten();
            one.kept_by(single.or(over_seeds))
        });
        kept.min().unwrap_or_default()
    }

    /// Frames that the shortest and the longest run reached.
    #[must_use]
    pub fn frames_span(&self) -> (f64, f64) {
        let frames = self.runs.iter().map(Run::frames);
        (frames.clone().fold(f64::INFINITY, f64::min), frames.fold(0.0, f64::max))
    }

    /// Whether every run reached the frames that it was asked for; `true` if they do not say.
    #[must_use]
    pub fn finished(&self) -> bool {
        self.runs.iter().all(Run::finished)
    }

    /// The least number of frames that one of its runs was first asked for, if any went on beyond
    /// that.
    #[must_use]
    pub fn extended_from(&self) -> Option<f64> {
        self.runs.iter().filter_map(|run| run.config.extended_from).reduce(f64::min)
    }

    /// The options that stand beside it, without the one of the given name, as one line; empty for
    /// none.
    #[must_use]
    pub fn options_line(&self, without: Option<&str>) -> String {
        let options = self.shown.iter().filter(|(key, _)| Some(key.as_str()) != without);
        options.map(|(key, value)| format!("{key} {value}")).collect::<Vec<_>>().join(", ")
    }
}

/// What to say of two runs of one experiment whose checkpoints were selected by different settings,
/// so that their means are over unlike agents. Of what one of them lacks, being older, only a switch
/// is known: it was off.
fn selected_otherwise(first: &Run, other: &Run) -> Option<Warning> {
    let value = |run: &Run, key: &String| run.config.selection.get(key).cloned();
    let mut keys = first.config.selection.keys().chain(other.config.selection.keys());
    let differ = |key: &&String| match (value(first, key), value(other, key)) {
        (Some(one), Some(another)) => one != another,
        (one, another) => one.or(another).is_some_and(|only| only == "true"),
    };
    let key = keys.find(differ)?;
    let name = |run: &Run| value(run, key).unwrap_or_else(|| "not given".into());
    Some(Warning {
        problem: format!(
            "{key} is {} here and {} in seed {} of the same experiment: their checkpoints were selected in two ways; train both alike before you average them",
            name(other),
            name(first),
            first.config.seed
        ),
        path: other.path.clone(),
        line: 0,
    })
}

/// What to say of two runs of one experiment that two versions of the program made.
fn of_another_version(first: &Run, other: &Run) -> Option<Warning> {
    let (own, others) = (first.config.version.as_ref()?, other.config.version.as_ref()?);
    (own != others).then(|| Warning {
        problem: format!(
            "was trained by version {others}, seed {} of the same experiment by {own}; they are averaged, though versions may learn differently (CHANGELOG.md)",
            first.config.seed
        ),
        path: other.path.clone(),
        line: 0,
    })
}

/// Adds, to experiments that would look the same, what they differ in.
fn distinguish(groups: &mut [Group]) {
    let seen: Vec<(Config, BTreeMap<String, String>)> =
        groups.iter().map(|group| (group.config().clone(), group.shown.clone())).collect();
    let look = |(config, shown): &(Config, BTreeMap<String, String>)| {
        (config.env.clone(), config.algo.clone(), config.frames.map(f64::to_bits), shown.clone())
    };
    for (group, own) in groups.iter_mut().zip(&seen) {
        for (other, _) in seen.iter().filter(|other| look(other) == look(own)) {
            for key in own.0.options.keys().chain(other.options.keys()) {
                let value = own.0.options.get(key);
                if value != other.options.get(key) {
                    group
                        .shown
                        .insert(key.clone(), value.cloned().unwrap_or_else(|| "not given".into()));
                }
            }
        }
    }
}

/// The algorithms in the order of the paper's tables, then those beyond it.
pub(crate) const ALGORITHMS: [&str; 13] = [
    "PPO", "PPOCost", "PPOLag", "PPOSaute", "PPOPID", "P3O", "TRPO", "TRPOLag", "TRPOPID", "CPO",
    "FOCOPS", "CUP", "IPO",
];

/// Place of a scenario in tables; unknown ones come last.
#[must_use]
pub fn scenario_order(scenario: &str) -> usize {
    let all = Scenario::in_paper_order();
    all.iter().position(|known| known.name == scenario).unwrap_or(all.len())
}

/// Name of a scenario for people.
#[must_use]
pub fn scenario_name(scenario: &str) -> String {
    Scenario::every()
        .iter()
        .find(|known| known.name == scenario)
        .map_or(scenario, |known| known.title)
        .to_owned()
}

/// Place of an algorithm in tables, and its colour in figures; unknown ones come last.
#[must_use]
pub fn algorithm_order(algo: &str) -> usize {
    ALGORITHMS.iter().position(|known| known.eq_ignore_ascii_case(algo)).unwrap_or(ALGORITHMS.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_distinguishes_experiments_is_shown() {
        let run = |seed: u64, extra: &str| {
            let text = format!(
                "{{\"env\":\"RemedyRushLevel1-v0\",\"algo\":\"PPO\",\"seed\":{seed},\"preset\":\"paper\",\"gamma\":0.9{extra}}}"
            );
            let config = Config::parse(&text).unwrap();
            Run {
                path: format!("{seed}{extra}").into(),
                config,
                rows: vec![],
                evaluation: vec![],
                summary: None,
                selected: None,
                calibration: vec![],
                heatmaps: vec![],
            }
        };
        let runs = vec![
            run(1, ""),
            run(2, ""),
            run(1, ",\"learning\":{\"rate\":1}"),
            run(1, ",\"full_actions\":true,\"learning\":{\"exploration\":\"entropy\"}"),
        ];
        let groups = Group::sort(&Found { runs, ..Found::default() }, &mut Vec::new());
        let mut lines: Vec<(usize, String)> =
            groups.iter().map(|group| (group.runs.len(), group.options_line(None))).collect();
        lines.sort();
        assert_eq!(
            lines,
            [
                (1, "full_actions true, preset paper".to_owned()),
                (1, "learning.rate 1, preset paper".to_owned()),
                (2, "learning.rate not given, preset paper".to_owned()),
            ]
        );
    }
}
