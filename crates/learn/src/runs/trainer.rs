//! The trainer: a run and its directory.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use crate::config::TrainConfig;
use crate::error::LearnError;
use crate::networks::device::ComputeDevice;
use crate::runs::checkpoint::{Checkpoint, Loaded, Progress, Store};
use crate::runs::evaluate::Evaluation;
use crate::runs::hand_out::{Examiner, HandOut};
use crate::runs::heatmap::Heatmap;
use crate::runs::report::Report;
use crate::runs::run_directory::{RunDirectory, read_hand_out};
use crate::runs::session::{Beginning, MakeWorlds, Session};
use crate::runs::together::{Word, invite};
use crate::runs::writer::Writer;
use crate::sampling::gather::panic_text;
use crate::team::Team;

/// What the caller of a run hears of it, and how it ends it.
pub struct Hooks<'a> {
    /// Raised by the caller to end the run cleanly, with a checkpoint.
    pub stop: &'a AtomicBool,
    /// Told every report.
    pub report: &'a mut dyn FnMut(&Report),
    /// Told what went wrong without ending the run.
    pub warn: &'a mut dyn FnMut(String),
}

/// How a run begins.
#[derive(Clone)]
pub enum Start<'a> {
    /// In a new directory.
    Fresh(TrainConfig),
    /// From the last checkpoint in the directory; settings given here, each as `NAME=VALUE`, replace the run's from there on
    /// and are written down in it.
    Resume {
        /// Settings that are to be others than before.
        settings: Vec<String>,
    },
    /// In a new directory, with the weights and normalisers of another run.
    From(TrainConfig, &'a Path),
}

impl Start<'_> {
    /// From the last checkpoint in the directory, as before.
    pub const RESUME: Start<'static> = Start::Resume { settings: Vec::new() };
}

/// How a run ended.
#[derive(Clone, Debug)]
pub struct Summary {
    /// The last report.
    pub last: Report,
    /// The caller ended it.
    pub stopped: bool,
    /// The checkpoint that it hands out; none if it was never evaluated.
    pub hand_out: Option<HandOut>,
}

/// Trains in `directory` until the run's frames are used up or the caller ends it.
///
/// In synchronous mode everything that is learned follows from the settings alone; a run that was stopped, or killed, and
/// resumed equals one that never stopped, bit by bit.
pub fn train(
    start: Start<'_>,
    directory: &Path,
    make_worlds: &MakeWorlds<'_>,
    hooks: &mut Hooks<'_>,
) -> Result<Summary, LearnError> {
    train_together(&Team::default(), start, directory, make_worlds, hooks)
}

/// As [`train`], with a team of workers of which this is the first: it alone has the directory, evaluates and reports. The others
/// [`follow`](crate::runs::together::Invitation::follow).
pub fn train_together(
    team: &Team,
    start: Start<'_>,
    directory: &Path,
    make_worlds: &MakeWorlds<'_>,
    hooks: &mut Hooks<'_>,
) -> Result<Summary, LearnError> {
    let fresh = !matches!(start, Start::Resume { .. });
    let (run, config, beginning, best) = begin(start, directory, hooks)?;
    invite(team, &config, &beginning)?;
    // A panic of the learner's own thread ends as an error too; checkpoints already written stay.
    let whole = || {
        let lesson = beginning.progress().map_or(0, |progress| progress.lesson);
        match Session::of(team.clone(), config.lesson(lesson), &beginning, make_worlds) {
            Ok(session) => {
                let seconds = beginning.progress().map_or(0.0, |progress| progress.wall_seconds);
                Trainer::new(run, config, seconds, best, lesson, session, make_worlds).run(hooks)
            }
            Err(error) => {
                if fresh {
                    run.withdraw();
                }
                Err(error)
            }
        }
    };
    catch_unwind(AssertUnwindSafe(whole)).unwrap_or_else(|panic| Err(LearnError::Panic(panic_text("the learner", &*panic))))
}

