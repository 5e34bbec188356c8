use super::progress::RunResult;
use super::*;
use crate::args::{Cli, Command};
use clap::Parser;
use std::time::Duration;

fn args(words: &str) -> SweepArgs {
    let line = ["hasard", "sweep"].into_iter().chain(words.split(' '));
    let Command::Sweep(args) =
        Cli::try_parse_from(line).unwrap_or_else(|error| panic!("{error}")).command
    else {
        panic!("{words} is no sweep");
    };
    args
}

fn jobs(words: &str) -> Vec<Job> {
    let args = args(words);
    let mut sweep = description(&args.what).unwrap().sweep;
    change(&mut sweep, &args).unwrap();
    sweep.jobs().unwrap()
}

/// Of an option that is given twice a run could have only the last, and a setting of the sweep's own
/// would be in no run whose folder says otherwise.
#[test]
fn options_are_given_once() {
    let path = std::env::temp_dir().join(format!("hasard-options-{}.toml", std::process::id()));
    let text =
        "scenarios = ['RemedyRush']\nalgorithms = ['PPO']\n[settings]\nlearning.gamma = 0.9\n";
    std::fs::write(&path, text).unwrap();
    let refused = |words: &str| {
        let args = args(&format!("{} {words}", path.display()));
        let mut sweep = description(&args.what).unwrap().sweep;
        change(&mut sweep, &args).map_err(Failure::line).err()
    };
    for (words, named) in [
        ("--option set=learning.rate=0.001 --option set=learning.gae_lambda=0.9", "[settings]"),
        ("--option rules=tables --option rules=paper", "rules is given twice"),
        ("--preset paper --option preset=quick", "preset is given twice"),
        ("--option set=learning.gamma=0.5", "the sweep has learning.gamma under [settings]"),
    ] {
        let line = refused(words).unwrap_or_else(|| panic!("{words} is taken"));
        assert!(line.contains(named), "{line}");
    }
    assert_eq!(
        refused("--option set=learning.rate=0.001 --option rules=paper --preset paper"),
        None
    );
    std::fs::remove_file(path).unwrap();
}

/// The runs of `words` after what `--scale` adds.
fn scaled(words: &str) -> Result<Vec<Job>, Failure> {
    let (mut jobs, scale) = (jobs(words), args(words).scale.unwrap());
    let configs = settings(&jobs)?;
    jobs.iter_mut()
        .zip(&configs)
        .try_for_each(|(job, config)| rescale::rescale(job, config, scale))?;
    Ok(jobs)
}

/// Every run of every experiment of the paper is a command that this program takes and can begin.
#[test]
fn the_papers_experiments_are_commands_of_this_program() {
    for known in paper::EXPERIMENTS {
        let Ok(sweep) = paper::experiment(known.name) else { continue };
        let jobs = sweep.jobs().unwrap();
        assert!(!jobs.is_empty(), "{}", known.name);
        if let Err(failure) = settings(&jobs) {
            panic!("{}: {failure:?}", known.name);
        }
    }
}

#[test]
fn words_of_the_command_change_the_experiment() {
    let chosen = jobs(
        "main --preset quick --seeds 3,11-12 --algos ppopid,P3O --levels 2 --scenarios RemedyRush --frames 8000000 --evaluate 50 \
         --option rules=tables --option hard",
    );
    assert_eq!(chosen.len(), 6);
    assert_eq!(chosen[0].evaluate, 50);
    let seeds: Vec<u64> = chosen.iter().map(|job| job.seed).collect();
    assert_eq!(seeds, [3, 3, 11, 11, 12, 12], "seeds are the outermost loop");
    let line = chosen[0].command_line("hasard");
    assert!(
        line.starts_with(
            "hasard train RemedyRushLevel2-v0 --algo PPOPID --frames 8000000 --seed 3"
        ),
        "{line}"
    );
    for option in ["--preset quick", "--rules tables", "--hard"] {
        assert_eq!(line.matches(option).count(), 1, "{line}");
    }
    for wrong in ["x", "5-3", "-1", "1-999999"] {
        assert!(super::seeds(&[wrong.to_owned()]).is_err(), "{wrong}");
    }
}

