//! Experiments and grids, expanded into their runs.
//!
//! Long because each experiment of the paper is expanded and counted.

use crate::*;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

#[test]
fn a_grid_expands_to_every_combination_once() {
    let text = "out = 'o'\nparallel = 3\nframes = 1_000\nseeds = [7, 8]\nlevels = [1, 3]\n\
                scenarios = ['RemedyRush', 'VolcanicVentureLevel2-v0']\nalgorithms = 'PPO'\n\
                [options]\nfull-actions = [false, true]\nobservation = ['rgb+depth']\n\
                [[grid]]\n[[grid]]\nalgorithms = ['PPO', 'P3O']\nseeds = 7\n";
    let sweep = Sweep::parse(text).unwrap();
    assert_eq!((sweep.parallel, sweep.grids.len()), (3, 2));
    let jobs = sweep.jobs().unwrap();
    // 3 environments x 2 action spaces x 2 seeds, and P3O with one seed; PPO of the second grid is
    // in the first.
    assert_eq!(jobs.len(), 12 + 6);
    let line = jobs[1].command_line("hasard");
    assert_eq!(
        line,
        "hasard train RemedyRushLevel1-v0 --algo PPO --frames 1000 --seed 7 --full-actions --observation rgb+depth \
         --out o/RemedyRushLevel1-v0/PPO/full-actions,observation=rgb+depth/seed7"
    );
    let mut directories: Vec<_> = jobs.iter().map(|job| job.directory.clone()).collect();
    directories.sort();
    directories.dedup();
    assert_eq!(directories.len(), jobs.len());
}

/// A factor of the frames is one of every length that is given in frames, by option or setting.
#[test]
fn scaled_sweeps_scale_all_their_lengths() {
    let text = "scenarios = ['RemedyRush']\nalgorithms = ['PPO']\nframes = 2_000_000\n[options]\neval-every = 500_000\n\
                [settings]\nlearning.schedule_frames = 4_000_000\nevaluation.every = 100_000\nevaluation.episodes = 8\n";
    let mut sweep = Sweep::parse(text).unwrap();
    sweep.scale_frames(0.01);
    // With a space behind each number, as there may be more digits.
    let line = sweep.jobs().unwrap()[0].command_line("hasard") + " ";
    for part in [
        "--frames 20000 ",
        "--eval-every 5000 ",
        "schedule_frames=40000 ",
        "evaluation.every=1000 ",
    ] {
        assert!(line.contains(part), "{part}: {line}");
    }
    assert!(line.contains("evaluation.episodes=8"), "{line}");
}

/// The benchmark's scenarios have three levels, a task of one's own up to nine.
#[test]
fn own_tasks_have_levels_beyond_the_third() {
    let jobs = |scenarios: &str, level: u32| {
        let text = format!(
            "scenarios = {scenarios}\nlevels = [{level}]\nalgorithms = ['PPO']\nframes = 64\n"
        );
        Sweep::parse(&text).and_then(|sweep| sweep.jobs())
    };
    assert_eq!(jobs("['own.toml']", 9).unwrap().len(), 1);
    assert!(jobs("['own.toml']", 10).unwrap_err().contains("levels are 1 to 9"));
    for built_in in ["['RemedyRush']", "['own.toml', 'RemedyRush']"] {
        assert!(jobs(built_in, 4).unwrap_err().contains("levels are 1 to 3"), "{built_in}");
    }
}

