//! `hasard train`: an agent from pixels.

use super::kept_task;
use super::sweep::plan;
use super::train_settings::{fresh, unread};
use crate::args::TrainArgs;
use crate::automap;
use crate::episode_lines::worth;
use crate::failure::{Failure, Outcome};
use crate::interrupt::{self, Manner};
use crate::progress::{Progress, grouped};
use crate::settings::{Elsewhere, scenario_of, warn_of_task};
use crate::zoo;
use clap::ArgMatches;
use hasard_envs::EnvOptions;
use hasard_learn::config::{AlgorithmKind, Constraint, EnvConfig, TrainConfig};
use hasard_learn::runs::progress_bar::line;
use hasard_learn::runs::report::Report;
use hasard_learn::runs::run_directory::{go_on, read_config};
use hasard_learn::runs::selection::Selection;
use hasard_learn::runs::trainer::{Hooks, Start, Summary, train_together};
use hasard_learn::team::Team;
use hasard_media::shell::quote;
use hasard_report::document::count;
use serde_json::{Value, json};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

/// A run about to begin.
pub struct Begun {
    /// Its directory.
    pub directory: PathBuf,
    start: Start,
    config: TrainConfig,
    options: EnvOptions,
}

/// What the words of the command begin; `typed` says which flags were given and which have their
/// default.
pub fn begin(args: &TrainArgs, typed: &ArgMatches) -> Result<Begun, Failure> {
    let args = &kept_task::named(args)?;
    let algorithm: AlgorithmKind = args.algo.parse().map_err(Failure::bad)?;
    // By the algorithm's own name, however it was typed.
    let directory = args.out.clone().unwrap_or_else(|| {
        let tasks = args.env.replace(',', "+");
        PathBuf::from(format!("runs/{tasks}-{algorithm}-seed{}", args.seed))
    });
    let (start, config) = if args.resume && directory.join("config.json").exists() {
        let config = read_config(&directory).map_err(Failure::bad)?;
        // A curriculum is of a scenario; the level that the command names does not matter.
        let same = |id: &str| {
            let id = if config.curriculum.is_empty() { id.to_string() } else { scenario_of(id) };
            // The run's own task need not be at its place any more for its name to be known.
            id.trim_end_matches("-v0").to_ascii_lowercase()
        };
        if same(&config.env.id) != same(&args.env) {
            let problem = format!(
                "{}: the run there is of {}; name that, or another --out",
                directory.display(),
                config.env.id
            );
            return Err(Failure::bad(problem));
        }
        let mut settings = super::resume::settings(args, typed, &config, &directory)?;
        settings.extend(super::init_from::moved(args, &config, &directory)?);
        let config = config.with_all(&settings).map_err(Failure::bad)?;
        (Start::Resume { settings }, config)
    } else {
        if args.resume && !args.quiet {
            note!("no run is in {}: one begins there", directory.display());
        }
        let config = fresh(args, typed)?;
        if !args.quiet {
            unread(args, config.algorithm).iter().for_each(|line| note!("{line}"));
            let tasks = config.env.tasks();
            let ids = tasks.iter().filter_map(|task| task.env_id().ok());
            ids.for_each(|id| warn_of_task(id.scenario));
        }
        let start = match &args.init_from {
            Some(other) => Start::From(config.clone(), zoo::find(other.as_os_str())?),
            None => Start::Fresh(config.clone()),
        };
        (start, config)
    };
    // Places that were typed are in the settings by now; those that are wrong are named as they
    // were typed.
    let typed = if matches!(start, Start::Resume { .. }) {
        Elsewhere::default()
    } else {
        args.env_args.elsewhere()
    };
    let options = crate::settings::trained_options(&config.env, typed)?;
    Ok(Begun { directory, start, config, options })
}

impl Begun {
    /// Whether it is worth a second to say how long it will take: a fresh run of minutes.
    fn is_long(&self) -> bool {
        let fresh = !matches!(self.start, Start::Resume { .. });
        fresh && self.config.frames >= 1_000_000 && self.config.device == "cpu"
    }

    /// Trains, and keeps the pictures of the map beside what is learned. Gives the run's directory
    /// and how it ended.
    pub fn train(self, team: &Team, hooks: &mut Hooks<'_>) -> Result<(PathBuf, Summary), Failure> {
        self.train_with(team, hooks, |_| {})
    }

    /// The same; calls `begins` when the directory is the run's own: at the first worlds made.
    fn train_with(
        self,
        team: &Team,
        hooks: &mut Hooks<'_>,
        begins: impl Fn(&Begun),
    ) -> Result<(PathBuf, Summary), Failure> {
        let (mut drawn, mut failed_drawing) = (false, None);
        let called = std::cell::Cell::new(false);
        let report = &mut *hooks.report;
        let mut hear = |row: &Report| {
            // Not before: the directory is the run's own only once it has begun.
            if !std::mem::replace(&mut drawn, true)
                && let Err(error) = automap::keep(&self.config, &self.options, &self.directory)
            {
                failed_drawing = Some(error);
            }
            report(row);
        };
        let make = |env: &EnvConfig, worlds| {
            if !called.replace(true) {
                begins(&self);
            }
            env.worlds(&self.options, worlds)
        };
        let mut hooks = Hooks { stop: hooks.stop, report: &mut hear, warn: &mut *hooks.warn };
        let summary = train_together(team, self.start.clone(), &self.directory, &make, &mut hooks)
            .map_err(Failure::bad)?;
        match failed_drawing {
            Some(error) => Err(error),
            None => Ok((self.directory.clone(), summary)),
        }
    }
}

