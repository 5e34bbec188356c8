//! `hasard train`: an agent from pixels.

use crate::args::TrainArgs;
use crate::automap;
use crate::failure::{Failure, Outcome};
use clap::ArgMatches;
use hasard_envs::{EnvId, EnvOptions, VecEnv};
use hasard_learn::config::curriculum::parse_curriculum;
use hasard_learn::config::{Constraint, EnvConfig, Preset, TrainConfig};
use hasard_learn::runs::interrupt::stop_on_interrupt;
use hasard_learn::runs::progress_bar::{Bar, line};
use hasard_learn::runs::report::Report;
use hasard_learn::runs::run_directory::read_config;
use hasard_learn::runs::trainer::{Hooks, Start, Summary, train};
use std::path::{Path, PathBuf};

/// A run about to begin.
pub struct Begun<'a> {
    /// Its directory.
    pub directory: PathBuf,
    start: Start<'a>,
    config: TrainConfig,
    options: EnvOptions,
}

/// What the words of the command begin; `typed` tells which flags were given and which have their default.
pub fn begin<'a>(args: &'a TrainArgs, typed: &ArgMatches) -> Result<Begun<'a>, Failure> {
    let directory =
        args.out.clone().unwrap_or_else(|| PathBuf::from(format!("runs/{}-{}-seed{}", args.env, args.algo, args.seed)));
    let (start, config) = if args.resume && directory.join("config.json").exists() {
        let config = read_config(&directory).map_err(Failure::bad)?;
        // A curriculum is of a scenario; the level that the command names does not matter.
        let same = |id: &str| if config.curriculum.is_empty() { id.to_string() } else { scenario_of(id) };
        if same(&config.env.id) != same(&args.env) {
            let problem = format!("{}: the run there is of {}; name that, or another --out", directory.display(), config.env.id);
            return Err(Failure::bad(problem));
        }
        super::resume::check(args, typed, &config, &directory)?;
        (Start::Resume { frames: args.frames }, config)
    } else {
        let config = configuration(args)?;
        let start = match &args.init_from {
            Some(other) => Start::From(config.clone(), other),
            None => Start::Fresh(config.clone()),
        };
        (start, config)
    };
    let options = crate::settings::trained_options(&config.env)?;
    Ok(Begun { directory, start, config, options })
}

impl Begun<'_> {
    /// Trains, and keeps the pictures of the map beside what is learned. Gives the run's directory and how it ended.
    pub fn train(self, hooks: &mut Hooks<'_>) -> Result<(PathBuf, Summary), Failure> {
        self.train_told(hooks, |_| {})
    }

    /// The same, telling once when the directory is the run's own: when the first worlds are made.
    fn train_told(self, hooks: &mut Hooks<'_>, begins: impl Fn(&Begun<'_>)) -> Result<(PathBuf, Summary), Failure> {
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
            VecEnv::new(&env.id, &self.options, worlds)
        };
        let mut hooks = Hooks { stop: hooks.stop, report: &mut hear, warn: &mut *hooks.warn };
        let summary = train(self.start.clone(), &self.directory, &make, &mut hooks).map_err(Failure::bad)?;
        match failed_drawing {
            Some(error) => Err(error),
            None => Ok((self.directory.clone(), summary)),
        }
    }
}

/// Runs the command, telling the terminal.
pub fn run(args: &TrainArgs, typed: &ArgMatches) -> Outcome {
    let begun = begin(args, typed)?;
    let stop = stop_on_interrupt().map_err(Failure::bad)?;
    let bar = (!args.json && !args.quiet).then(|| Bar::new(args.frames.unwrap_or(begun.config.frames)));
    let id = begun.config.env.id.clone();
    let mut first: Option<Report> = None;
    let mut hear = |report: &Report| {
        if first.is_none() && report.means.is_some() {
            first = Some(report.clone());
        }
        match &bar {
            Some(bar) => bar.show(report),
            // A reader who goes away does not stop the run.
            None if args.json => drop(print_row(report)),
            None => {}
        }
    };
    let mut warn = |text: String| match &bar {
        Some(bar) => bar.print(&format!("hasard: {text}")),
        None => eprintln!("hasard: {text}"),
    };
    let mut hooks = Hooks { stop: &stop, report: &mut hear, warn: &mut warn };
    let (directory, summary) = begun.train_told(&mut hooks, |begun| {
        if bar.is_some() {
            describe(&begun.config, &begun.directory);
        }
    })?;
    if let Some(bar) = &bar {
        bar.finish();
        if let Some(first) = &first {
            eprintln!("first: {}", line(first));
        }
        eprintln!("last:  {}", line(&summary.last));
        let name = directory.display();
        match summary.stopped {
            true => eprintln!("stopped; go on with: hasard train {id} --resume --out {name}"),
            false => eprintln!("{name} is a run directory: hasard eval {name}, hasard report {name}"),
        }
    }
    Ok(())
}

/// An environment id without its level, or the whole text if it is none.
fn scenario_of(id: &str) -> String {
    id.parse::<EnvId>().map_or_else(|_| id.to_string(), |id| id.scenario.name().to_string())
}

fn print_row(report: &Report) -> Outcome {
    say!("{}", report.row());
    Ok(())
}

fn describe(config: &TrainConfig, directory: &Path) {
    let budgets: Vec<String> = config.constraints.iter().map(|constraint| constraint.budget.to_string()).collect();
    let levels: Vec<String> = config.curriculum.iter().map(|lesson| format!("{} for {}", lesson.level, lesson.frames)).collect();
    let levels = if levels.is_empty() { String::new() } else { format!(" (levels {})", levels.join(", ")) };
    eprintln!(
        "{} on {}, preset {}, seed {}, {} frames{levels}, cost budget {} an episode, device {} -> {}",
        config.algorithm,
        config.env.id,
        config.preset,
        config.seed,
        config.frames,
        budgets.join(" / "),
        config.device,
        directory.display()
    );
}

/// The settings of a fresh run: the preset's, then flags, then `--set`.
pub(super) fn configuration(args: &TrainArgs) -> Result<TrainConfig, Failure> {
    let env = crate::settings::env_config(&args.env, &args.env_args, &args.observation);
    let preset: Preset = args.preset.parse().map_err(Failure::bad)?;
    let mut config = TrainConfig::new(args.algo.parse().map_err(Failure::bad)?, preset, env).map_err(Failure::bad)?;
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
    if let Some(scale) = args.cost_scale {
        config.algorithm_settings.penalty_scale = scale;
    }
    if !args.safety_budget.is_empty() {
        config.constraints = args.safety_budget.iter().map(|text| constraint(text)).collect::<Result<_, _>>()?;
    }
    let mut config = args
        .set
        .iter()
        .try_fold(config, |config, text| config.with(text).map_err(|error| Failure::bad(format!("--set '{text}': {error}"))))?;
    if let Some(text) = &args.curriculum {
        let lessons = parse_curriculum(text, config.frames).map_err(Failure::bad)?;
        config.set_curriculum(lessons);
    }
    config.check().map_err(Failure::bad)?;
    Ok(config)
}

/// `50`, or `lava=50` for a named cost term.
fn constraint(text: &str) -> Result<Constraint, Failure> {
    let (term, number) = text.split_once('=').map_or((None, text), |(term, number)| (Some(term.to_string()), number));
    let budget = number.parse().map_err(|_| Failure::bad(format!("--safety-budget '{text}': write a number, or TERM=NUMBER")))?;
    Ok(Constraint { term, budget })
}