#[test]
fn settings_go_into_every_command_and_no_folder() {
    let text = "experiment = 'quick'\nseeds = [11]\n[settings]\nlearning.products = 'bfloat16'\n\
                evaluation.confirming_episodes = 200\nalgorithm_settings.pid_gains = [1.5, 0.2, 0]\n";
    let jobs = Sweep::parse(text).unwrap().jobs().unwrap();
    let line = jobs[0].command_line("hasard");
    for part in [
        " --set learning.products=bfloat16",
        " --set evaluation.confirming_episodes=200",
        " --set 'algorithm_settings.pid_gains=[1.5,0.2,0]'",
    ] {
        assert!(line.contains(part), "{part}: {line}");
    }
    assert!(!jobs[0].directory.to_string_lossy().contains("bfloat16"));
    // A grid has its own over them; two grids that differ in nothing else have one folder.
    let grids = |algorithms: &str| {
        let text = format!(
            "frames = 64\nscenarios = ['RemedyRush']\n[[grid]]\nalgorithms = ['PPO', 'P3O']\nsettings.learning.epochs = 3\n\
             [[grid]]\nalgorithms = ['{algorithms}']\n"
        );
        Sweep::parse(&text).unwrap().jobs()
    };
    let of_grids: Vec<usize> = grids("CPO")
        .unwrap()
        .iter()
        .map(|job| job.command_line("hasard").matches("epochs=3").count())
        .collect();
    assert_eq!(of_grids, [1, 1, 0]);
    assert!(grids("PPO").unwrap_err().contains("with other settings"));
    let wrong = Sweep::parse("experiment = 'quick'\n[settings]\nlearning.rate = 2020-01-01\n");
    assert_eq!(
        wrong.unwrap_err(),
        "`settings.learning.rate` must be a text, a number, true, false or a list of them"
    );
}

#[test]
fn the_papers_experiments_have_their_sizes() {
    let count = |name: &str| paper::experiment(name).unwrap().jobs().unwrap().len();
    for (name, expected) in [
        ("main", 540),
        ("safety-bounds", 90),
        ("curriculum", 20),
        ("segmentation", 10),
        ("depth", 20),
        ("heatmaps", 9),
        ("trpo", 90),
        ("cost-scale", 120),
        ("hard", 90),
        ("full-actions", 60),
        ("efficiency", 1),
        ("behaviour", 30),
        ("all-algorithms", 130),
        ("quick", 5),
        ("quick-all", 6),
        ("quick-algorithms", 19),
    ] {
        assert_eq!(count(name), expected, "{name}");
    }
    for known in paper::EXPERIMENTS {
        let advised = paper::advice(known.name).is_some();
        assert_eq!(paper::experiment(known.name).is_err(), advised, "{}", known.name);
    }
    let mut curriculum = paper::experiment("curriculum").unwrap();
    curriculum.scale_frames(0.01);
    let lines: Vec<String> =
        curriculum.jobs().unwrap().iter().map(|job| job.command_line("hasard")).collect();
    assert!(
        lines[0].contains("--frames 3000000 --seed 1 --curriculum 1,2,3 --preset paper"),
        "{}",
        lines[0]
    );
    assert!(lines.iter().any(|line| line.ends_with(
        "--seed 1 --preset paper --out runs/RemedyRushLevel3-v0/PPOPID/preset=paper/seed1"
    )));
    let error = paper::experiment("mian").unwrap_err();
    assert!(error.contains("`mian`") && error.contains("main, safety-bounds"), "{error}");
}

/// The grids of the paper's section 5 and its appendices: bounds of half, whole and one and a half
/// times the budget, four scales of the cost, what is observed, and hard constraints.
#[test]
fn the_papers_experiments_ask_for_its_grids() {
    // All values that an experiment gives an option in a scenario, in their order.
    let asked = |name: &str, scenario: &str, option: &str| {
        let mut values: Vec<String> = Vec::new();
        for job in paper::experiment(name).unwrap().jobs().unwrap() {
            let line = job.command_line("hasard");
            if line.contains(&format!(" train {scenario}Level")) {
                let mut words = line.split(' ').skip_while(|word| *word != format!("--{option}"));
                let value = words.nth(1).unwrap_or("none").to_string();
                if !values.contains(&value) {
                    values.push(value);
                }
            }
        }
        values
    };
    for (scenario, bounds) in [
        ("ArmamentBurden", ["25", "50", "75"]),
        ("VolcanicVenture", ["25", "50", "75"]),
        ("RemedyRush", ["2.5", "5", "7.5"]),
        ("CollateralDamage", ["2.5", "5", "7.5"]),
        ("PrecipicePlunge", ["25", "50", "75"]),
        ("DetonatorsDilemma", ["2.5", "5", "7.5"]),
    ] {
        assert_eq!(asked("safety-bounds", scenario, "safety-budget"), bounds, "{scenario}");
        assert_eq!(asked("cost-scale", scenario, "cost-scale"), ["0.1", "0.5", "1", "2"]);
    }
    assert_eq!(asked("depth", "PrecipicePlunge", "observation"), ["rgb", "rgb+depth"]);
    assert_eq!(asked("segmentation", "ArmamentBurden", "observation"), ["rgb", "segmented"]);
    assert_eq!(asked("curriculum", "RemedyRush", "curriculum"), ["1,2,3", "none"]);
    let lines = |name: &str| -> Vec<String> {
        let jobs = paper::experiment(name).unwrap().jobs().unwrap();
        jobs.iter().map(|job| format!("{} ", job.command_line("hasard"))).collect()
    };
    assert!(lines("hard").iter().all(|line| line.contains(" --hard ")));
    assert!(lines("main").iter().all(|line| !line.contains(" --hard ")));
    let full = lines("full-actions");
    assert_eq!(full.iter().filter(|line| line.contains(" --full-actions ")).count(), 30);
}

