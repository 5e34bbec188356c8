use super::*;
use crate::config::{EnvConfig, Preset};
use crate::statistics::Estimate;

fn config() -> TrainConfig {
    let mut config =
        TrainConfig::plain(AlgorithmKind::PpoLag, Preset::Paper, EnvConfig::new("test"));
    config.constraints = vec![Constraint { term: None, budget: 5.0 }];
    config.evaluation.confirming_episodes = Some(4);
    config.env.frame_skip = 4;
    config
}

/// Episodes whose costs lie a little around their mean.
fn episodes(episode_return: f64, cost: f64, count: usize) -> Vec<Episode> {
    let one = |index: usize| Episode {
        task: None,
        lane: 0,
        seed: 0,
        episode_return,
        cost: cost + if index.is_multiple_of(2) { 0.1 } else { -0.1 },
        costs: vec![],
        length: 10,
        terminated: true,
        truncated: false,
        stats: vec![],
    };
    (0..count).map(one).collect()
}

fn candidate(frames: u64, episode_return: f64, cost: f64) -> Candidate {
    Candidate::new(
        frames,
        Evaluation::of(&episodes(episode_return, cost, 4), &config().constraints).unwrap(),
    )
}

fn ranked(all: &[(u64, f64, f64)], algorithm: AlgorithmKind) -> Candidates {
    let mut candidates = Candidates::default();
    for &(frames, episode_return, cost) in all {
        candidates.add(candidate(frames, episode_return, cost), algorithm, 5);
    }
    candidates
}

fn order(candidates: &Candidates) -> Vec<u64> {
    candidates.ranked.iter().map(|one| one.frames).collect()
}

/// Audit, "Choosing the checkpoint": 4.56 at cost 1.27 was once chosen over 15.2 at 4.9 of a
/// budget of 5.
#[test]
fn among_those_within_the_budget_the_return_decides() {
    let all = [(1, 4.56, 1.27), (2, 15.2, 4.9), (3, 40.0, 9.0), (4, 30.0, 5.5), (5, 10.0, 4.0)];
    assert_eq!(order(&ranked(&all, AlgorithmKind::PpoLag)), [2, 5, 1, 4, 3]);
    // An algorithm without budgets is after the return.
    assert_eq!(order(&ranked(&all, AlgorithmKind::Ppo)), [3, 4, 2, 5, 1]);
    let mut few = ranked(&all, AlgorithmKind::PpoLag);
    assert!(!few.add(candidate(6, 50.0, 20.0), AlgorithmKind::PpoLag, 5), "worse than five others");
    assert!(few.add(candidate(7, 12.0, 3.0), AlgorithmKind::PpoLag, 5));
    assert_eq!(order(&few), [2, 7, 5, 1, 4]);
}

/// A failed closing leads to the next candidate with new episodes; the last policy's closing is
/// always beside it.
#[test]
fn a_candidate_that_fails_its_closing_gives_way_to_the_next() {
    let config = config();
    let candidates = ranked(
        &[(1, 20.0, 4.0), (2, 18.0, 4.0), (3, 16.0, 4.0), (4, 14.0, 4.0)],
        AlgorithmKind::PpoLag,
    );
    let mut asked = Vec::new();
    let mut play = |policy: Option<u64>, set: EpisodeSet, count: usize| {
        asked.push((policy, set));
        let cost = match (policy, set) {
            // The first fails its confirmation, the second its closing.
            (Some(1), _) | (Some(2), EpisodeSet::Closing(_)) => 5.5,
            (None, _) => 7.0,
            _ => 4.5,
        };
        Ok(Some(episodes(11.0, cost, count)))
    };
    let selection = select(&Candidates { frames: 1000, ..candidates }, &config, 99, &mut play)
        .unwrap()
        .unwrap();
    let (confirm, closing) = (EpisodeSet::Confirmation, EpisodeSet::Closing);
    let expected = [
        (Some(1), confirm),
        (Some(2), confirm),
        (Some(2), closing(1)),
        (Some(3), confirm),
        (Some(3), closing(2)),
        (None, closing(0)),
    ];
    assert_eq!(asked, expected);
    assert_eq!((selection.selected.frames, selection.selected.confirmed), (3, true));
    assert_eq!(
        selection.failed.iter().map(|one| (one.frames, one.closing.is_some())).collect::<Vec<_>>(),
        [(1, false), (2, true)]
    );
    let last = selection.last.unwrap();
    assert_eq!((last.frames, last.closing.cost.mean), (99, 7.0));
    // Six sets of four episodes of ten steps of four frames.
    assert_eq!(selection.selection_frames, 1000 + 6 * 160);
    assert!(selection.selected.evaluation().within());
}

