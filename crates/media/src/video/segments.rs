//! Pictures coded in stretches that stand alone, several at a time on threads of their own. The
//! bytes are those of one thread.

use rusty_h264_common::YuvFrame;
use rusty_h264_encoder::{Encoder, EncoderConfig};
use std::collections::VecDeque;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;

/// Pictures of a stretch at most: players jump to their beginnings.
const LONGEST: usize = 140;
/// Pictures of a stretch at least: two pictures that stand alone may not follow each other
/// directly, and a flash fades within them.
const SHORTEST: usize = 8;
/// Bytes of the pictures of a stretch at most, so that large films fit into memory.
const MOST_BYTES: usize = 48 << 20;
/// Stretches that are coded at a time at most.
const MOST_THREADS: usize = 8;
/// Mean change of brightness from one picture to the next (of 256) from which on it is a cut or a
/// flash, not a movement.
const CUT: u64 = 20;

/// A coded picture, and whether it stands alone.
pub(super) type Unit = (Vec<u8>, bool);

/// Codes pictures in order.
pub(super) struct Segments {
    config: EncoderConfig,
    waiting: Vec<YuvFrame>,
    /// Stretches that were begun and not yet given, in order; some may be coded already.
    begun: VecDeque<JoinHandle<Result<Vec<Unit>, String>>>,
    threads: usize,
    /// Threads that are coding, and what they say when they end.
    coding: usize,
    ends: Receiver<()>,
    end: Sender<()>,
}

/// Says that a thread has ended, also if by a panic.
struct Ends(Sender<()>);

impl Drop for Ends {
    fn drop(&mut self) {
        // Nobody listens any more when the film was given up.
        let _ = self.0.send(());
    }
}

impl Segments {
    /// A coder, which tries once whether the configuration can be coded at all.
    pub fn new(config: EncoderConfig) -> Result<Segments, String> {
        Encoder::new(config.clone()).map_err(|error| error.to_string())?;
        let threads = std::thread::available_parallelism().map_or(1, usize::from).min(MOST_THREADS);
        let (end, ends) = channel();
        Ok(Segments {
            config,
            waiting: Vec::new(),
            begun: VecDeque::new(),
            threads,
            coding: 0,
            ends,
            end,
        })
    }

    /// Takes the next picture, and gives what has been coded meanwhile, in order.
    pub fn push(&mut self, frame: YuvFrame) -> Result<Vec<Unit>, String> {
        let longest = (MOST_BYTES / (frame.y.len() * 3 / 2)).clamp(SHORTEST, LONGEST);
        let cut = self.waiting.last().is_some_and(|last| change(last, &frame) >= CUT);
        let begins = self.waiting.len() >= longest || cut && self.waiting.len() >= SHORTEST;
        let coded = if begins { self.begin()? } else { Vec::new() };
        self.waiting.push(frame);
        Ok(coded)
    }

    /// Ends the last stretch, and gives all that is left.
    pub fn finish(&mut self) -> Result<Vec<Unit>, String> {
        let mut coded = self.begin()?;
        while let Some(oldest) = self.begun.pop_front() {
            coded.extend(ended(oldest)?);
        }
        Ok(coded)
    }

    /// Gives the waiting stretch to a thread, after one has ended where as many code as there are
    /// cores. Gives those that are coded, up to the first that is not.
    fn begin(&mut self) -> Result<Vec<Unit>, String> {
        let frames = std::mem::take(&mut self.waiting);
        if frames.is_empty() {
            return Ok(Vec::new());
        }
        while self.coding >= self.threads && self.ends.recv().is_ok() {
            self.coding -= 1;
        }
        let (config, end) = (self.config.clone(), Ends(self.end.clone()));
        let thread = std::thread::Builder::new().name("film".into()).spawn(move || {
            let _end = end;
            code(config, &frames)
        });
        self.begun.push_back(thread.map_err(|error| error.to_string())?);
        self.coding += 1;
        let mut coded = Vec::new();
        while let Some(oldest) = self.begun.pop_front_if(|oldest| oldest.is_finished()) {
            coded.extend(ended(oldest)?);
        }
        Ok(coded)
    }
}

fn ended(thread: JoinHandle<Result<Vec<Unit>, String>>) -> Result<Vec<Unit>, String> {
    thread.join().unwrap_or_else(|_| Err("the video encoder failed".into()))
}

fn code(config: EncoderConfig, frames: &[YuvFrame]) -> Result<Vec<Unit>, String> {
    // One picture in is one picture out: nothing looks ahead, and the quantiser is constant.
    let mut encoder = Encoder::new(config).map_err(|error| error.to_string())?;
    let unit = |(at, frame)| {
        encoder.try_encode(frame).map(|bytes| (bytes, at == 0)).map_err(|error| error.to_string())
    };
    frames.iter().enumerate().map(unit).collect()
}

/// Mean change of brightness from one picture to the next.
fn change(last: &YuvFrame, next: &YuvFrame) -> u64 {
    let sum: u64 = last.y.iter().zip(&next.y).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    sum / last.y.len().max(1) as u64
}