fn begin(
    start: Start<'_>,
    directory: &Path,
    hooks: &mut Hooks<'_>,
) -> Result<(RunDirectory, TrainConfig, Beginning<'static>, Option<HandOut>), LearnError> {
    match start {
        Start::Fresh(config) => {
            config.check()?;
            ComputeDevice::of(&config)?;
            Ok((RunDirectory::create(directory, &config)?, config, Beginning::Nothing, None))
        }
        Start::From(config, other) => {
            config.check()?;
            ComputeDevice::of(&config)?;
            let loaded = Store::new(other, 1).newest(hooks.warn)?;
            let loaded = loaded.ok_or_else(|| LearnError::content(other, "no checkpoint to take weights from is here"))?;
            Ok((RunDirectory::create(directory, &config)?, config, Beginning::Weights(Box::new(loaded)), None))
        }
        Start::Resume { settings } => {
            let (run, before) = RunDirectory::open(directory)?;
            let store = Store::new(directory, before.reporting.keep);
            let loaded = store.newest(hooks.warn)?;
            let at = loaded.as_ref().map_or(0, |loaded| loaded.progress.frames);
            if loaded.is_none() {
                (hooks.warn)(format!("{}: no checkpoint was written yet; the run starts again", directory.display()));
            }
            let config = before.resumed_with(&settings, at)?;
            if config != before {
                run.rewrite_config(&config)?;
            }
            run.rewind_metrics(at, hooks.warn)?;
            let best = loaded.as_ref().map_or(Ok(None), |loaded| store.go_back_to(&loaded.progress))?;
            Ok((run, config, loaded.map_or(Beginning::Nothing, |loaded| Beginning::Everything(Box::new(loaded))), best))
        }
    }
}

struct Trainer<'a> {
    run: RunDirectory,
    /// Settings of the whole run; the session has those of the lesson.
    config: TrainConfig,
    make_worlds: &'a MakeWorlds<'a>,
    /// The lesson of a curriculum that the session is.
    lesson: usize,
    session: Session,
    /// Where the agents have been, if the worlds have places.
    heatmap: Option<Heatmap>,
    seconds_before: f64,
    started: Instant,
    examiner: Examiner<'a>,
}

