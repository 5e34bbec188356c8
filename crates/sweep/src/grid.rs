//! What a sweep runs.

use crate::job::{Job, NOT_IDENTITY};
use crate::one_line;
use crate::option::OptionValue;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::PathBuf;

/// Most runs that one sweep may expand to; more is surely a slip of the pen.
const MAX_JOBS: usize = 100_000;

/// The benchmark's scenarios as environment ids spell them, in the order of the paper's tables.
pub(crate) fn scenarios() -> [&'static str; 6] {
    hasard_envs::Scenario::in_paper_order().map(hasard_envs::Scenario::name)
}

/// All combinations of its lists are run.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Grid {
    /// Scenario names (then every level is combined with each) or whole environment ids.
    pub scenarios: Vec<String>,
    /// Levels, for scenario names and files of own tasks.
    pub levels: Vec<u32>,
    /// Algorithms.
    pub algorithms: Vec<String>,
    /// Seeds.
    pub seeds: Vec<u64>,
    /// Frames of each run.
    pub frames: u64,
    /// Options of `hasard train` without dashes, and their values: more than one value is a further
    /// axis.
    pub options: Vec<(String, Vec<OptionValue>)>,
    /// Settings of `config.json` and their values, the later over the earlier; the folders of runs
    /// do not say them.
    pub settings: Vec<(String, String)>,
}

/// One or more grids and where their runs go.
#[derive(Clone, PartialEq, Debug)]
pub struct Sweep {
    /// Folder of the runs.
    pub out: PathBuf,
    /// Runs at a time.
    pub parallel: usize,
    /// Episodes that the agent of each finished run is evaluated on, kept in its directory as
    /// `eval.jsonl`; 0 for none.
    pub evaluate: u32,
    /// The grids; a run that several ask for is made once.
    pub grids: Vec<Grid>,
}

impl Sweep {
    /// Expands the grids into jobs: seeds outermost, then environments, algorithms and options, so
    /// that wherever a sweep stops there are whole tables of fewer seeds.
    ///
    /// # Errors
    /// When a list is empty, a value is unusable, or there are too many runs.
    pub fn jobs(&self) -> Result<Vec<Job>, String> {
        self.expand().map_err(|problem| one_line(&problem))
    }

    fn expand(&self) -> Result<Vec<Job>, String> {
        let mut jobs: Vec<(usize, Job)> = Vec::new();
        let mut seen: BTreeMap<PathBuf, (u64, Vec<OsString>)> = BTreeMap::new();
        for grid in &self.grids {
            let mut expanded = 1usize;
            for length in [grid.environments().len(), grid.algorithms.len(), grid.seeds.len()]
                .into_iter()
                .chain(grid.options.iter().map(|o| o.1.len()))
            {
                expanded = expanded.saturating_mul(length);
            }
            if expanded.saturating_add(jobs.len()) > MAX_JOBS {
                return Err(format!("more than {MAX_JOBS} runs; make the grid smaller"));
            }
            grid.check()?;
            for (index, &seed) in grid.seeds.iter().enumerate() {
                for environment in grid.environments() {
                    for algorithm in &grid.algorithms {
                        for options in grid.option_combinations() {
                            let mut job = Job::new(
                                &self.out,
                                &environment,
                                algorithm,
                                grid.frames,
                                seed,
                                &options,
                            );
                            job.evaluate = self.evaluate;
                            for (name, value) in &grid.settings {
                                job.add_option("set", &format!("{name}={value}"));
                            }
                            let made = (job.frames, job.arguments.clone());
                            match seen.insert(job.directory.clone(), made) {
                                None => jobs.push((index, job)),
                                Some((frames, _)) if frames != job.frames => {
                                    return Err(format!(
                                        "two grids have the run {} with {frames} and with {} frames; give them an option that differs, or one `frames`",
                                        job.directory.display(),
                                        job.frames
                                    ));
                                }
                                Some((_, arguments)) if arguments != job.arguments => {
                                    return Err(format!(
                                        "two grids have the run {} with other settings; give them an option that differs, or one `settings`",
                                        job.directory.display()
                                    ));
                                }
                                Some(_) => {}
                            }
                        }
                    }
                }
            }
        }
        // The first seeds of all grids, then the second ones.
        jobs.sort_by_key(|(index, _)| *index);
        let jobs: Vec<Job> = jobs.into_iter().map(|(_, job)| job).collect();
        if jobs.is_empty() {
            return Err("nothing to run; give scenarios, algorithms and seeds".into());
        }
        Ok(jobs)
    }

    /// Multiplies the frames of every run, and between its evaluations, to try an experiment in
    /// small; at least one frame remains.
    pub fn scale_frames(&mut self, factor: f64) {
        let scaled = |frames: u64| ((frames as f64 * factor).round() as u64).max(1);
        for grid in &mut self.grids {
            grid.frames = scaled(grid.frames);
            let every = grid
                .options
                .iter_mut()
                .filter(|(name, _)| name == "eval-every")
                .flat_map(|(_, values)| values);
            for value in every {
                if let OptionValue::Text(text) = value
                    && let Ok(frames @ 1..) = text.parse::<u64>()
                {
                    *text = scaled(frames).to_string();
                }
            }
            let lengths = ["evaluation.every", "learning.schedule_frames"];
            let own = grid.settings.iter_mut();
            for (_, value) in own.filter(|(name, _)| lengths.contains(&name.as_str())) {
                if let Ok(frames @ 1..) = value.parse::<u64>() {
                    *value = scaled(frames).to_string();
                }
            }
        }
    }

