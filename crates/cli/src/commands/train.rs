//! `hasard train`: an agent from pixels.

use crate::args::TrainArgs;
use crate::automap;
use crate::episode_lines::worth;
use crate::failure::{Failure, Outcome};
use clap::ArgMatches;
use hasard_envs::{EnvId, EnvOptions, VecEnv};
use hasard_learn::config::curriculum::parse_curriculum;
use hasard_learn::config::{AlgorithmKind, Constraint, EnvConfig, Preset, TrainConfig};
use hasard_learn::runs::hand_out::HandOut;
use hasard_learn::runs::interrupt::stop_on_interrupt;
use hasard_learn::runs::progress_bar::{Bar, line};
use hasard_learn::runs::report::Report;
use hasard_learn::runs::run_directory::read_config;
use hasard_learn::runs::trainer::{Hooks, Start, Summary, train_together};
use hasard_learn::team::Team;
use serde_json::json;
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
    let algorithm: AlgorithmKind = args.algo.parse().map_err(Failure::bad)?;
    // By the algorithm's own name, however it was typed.
    let directory = args.out.clone().unwrap_or_else(|| PathBuf::from(format!("runs/{}-{algorithm}-seed{}", args.env, args.seed)));
    let (start, config) = if args.resume && directory.join("config.json").exists() {
        let config = read_config(&directory).map_err(Failure::bad)?;
        // A curriculum is of a scenario; the level that the command names does not matter.
        let same = |id: &str| if config.curriculum.is_empty() { id.to_string() } else { scenario_of(id) };
        if same(&config.env.id) != same(&args.env) {
            let problem = format!("{}: the run there is of {}; name that, or another --out", directory.display(), config.env.id);
            return Err(Failure::bad(problem));
        }
        let settings = super::resume::settings(args, typed, &config, &directory)?;
        let config = config.with_all(&settings).map_err(Failure::bad)?;
        (Start::Resume { settings }, config)
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
    pub fn train(self, team: &Team, hooks: &mut Hooks<'_>) -> Result<(PathBuf, Summary), Failure> {
        self.train_told(team, hooks, |_| {})
    }

    /// The same, telling once when the directory is the run's own: when the first worlds are made.
    fn train_told(self, team: &Team, hooks: &mut Hooks<'_>, begins: impl Fn(&Begun<'_>)) -> Result<(PathBuf, Summary), Failure> {
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
        let summary = train_together(team, self.start.clone(), &self.directory, &make, &mut hooks).map_err(Failure::bad)?;
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
    let bar = (!args.json && !args.quiet).then(|| Bar::new(begun.config.frames));
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
    let (directory, summary) = begun.train_told(&Team::default(), &mut hooks, |begun| {
        if bar.is_some() {
            describe(&begun.config, &begun.directory);
        }
    })?;
    if let (true, Some(hand_out)) = (args.json, &summary.hand_out) {
        say!("{}", json!({ "hand_out": hand_out }));
    }
    if let Some(bar) = &bar {
        bar.finish();
        if let Some(first) = &first {
            eprintln!("first: {}", line(first));
        }
        eprintln!("last:  {}", line(&summary.last));
        let name = directory.display();
        if let Some(hand_out) = &summary.hand_out {
            eprintln!("{}", handed_out(hand_out, summary.stopped));
        }
        match summary.stopped {
            true => eprintln!("stopped; go on with: hasard train {id} --resume --out {name}"),
            false => eprintln!("{name} is a run directory: hasard eval {name}, hasard report {name}"),
        }
    }
    Ok(())
}

/// Which checkpoint the run hands out, and what it is worth.
fn handed_out(hand_out: &HandOut, stopped: bool) -> String {
    let all = hand_out.evaluation();
    let kept = if all.within() { "within" } else { "NOT within" };
    let so_far = if stopped { " so far" } else { "" };
    let (frames, episodes) = (hand_out.frames, all.episodes);
    format!(
        "handed out{so_far}: the checkpoint of {frames} frames, {kept} its budget; {}, {episodes} episodes of their own",
        worth(all)
    )
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
    if args.eval_every.is_some() {
        config.evaluation.every = args.eval_every;
    }
    if let Some(scale) = args.cost_scale {
        config.algorithm_settings.penalty_scale = scale;
    }
    if !args.safety_budget.is_empty() {
        config.constraints = args.safety_budget.iter().map(|text| constraint(text)).collect::<Result<_, _>>()?;
    }
    let mut config = config.with_all(&args.set).map_err(|error| Failure::bad(format!("--set {error}")))?;
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
