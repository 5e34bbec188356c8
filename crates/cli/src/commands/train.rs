//! `hasard train`: an agent from pixels.

use super::sweep::plan;
use crate::args::{Rules, TrainArgs};
use crate::automap;
use crate::episode_lines::worth;
use crate::failure::{Failure, Outcome};
use crate::interrupt::{self, Manner};
use crate::progress::{Progress, grouped};
use crate::settings::{Elsewhere, scenario_of};
use crate::zoo;
use clap::ArgMatches;
use clap::parser::ValueSource;
use hasard_envs::EnvOptions;
use hasard_learn::config::constraint::check_once_each;
use hasard_learn::config::curriculum::parse_curriculum;
use hasard_learn::config::ranges::check_number;
use hasard_learn::config::{AlgorithmKind, Constraint, EnvConfig, Preset, TrainConfig};
use hasard_learn::runs::progress_bar::line;
use hasard_learn::runs::report::Report;
use hasard_learn::runs::run_directory::{go_on, read_config};
use hasard_learn::runs::selection::Selection;
use hasard_learn::runs::trainer::{Hooks, Start, Summary, train_together};
use hasard_learn::team::Team;
use hasard_media::shell::quote;
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

/// What the words of the command begin; `typed` tells which flags were given and which have their
/// default.
pub fn begin(args: &TrainArgs, typed: &ArgMatches) -> Result<Begun, Failure> {
    let algorithm: AlgorithmKind = args.algo.parse().map_err(Failure::bad)?;
    // By the algorithm's own name, however it was typed.
    let directory = args.out.clone().unwrap_or_else(|| {
        let tasks = args.env.replace(',', "+");
        PathBuf::from(format!("runs/{tasks}-{algorithm}-seed{}", args.seed))
    });
    let (start, config) = if args.resume && directory.join("config.json").exists() {
        let config = read_config(&directory).map_err(Failure::bad)?;
        // A curriculum is of a scenario; the level that the command names does not matter.
        let same =
            |id: &str| if config.curriculum.is_empty() { id.to_string() } else { scenario_of(id) };
        if same(&config.env.id) != same(&args.env) {
            let problem = format!(
                "{}: the run there is of {}; name that, or another --out",
                directory.display(),
                config.env.id
            );
            return Err(Failure::bad(problem));
        }
        let settings = super::resume::settings(args, typed, &config, &directory)?;
        let config = config.with_all(&settings).map_err(Failure::bad)?;
        (Start::Resume { settings }, config)
    } else {
        let config = configuration(&with_rules(args, typed))?;
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
        self.train_told(team, hooks, |_| {})
    }

    /// The same, telling once when the directory is the run's own: when the first worlds are made.
    fn train_told(
        self,
        team: &Team,
        hooks: &mut Hooks<'_>,
        begins: impl Fn(&Begun),
    ) -> Result<(PathBuf, Summary), Failure> {
        let (mut drawn, mut failed_drawing) = (false, None);
        let told = std::cell::Cell::new(false);
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
            if !told.replace(true) {
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

/// Runs the command, telling the terminal.
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
    let (directory, summary) = begun.train_told(&Team::default(), &mut hooks, |begun| {
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
        if let Some(first) = &first {
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
    let (frames, episodes) = (selection.selected.frames, all.episodes);
    let mut lines = Vec::new();
    if let Some(last) = &selection.last {
        lines.push(format!(
            "last policy: {}, {} episodes of their own",
            worth(&last.closing),
            last.closing.episodes
        ));
    }
    lines.push(format!(
        "selected{so_far}: the checkpoint of {frames} frames, {kept} its budget; {}, {episodes} episodes of their own",
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

/// The command with the rules that its preset belongs to, unless it names others: what made the
/// paper's tables is both.
pub(super) fn with_rules(args: &TrainArgs, typed: &ArgMatches) -> TrainArgs {
    let mut args = args.clone();
    let given = typed.value_source("rules") == Some(ValueSource::CommandLine);
    if !given && args.preset.parse().is_ok_and(|preset: Preset| preset == Preset::Tables) {
        args.env_args.rules = Rules::Tables;
    }
    args
}

/// The settings of a fresh run: the preset's, then flags, then `--set`.
pub(super) fn configuration(args: &TrainArgs) -> Result<TrainConfig, Failure> {
    let env = crate::settings::env_config(&args.env, &args.env_args, &args.observation);
    let preset: Preset = args.preset.parse().map_err(Failure::bad)?;
    let mut config = TrainConfig::new(args.algo.parse().map_err(Failure::bad)?, preset, env)
        .map_err(Failure::bad)?;
    config.seed = args.seed;
    config.device.clone_from(&args.device);
    config.frames = args.frames.unwrap_or(config.frames);
    config.sampling.synchronous = args.sync || (args.device == "cpu" && !args.asynchronous);
    config.learning.portable = args.portable;
    if let Some(threads) = args.threads {
        config.learning.threads = usize::from(threads);
        config.sampling.samplers = usize::from(threads);
    }
    if let Some(lanes) = args.envs {
        config.sampling.lanes = lanes as usize;
    }
    if args.eval_every.is_some() {
        config.evaluation.every = args.eval_every;
    }
    // What is no number is refused before --set is read: in JSON it becomes null, and another input
    // would be blamed for it.
    if let Some(scale) = args.cost_scale {
        check_number("--cost-scale", scale).map_err(Failure::bad)?;
        config.algorithm_settings.penalty_scale = scale;
    }
    if let Some(text) = &args.constraint_statistic {
        config.constraint_statistic = text
            .parse()
            .map_err(|error| Failure::bad(format!("--constraint-statistic: {error}")))?;
    }
    if !args.safety_budget.is_empty() {
        config.constraints =
            args.safety_budget.iter().map(|text| constraint(text)).collect::<Result<_, _>>()?;
    }
    let mut config =
        config.with_all(&args.set).map_err(|error| Failure::bad(format!("--set {error}")))?;
    if let Some(text) = &args.curriculum {
        let lessons = parse_curriculum(text, config.frames).map_err(Failure::bad)?;
        config.set_curriculum(lessons);
    }
    config.check().map_err(Failure::bad)?;
    check_once_each(&config.constraints).map_err(Failure::bad)?;
    Ok(config)
}

/// `50`, or `lava=50` for a named cost term.
fn constraint(text: &str) -> Result<Constraint, Failure> {
    let (term, number) = text
        .split_once('=')
        .map_or((None, text), |(term, number)| (Some(term.to_string()), number));
    let budget = number.parse().map_err(|_| {
        Failure::bad(format!("--safety-budget '{text}': write a number, or TERM=NUMBER"))
    })?;
    check_number(&format!("--safety-budget '{text}'"), budget).map_err(Failure::bad)?;
    Ok(Constraint { term, budget })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::{Cli, Command};
    use clap::{CommandFactory, FromArgMatches};
    use hasard_learn::config::ConstraintStatistic;

    fn config(line: &str) -> Result<TrainConfig, Failure> {
        let line = format!("hasard train ArmamentBurdenLevel1-v0 {line}");
        let matches = Cli::command().try_get_matches_from(line.split_whitespace()).unwrap();
        let Command::Train(args) = Cli::from_arg_matches(&matches).unwrap().command else {
            panic!("not a training")
        };
        configuration(&with_rules(&args, matches.subcommand_matches("train").unwrap()))
    }

    /// A2: the paper's best algorithm within minutes is what a command without options trains; 500
    /// million frames are asked for.
    #[test]
    fn without_options_it_is_the_quick_pid() {
        let plain = config("").unwrap();
        assert_eq!(
            (plain.algorithm, plain.preset, plain.frames),
            (AlgorithmKind::PpoPid, Preset::Quick, 10_000_000)
        );
        assert_eq!(config("--preset paper").unwrap().frames, 500_000_000);
    }

    #[test]
    fn the_preset_of_the_tables_has_their_rules_unless_others_are_named() {
        for (line, rules) in [
            ("--preset tables", "tables"),
            ("--preset tables --rules paper", "paper"),
            ("--preset released", "paper"),
            ("", "paper"),
        ] {
            assert_eq!(config(line).unwrap().env.rules, rules, "{line}");
        }
    }

    /// JSON has no NaN: the null in its place was laid to `--set`.
    #[test]
    fn what_is_no_number_is_refused_by_the_option_that_gave_it() {
        for (option, name) in [
            ("--safety-budget nan", "--safety-budget 'nan' cannot be NaN"),
            ("--safety-budget excess_weight=inf", "--safety-budget 'excess_weight=inf'"),
            ("--safety-budget=-1", "--safety-budget '-1' cannot be -1"),
            ("--cost-scale nan", "--cost-scale cannot be NaN"),
            ("--cost-scale=-1", "--cost-scale cannot be -1"),
        ] {
            for set in ["", "--set sampling.rollout=8"] {
                let message = format!("{:?}", config(&format!("{option} {set}")).unwrap_err());
                assert!(message.contains(name), "{option}: {message}");
                assert!(message.contains("at least 0"), "{option}: {message}");
            }
        }
    }

    #[test]
    fn a_cost_has_one_budget() {
        for (line, cost) in [
            ("--safety-budget 1 --safety-budget 2", "the cost has two budgets"),
            ("--set constraints=[{\"budget\":1},{\"budget\":2}]", "the cost has two budgets"),
        ] {
            let message = format!("{:?}", config(line).unwrap_err());
            assert!(message.contains(cost), "{message}");
        }
    }

    #[test]
    fn a_constraint_on_the_tail_is_asked_for_by_name() {
        assert_eq!(
            config("--constraint-statistic cvar:0.1").unwrap().constraint_statistic,
            ConstraintStatistic::Cvar(0.1)
        );
        for wrong in ["--constraint-statistic cvar:2", "--algo P3O --constraint-statistic cvar:0.1"]
        {
            assert!(config(wrong).is_err(), "{wrong}");
        }
    }
}
