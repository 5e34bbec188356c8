//! Several workers of one run, each a thread, against one worker that has all lanes.

mod tiny;

use hasard_learn::config::{AlgorithmKind, CriticInput, TrainConfig};
use hasard_learn::runs::agent_file::export;
use hasard_learn::runs::report::Report;
use hasard_learn::runs::together::Invitation;
use hasard_learn::runs::trainer::{Hooks, Start, train_together};
use hasard_learn::team::{Exchange, Team};
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Condvar, Mutex};
use std::time::Duration;
use tiny::{config, directory, run, worlds};

/// A table in the middle: everyone lays something down, and takes a copy of all of it when all
/// have.
#[derive(Default)]
struct Table {
    round: Mutex<Round>,
    turned: Condvar,
}

#[derive(Default)]
struct Round {
    number: u64,
    laid: Vec<Option<Vec<u8>>>,
    complete: Vec<Vec<u8>>,
}

struct Seat {
    table: Arc<Table>,
    rank: usize,
    /// Leaves the table after so many exchanges.
    left: usize,
}

impl Exchange for Seat {
    fn gather(&mut self, bytes: Vec<u8>) -> Result<Vec<Vec<u8>>, String> {
        self.left = self.left.checked_sub(1).ok_or("worker left the table")?;
        let mut round = self.table.round.lock().unwrap();
        let number = round.number;
        round.laid[self.rank] = Some(bytes);
        if round.laid.iter().all(Option::is_some) {
            round.complete = round.laid.iter_mut().map(|part| part.take().unwrap()).collect();
            round.number += 1;
            self.table.turned.notify_all();
        }
        while round.number == number {
            let (again, late) =
                self.table.turned.wait_timeout(round, Duration::from_secs(20)).unwrap();
            round = again;
            if late.timed_out() && round.number == number {
                return Err("a worker is gone".into());
            }
        }
        Ok(round.complete.clone())
    }
}

/// Trains with `ranks` workers, of which the last leaves after some exchanges; gives the first
/// one's reports.
fn together(
    start: Start,
    at: &Path,
    ranks: usize,
    leaves_after: usize,
) -> (Result<(), String>, Vec<Report>) {
    let table = Arc::new(Table::default());
    table.round.lock().unwrap().laid = vec![None; ranks];
    let team = |rank: usize| {
        let left = if rank == ranks - 1 { leaves_after } else { usize::MAX };
        Team::new(rank, ranks, Box::new(Seat { table: Arc::clone(&table), rank, left }))
    };
    let mut reports = Vec::new();
    let outcome = std::thread::scope(|scope| {
        for rank in 1..ranks {
            let team = team(rank);
            scope.spawn(move || {
                Invitation::hear(team)
                    .and_then(|invitation| invitation.follow(&worlds, &mut |_| {}))
            });
        }
        let stop = AtomicBool::new(false);
        let mut hear = |report: &Report| reports.push(report.clone());
        let mut hooks = Hooks { stop: &stop, report: &mut hear, warn: &mut |_| {} };
        train_together(&team(0), start, at, &worlds, &mut hooks)
    });
    (outcome.map(drop).map_err(|error| error.to_string()), reports)
}

/// Twenty updates' worth of rollouts, a report each.
fn short(algorithm: AlgorithmKind) -> TrainConfig {
    let mut config = config(algorithm);
    config.learning.epochs = 1;
    config.frames = 512 * 10;
    if algorithm == AlgorithmKind::PpoLag {
        // Rollouts in two trajectories each, and critics that see more than the policy.
        config.learning.recurrence = Some(8);
        config.learning.critic_inputs = CriticInput::ALL.to_vec();
    }
    if algorithm == AlgorithmKind::P3o {
        // Whatever else a frame may teach more by.
        let learning = &mut config.learning;
        (learning.epochs, learning.recompute_advantages) = (2, true);
        (learning.auxiliary_depth, learning.auxiliary_labels) = (0.1, 0.1);
        (learning.value_phase, learning.value_phase_passes) = (Some(2), 2);
        learning.budget_annealing = Some(0.5);
    }
    config
}

/// What was learned of a report, by name: not how long it took.
fn numbers(report: &Report) -> Vec<(String, f64)> {
    let row = report.row();
    let timed = |name: &str| name.contains("second") || ["fps", "wall_s"].contains(&name);
    let kept = row.as_object().unwrap().iter().filter(|(name, _)| !timed(name));
    kept.filter_map(|(name, value)| Some((name.clone(), value.as_f64()?))).collect()
}

fn weights(run: &Path) -> Vec<u8> {
    let all =
        std::fs::read_dir(run.join("checkpoints")).unwrap().map(|entry| entry.unwrap().path());
    std::fs::read(all.max().unwrap().join("weights.safetensors")).unwrap()
}