#[test]
fn a_file_may_change_an_experiment_of_the_paper() {
    let mut sweep =
        Sweep::parse("experiment = 'main'\nframes = 2_000_000\nseeds = [1]\nlevels = [1]\n[options]\nrules = 'released'")
            .unwrap();
    let jobs = sweep.jobs().unwrap();
    assert_eq!(jobs.len(), 36);
    assert!(
        jobs[0]
            .command_line("h")
            .contains("--frames 2000000 --seed 1 --preset paper --rules released")
    );
    sweep.set_option("rules", &OptionValue::Text("paper".into()));
    sweep.set_option("device", &OptionValue::Text("cpu".into()));
    let job = &sweep.jobs().unwrap()[0];
    assert!(job.command_line("h").contains("--device cpu --preset paper --rules paper"));
    assert!(
        job.directory.ends_with("ArmamentBurdenLevel1-v0/PPO/preset=paper,rules=paper/seed1"),
        "{}",
        job.directory.display()
    );
}

#[test]
fn slips_of_the_pen_are_named() {
    let base = "frames = 10\nscenarios = ['RemedyRush']\nalgorithms = ['PPO']\n";
    for (text, part) in [
        ("frames = = 3", "line 1, column 10"),
        ("frmes = 3", "unknown key `frmes`"),
        (&format!("{base}seeds = ['a']"), "`seeds` must be whole numbers"),
        (&format!("{base}seeds = []"), "`seeds` is empty"),
        (&format!("{base}levels = [4]"), "level 4 does not exist"),
        (&format!("{base}parallel = 0"), "`parallel`"),
        (&format!("{base}[options]\nseed = 3"), "set by the sweep itself"),
        (&format!("{base}[options]\n'--rules' = 'paper'"), "without dashes"),
        (&format!("{base}[options]\nx = {{ y = 1 }}"), "`x` must be a text"),
        (&format!("{base}[options]\nx = []"), "`x` has no value"),
        (&format!("{base}[options]\nx = ''"), "unprintable value; give another"),
        (&format!("{base}[options]\niwad = 5"), "`iwad` must be a path in quotes"),
        (&format!("{base}[options]\niwad = ''"), "`iwad` must be a path in quotes"),
        (&format!("{base}[options]\nmaps = true"), "`maps` must be a path in quotes"),
        (&format!("{base}iwad = 'a.wad'"), "unknown key `iwad`; known are "),
        (&format!("{base}maps = 'a'"), "options of `hasard train` go under [options]"),
        (&format!("{base}[settings]\nenv.maps = 'a'"), "use maps under [options]"),
        (&format!("{base}[settings]\niwad = 'a.wad'"), "use iwad under [options]"),
        (
            &format!("{base}[options]\nthreads = [1, 2]"),
            "`threads` makes no other run; give one value",
        ),
        (&format!("{base}[[grid]]\nout = 'x'"), "grid 1: unknown key `out`"),
        ("frames = 10\nscenarios = ['Lava']\nalgorithms = ['PPO']", "unknown scenario `Lava`"),
        ("frames = 10\nscenarios = ['../../x-v0']\nalgorithms = ['PPO']", "unknown scenario"),
        (
            "frames = 10\nscenarios = ['RemedyRush']\nalgorithms = ['a b']",
            "no name of an algorithm",
        ),
        ("scenarios = ['RemedyRush']\nalgorithms = ['PPO']", "`frames` is 0"),
        (
            &format!("{base}seeds = [{}]\n[options]\na=[{}]", "1,".repeat(2000), "1,".repeat(2000)),
            "more than 100000 runs",
        ),
    ] {
        let error = Sweep::parse(text).and_then(|sweep| sweep.jobs()).unwrap_err();
        assert!(error.contains(part) && !error.contains('\n'), "{text}: {error}");
    }
}

