//! The trainer: a run and its directory.
//!
//! Long because one loop owns a run from its start to its last checkpoint.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use crate::config::TrainConfig;
use crate::error::LearnError;
use crate::learning::metrics::Means;
use crate::networks::device::ComputeDevice;
use crate::runs::checkpoint::{Checkpoint, Loaded, Progress, Store};
use crate::runs::evaluation::Evaluation;
use crate::runs::examiner::Examiner;
use crate::runs::heatmap::Heatmap;
use crate::runs::init_from;
use crate::runs::report::Report;
use crate::runs::run_directory::{RunDirectory, read_selection};
use crate::runs::selection::{Candidates, Selection};
use crate::runs::session::{Beginning, MakeWorlds, Session};
use crate::runs::together::{Word, invite};
use crate::runs::writer::Writer;
use crate::sampling::gather::panic_text;
use crate::team::Team;

/// What the caller of a run hears of it, and how it ends it.
pub struct Hooks<'a> {
    /// Raised by the caller to end the run cleanly, with a checkpoint.
    pub stop: &'a AtomicBool,
    /// Called with every report.
    pub report: &'a mut dyn FnMut(&Report),
    /// Called with what went wrong without ending the run.
    pub warn: &'a mut dyn FnMut(String),
}

/// How a run begins.
#[derive(Clone)]
pub enum Start {
    /// In a new directory.
    Fresh(TrainConfig),
    /// From the last checkpoint in the directory; settings given here, each as `NAME=VALUE`,
    /// replace the run's from there on and are written down in it.
    Resume {
        /// Settings that are to be others than before.
        settings: Vec<String>,
    },
    /// In a new directory, with the weights and normalisers of another run, or of an agent's file.
    From(TrainConfig, PathBuf),
}

impl Start {
    /// From the last checkpoint in the directory, as before.
    pub const RESUME: Start = Start::Resume { settings: Vec::new() };
}

/// How a run ended.
#[derive(Clone, Debug)]
pub struct Summary {
    /// The last report.
    pub last: Report,
    /// The caller ended it.
    pub stopped: bool,
    /// The checkpoint that it selects; none if it was never evaluated. Of a run that was stopped,
    /// the best candidate so far.
    pub selection: Option<Selection>,
}

/// Trains in `directory` until the run's frames are used up or the caller ends it.
///
/// In synchronous mode everything that is learned follows from the settings alone; a run that was
/// stopped, or killed, and resumed equals one that never stopped, bit by bit.
pub fn train(
    start: Start,
    directory: &Path,
    make_worlds: &MakeWorlds<'_>,
    hooks: &mut Hooks<'_>,
) -> Result<Summary, LearnError> {
    train_together(&Team::default(), start, directory, make_worlds, hooks)
}

/// As [`train`], with a team of workers of which this is the first: it alone has the directory,
/// evaluates and reports. The others [`follow`](crate::runs::together::Invitation::follow).
pub fn train_together(
    team: &Team,
    start: Start,
    directory: &Path,
    make_worlds: &MakeWorlds<'_>,
    hooks: &mut Hooks<'_>,
) -> Result<Summary, LearnError> {
    let begun = begin(start, directory, hooks)?;
    // A panic of the learner's own thread ends as an error too; checkpoints already written stay.
    let whole = || {
        invite(team, &begun.config, &begun.beginning)?;
        let lesson = begun.beginning.progress().map_or(0, |progress| progress.lesson);
        let session =
            Session::of(team.clone(), begun.config.lesson(lesson), &begun.beginning, make_worlds)?;
        // Only now is anything of a run that goes on touched: a resume that cannot begin leaves it
        // as it was.
        let candidates =
            if begun.fresh { Candidates::default() } else { begun.take_back(hooks)? };
        Trainer::new(&begun, candidates, lesson, session, make_worlds).run(hooks)
    };
    let outcome = catch_unwind(AssertUnwindSafe(whole))
        .unwrap_or_else(|panic| Err(LearnError::Panic(panic_text("the learner", &*panic))));
    let is_there = || begun.run.check_is_there().is_ok();
    if outcome.is_err() && begun.fresh && is_there() && begun.run.is_blank() {
        begun.run.withdraw();
    }
    outcome
}