#[test]
fn four_workers_learn_what_one_does_and_two_runs_of_them_are_equal() {
    for algorithm in
        [AlgorithmKind::PpoLag, AlgorithmKind::P3o, AlgorithmKind::TrpoLag, AlgorithmKind::Cup]
    {
        let names = ["alone", "once", "twice"]
            .map(|name| directory(&format!("together-{name}-{algorithm}")));
        let [alone, once, twice] = &names;
        let (outcome, one, _) = run(Start::Fresh(short(algorithm)), alone);
        outcome.unwrap();
        let mut runs = Vec::new();
        for at in [once, twice] {
            let (outcome, reports) = together(Start::Fresh(short(algorithm)), at, 4, usize::MAX);
            outcome.unwrap();
            assert_eq!(reports.len(), one.len());
            runs.push(reports);
        }
        for (number, (ours, expected)) in runs[0].iter().zip(&one).enumerate() {
            let (ours, expected) = (numbers(ours), numbers(expected));
            assert_eq!(ours.len(), expected.len());
            for ((name, ours), (_, expected)) in ours.iter().zip(&expected) {
                assert!(
                    (ours - expected).abs() <= 1e-4 * expected.abs().max(1.0),
                    "{algorithm}, {name} of report {number}: {ours} and {expected}"
                );
            }
        }
        assert!(
            numbers(&one[9]).iter().any(|(name, _)| name.contains("loss")),
            "losses are among what is compared"
        );
        assert_eq!(weights(once), weights(twice), "{algorithm}");
        for at in &names {
            std::fs::remove_dir_all(at).unwrap();
        }
    }
}

/// What each worker is sent of an agent's file is the whole of it.
#[test]
fn several_workers_begin_with_an_agents_file_as_one_does() {
    let [before, alone, both] =
        ["before", "from-alone", "from-both"].map(|name| directory(&format!("together-{name}")));
    let mut config = short(AlgorithmKind::PpoPid);
    config.frames = 512 * 2;
    config.evaluation.every = Some(config.frames);
    (config.evaluation.episodes, config.evaluation.confirming_episodes) = (2, Some(2));
    run(Start::Fresh(config.clone()), &before).0.unwrap();
    let file = before.join("one.agent");
    std::fs::write(&file, export(&before).unwrap()).unwrap();
    config.evaluation.every = Some(0);
    let start = || Start::From(config.clone(), file.clone());
    let (outcome, expected, _) = run(start(), &alone);
    outcome.unwrap();
    let (outcome, reports) = together(start(), &both, 2, usize::MAX);
    outcome.unwrap();
    assert_eq!(reports.len(), expected.len());
    for ((name, ours), (_, expected)) in numbers(&reports[0]).iter().zip(numbers(&expected[0])) {
        assert!(
            (ours - expected).abs() <= 1e-4 * expected.abs().max(1.0),
            "{name}: {ours} and {expected}"
        );
    }
    for at in [before, alone, both] {
        std::fs::remove_dir_all(at).unwrap();
    }
}

#[test]
fn a_run_goes_on_with_another_number_of_workers() {
    let (three, one) = (directory("together-three"), directory("together-one"));
    let mut config = short(AlgorithmKind::PpoLag);
    config.frames = 512 * 4;
    together(Start::Fresh(config.clone()), &three, 3, usize::MAX).0.unwrap();
    run(Start::Fresh(config), &one).0.unwrap();
    let longer = || Start::Resume { settings: vec!["frames=4096".into()] };
    let (outcome, reports) = together(longer(), &three, 2, usize::MAX);
    outcome.unwrap();
    let (outcome, expected, _) = run(longer(), &one);
    outcome.unwrap();
    for (ours, expected) in reports.iter().zip(&expected) {
        for ((name, ours), (_, expected)) in numbers(ours).iter().zip(numbers(expected)) {
            assert!(
                (ours - expected).abs() <= 1e-4 * expected.abs().max(1.0),
                "{name}: {ours} and {expected}"
            );
        }
    }
    assert_eq!(reports.last().map(|last| last.frames), Some(4096));
    for at in [three, one] {
        std::fs::remove_dir_all(at).unwrap();
    }
}

#[test]
fn a_worker_that_is_gone_ends_the_run_with_its_reason() {
    let at = directory("together-gone");
    let (outcome, _) = together(Start::Fresh(short(AlgorithmKind::PpoLag)), &at, 2, 30);
    assert_eq!(outcome, Err("a worker is gone".to_string()));
    std::fs::remove_dir_all(at).unwrap();
}