static OFF: AtomicBool = AtomicBool::new(false);
const NEVER: Stop<'static> = Stop { soon: &OFF, now: &OFF };

/// A folder that is gone after the test, with a stand-in for the trainer.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("hasard-sweep-{}-{name}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        Folder(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn jobs(out: &Path, seeds: &str) -> Vec<Job> {
    let text = format!(
        "out = '{}'\nframes = 100\nscenarios = ['RemedyRush']\nalgorithms = ['PPO']\nseeds = {seeds}",
        out.display()
    );
    Sweep::parse(&text).unwrap().jobs().unwrap()
}

/// Writes a program. Another process does: while this one had the file open for writing, a child of
/// another test's thread could begin, with the file open in it too, and nothing runs a file that is
/// open for writing somewhere.
#[cfg(unix)]
fn write_program(path: &Path, script: &str) {
    let command = "printf %s \"$1\" > \"$0\" && chmod 755 \"$0\"";
    let written =
        std::process::Command::new("sh").args(["-c", command]).arg(path).arg(script).status();
    assert!(written.unwrap().success());
}

#[cfg(unix)]
#[test]
fn jobs_run_are_resumed_and_skipped() {
    let folder = Folder::new("run");
    let program = folder.0.join("trainer");
    // The last argument but for --resume is the directory. Seed 2 stops half-way at first; seed 3
    // always fails.
    let script = "#!/bin/sh\nfor a in \"$@\"; do case \"$a\" in */seed*) dir=$a;; --resume) resume=1;; esac; done\n\
                  echo \"args $*\"\nmkdir -p \"$dir\"; echo '{}' > \"$dir/config.json\"\n\
                  case \"$dir\" in\n*/seed2) if [ -z \"$resume\" ]; then echo '{\"frames\":50}' > \"$dir/metrics.jsonl\"; printf '{\"fra' >> \"$dir/metrics.jsonl\"; exit 1; fi;;\n\
                  */seed3) echo 'out of luck' >&2; exit 2;; esac\necho '{\"frames\":100}' >> \"$dir/metrics.jsonl\"\n";
    write_program(&program, script);
    let jobs = jobs(&folder.0.join("out"), "[1, 2, 3]");
    let first = run_jobs(&program, &jobs, 2, NEVER, |_, _| {});
    assert_eq!((first.skipped, first.finished, first.failed.len()), (0, 1, 2), "{first:?}");
    assert!(
        first.failed[1].0.ends_with("seed3") && first.failed[1].1.ends_with("out of luck"),
        "{first:?}"
    );
    assert_eq!(jobs[1].state(), State::Unfinished(50));
    let events = Mutex::new(Vec::new());
    let second = run_jobs(&program, &jobs, 1, NEVER, |job, event| {
        events.lock().unwrap().push((job, event.clone()))
    });
    // The half-written line of seed 2 runs into the next one: a trainer mends that, this stand-in
    // does not.
    assert_eq!(second.skipped, 1, "{second:?}");
    let events = events.into_inner().unwrap();
    assert_eq!(events[0], (0, Event::AlreadyFinished));
    assert_eq!(events[1], (1, Event::Started(State::Unfinished(50))));
    let log = std::fs::read_to_string(jobs[1].log()).unwrap();
    assert!(log.contains("--resume"), "{log}");
    // Two at a time had half the cores each; one alone takes what it likes.
    let (first, second) = log.split_once("--resume").unwrap();
    let share = (std::thread::available_parallelism().unwrap().get() / 2).max(1);
    assert!(
        first.contains(&format!("--threads {share}\n")) && !second.contains("--threads"),
        "{log}"
    );
}