    /// Keeps of every grid the scenarios that are wanted; those that no grid has are run in all of
    /// them.
    pub fn restrict_scenarios(&mut self, wanted: &[String]) {
        self.restrict(wanted, |grid| &mut grid.scenarios);
    }

    /// The same for levels.
    pub fn restrict_levels(&mut self, wanted: &[u32]) {
        self.restrict(wanted, |grid| &mut grid.levels);
    }

    /// The same for algorithms.
    pub fn restrict_algorithms(&mut self, wanted: &[String]) {
        self.restrict(wanted, |grid| &mut grid.algorithms);
    }

    /// An experiment's grids may differ in what a list goes with (each scenario has its own
    /// budgets): there the list only chooses among them. What is in none of them goes with all of
    /// them.
    fn restrict<T: Clone + PartialEq>(&mut self, wanted: &[T], list: fn(&mut Grid) -> &mut Vec<T>) {
        let known =
            wanted.iter().all(|one| self.grids.iter_mut().any(|grid| list(grid).contains(one)));
        if known {
            self.grids.iter_mut().for_each(|grid| list(grid).retain(|one| wanted.contains(one)));
            self.grids.retain_mut(|grid| !list(grid).is_empty());
        } else {
            self.grids.iter_mut().for_each(|grid| *list(grid) = wanted.to_vec());
        }
    }

    /// Sets an option in every grid, over whatever values it had.
    pub fn set_option(&mut self, name: &str, value: &OptionValue) {
        for grid in &mut self.grids {
            grid.options.retain(|(key, _)| key != name);
            grid.options.insert(0, (name.to_owned(), vec![value.clone()]));
        }
    }
}

impl Grid {
    /// Ids of the environments.
    #[must_use]
    pub fn environments(&self) -> Vec<String> {
        self.scenarios
            .iter()
            .flat_map(|scenario| {
                if scenarios().contains(&scenario.as_str()) {
                    self.levels.iter().map(|level| format!("{scenario}Level{level}-v0")).collect()
                } else if scenario.ends_with(".toml") && !scenario.contains(',') {
                    // The file itself is its first level.
                    let of_level = |level: &u32| match level {
                        1 => scenario.clone(),
                        level => format!("{scenario}#{level}"),
                    };
                    self.levels.iter().map(of_level).collect()
                } else {
                    vec![scenario.clone()]
                }
            })
            .collect()
    }

    fn option_combinations(&self) -> Vec<Vec<(String, OptionValue)>> {
        let mut combinations = vec![Vec::new()];
        for (name, values) in &self.options {
            combinations = combinations
                .into_iter()
                .flat_map(|before: Vec<(String, OptionValue)>| {
                    values.iter().map(move |value| {
                        let mut with = before.clone();
                        with.push((name.clone(), value.clone()));
                        with
                    })
                })
                .collect();
        }
        combinations
    }

    fn check(&self) -> Result<(), String> {
        for (name, empty) in [
            ("scenarios", self.scenarios.is_empty()),
            ("levels", self.levels.is_empty()),
            ("algorithms", self.algorithms.is_empty()),
            ("seeds", self.seeds.is_empty()),
        ] {
            if empty {
                return Err(format!("`{name}` is empty; list at least one"));
            }
        }
        if self.frames == 0 {
            return Err("`frames` is 0; give the frames of each run, such as 2000000".into());
        }
        // They become parts of paths and command lines.
        let plain = |text: &str| {
            !text.is_empty()
                && text.chars().all(|c| c.is_ascii_alphanumeric() || "-_.".contains(c))
                && !text.starts_with(['-', '.'])
        };
        let like_an_id = |environment: &str| {
            let path = environment.rsplit_once('#').map_or(environment, |(path, _)| path);
            let own_file = path.ends_with(".toml")
                && !environment.starts_with('-')
                && !environment.contains(char::is_control);
            environment.contains("-v") && plain(environment) || own_file
        };
        for environment in &self.scenarios {
            // Several ids make one environment of several tasks.
            let known = scenarios().contains(&environment.as_str())
                || environment.split(',').all(like_an_id);
            if !known {
                return Err(format!(
                    "unknown scenario `{environment}`; one of {}, an id of `hasard envs`, the file of an own task, or several ids or files \
                     with commas between",
                    scenarios().join(", ")
                ));
            }
        }
        // Tasks of one's own may have up to nine.
        let own = self.scenarios.iter().all(|environment| environment.contains(".toml"));
        let last = if own { 9 } else { 3 };
        if let Some(level) = self.levels.iter().find(|level| !(1..=last).contains(*level)) {
            return Err(format!("level {level} does not exist; levels are 1 to {last}"));
        }
        if let Some(algorithm) = self.algorithms.iter().find(|algorithm| !plain(algorithm)) {
            return Err(format!("`{algorithm}` is no name of an algorithm"));
        }
        for (name, values) in &self.options {
            if !plain(name) {
                return Err(format!(
                    "`{name}` is no option of `hasard train`; write it without dashes in front"
                ));
            }
            if ["out", "seed", "algo", "frames", "resume"].contains(&name.as_str()) {
                return Err(format!(
                    "the option `{name}` is set by the sweep itself; use the keys out, seeds, algorithms, frames"
                ));
            }
            if values.is_empty() {
                return Err(format!("the option `{name}` has no value"));
            }
            if values.len() > 1 && NOT_IDENTITY.contains(&name.as_str()) {
                return Err(format!("the option `{name}` makes no other run; give one value"));
            }
            if values
                .iter()
                .any(|value| matches!(value, OptionValue::Text(text) if text.is_empty() || text.contains(char::is_control)))
            {
                return Err(format!("the option `{name}` has an empty or unprintable value; give another, or leave it out"));
            }
        }
        Ok(())
    }
}
