//! Sampler threads and what passes between them and the learner.
//!
//! Every sampler has a thread of its own that works off a queue. Sampling and learning side by side or taking turns is
//! one code path: the difference is how many rollouts are asked for ahead.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, RwLock};
use std::thread::JoinHandle;

use crate::error::LearnError;
use crate::networks::Published;
use crate::sampling::rollout::{Part, Rollout};
use crate::sampling::sampler::{Newest, Sampler, SamplerState};

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
    waiting: std::collections::VecDeque<Box<Part>>,
    thread: Option<JoinHandle<()>>,
}

impl Worker {
    fn answer(&self) -> Result<Answer, LearnError> {
        self.answers.recv().map_err(|_| LearnError::Panic("a sampler thread has ended".into()))?
    }
}

/// All samplers.
pub struct Gatherer {
    workers: Vec<Worker>,
    newest: Arc<Newest>,
    /// Raised when no answer is wanted any more.
    over: Arc<AtomicBool>,
}

impl Gatherer {
    /// Puts samplers to work; `ahead` rollouts of `steps` steps are asked for at once (1 takes turns with the learner).
    pub fn new(samplers: Vec<Sampler>, steps: usize, ahead: usize, published: Published) -> Gatherer {
        let newest = Arc::new(RwLock::new(Arc::new(published)));
        let over = Arc::new(AtomicBool::new(false));
        let hire = |sampler| hire(sampler, steps, ahead, Arc::clone(&newest), Arc::clone(&over));
        Gatherer { workers: samplers.into_iter().map(hire).collect(), newest, over }
    }

    /// Waits for the next rollout.
    pub fn next_rollout(&mut self) -> Result<Rollout, LearnError> {
        let mut parts = Vec::with_capacity(self.workers.len());
        for worker in &mut self.workers {
            let part = match worker.waiting.pop_front() {
                Some(part) => part,
                None => match worker.answer()? {
                    Answer::Filled(part) => part,
                    Answer::Saved(_) => return Err(LearnError::Panic("a sampler answered out of turn".into())),
                },
            };
            parts.push(*part);
        }
        Ok(Rollout { parts })
    }

    /// Publishes new weights, then asks for another rollout in the memory of one that has been learned from.
    pub fn go_on(&self, rollout: Rollout, published: Published) {
        *self.newest.write().unwrap_or_else(|poisoned| poisoned.into_inner()) = Arc::new(published);
        for (worker, part) in self.workers.iter().zip(rollout.parts) {
            // A worker that has gone is found out by the next answer.
            let _ = worker.asks.send(Ask::Fill(Box::new(part)));
        }
    }

    /// Where all samplers are, once they have done what they were asked for before.
    pub fn save(&mut self) -> Result<Vec<SamplerState>, LearnError> {
        for worker in &self.workers {
            let _ = worker.asks.send(Ask::Save);
        }
        let mut states = Vec::new();
        for worker in &mut self.workers {
            loop {
                match worker.answer()? {
                    Answer::Filled(part) => worker.waiting.push_back(part),
                    Answer::Saved(state) => {
                        states.push(state);
                        break;
                    }
                }
            }
        }
        Ok(states)
    }
}

impl Drop for Gatherer {
    fn drop(&mut self) {
        self.over.store(true, Ordering::Relaxed);
        for worker in &mut self.workers {
            // Hanging up ends the thread after the rollout that it is at.
            let (nowhere, _) = channel();
            worker.asks = nowhere;
            if let Some(thread) = worker.thread.take() {
                let _ = thread.join();
            }
        }
    }
}

fn hire(mut sampler: Sampler, steps: usize, ahead: usize, newest: Arc<Newest>, over: Arc<AtomicBool>) -> Worker {
    let (asks, asked) = channel();
    let (answering, answers) = channel();
    for _ in 0..ahead {
        let _ = asks.send(Ask::Fill(Box::default()));
    }
    let thread = std::thread::spawn(move || {
        for ask in asked {
            if over.load(Ordering::Relaxed) {
                return;
            }
            let answer = catch_unwind(AssertUnwindSafe(|| match ask {
                Ask::Fill(mut part) => sampler.fill(&mut part, steps, &newest).map(|()| Answer::Filled(part)),
                Ask::Save => sampler.save().map(Answer::Saved),
            }));
            let answer = answer.unwrap_or_else(|panic| Err(LearnError::Panic(panic_text("a sampler", &*panic))));
            let failed = answer.is_err();
            if answering.send(answer).is_err() || failed {
                return;
            }
        }
    });
    Worker { asks, answers, waiting: std::collections::VecDeque::new(), thread: Some(thread) }
}

/// A panic as one line.
#[must_use]
pub fn panic_text(who: &str, panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied().or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    format!("{who} panicked ({}); this is a fault of hasard, please report it", text.unwrap_or("no message"))
}