/// The policy at the end of the run is closed once, by episodes of its own number, whether it
/// is selected or fails there.
#[test]
fn the_last_policy_is_closed_once() {
    let candidates = ranked(&[(9, 20.0, 4.0), (2, 18.0, 4.0)], AlgorithmKind::PpoLag);
    let (confirm, closing) = (EpisodeSet::Confirmation, EpisodeSet::Closing);
    for (cost, expected) in [
        (4.5, vec![(Some(9), confirm), (Some(9), closing(0))]),
        (
            5.5,
            vec![
                (Some(9), confirm),
                (Some(9), closing(0)),
                (Some(2), confirm),
                (Some(2), closing(1)),
            ],
        ),
    ] {
        let mut asked = Vec::new();
        let mut play = |policy: Option<u64>, set: EpisodeSet, count: usize| {
            asked.push((policy, set));
            Ok(Some(episodes(11.0, if set == closing(0) { cost } else { 4.5 }, count)))
        };
        let selection = select(&candidates, &config(), 9, &mut play).unwrap().unwrap();
        assert_eq!(asked, expected);
        assert_eq!(selection.selected.frames, if cost < 5.0 { 9 } else { 2 });
        assert_eq!(selection.last.unwrap().closing.cost.mean, cost);
    }
}

/// Without one that keeps its budgets all the way, the least evil is closed and says so.
#[test]
fn where_none_keeps_its_budgets_the_least_evil_is_selected() {
    let candidates = ranked(&[(1, 20.0, 8.0), (2, 18.0, 6.0)], AlgorithmKind::PpoLag);
    let mut play =
        |_: Option<u64>, _: EpisodeSet, count: usize| Ok(Some(episodes(11.0, 6.5, count)));
    let selection = select(&candidates, &config(), 9, &mut play).unwrap().unwrap();
    assert_eq!(
        (selection.selected.frames, selection.selected.confirmed, selection.failed.len()),
        (2, false, 0)
    );
    assert!(!selection.selected.closing.unwrap().within());
    let mut nothing = |_: Option<u64>, _: EpisodeSet, _: usize| panic!("nothing to play");
    assert!(select(&Candidates::default(), &config(), 9, &mut nothing).unwrap().is_none());
}

/// Alpha is shared out: at 2.5 % over 5 confirmations, each has 0.5 %. Four costs of 4.5 +- 0.1
/// have a standard error of 0.0577 (0.11547 / 2), and scipy.stats.t.ppf(0.995, 3) = 5.8409: the
/// upper end is 4.837. With 0.6 it would be 2.02 higher than 4.5.
#[test]
fn surely_within_is_said_at_the_level_shared_out() {
    let mut config = config();
    assert_eq!(shared_level(&config.evaluation), 0.005);
    assert!(surely_within(&episodes(1.0, 4.5, 4), &config.constraints, 0.005).unwrap());
    config.constraints[0].budget = 4.836;
    assert!(!surely_within(&episodes(1.0, 4.5, 4), &config.constraints, 0.005).unwrap());
    config.constraints[0].budget = 4.838;
    assert!(surely_within(&episodes(1.0, 4.5, 4), &config.constraints, 0.005).unwrap());
    // At 2.5 % alone, 4.5 + 3.1824 * 0.0577 = 4.684 would do.
    config.constraints[0].budget = 4.7;
    assert!(surely_within(&episodes(1.0, 4.5, 4), &config.constraints, 0.025).unwrap());
    assert!(!surely_within(&episodes(1.0, 4.5, 4), &config.constraints, 0.005).unwrap());
}

/// The setting that lets only those be selected that are surely within.
#[test]
fn runs_may_ask_for_sure_candidates() {
    let mut config = config();
    config.evaluation.surely = true;
    let candidates = ranked(&[(1, 20.0, 4.8), (2, 18.0, 4.0)], AlgorithmKind::PpoLag);
    let mut play = |policy: Option<u64>, _: EpisodeSet, count: usize| {
        Ok(Some(episodes(11.0, if policy == Some(1) { 4.8 } else { 4.0 }, count)))
    };
    let selection = select(&candidates, &config, 9, &mut play).unwrap().unwrap();
    assert_eq!((selection.selected.frames, selection.selected.surely_within), (2, true));
    assert_eq!(selection.failed[0].frames, 1);
    config.evaluation.surely = false;
    let selection = select(&candidates, &config, 9, &mut play).unwrap().unwrap();
    assert_eq!((selection.selected.frames, selection.selected.surely_within), (1, false));
}

/// What older versions wrote as `hand_out.json`.
#[test]
fn an_older_runs_file_is_read() {
    let estimate = |mean: f64| serde_json::json!({ "mean": mean, "half_width": 1.0 });
    let evaluation = serde_json::json!({
        "episodes": 100, "episode_return": estimate(20.0), "cost": estimate(4.0), "length": estimate(525.0),
        "constraints": [{ "term": null, "budget": 5.0, "cost": estimate(4.0) }],
    });
    let old = serde_json::json!({ "frames": 7, "chosen_by": evaluation, "confirmed": true, "closing": evaluation });
    let read: Selection = serde_json::from_value(old).unwrap();
    assert_eq!(
        (read.selected.frames, read.selected.evaluation().cost),
        (7, Estimate { mean: 4.0, half_width: 1.0, bootstrap: None })
    );
    let again: Selection = serde_json::from_str(&serde_json::to_string(&read).unwrap()).unwrap();
    assert_eq!(again, read);
}