/// A run that another sweep has is waited for, after all others, and counts as finished before.
#[cfg(unix)]
#[test]
fn two_sweeps_share_their_runs() {
    let folder = Folder::new("share");
    let program = folder.0.join("trainer");
    let script = "#!/bin/sh\nfor a in \"$@\"; do case \"$a\" in */seed*) dir=$a;; esac; done\nmkdir -p \"$dir\"; echo '{}' > \"$dir/config.json\"\n\
                  echo '{\"frames\":100}' >> \"$dir/metrics.jsonl\"\n";
    write_program(&program, script);
    let jobs = jobs(&folder.0.join("out"), "[1, 2]");
    let held = &jobs[0].directory;
    std::fs::create_dir_all(held).unwrap();
    let lock = std::fs::File::create(held.join("lock")).unwrap();
    lock.lock().unwrap();
    let events = Mutex::new(Vec::new());
    let summary = run_jobs(&program, &jobs, 1, NEVER, |job, event| {
        if matches!(event, Event::Finished(_)) {
            // The other process comes to its end.
            std::fs::write(held.join("config.json"), "{}").unwrap();
            std::fs::write(held.join("metrics.jsonl"), "{\"frames\":100}\n").unwrap();
            lock.unlock().unwrap();
        }
        events.lock().unwrap().push((job, event.clone()));
    });
    assert_eq!((summary.skipped, summary.finished, summary.failed.len()), (1, 1, 0), "{summary:?}");
    let events = events.into_inner().unwrap();
    assert_eq!(events[0], (0, Event::Elsewhere));
    assert_eq!(events[1], (1, Event::Started(State::New)));
    assert_eq!(events[3], (0, Event::AlreadyFinished));
    assert_eq!(events.len(), 4);
}

/// Agents of finished runs are evaluated once, those of runs that were finished before as well; and
/// jobs that choose their threads keep them.
#[cfg(unix)]
#[test]
fn finished_runs_are_evaluated_once() {
    let folder = Folder::new("evaluate");
    let program = folder.0.join("trainer");
    let script = "#!/bin/sh\nif [ $1 = eval ]; then for k in $(seq $4); do echo \"{\\\"episode\\\":$k,\\\"asked\\\":\\\"$*\\\"}\"; done; echo \"{\\\"episodes\\\":$4}\"; exit 0; fi\n\
                  for a in \"$@\"; do case \"$a\" in */seed*) dir=$a;; esac; done\nmkdir -p \"$dir\"; echo '{}' > \"$dir/config.json\"\n\
                  echo '{\"frames\":100}' >> \"$dir/metrics.jsonl\"\n";
    write_program(&program, script);
    let text = |evaluate: u32| {
        let out = folder.0.join("out");
        format!(
            "out = '{}'\nevaluate = {evaluate}\nframes = 100\nscenarios = ['RemedyRush']\nalgorithms = ['PPO']\nseeds = [1, 2]\n\
             [options]\nthreads = 7",
            out.display()
        )
    };
    let without = Sweep::parse(&text(0)).unwrap().jobs().unwrap();
    assert_eq!(run_jobs(&program, &without, 2, NEVER, |_, _| {}).finished, 2);
    assert!(!without[0].evaluation().exists());
    let log = std::fs::read_to_string(without[0].log()).unwrap();
    assert!(log.contains("--threads 7") && log.matches("--threads").count() == 1, "{log}");
    let with = Sweep::parse(&text(100)).unwrap().jobs().unwrap();
    for _ in 0..2 {
        assert_eq!(run_jobs(&program, &with, 2, NEVER, |_, _| {}).skipped, 2);
        for job in &with {
            let kept = std::fs::read_to_string(job.evaluation()).unwrap();
            assert!(
                kept.contains(&format!("eval {} --episodes 100 --json", job.directory.display())),
                "{kept}"
            );
            std::fs::write(job.evaluation(), kept + "once").unwrap();
            assert!(!job.wants_evaluation());
        }
    }
    assert!(
        std::fs::read_to_string(with[0].evaluation()).unwrap().ends_with("onceonce"),
        "it was evaluated twice"
    );
    // A run without a selection that went on has a newer checkpoint.
    let newer = with[0].directory.join("checkpoints/frames_200");
    std::fs::create_dir_all(newer.parent().unwrap()).unwrap();
    let later = std::time::SystemTime::now() + std::time::Duration::from_secs(1);
    std::fs::File::create(newer).unwrap().set_modified(later).unwrap();
    assert!(with[0].wants_evaluation() && !with[1].wants_evaluation());
}

