//! The samplers of a run, and what passes between them and the learner: taking turns with it, or
//! side by side with it, each on a thread of its own that works off a queue.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, RwLock};
use std::thread::JoinHandle;

use crate::error::LearnError;
use crate::networks::Published;
use crate::sampling::rollout::{Part, Rollout};
use crate::sampling::sampler::{Newest, Sampler, SamplerState};
use crate::threads::in_parallel;

enum Ask {
    Fill(Box<Part>),
    Save,
}

enum Answer {
    Filled(Box<Part>),
    Saved(SamplerState),
}

struct Worker {
    asks: Sender<Ask>,
    answers: Receiver<Result<Answer, LearnError>>,
    /// Filled parts that came while something else was waited for.
    waiting: std::collections::VecDeque<Part>,
    thread: Option<JoinHandle<()>>,
}

impl Worker {
    fn next_part(&mut self) -> Result<Part, LearnError> {
        if let Some(part) = self.waiting.pop_front() {
            return Ok(part);
        }
        match self.answer()? {
            Answer::Filled(part) => Ok(*part),
            Answer::Saved(_) => Err(LearnError::Panic("a sampler answered out of turn".into())),
        }
    }

    fn next_state(&mut self) -> Result<SamplerState, LearnError> {
        loop {
            match self.answer()? {
                Answer::Filled(part) => self.waiting.push_back(*part),
                Answer::Saved(state) => return Ok(state),
            }
        }
    }

    fn answer(&self) -> Result<Answer, LearnError> {
        self.answers.recv().map_err(|_| LearnError::Panic("a sampler thread has ended".into()))?
    }
}

/// All samplers.
pub struct Gatherer {
    crew: Crew,
    newest: Arc<Newest>,
}

enum Crew {
    /// They gather on threads of the learner, when it waits for a rollout. (Threads of their own
    /// would often be woken on one and the same core, and stay there for milliseconds.)
    InTurn { samplers: Vec<Sampler>, parts: Vec<Part>, steps: usize },
    /// Each gathers on a thread of its own, while the learner learns.
    Ahead {
        workers: Vec<Worker>,
        /// Raised when no answer is wanted any more.
        over: Arc<AtomicBool>,
    },
}

impl Gatherer {
    /// Samplers that take turns with the learner: a rollout of `steps` steps is gathered when it is
    /// waited for.
    pub fn in_turn(samplers: Vec<Sampler>, steps: usize, published: Published) -> Gatherer {
        let parts = samplers.iter().map(|_| Part::default()).collect();
        Gatherer { crew: Crew::InTurn { samplers, parts, steps }, newest: newest(published) }
    }

    /// Samplers on threads of their own, of which `ahead` rollouts are asked at once.
    pub fn ahead(
        samplers: Vec<Sampler>,
        steps: usize,
        ahead: usize,
        published: Published,
    ) -> Result<Gatherer, LearnError> {
        let newest = newest(published);
        let over = Arc::new(AtomicBool::new(false));
        let hire = |sampler| hire(sampler, steps, ahead, Arc::clone(&newest), Arc::clone(&over));
        let workers = samplers.into_iter().map(hire).collect::<Result<_, _>>()?;
        Ok(Gatherer { crew: Crew::Ahead { workers, over }, newest })
    }

    /// Waits for the next rollout.
    pub fn next_rollout(&mut self) -> Result<Rollout, LearnError> {
        let parts: Result<Vec<Part>, LearnError> = match &mut self.crew {
            Crew::InTurn { samplers, parts, steps } => {
                let (steps, newest) = (*steps, &self.newest);
                let mut threads = vec![(); samplers.len()];
                let mut filled: Vec<Option<Result<Part, LearnError>>> =
                    samplers.iter().map(|_| None).collect();
                let work = samplers.iter_mut().zip(parts.drain(..)).zip(&mut filled).map(
                    |((sampler, part), filled)| {
                        move |_: &mut ()| {
                            *filled = Some(caught(|| fill(sampler, part, steps, newest)))
                        }
                    },
                );
                in_parallel(&mut threads, work);
                filled.into_iter().flatten().collect()
            }
            Crew::Ahead { workers, .. } => workers.iter_mut().map(Worker::next_part).collect(),
        };
        Ok(Rollout { parts: parts? })
    }