/// A run whose directory is locked and whose settings are known.
struct Begun {
    run: RunDirectory,
    config: TrainConfig,
    beginning: Beginning<'static>,
    /// It is a new one.
    fresh: bool,
    /// The settings that it goes on with are others than before.
    changed: bool,
}

impl Begun {
    /// Makes the directory agree with the checkpoint that the run goes on from, and gives its
    /// candidates so far.
    fn take_back(&self, hooks: &mut Hooks<'_>) -> Result<Candidates, LearnError> {
        if self.changed {
            self.run.rewrite_config(&self.config)?;
        }
        let progress = self.beginning.progress();
        let at = progress.map_or(0, |progress| progress.frames);
        // The row of a moment whose evaluation is still to be made is written with it.
        let owes = progress.is_some_and(|progress| progress.owes_evaluation);
        self.run.rewind(if owes { at.saturating_sub(1) } else { at }, at, hooks.warn)?;
        let none = || Ok(Candidates::default());
        progress.map_or_else(none, |progress| {
            Store::new(self.run.path(), 1).go_back_to(progress, hooks.warn)
        })
    }

    /// The checkpoint that the run goes on from, if an evaluation of it is still to be made: it was
    /// stopped in the midst of it, or has come to its end without any and is now asked for one.
    fn owed(&self, candidates: &Candidates) -> Option<&Loaded> {
        let Beginning::Everything(loaded) = &self.beginning else { return None };
        let unjudged = candidates.ranked.is_empty()
            && loaded.progress.frames >= self.config.frames
            && self.config.evaluates_at_its_end();
        (loaded.progress.owes_evaluation || unjudged).then_some(loaded)
    }
}

fn begin(start: Start, directory: &Path, hooks: &mut Hooks<'_>) -> Result<Begun, LearnError> {
    let new = |config: TrainConfig, beginning| {
        let run = RunDirectory::create(directory, &config)?;
        Ok(Begun { run, config, beginning, fresh: true, changed: false })
    };
    match start {
        Start::Fresh(config) => {
            let config = TrainConfig { init_from: None, ..config.begun() };
            config.check()?;
            ComputeDevice::of(&config)?;
            new(config, Beginning::Nothing)
        }
        Start::From(config, other) => {
            let config = config.begun();
            config.check()?;
            ComputeDevice::of(&config)?;
            let (beginning, found) = init_from::read(&other, &config, hooks.warn)?;
            new(TrainConfig { init_from: Some(found), ..config }, beginning)
        }
        Start::Resume { settings } => {
            let (run, before) = RunDirectory::open(directory)?;
            let store = Store::new(directory, 1);
            let loaded = store.newest(hooks.warn)?;
            let at = loaded.as_ref().map_or(0, |loaded| loaded.progress.frames);
            if loaded.is_none() && store.has_judged() {
                return Err(LearnError::content(
                    directory,
                    "the checkpoints that it would go on from are gone; bring its folder checkpoints back, or train anew with another --out",
                ));
            }
            if loaded.is_none() {
                (hooks.warn)(format!(
                    "{}: no checkpoint was written yet; the run starts again",
                    directory.display()
                ));
            }
            let config = before.resumed_with(&settings, at)?;
            ComputeDevice::of(&config)?;
            // Where nothing is left to learn, what would have been learned otherwise is no part of
            // the run; only evaluations may still come.
            let learns = loaded.is_none() || at < config.frames;
            let changed = config != before && (learns || config.evaluation != before.evaluation);
            if changed
                && !learns
                && read_selection(run.path()).is_some_and(|known| known.closes(at))
            {
                return Err(LearnError::content(
                    directory,
                    "the run is over, and its checkpoint was selected by the evaluations that it had; `hasard eval` plays more episodes, \
                     and --frames trains on",
                ));
            }
            let beginning = match loaded {
                Some(loaded) => Beginning::Everything(Box::new(loaded)),
                None => init_from::read_again(directory, &config, hooks.warn)?,
            };
            Ok(Begun { run, config, beginning, fresh: false, changed })
        }
    }
}