/// A caller who stops a sweep: the processes hear of it at their standard input, no further one
/// begins, and those that do not listen are killed when the caller insists.
#[cfg(unix)]
#[test]
fn a_sweep_that_is_stopped_leaves_no_process() {
    let folder = Folder::new("stopped");
    let program = folder.0.join("trainer");
    // Seed 1 listens, as a training does; seed 2 is deaf.
    let script = "#!/bin/sh\nfor a in \"$@\"; do case \"$a\" in */seed*) dir=$a;; esac; done\nmkdir -p \"$dir\"\n\
                  echo $$ > \"$dir/process\"\ncase \"$dir\" in */seed1) cat > /dev/null; echo stopped; exit 143;; esac\nexec sleep 600\n";
    write_program(&program, script);
    let jobs = jobs(&folder.0.join("out"), "[1, 2, 3]");
    let (soon, now) = (AtomicBool::new(false), AtomicBool::new(false));
    let begun = |job: &Job| {
        std::fs::read_to_string(job.directory.join("process"))
            .is_ok_and(|text| text.ends_with('\n'))
    };
    let wait = |what: &dyn Fn() -> bool| {
        (0..2000).any(|_| {
            what() || {
                std::thread::sleep(std::time::Duration::from_millis(5));
                false
            }
        })
    };
    let events = Mutex::new(Vec::new());
    let note = |job: usize, event: &Event| events.lock().unwrap().push((job, event.clone()));
    let summary = std::thread::scope(|scope| {
        let sweep =
            scope.spawn(|| run_jobs(&program, &jobs, 2, Stop { soon: &soon, now: &now }, note));
        assert!(wait(&|| begun(&jobs[0]) && begun(&jobs[1])));
        soon.store(true, Ordering::SeqCst);
        assert!(
            wait(&|| events.lock().unwrap().contains(&(0, Event::Stopped))),
            "{:?}",
            events.lock().unwrap()
        );
        now.store(true, Ordering::SeqCst);
        sweep.join().unwrap()
    });
    assert_eq!((summary.stopped, summary.finished, summary.failed.len()), (2, 0, 0), "{summary:?}");
    assert!(!jobs[2].directory.exists(), "a run began after the sweep was stopped");
    for job in &jobs[..2] {
        let process = std::fs::read_to_string(job.directory.join("process")).unwrap();
        assert!(!Path::new("/proc").join(process.trim()).exists(), "{process} lives on");
    }
}

/// Rows alone do not make a run finished: its last checkpoint and the closing episodes of its
/// selected one come after them.
#[test]
fn a_run_that_was_killed_at_its_end_is_unfinished() {
    let folder = Folder::new("closing");
    let job = jobs(&folder.0.join("out"), "[1]").swap_remove(0);
    let run = &job.directory;
    std::fs::create_dir_all(run.join("checkpoints/frames_000000000050")).unwrap();
    std::fs::create_dir_all(run.join("checkpoints/best_000000000050")).unwrap();
    std::fs::write(run.join("config.json"), "{}").unwrap();
    std::fs::write(run.join("metrics.jsonl"), "{\"frames\":50}\n{\"frames\":104}\n").unwrap();
    assert_eq!(job.state(), State::Unfinished(104), "its last checkpoint is missing");
    std::fs::create_dir_all(run.join("checkpoints/frames_000000000104")).unwrap();
    assert_eq!(job.state(), State::Unfinished(104), "its closing episodes are missing");
    std::fs::write(run.join("hand_out.json"), "{\"frames\": 10}").unwrap();
    assert_eq!(
        job.state(),
        State::Unfinished(104),
        "its closing episodes are those of an earlier end"
    );
    std::fs::write(run.join("hand_out.json"), "{\"frames\": 50}").unwrap();
    assert_eq!(job.state(), State::Finished, "as older versions ended");
    std::fs::write(run.join("selected.json"), "{\"frames\": 50, \"last\": {\"frames\": 60}}")
        .unwrap();
    assert_eq!(job.state(), State::Unfinished(104), "it was closed at an earlier end");
    std::fs::write(run.join("selected.json"), "{\"frames\": 50, \"last\": {\"frames\": 104}}")
        .unwrap();
    assert_eq!(job.state(), State::Finished);
}

#[test]
fn a_missing_program_is_a_failed_job() {
    let folder = Folder::new("missing");
    let jobs = jobs(&folder.0.join("out"), "[1]");
    let summary = run_jobs(Path::new("/no/such/hasard"), &jobs, 8, NEVER, |_, _| {});
    assert!(summary.failed[0].1.contains("cannot run /no/such/hasard"), "{summary:?}");
}