    /// Publishes new weights, then asks for another rollout in the memory of one that has been
    /// learned from.
    pub fn go_on(&mut self, rollout: Rollout, published: Published) {
        *self.newest.write().unwrap_or_else(|poisoned| poisoned.into_inner()) = Arc::new(published);
        match &mut self.crew {
            Crew::InTurn { parts, .. } => *parts = rollout.parts,
            Crew::Ahead { workers, .. } => {
                for (worker, part) in workers.iter().zip(rollout.parts) {
                    // A worker that has gone is found out by the next answer.
                    let _ = worker.asks.send(Ask::Fill(Box::new(part)));
                }
            }
        }
    }

    /// Where all samplers are, once they have done what they were asked for before.
    pub fn save(&mut self) -> Result<Vec<SamplerState>, LearnError> {
        match &mut self.crew {
            Crew::InTurn { samplers, .. } => samplers.iter_mut().map(Sampler::save).collect(),
            Crew::Ahead { workers, .. } => {
                for worker in workers.iter() {
                    let _ = worker.asks.send(Ask::Save);
                }
                workers.iter_mut().map(Worker::next_state).collect()
            }
        }
    }
}

impl Drop for Gatherer {
    fn drop(&mut self) {
        let Crew::Ahead { workers, over } = &mut self.crew else { return };
        over.store(true, Ordering::Relaxed);
        for worker in workers {
            // Hanging up ends the thread after the rollout that it is at.
            let (nowhere, _) = channel();
            worker.asks = nowhere;
            if let Some(thread) = worker.thread.take() {
                let _ = thread.join();
            }
        }
    }
}

fn newest(published: Published) -> Arc<Newest> {
    Arc::new(RwLock::new(Arc::new(published)))
}

fn fill(
    sampler: &mut Sampler,
    mut part: Part,
    steps: usize,
    newest: &Newest,
) -> Result<Part, LearnError> {
    sampler.fill(&mut part, steps, newest).map(|()| part)
}

/// What a sampler does, a panic being an error.
fn caught<T>(work: impl FnOnce() -> Result<T, LearnError>) -> Result<T, LearnError> {
    catch_unwind(AssertUnwindSafe(work))
        .unwrap_or_else(|panic| Err(LearnError::Panic(panic_text("a sampler", &*panic))))
}

fn hire(
    mut sampler: Sampler,
    steps: usize,
    ahead: usize,
    newest: Arc<Newest>,
    over: Arc<AtomicBool>,
) -> Result<Worker, LearnError> {
    let (asks, asked) = channel();
    let (answering, answers) = channel();
    for _ in 0..ahead {
        let _ = asks.send(Ask::Fill(Box::default()));
    }
    let thread = std::thread::Builder::new().spawn(move || {
        for ask in asked {
            if over.load(Ordering::Relaxed) {
                return;
            }
            let answer = caught(|| match ask {
                Ask::Fill(part) => fill(&mut sampler, *part, steps, &newest)
                    .map(|part| Answer::Filled(Box::new(part))),
                Ask::Save => sampler.save().map(Answer::Saved),
            });
            let failed = answer.is_err();
            if answering.send(answer).is_err() || failed {
                return;
            }
        }
    });
    let thread = Some(thread.map_err(LearnError::Thread)?);
    Ok(Worker { asks, answers, waiting: std::collections::VecDeque::new(), thread })
}

/// A panic as one line.
#[must_use]
pub fn panic_text(who: &str, panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    format!(
        "{who} panicked ({}); this is a fault of hasard, please report it",
        text.unwrap_or("no message")
    )
}