struct Trainer<'a> {
    run: &'a RunDirectory,
    /// Settings of the whole run; the session has those of the lesson.
    config: TrainConfig,
    /// The checkpoint that it goes on from, if that still has to be evaluated.
    owed: Option<&'a Loaded>,
    make_worlds: &'a MakeWorlds<'a>,
    /// The lesson of a curriculum that the session is.
    lesson: usize,
    session: Session,
    /// Where the agents have been, if the worlds have places.
    heatmap: Option<Heatmap>,
    seconds_before: f64,
    started: Instant,
    examiner: Examiner<'a>,
    /// What a row whose evaluation was stopped would have said of learning.
    unreported: Means,
}

impl<'a> Trainer<'a> {
    fn new(
        begun: &'a Begun,
        candidates: Candidates,
        lesson: usize,
        session: Session,
        make_worlds: &'a MakeWorlds<'a>,
    ) -> Trainer<'a> {
        let (run, config) = (&begun.run, begun.config.clone());
        let heatmap = heatmap(&config, lesson, &session);
        let started = Instant::now();
        let seconds_before =
            begun.beginning.progress().map_or(0.0, |progress| progress.wall_seconds);
        let owed = begun.owed(&candidates);
        let examiner = Examiner::new(make_worlds, candidates);
        Trainer {
            run,
            config,
            owed,
            make_worlds,
            lesson,
            session,
            heatmap,
            seconds_before,
            started,
            examiner,
            unreported: Means::default(),
        }
    }

    /// Begins the lesson that the frames so far ask for.
    fn begin_lesson(&mut self) -> Result<(), LearnError> {
        self.lesson = self.config.lesson_at(self.session.frames);
        let config = self.config.lesson(self.lesson);
        self.session = Session::of(
            self.session.team.clone(),
            config,
            &Beginning::Lesson(&self.session),
            self.make_worlds,
        )?;
        self.heatmap = heatmap(&self.config, self.lesson, &self.session);
        Ok(())
    }

    fn lesson_is_over(&self) -> bool {
        self.config.lesson_at(self.session.frames) != self.lesson
    }

    fn wall_seconds(&self) -> f64 {
        self.seconds_before + self.started.elapsed().as_secs_f64()
    }

    fn run(mut self, hooks: &mut Hooks<'_>) -> Result<Summary, LearnError> {
        let store = Store::new(self.run.path(), self.session.config.reporting.keep);
        let writer = Writer::new(self.run.path(), store.clone(), self.session.frames)?;
        let (mut last_report, mut last_checkpoint) = (Instant::now(), Instant::now());
        let mut reported_frames = self.session.frames;
        let mut last = None;
        let mut over = self.session.frames >= self.session.config.frames;
        let mut cut_short = false;
        if let Some(loaded) = self.owed.take() {
            match self.settle(loaded, &writer, hooks)? {
                Some(report) => last = Some(report),
                None => (over, cut_short) = (true, true),
            }
        }
        while !over {
            // Here and not after the checkpoint, so that a run resumed from one taken at a lesson's
            // end begins the next as well.
            if self.lesson_is_over() {
                self.begin_lesson()?;
            }
            let before = self.session.frames;
            let rollout = self.session.turn(hooks.warn)?;
            let evaluates = self.config.evaluates(before, self.session.frames);
            let evaluation = if evaluates { self.examine(&writer, hooks.stop)? } else { None };
            // What was stopped in the midst of its evaluation has no row yet: it is made when the
            // run goes on.
            cut_short = evaluates && evaluation.is_none();
            // Asked once a rollout: from here on it is decided whether samplers go on.
            over = self.session.frames >= self.session.config.frames
                || cut_short
                || hooks.stop.load(Ordering::Relaxed);
            let due =
                last_report.elapsed().as_secs_f64() >= self.session.config.reporting.report_seconds;
            if cut_short {
                self.unreported.clone_from(&self.session.means);
            }
            if over || due || evaluation.is_some() {
                let seconds = last_report.elapsed().as_secs_f64().max(1e-9);
                let mut report =
                    self.report((self.session.frames - reported_frames) as f64 / seconds);
                report.evaluation = evaluation;
                report.evaluated_frames = self.examiner.candidates.frames;
                (last_report, reported_frames) = (Instant::now(), self.session.frames);
                if !cut_short {
                    writer.row(self.session.frames, report.row());
                    (hooks.report)(&report);
                }
                last = Some(report);
                over = over || hooks.stop.load(Ordering::Relaxed);
            }
            if let Some(heatmap) = &mut self.heatmap {
                heatmap.add(&rollout);
                let lesson_is_over = self.config.lesson_at(self.session.frames) != self.lesson;
                heatmap
                    .line(self.session.frames, over || lesson_is_over)
                    .into_iter()
                    .for_each(|line| writer.heatmap(line));
            }
            self.run.check_is_there()?;
            writer.check()?;
            let due = last_checkpoint.elapsed().as_secs_f64()
                >= self.session.config.reporting.checkpoint_seconds;
            let save = over || (due && writer.keeps_up());
            Word { over, save }.send(&self.session.team)?;
            if save {
                writer.checkpoint(self.checkpoint(cut_short)?);
                last_checkpoint = Instant::now();
            }
            if !over && !self.lesson_is_over() {
                self.session.go_on(rollout);
            }
        }
        writer.finish()?;
        let last = match last {
            Some(report) => report,
            None => self.report(0.0),
        };
        let ended = !cut_short && self.session.frames >= self.session.config.frames;
        let closed = if ended { self.close(&store, hooks.stop)? } else { None };
        let stopped = closed.is_none();
        Ok(Summary { last, stopped, selection: closed.unwrap_or_else(|| self.so_far()) })
    }

    /// The best candidate of a run that is not over.
    fn so_far(&self) -> Option<Selection> {
        let selected = self.examiner.candidates.ranked.first()?.clone();
        let selection_frames = self.examiner.candidates.frames;
        Some(Selection { selected, failed: Vec::new(), last: None, level: None, selection_frames })
    }

    /// Of a curriculum, evaluations of the last level alone select a checkpoint.
    fn counts(&self) -> bool {
        self.lesson + 1 == self.config.lessons()
    }

    /// Evaluates the policy as it is; if it is a candidate, its checkpoint is kept. Nothing if the
    /// run is stopped meanwhile.
    fn examine(
        &mut self,
        writer: &Writer,
        stop: &AtomicBool,
    ) -> Result<Option<Evaluation>, LearnError> {
        let counts = self.counts();
        let examined = self.examiner.examine(&mut self.session, counts, stop)?;
        self.run.check_is_there()?;
        let candidate = examined.as_ref().is_some_and(|(_, candidate)| *candidate);
        Word { over: false, save: candidate }.send(&self.session.team)?;
        if candidate {
            writer.best(self.checkpoint(false)?);
        }
        Ok(examined.map(|(evaluation, _)| evaluation))
    }

    /// Makes the evaluation that the checkpoint which the run goes on from still lacks, as
    /// [`Trainer::examine`] would have then; the other workers need not know. Nothing if the run is
    /// stopped meanwhile: then it goes on lacking it.
    fn settle(
        &mut self,
        loaded: &Loaded,
        writer: &Writer,
        hooks: &mut Hooks<'_>,
    ) -> Result<Option<Report>, LearnError> {
        let counts = self.counts();
        let Some((evaluation, candidate)) =
            self.examiner.examine(&mut self.session, counts, hooks.stop)?
        else {
            return Ok(None);
        };
        self.run.check_is_there()?;
        let candidates = self.examiner.candidates.clone();
        let progress = Progress {
            candidates,
            sole_candidate: None,
            owes_evaluation: false,
            learning: Means::default(),
            ..loaded.progress.clone()
        };
        self.session.means.absorb(loaded.progress.learning.clone());
        // Of its own rollouts nobody knows any more how long they took.
        let mean_rate = self.session.frames as f64 / self.wall_seconds().max(1e-9);
        let mut report = self.report(mean_rate);
        report.evaluation = Some(evaluation);
        report.evaluated_frames = self.examiner.candidates.frames;
        if loaded.progress.owes_evaluation {
            writer.row(self.session.frames, report.row());
        }
        if candidate {
            writer.best(loaded.with(progress.clone()));
        }
        writer.amend(progress);
        (hooks.report)(&report);
        Ok(Some(report))
    }

    /// Selects a checkpoint, by episodes of its own; the other candidates go. The selection, if
    /// there were candidates; nothing at all if the run is stopped meanwhile.
    fn close(
        &mut self,
        store: &Store,
        stop: &AtomicBool,
    ) -> Result<Option<Option<Selection>>, LearnError> {
        // A run that had ended before is not closed anew.
        let known = read_selection(self.run.path());
        if let Some(known) = known.filter(|known| known.closes(self.session.frames)) {
            store.keep_only(&[store.best_of(known.selected.frames)])?;
            return Ok(Some(Some(known)));
        }
        if self.examiner.candidates.ranked.is_empty() {
            return Ok(Some(None));
        }
        let Some((selection, closings)) = self.examiner.close(&mut self.session, store, stop)?
        else {
            return Ok(None);
        };
        self.run.check_is_there()?;
        self.run.write_selection(&selection, &closings, &self.session.config)?;
        store.keep_only(&[store.best_of(selection.selected.frames)])?;
        Ok(Some(Some(selection)))
    }

    fn report(&mut self, frames_per_second: f64) -> Report {
        let mut report = Report::take(
            &self.session.config,
            &self.session.watch,
            &mut self.session.means,
            self.session.algorithm.multipliers(),
        );
        report.frames = self.session.frames;
        report.level = self.config.curriculum.get(self.lesson).map(|lesson| lesson.level);
        report.updates = self.session.learner.version;
        report.made_with =
            (self.session.learner.kernels().name(), self.session.config.learning.threads);
        report.wall_seconds = self.wall_seconds();
        report.frames_per_second = frames_per_second;
        report
    }

    /// Takes a checkpoint, which may still owe its evaluation.
    fn checkpoint(&mut self, owes_evaluation: bool) -> Result<Checkpoint, LearnError> {
        let samplers = self.session.save_samplers()?;
        let progress = Progress {
            frames: self.session.frames,
            rollouts: self.session.rollouts,
            lesson: self.lesson,
            updates: self.session.learner.version,
            wall_seconds: self.wall_seconds(),
            candidates: self.examiner.candidates.clone(),
            sole_candidate: None,
            owes_evaluation,
            learning: std::mem::take(&mut self.unreported),
            returns: self.session.learner.returns.clone(),
            optimiser_steps: self
                .session
                .learner
                .optimisers
                .iter()
                .map(|adam| adam.steps)
                .collect(),
            algorithm: self.session.algorithm.save(),
            watch: self.session.watch.clone(),
            samplers: samplers
                .iter()
                .map(|sampler| (sampler.steps, sampler.safety.clone()))
                .collect(),
            spent: samplers
                .iter()
                .map(|sampler| sampler.spent.clone())
                .filter(|spent| !spent.is_empty())
                .collect(),
            pixel_count: self.session.learner.pixels.count,
        };
        Checkpoint::take(&self.session.learner, &samplers, progress)
    }
}

/// The grid of a lesson's map, if it has places.
fn heatmap(config: &TrainConfig, lesson: usize, session: &Session) -> Option<Heatmap> {
    let automap = config.automap(lesson);
    session.extent.map(|extent| {
        Heatmap::new(extent, config.sampling.lanes, config.frames, session.frames, automap)
    })
}