#[test]
fn words_are_quoted_for_a_shell() {
    let text = "out = \"a b/it's\"\nframes = 1\nscenarios = ['RemedyRush']\nalgorithms = ['PPO']\n[options]\niwad = 'my file'";
    let line = Sweep::parse(text).unwrap().jobs().unwrap()[0].command_line("hasard");
    assert!(
        line.contains("--iwad 'my file'")
            && line.contains("'a b/it'\\''s/RemedyRushLevel1-v0/PPO/iwad=my_file/seed1'"),
        "{line}"
    );
}

#[test]
fn seeds_are_the_outermost_loop() {
    let text = "frames = 1\nscenarios = ['RemedyRush', 'VolcanicVenture']\nalgorithms = ['PPO', 'P3O']\nseeds = [4, 2, 9]\n\
                [[grid]]\n[[grid]]\nalgorithms = ['CPO']\nseeds = [2, 4]";
    let jobs = Sweep::parse(text).unwrap().jobs().unwrap();
    let order: Vec<(u64, &str)> =
        jobs.iter().map(|job| (job.seed, job.algorithm.as_str())).collect();
    // The first seeds of both grids, then their second ones; the same run of both is made once.
    let first = [(4, "PPO"), (4, "P3O"), (4, "PPO"), (4, "P3O"), (2, "CPO"), (2, "CPO")];
    let second = [(2, "PPO"), (2, "P3O"), (2, "PPO"), (2, "P3O"), (4, "CPO"), (4, "CPO")];
    assert_eq!(order[..6], first);
    assert_eq!(order[6..12], second);
    assert_eq!(order[12..].iter().map(|(seed, _)| *seed).collect::<Vec<_>>(), [9; 4]);
    assert_eq!(jobs[0].name(), "PPO RemedyRushLevel1 seed 4");
}

/// Lists choose among an experiment's runs; what it does not have goes with all of them.
#[test]
fn lists_choose_among_the_runs_of_an_experiment() {
    let count = |change: &dyn Fn(&mut Sweep), name: &str| {
        let mut sweep = paper::experiment(name).unwrap();
        change(&mut sweep);
        sweep.jobs().unwrap()
    };
    let two = ["RemedyRush", "VolcanicVenture"].map(String::from);
    let bounds = count(&|sweep| sweep.restrict_scenarios(&two), "safety-bounds");
    assert_eq!(bounds.len(), 2 * 3 * 5);
    let lines: Vec<String> = bounds.iter().map(|job| job.command_line("hasard")).collect();
    // Each with its own budgets.
    assert!(lines.iter().all(|line| line.contains("RemedyRush")
        == ["2.5 ", "5 ", "7.5 "].iter().any(|b| line.contains(&format!("-budget {b}")))));
    let file = "experiment = 'safety-bounds'\nscenarios = ['RemedyRush', 'VolcanicVenture']";
    assert_eq!(Sweep::parse(file).unwrap().jobs().unwrap(), bounds);
    let elsewhere = count(&|sweep| sweep.restrict_scenarios(&two[..1]), "depth");
    assert!(elsewhere.iter().all(|job| job.environment == "RemedyRushLevel2-v0"));
    assert_eq!(elsewhere.len(), 20);
    assert_eq!(count(&|sweep| sweep.restrict_levels(&[2, 3]), "main").len(), 360);
    assert_eq!(count(&|sweep| sweep.restrict_algorithms(&["PPO".into()]), "heatmaps").len(), 2);
}