/// Runs the command, reporting to the terminal.
pub fn run(args: &TrainArgs, typed: &ArgMatches) -> Outcome {
    let begun = begin(args, typed)?;
    interrupt::behave(Manner::Patient);
    let mut progress =
        if args.json || args.quiet { Progress::Silent } else { Progress::of(begun.config.frames) };
    let go_on = go_on(&begun.config, &begun.directory);
    let mut rows = Rows { asked_for: args.json, lost: None };
    let mut heard = false;
    let mut first: Option<Report> = None;
    let mut hear = |report: &Report| {
        heard = true;
        if first.is_none() && report.means.is_some() {
            first = Some(report.clone());
        }
        progress.show(report);
        rows.print(&report.row());
    };
    let mut warn = |text: String| progress.print(&format!("hasard: {text}"));
    let mut hooks = Hooks { stop: &interrupt::STOP, report: &mut hear, warn: &mut warn };
    let (directory, summary) = begun.train_with(&Team::default(), &mut hooks, |begun| {
        if progress.is_shown() {
            describe(&begun.config, &begun.directory);
            // What keeps it from being measured keeps the run from beginning, which says so.
            if begun.is_long()
                && let Ok(line) = plan::outlook(&begun.config, &begun.options)
            {
                note!("{line}");
            }
        }
    })?;
    if let Some(selection) = &summary.selection {
        rows.print(&json!({ "selection": selection }));
    }
    progress.finish();
    if progress.is_shown() {
        // Of a single report one line says all.
        if let Some(first) = first.as_ref().filter(|first| first.frames < summary.last.frames) {
            note!("first: {}", line(first));
        }
        if heard {
            note!("last:  {}", line(&summary.last));
        }
        let name = directory.display();
        let run = quote(&directory);
        if !heard && !summary.stopped {
            note!(
                "{name} was finished before, at {} frames; train on with: {go_on} --frames MORE",
                summary.last.frames
            );
        }
        if summary.selection.is_none() && !summary.stopped {
            note!("too short to be evaluated on the way: its latest checkpoint is what is played");
        }
        match summary.stopped {
            true => note!("stopped; go on with: {go_on}"),
            false => note!("{name} is a run directory: hasard eval {run}, hasard report {run}"),
        }
        // What the run is worth comes last, where the eye rests.
        if let Some(selection) = &summary.selection {
            headline(selection, summary.stopped).iter().for_each(|line| note!("{line}"));
        }
    }
    rows.check(&go_on)?;
    interrupt::check()
}

/// Rows on standard output, as `--json` has them.
struct Rows {
    asked_for: bool,
    /// Why no more are printed.
    lost: Option<io::Error>,
}

impl Rows {
    /// Prints one. A reader who goes away does not stop the run; a full disk does, for rows would
    /// be lost in silence.
    fn print(&mut self, row: &Value) {
        if !self.asked_for || self.lost.is_some() {
            return;
        }
        if let Err(error) = writeln!(io::stdout().lock(), "{row}") {
            if error.kind() != io::ErrorKind::BrokenPipe {
                interrupt::STOP.store(true, Ordering::SeqCst);
            }
            self.lost = Some(error);
        }
    }

    fn check(self, go_on: &str) -> Outcome {
        match self.lost {
            Some(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Failure::bad(format!(
                "standard output cannot be written: {error}; the run stopped with a checkpoint, make room and go on with: {go_on}"
            ))),
            _ => Ok(()),
        }
    }
}

/// Which checkpoint the run selects and what it is worth, after what the policy at its end is.
fn headline(selection: &Selection, stopped: bool) -> Vec<String> {
    let all = selection.selected.evaluation();
    let kept = match (all.within(), selection.selected.surely_within) {
        (true, true) => "surely within",
        (true, false) => "within",
        (false, _) => "NOT within",
    };
    let so_far = if stopped { " so far" } else { "" };
    let (frames, episodes) = (selection.selected.frames, count(all.episodes, "episode"));
    let mut lines = Vec::new();
    if let Some(last) = &selection.last {
        lines.push(format!(
            "last policy: {}, {} of their own",
            worth(&last.closing),
            count(last.closing.episodes, "episode")
        ));
    }
    lines.push(format!(
        "selected{so_far}: the checkpoint of {frames} frames, {kept} its budget; {}, {episodes} of their own",
        worth(all)
    ));
    lines
}

fn describe(config: &TrainConfig, directory: &Path) {
    let budget_of = |constraint: &Constraint| {
        format!("{} {}", constraint.term.as_deref().unwrap_or("cost"), constraint.budget)
    };
    let budgets: Vec<String> = config.constraints.iter().map(budget_of).collect();
    let levels: Vec<String> = config
        .curriculum
        .iter()
        .map(|lesson| format!("{} for {}", lesson.level, lesson.frames))
        .collect();
    let levels =
        if levels.is_empty() { String::new() } else { format!(" (levels {})", levels.join(", ")) };
    note!(
        "{} on {}, preset {}, seed {}, {} frames{levels}, budget of an episode: {}, device {} -> {}",
        config.algorithm,
        config.env.id,
        config.preset,
        config.seed,
        grouped(config.frames),
        budgets.join(", "),
        config.device,
        directory.display()
    );
}
