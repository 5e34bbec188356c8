//! The settings of a fresh run, from the options of `hasard train`.

use super::resume::check_said_once;
use crate::args::{Rules, TrainArgs};
use crate::failure::Failure;
use clap::ArgMatches;
use clap::parser::ValueSource;
use hasard_learn::config::constraint::{check_every_task, check_once_each};
use hasard_learn::config::curriculum::parse_curriculum;
use hasard_learn::config::numbers::check_number;
use hasard_learn::config::readers::readers;
use hasard_learn::config::{AlgorithmKind, Constraint, Preset, TrainConfig};

/// The command with the rules that its preset belongs to, unless it names others: what made the
/// paper's tables is both.
pub fn with_rules(args: &TrainArgs, typed: &ArgMatches) -> TrainArgs {
    let mut args = args.clone();
    let given = typed.value_source("rules") == Some(ValueSource::CommandLine);
    if let (false, Some(rules)) = (given, args.preset.parse().ok().and_then(rules_of)) {
        args.env_args.rules = rules;
    }
    args
}

/// The rules that a preset belongs to, if it does.
pub fn rules_of(preset: Preset) -> Option<Rules> {
    (preset == Preset::Tables).then_some(Rules::Tables)
}

/// The settings of a fresh run: the preset's, then flags, then `--set`.
pub fn configuration(args: &TrainArgs) -> Result<TrainConfig, Failure> {
    let env = crate::settings::env_config(&args.env, &args.env_args, &args.observation);
    let preset: Preset = args.preset.parse().map_err(Failure::bad)?;
    let mut config = TrainConfig::new(args.algo.parse().map_err(Failure::bad)?, preset, env)
        .map_err(Failure::bad)?;
    config.seed = args.seed;
    config.device.clone_from(&args.device);
    config.set_frames(args.frames.unwrap_or(config.frames));
    config.sampling.synchronous = args.sync || (args.device == "cpu" && !args.asynchronous);
    config.learning.portable = args.portable;
    if let Some(threads) = args.threads {
        config.learning.threads = usize::from(threads);
        config.sampling.samplers = usize::from(threads);
    }
    if args.device != "cpu" {
        // A card computes one batch of all worlds in the time of a small one: the threads step
        // worlds, and do not each ask it for a share.
        config.sampling.samplers = 1;
        config.sampling.world_threads = config.learning.threads;
    }
    if let Some(lanes) = args.envs {
        config.set_lanes(lanes as usize);
    }
    if args.eval_every.is_some() {
        config.evaluation.every = args.eval_every;
    }
    // What is no number is refused before --set is read: in JSON it becomes null, and another input
    // would be blamed for it.
    if let Some(scale) = args.cost_scale {
        check_number("--cost-scale", scale).map_err(Failure::bad)?;
        if config.algorithm != AlgorithmKind::PpoCost {
            return Err(Failure::bad(format!(
                "--cost-scale {scale}: {} takes no cost off its reward; leave it out, or give --algo PPOCost",
                config.algorithm.name()
            )));
        }
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
    let lessons = |text: &String, config: &TrainConfig| {
        let levels = config.env.env_id().map_or(3, |id| id.scenario.levels.max(1));
        parse_curriculum(text, config.frames, levels).map_err(Failure::bad)
    };
    // Lessons with lengths of their own say how long the run is, which other settings hang on.
    if let Some(text) = &args.curriculum {
        let lessons = lessons(text, &config)?;
        config.set_frames(lessons.iter().fold(0, |sum, one| sum.saturating_add(one.frames)));
    }
    // As the flag does: other settings hang on the length, and --set of those comes after it.
    if let Some(set) = args.set.iter().rev().find(|set| set.starts_with("frames=")) {
        let named = |error| Failure::bad(format!("--set '{set}': {error}"));
        config.set_frames(config.with(set).map_err(named)?.frames);
    }
    let mut config =
        config.with_all(&args.set).map_err(|error| Failure::bad(format!("--set {error}")))?;
    if let Some(text) = &args.curriculum {
        config.set_curriculum(lessons(text, &config)?);
    }
    config.check().map_err(Failure::bad)?;
    check_once_each(&config.constraints).map_err(Failure::bad)?;
    let tasks: Vec<String> = config.env.tasks().into_iter().map(|task| task.id).collect();
    check_every_task(&tasks, &config.constraints).map_err(Failure::bad)?;
    Ok(config)
}

/// The settings of a fresh run, for which a command must say nothing twice. What it begins with is
/// left to the trainer.
pub fn fresh(args: &TrainArgs, typed: &ArgMatches) -> Result<TrainConfig, Failure> {
    let config = configuration(&with_rules(args, typed))?;
    check_length(args, &config)?;
    check_said_once(args, typed)?;
    Ok(config)
}

/// A line for each `--set` of the algorithm's own settings that this algorithm does not read.
pub fn unread(args: &TrainArgs, algorithm: AlgorithmKind) -> Vec<String> {
    let line = |text: &String| {
        let name = text.split('=').next()?;
        let readers = readers(name).filter(|readers| !readers.contains(&algorithm))?;
        let names: Vec<&str> = readers.into_iter().map(AlgorithmKind::name).collect();
        Some(format!(
            "hasard: --set {text} changes nothing: {} does not read it, but {}",
            algorithm.name(),
            names.join(", ")
        ))
    };
    args.set.iter().filter_map(line).collect()
}

/// Refuses a fresh run whose curriculum has another length than `--frames` asks for: it would train
/// for its own.
pub fn check_length(args: &TrainArgs, config: &TrainConfig) -> Result<(), Failure> {
    let (Some(text), Some(frames)) = (&args.curriculum, args.frames) else { return Ok(()) };
    if frames == config.frames {
        return Ok(());
    }
    Err(Failure::bad(format!(
        "--curriculum {text}: its levels have {} frames, --frames says {frames}; leave --frames out, or name levels alone, \
         such as 1,2,3, to share its frames",
        config.frames
    )))
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
    // A task's name, as short as elsewhere.
    let term = term.map(|term| crate::number::env_id(&term).unwrap_or(term));
    Ok(Constraint { term, budget })
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::args::{Cli, Command};
    use clap::{CommandFactory, FromArgMatches};
    use hasard_learn::config::{AlgorithmKind, ConstraintStatistic};

    /// The options of a line, and which of them were typed.
    pub(in crate::commands) fn train(line: &str) -> (TrainArgs, ArgMatches) {
        let matches = Cli::command().try_get_matches_from(line.split_whitespace()).unwrap();
        let Command::Train(args) = Cli::from_arg_matches(&matches).unwrap().command else {
            panic!("not a training")
        };
        (args, matches.subcommand_matches("train").unwrap().clone())
    }

    /// What the options of a line come to.
    pub(in crate::commands) fn config(line: &str) -> Result<TrainConfig, Failure> {
        let (args, typed) = train(&format!("hasard train ArmamentBurdenLevel1-v0 {line}"));
        configuration(&with_rules(&args, &typed))
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
        let reference = |line: &str| config(line).unwrap().algorithm_settings.pid_reference_budget;
        assert_eq!((reference(""), reference("--frames 2M")), (Some(201.0), Some(450.0)));
        assert_eq!(reference("--set frames=2000000"), Some(450.0));
        let both = "--set algorithm_settings.pid_reference_budget=45 --set frames=2000000";
        assert_eq!(reference(both), Some(45.0));
        let set = "--frames 2M --set algorithm_settings.pid_reference_budget=45";
        assert_eq!(reference(set), Some(45.0));
    }

    /// With a share of the worlds for each thread, training on a card was four times slower.
    #[test]
    fn a_card_is_asked_for_all_worlds_at_once() {
        let dealt = |line: &str| {
            let sampling = config(line).unwrap().sampling;
            (sampling.samplers, sampling.world_threads)
        };
        assert_eq!(dealt("--device wgpu --threads 6"), (1, 6));
        assert_eq!(dealt("--device wgpu --threads 6 --set sampling.samplers=3"), (3, 6));
        assert_eq!(dealt("--threads 6"), (6, 0));
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

    /// It was stored, and nothing used it.
    #[test]
    fn a_price_of_cost_is_for_the_algorithm_that_has_one() {
        let message = format!("{:?}", config("--cost-scale 2").unwrap_err());
        assert!(message.contains("--cost-scale 2: PPOPID takes no cost off"), "{message}");
        let config = config("--cost-scale 2 --algo PPOCost").unwrap();
        assert_eq!(config.algorithm_settings.penalty_scale, 2.0);
    }

    /// JSON has no NaN: `--set` was blamed for the null in its place.
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

    /// The run was as long as its levels, whatever `--frames` said.
    #[test]
    fn a_curriculum_is_as_long_as_frames_say() {
        let check = |line: &str| {
            let (args, _) = train(&format!("hasard train RemedyRushLevel1 {line}"));
            check_length(&args, &configuration(&args).unwrap())
        };
        let message = format!("{:?}", check("--curriculum 1:64,2:64 --frames 100").unwrap_err());
        assert!(message.contains("128 frames, --frames says 100"), "{message}");
        for line in [
            "--curriculum 1:64,2:64 --frames 128",
            "--curriculum 1,2 --frames 100",
            "--curriculum 1:64",
        ] {
            assert!(check(line).is_ok(), "{line}");
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

    /// The schedule of the multiplier hangs on the length, however that is given.
    #[test]
    fn lessons_with_lengths_make_the_run_that_shares_of_its_length_make() {
        let (lengths, shares) = (
            config("--curriculum 1:700000,2:700000,3:600000").unwrap(),
            config("--curriculum 1,2,3 --frames 2M").unwrap(),
        );
        assert_eq!(lengths.frames, 2_000_000);
        assert_eq!(lengths.algorithm_settings, shares.algorithm_settings);
        let typed = "--curriculum 1:5,2:5 --set algorithm_settings.pid_reference_budget=7";
        let settings = config(typed).unwrap().algorithm_settings;
        assert_eq!(settings.pid_reference_budget, Some(7.0));
    }

    #[test]
    fn settings_that_an_algorithm_does_not_read_are_named() {
        let (args, _) = train(
            "hasard train RemedyRushLevel1-v0 --set algorithm_settings.multiplier_rate=5 --set learning.gamma=0.9 \
             --set algorithm_settings.pid_delay=3",
        );
        let lines = unread(&args, AlgorithmKind::PpoPid);
        assert!(
            lines.len() == 1 && lines[0].contains("multiplier_rate=5 changes nothing"),
            "{lines:?}"
        );
        assert!(lines[0].ends_with("but PPOLag, TRPOLag, FOCOPS, CUP"), "{lines:?}");
        assert_eq!(unread(&args, AlgorithmKind::PpoLag).len(), 1);
    }

    #[test]
    fn a_budget_of_a_task_is_named_as_the_task_is() {
        let two = "RemedyRushLevel1-v0,VolcanicVentureLevel1-v0";
        let line = format!(
            "hasard train {two} --safety-budget remedyrushlevel1=3 --safety-budget VolcanicVentureLevel1-v0=40"
        );
        let (args, _) = train(&line);
        let constraints = configuration(&args).unwrap().constraints;
        let terms: Vec<_> = constraints.iter().filter_map(|one| one.term.as_deref()).collect();
        assert_eq!(terms, two.split(',').collect::<Vec<_>>());
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