/// Over a run, a multiplier moves by its rate times the number of updates: in a hundredth of the
/// updates it comes as far by a hundred times the rate.
#[test]
fn shorter_runs_move_their_multipliers_as_far() {
    let before = settings(&jobs("main --seeds 1 --levels 1 --scenarios RemedyRush")).unwrap();
    let after =
        settings(&scaled("main --seeds 1 --levels 1 --scenarios RemedyRush --scale 0.01").unwrap())
            .unwrap();
    for (before, after) in before.iter().zip(&after) {
        assert_eq!(after.frames, before.frames / 100);
        let travel = |config: &TrainConfig| {
            let settings = &config.algorithm_settings;
            [settings.multiplier_rate, settings.pid_gains.1].map(|rate| rate * config.frames as f64)
        };
        let (own, short) = (travel(before), travel(after));
        match before.algorithm {
            AlgorithmKind::PpoLag => assert!((short[0] / own[0] - 1.0).abs() < 1e-3),
            AlgorithmKind::PpoPid => {
                assert!((short[1] / own[1] - 1.0).abs() < 1e-3);
                let proportional = |config: &TrainConfig| config.algorithm_settings.pid_gains.0;
                assert_eq!(proportional(before), proportional(after));
            }
            _ => assert_eq!(before.algorithm_settings, after.algorithm_settings),
        }
    }
    let sets = |words: &str| -> usize {
        scaled(words)
            .unwrap()
            .iter()
            .map(|job| job.words().filter(|word| word == "--set").count())
            .sum()
    };
    // The quick preset's rates are made for its own ten million frames.
    assert_eq!(sets("main --seeds 1 --levels 1 --preset quick --scale 0.02"), 0);
    assert_eq!(sets("main --seeds 1 --levels 1 --preset quick --scale 0.01"), 12);
    // What is set already stays.
    assert_eq!(
        sets(
            "hard --seeds 1 --algos PPOLag --scale 0.01 --option set=algorithm_settings.multiplier_rate=0.5"
        ),
        6
    );
    assert_eq!(sets("main --seeds 1 --levels 1 --scale 2"), 0, "longer runs keep their rates");
}

/// `train --preset tables` has the rules of the tables: runs of them are no runs of the paper's.
#[test]
fn runs_of_the_preset_tables_have_its_rules() {
    let rules = |words: &str| -> Vec<String> {
        settings(&jobs(words)).unwrap().into_iter().map(|config| config.env.rules).collect()
    };
    let main = "main --seeds 1 --levels 1 --scenarios RemedyRush --algos PPO";
    assert_eq!(rules(&format!("{main} --preset tables")), ["tables"]);
    assert_eq!(rules(&format!("{main} --preset tables --option rules=paper")), ["paper"]);
    assert_eq!(rules(main), ["paper"]);
    let share = |words: &str| {
        let jobs = jobs(words);
        let configs = settings(&jobs).unwrap();
        share(jobs.into_iter().zip(configs).collect()).len()
    };
    assert_eq!(share(&format!("{main} --preset tables")), 1);
}

#[test]
fn runs_that_end_before_their_first_episodes_are_refused() {
    let Err(Failure::BadInput(line)) = scaled("main --seeds 1 --scale 0.00001") else {
        panic!("taken")
    };
    // 500 million frames by a hundred thousandth; 32 worlds of 2100 tics.
    assert!(
        line.contains("after 5000 frames") && line.contains("67200") && !line.contains('\n'),
        "{line}"
    );
}

#[test]
fn progress_says_what_is_done_what_came_of_it_and_what_is_left() {
    let jobs = jobs("quick --out /nowhere/of/this/test --frames 1000000");
    let mut progress = Progress::new(&jobs, 1, Some(10_000.0));
    // Five runs of 100 s.
    assert_eq!(progress.seconds_left(), Some(500.0));
    progress.hear(0, &Event::Started(hasard_sweep::State::New));
    assert!(progress.seconds_left().is_some_and(|left| (499.0..=500.0).contains(&left)));
    let finished = Event::Finished(Duration::from_secs(50));
    progress.hear(0, &finished);
    // It took half as long as expected: four more such.
    assert_eq!(progress.seconds_left(), Some(200.0));
    let result = RunResult {
        episode_return: 5.61,
        costs: vec![84.24],
        budgets: vec!["50".into()],
        within: false,
    };
    let line = progress.line(&jobs[0], &finished, Some(&result)).unwrap();
    let expected = "[1/5] PPOPID VolcanicVentureLevel1 seed 1, preset=quick: 5.6 @ 84.2 of 50, over, 50 s; ~3 min left";
    assert_eq!(line, expected);
    progress.hear(1, &Event::AlreadyFinished);
    assert_eq!(progress.seconds_left(), Some(150.0));
    let failed = Event::Failed("no luck".into());
    progress.hear(2, &failed);
    let line = progress.line(&jobs[2], &failed, None).unwrap();
    assert!(
        line.starts_with("[3/5]")
            && line.contains("failed: no luck")
            && line.ends_with("~100 s left"),
        "{line}"
    );
}

/// The campaign's files, whatever `quick` has become since, ask for what its recorded runs had.
#[test]
fn the_campaigns_files_ask_for_its_recorded_runs() {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    let mut files = 0;
    let mut found = 0;
    for entry in std::fs::read_dir(format!("{root}/docs/campaign")).unwrap() {
        let file = entry.unwrap().path();
        let words = format!("{} --seeds 11 --out {root}/docs/results/campaign", file.display());
        let jobs = jobs(&words);
        let configs = settings(&jobs).unwrap();
        for (job, config) in jobs.iter().zip(&configs) {
            if let Err(failure) = fits(job, config) {
                panic!("{}: {failure:?}", file.display());
            }
            found += usize::from(job.directory.join("config.json").exists());
        }
        files += 1;
    }
    assert!(files == 11 && found > 150, "{files} files, {found} runs");
}