impl<'a> Trainer<'a> {
    fn new(
        run: RunDirectory,
        config: TrainConfig,
        seconds_before: f64,
        best: Option<HandOut>,
        lesson: usize,
        session: Session,
        make_worlds: &'a MakeWorlds<'a>,
    ) -> Trainer<'a> {
        let heatmap = heatmap(&config, lesson, &session);
        let started = Instant::now();
        let examiner = Examiner::new(make_worlds, best);
        Trainer { run, config, make_worlds, lesson, session, heatmap, seconds_before, started, examiner }
    }

    /// Begins the lesson that the frames so far ask for.
    fn begin_lesson(&mut self) -> Result<(), LearnError> {
        self.lesson = self.config.lesson_at(self.session.frames);
        let config = self.config.lesson(self.lesson);
        self.session = Session::of(self.session.team.clone(), config, &Beginning::Lesson(&self.session), self.make_worlds)?;
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
        let writer = Writer::new(self.run.path(), store.clone())?;
        let (mut last_report, mut last_checkpoint) = (Instant::now(), Instant::now());
        let mut reported_frames = self.session.frames;
        let mut last = None;
        let mut over = self.session.frames >= self.session.config.frames;
        while !over {
            // Here and not after the checkpoint, so that a run resumed from one taken at a lesson's end begins the next as well.
            if self.lesson_is_over() {
                self.begin_lesson()?;
            }
            let before = self.session.frames;
            let rollout = self.session.turn(hooks.warn)?;
            let evaluation = if self.config.evaluates(before, self.session.frames) { Some(self.examine(&writer)?) } else { None };
            // Asked once a rollout: from here on it is decided whether samplers are told to go on.
            over = self.session.frames >= self.session.config.frames || hooks.stop.load(Ordering::Relaxed);
            let due = last_report.elapsed().as_secs_f64() >= self.session.config.reporting.report_seconds;
            if over || due || evaluation.is_some() {
                let seconds = last_report.elapsed().as_secs_f64().max(1e-9);
                let mut report = self.report((self.session.frames - reported_frames) as f64 / seconds);
                report.evaluation = evaluation;
                (last_report, reported_frames) = (Instant::now(), self.session.frames);
                writer.row(self.session.frames, report.row());
                (hooks.report)(&report);
                last = Some(report);
                over = over || hooks.stop.load(Ordering::Relaxed);
            }
            if let Some(heatmap) = &mut self.heatmap {
                heatmap.add(&rollout);
                let lesson_is_over = self.config.lesson_at(self.session.frames) != self.lesson;
                heatmap.line(self.session.frames, over || lesson_is_over).into_iter().for_each(|line| writer.heatmap(line));
            }
            writer.check()?;
            let due = last_checkpoint.elapsed().as_secs_f64() >= self.session.config.reporting.checkpoint_seconds;
            let save = over || (due && writer.keeps_up());
            Word { over, save }.tell(&self.session.team)?;
            if save {
                writer.checkpoint(self.checkpoint()?);
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
        let stopped = self.session.frames < self.session.config.frames;
        if !stopped {
            self.close(&store)?;
        }
        Ok(Summary { last, stopped, hand_out: self.examiner.best.take() })
    }

    /// Evaluates the policy as it is; if it is the best so far, its checkpoint is what the run hands out.
    fn examine(&mut self, writer: &Writer) -> Result<Evaluation, LearnError> {
        // Of a curriculum, the last level's alone.
        let counts = self.lesson + 1 == self.config.lessons();
        let (evaluation, best) = self.examiner.examine(&mut self.session, counts)?;
        Word { over: false, save: best }.tell(&self.session.team)?;
        if best {
            writer.best(self.checkpoint()?);
        }
        Ok(evaluation)
    }

    /// Says what the checkpoint that is handed out is worth, by episodes that had no part in the choice.
    fn close(&mut self, store: &Store) -> Result<(), LearnError> {
        let Some(best) = &self.examiner.best else { return Ok(()) };
        // A run that had ended before is not closed anew.
        if let Some(known) = read_hand_out(self.run.path()).filter(|known| known.frames == best.frames && known.closing.is_some())
        {
            self.examiner.best = Some(known);
            return Ok(());
        }
        let checkpoint = Loaded::read(&store.best_of(best.frames))?;
        self.examiner.close(&self.session, &checkpoint)?;
        self.examiner.best.as_ref().map_or(Ok(()), |best| self.run.write_hand_out(best))
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
        report.made_with = (self.session.learner.kernels().name(), self.session.config.learning.threads);
        report.wall_seconds = self.wall_seconds();
        report.frames_per_second = frames_per_second;
        report
    }

    /// Takes a checkpoint.
    fn checkpoint(&mut self) -> Result<Checkpoint, LearnError> {
        let samplers = self.session.save_samplers()?;
        let progress = Progress {
            frames: self.session.frames,
            rollouts: self.session.rollouts,
            lesson: self.lesson,
            updates: self.session.learner.version,
            wall_seconds: self.wall_seconds(),
            hand_out: self.examiner.best.clone(),
            returns: self.session.learner.returns.clone(),
            optimiser_steps: self.session.learner.optimisers.iter().map(|adam| adam.steps).collect(),
            algorithm: self.session.algorithm.save(),
            watch: self.session.watch.clone(),
            samplers: samplers.iter().map(|sampler| (sampler.steps, sampler.safety.clone())).collect(),
            spent: samplers.iter().map(|sampler| sampler.spent.clone()).filter(|spent| !spent.is_empty()).collect(),
            pixel_count: self.session.learner.pixels.count,
        };
        Checkpoint::take(&self.session.learner, &samplers, progress)
    }
}

/// The grid of a lesson's map, if it has places.
fn heatmap(config: &TrainConfig, lesson: usize, session: &Session) -> Option<Heatmap> {
    let automap = config.automap(lesson);
    session.extent.map(|extent| Heatmap::new(extent, config.sampling.lanes, config.frames, session.frames, automap))
}