/// Files of a campaign: an experiment, its length, seeds and preset.
#[test]
fn files_of_a_campaign_work_as_they_are() {
    let common =
        "out = 'o'\nparallel = 2\nevaluate = 200\nframes = 8_000_000\nseeds = [11, 12, 13]\n";
    for (what, runs) in [
        ("experiment = 'main'\nlevels = [1]", 108),
        (
            "scenarios = ['ArmamentBurden', 'VolcanicVenture', 'RemedyRush', 'CollateralDamage', 'PrecipicePlunge', 'DetonatorsDilemma']\n\
             levels = [2, 3]\nalgorithms = ['PPOPID']",
            36,
        ),
        ("experiment = 'curriculum'", 12),
        ("experiment = 'depth'", 12),
        ("experiment = 'hard'", 54),
        ("experiment = 'safety-bounds'", 54),
        ("experiment = 'segmentation'", 6),
    ] {
        let text = format!("{what}\n{common}[options]\npreset = 'quick'");
        assert!(Sweep::chooses_frames(&text));
        let sweep = Sweep::parse(&text).unwrap();
        let jobs = sweep.jobs().unwrap();
        assert_eq!((jobs.len(), sweep.parallel), (runs, 2), "{what}");
        for job in jobs {
            let line = job.command_line("hasard");
            assert!(
                line.contains("--frames 8000000") && line.matches("--preset quick").count() == 1,
                "{line}"
            );
            assert!(
                job.evaluate == 200
                    && (11..=13).contains(&job.seed)
                    && job.options.contains("preset=quick")
            );
        }
    }
    assert!(!Sweep::chooses_frames("experiment = 'main'") && !Sweep::chooses_frames("frames"));
}

/// The guide's table of experiments, row by row.
#[test]
fn the_guide_has_every_experiment_with_its_size() {
    let page = std::fs::read_to_string("../../docs/guide/reproduce.md").unwrap();
    let rows: Vec<Vec<&str>> = page
        .lines()
        .map(|line| line.split('|').map(|cell| cell.trim().trim_matches('`')).collect::<Vec<_>>())
        .filter(|cells| {
            cells.len() == 8 && paper::EXPERIMENTS.iter().any(|known| known.name == cells[1])
        })
        .collect();
    let names: Vec<&str> = rows.iter().map(|cells| cells[1]).collect();
    assert_eq!(names, paper::EXPERIMENTS.map(|known| known.name));
    for (cells, known) in rows.iter().zip(paper::EXPERIMENTS) {
        let [_, name, fills, what, runs, frames, hours, _] = cells[..] else { unreachable!() };
        assert_eq!(
            (fills, what),
            (if known.fills.is_empty() { "-" } else { known.fills }, known.what),
            "{name}"
        );
        let Ok(sweep) = paper::experiment(name) else {
            assert_eq!((runs, frames, hours), ("-", "-", "-"), "{name}");
            continue;
        };
        let jobs = sweep.jobs().unwrap();
        let total = jobs.iter().map(|job| job.frames).sum::<u64>() as f64;
        assert_eq!(runs, jobs.len().to_string(), "{name}");
        let (number, unit) = frames.split_once(' ').unwrap();
        let scale = [("G", 1e9), ("M", 1e6)].iter().find(|(letter, _)| *letter == unit).unwrap().1;
        assert_eq!(number.parse::<f64>().unwrap() * scale, total, "{name}");
        // At 10,000 frames a second.
        let expected = total / 10_000.0 / 3600.0;
        let written: f64 = hours.replace(',', "").parse().unwrap();
        assert!(
            (written - expected).abs() <= 0.005 * expected + 0.05,
            "{name}: {written} for {expected}"
        );
    }
}

/// A file of an own task has its levels as a scenario has; one level of it is named with `#`.
#[test]
fn files_of_own_tasks_have_levels() {
    let grid = |scenarios: &[&str], levels: &[u32]| Grid {
        scenarios: scenarios.iter().map(ToString::to_string).collect(),
        levels: levels.to_vec(),
        ..Grid::default()
    };
    assert_eq!(grid(&["a.toml"], &[1]).environments(), ["a.toml"]);
    assert_eq!(grid(&["a.toml"], &[1, 3]).environments(), ["a.toml", "a.toml#3"]);
    assert_eq!(grid(&["a.toml#2"], &[1, 3]).environments(), ["a.toml#2"]);
    // A path from elsewhere, or from the root, stays below the sweep's folder.
    for (file, folder) in
        [("../t/a.toml", "t/a.toml"), ("/t/a.toml#2", "t/a.toml#2"), ("./a.toml", "a.toml")]
    {
        let job = Job::new(Path::new("out"), file, "PPO", 64, 1, &[]);
        assert_eq!(job.directory, Path::new("out").join(folder).join("PPO/seed1"));
    }
    // Several tasks are one environment, whatever the levels of others.
    let several = "RemedyRushLevel1-v0,a.toml#2,b.toml";
    assert_eq!(grid(&[several], &[1, 3]).environments(), [several]);
}
