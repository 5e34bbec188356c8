//! How far a sweep is: each finished run with its result, and the time that the whole still takes.

use super::plan::span;
use hasard_report::run::{Kept, Run};
use hasard_report::statistics::Estimate;
use hasard_sweep::{Event, Job, State};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::time::Instant;

/// What became of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct RunResult {
    /// Mean return of its selected checkpoint, or of its last training episodes.
    pub episode_return: f64,
    /// Mean cost of the same episodes, under each of its constraints.
    pub costs: Vec<f64>,
    /// What they are held against.
    pub budgets: Vec<String>,
    /// Whether all means are within.
    pub within: bool,
}

impl RunResult {
    /// Reads it from the run's directory: its evaluation if it has one, else the latest training
    /// episodes.
    pub fn of(job: &Job) -> Option<RunResult> {
        let run = Run::read(&job.directory, &mut Vec::new()).ok()?;
        let last = |metric: &str| run.rows.iter().rev().find_map(|row| row.get(metric));
        let mean =
            |metric: &str| run.evaluated(metric).map(|found| found.mean).or_else(|| last(metric));
        let constraints = &run.config.constraints;
        let costs: Option<Vec<f64>> = constraints.iter().map(|one| mean(&one.metric())).collect();
        let costs = costs?;
        let estimate = |&mean: &f64| Some(Estimate { mean, half_width: None, n: 1 });
        Some(RunResult {
            episode_return: mean("return_mean")?,
            within: constraints
                .iter()
                .zip(&costs)
                .all(|(one, cost)| one.kept_by(estimate(cost)) >= Kept::ByMean),
            budgets: constraints.iter().map(hasard_report::run::Constraint::label).collect(),
            costs,
        })
    }

    /// `5.6 @ 84.2 of 50, over`
    pub fn text(&self) -> String {
        let pairs: Vec<String> = self
            .costs
            .iter()
            .zip(&self.budgets)
            .map(|(cost, of)| format!("{cost:.1} of {of}"))
            .collect();
        let judged = if self.within { "within" } else { "over" };
        format!("{:.1} @ {}, {judged}", self.episode_return, pairs.join(" / "))
    }
}

/// Follows the events of a sweep.
pub struct Progress {
    began: Instant,
    total: usize,
    parallel: usize,
    done: usize,
    /// Frames that wait for a process, by job.
    waiting: BTreeMap<usize, u64>,
    /// When each running job began, and the frames that it has before it.
    running: BTreeMap<usize, (Instant, u64)>,
    /// Frames and seconds of processes that have ended well.
    measured: (u64, f64),
    /// Seconds a frame before any has.
    expected: Option<f64>,
}

impl Progress {
    /// Nothing has run yet; `rate` is what was measured, frames a second.
    pub fn new(jobs: &[Job], parallel: usize, rate: Option<f64>) -> Progress {
        let to_go = |job: &Job| match job.state() {
            State::Finished => 0,
            State::Unfinished(frames) => job.frames.saturating_sub(frames),
            State::New => job.frames,
        };
        Progress {
            began: Instant::now(),
            total: jobs.len(),
            parallel: parallel.clamp(1, jobs.len().max(1)),
            done: 0,
            waiting: jobs.iter().map(to_go).enumerate().collect(),
            running: BTreeMap::new(),
            measured: (0, 0.0),
            expected: rate.map(|rate| 1.0 / rate),
        }
    }

    /// Takes an event in.
    pub fn hear(&mut self, index: usize, event: &Event) {
        let waited = self.waiting.remove(&index);
        match event {
            Event::Started(_) => {
                _ = self.running.insert(index, (Instant::now(), waited.unwrap_or(0)))
            }
            Event::Finished(time) => {
                if let Some((_, frames)) = self.running.remove(&index) {
                    self.measured =
                        (self.measured.0 + frames, self.measured.1 + time.as_secs_f64());
                }
                self.done += 1;
            }
            // It still waits, and for how long is the other process's.
            Event::Elsewhere => _ = self.running.remove(&index),
            _ => {
                self.running.remove(&index);
                self.done += 1;
            }
        }
    }

    /// Seconds that the rest takes, by what was run so far.
    pub fn seconds_left(&self) -> Option<f64> {
        let (frames, seconds) = self.measured;
        let a_frame = if frames > 0 { seconds / frames as f64 } else { self.expected? };
        let of_running = self.running.values().map(|(began, frames)| {
            // One that takes longer than expected is about to end.
            (*frames as f64 * a_frame - began.elapsed().as_secs_f64()).max(0.0)
        });
        let waiting: u64 = self.waiting.values().sum();
        let work = of_running.sum::<f64>() + waiting as f64 * a_frame;
        Some(work / self.parallel.min(self.running.len() + self.waiting.len()).max(1) as f64)
    }

    /// The line of an event, or `None` where it would say nothing new.
    pub fn line(&self, job: &Job, event: &Event, outcome: Option<&RunResult>) -> Option<String> {
        let (done, total, name) = (self.done, self.total, job.name());
        let left = match self.seconds_left() {
            Some(seconds) if done < total => format!("; ~{} left", span(seconds / 3600.0)),
            _ => String::new(),
        };
        Some(match event {
            Event::AlreadyFinished => return None,
            Event::Started(State::Unfinished(frames)) => {
                format!("{name}: goes on from {frames} frames")
            }
            Event::Started(_) => return None,
            Event::Finished(time) => {
                let result =
                    outcome.map_or_else(String::new, |outcome| format!("{}, ", outcome.text()));
                format!(
                    "[{done}/{total}] {name}: {result}{}{left}",
                    span(time.as_secs_f64() / 3600.0)
                )
            }
            Event::Failed(why) => format!("[{done}/{total}] {name}: failed: {why}{left}"),
            Event::Stopped => format!("[{done}/{total}] {name}: stopped; the same command goes on"),
            Event::Elsewhere => format!("{name}: another process trains it; its turn comes again"),
        })
    }

    /// What an event's JSON object has beside its text.
    pub fn object(&self, event: &Event, outcome: Option<&RunResult>) -> Map<String, Value> {
        let mut object = Map::new();
        if let Event::Finished(time) = event {
            object.insert("seconds".into(), json!(time.as_secs_f64()));
        }
        if let Some(outcome) = outcome {
            object.insert("return".into(), json!(outcome.episode_return));
            object.insert("costs".into(), json!(outcome.costs));
            object.insert("budgets".into(), json!(outcome.budgets));
            object.insert("within".into(), json!(outcome.within));
        }
        object.insert("done".into(), json!(self.done));
        object.insert("runs".into(), json!(self.total));
        object.insert("seconds_left".into(), json!(self.seconds_left()));
        object
    }

    /// Time since it began.
    pub fn elapsed(&self) -> String {
        span(self.began.elapsed().as_secs_f64() / 3600.0)
    }
}
