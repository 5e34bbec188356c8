//! One input against one target, within limits.

use crate::allocation::measured;
use crate::targets::Target;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Longest that an input may take.
pub const LONGEST: Duration = Duration::from_secs(3);

/// Processor time of this thread so far, where the system reports it: on a busy machine the clock
/// says little.
fn processor_time() -> Option<Duration> {
    let text = std::fs::read_to_string("/proc/thread-self/stat").ok()?;
    let ticks: u64 = text
        .rsplit(") ")
        .next()?
        .split(' ')
        .skip(11)
        .take(2)
        .filter_map(|word| word.parse::<u64>().ok())
        .sum();
    Some(Duration::from_millis(ticks * 10))
}

/// Where the last panic happened, by [`listen`].
static PLACE: Mutex<String> = Mutex::new(String::new());

/// Has panics leave their place for the verdict instead of printing.
pub fn listen() {
    std::panic::set_hook(Box::new(|info| {
        if let (Some(place), Ok(mut last)) = (info.location(), PLACE.lock()) {
            *last = format!("{}:{}", place.file(), place.line());
        }
    }));
}

/// What came of an input.
#[derive(Clone, PartialEq, Debug)]
pub enum Verdict {
    /// It was read.
    Accepted,
    /// It was refused with an error.
    Refused,
    /// It broke a limit or panicked: a word for the kind, and what happened.
    Failed(&'static str, String),
}

/// Tries an input.
#[must_use]
pub fn try_input(target: &Target, bytes: &[u8]) -> Verdict {
    let attempt = || {
        let started = Instant::now();
        let (result, held) = measured(|| catch_unwind(AssertUnwindSafe(|| (target.run)(bytes))));
        (result, held, started.elapsed())
    };
    let (result, held, mut took) = attempt();
    if took > LONGEST {
        // Once more by the processor's time, lest something else kept the machine busy.
        let before = processor_time();
        took = attempt().2;
        if let Some((before, after)) = before.zip(processor_time()) {
            took = after.saturating_sub(before);
        }
    }
    match result {
        Err(panic) => {
            let text = panic.downcast_ref::<String>().map(String::as_str);
            let text = text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no text");
            let place = PLACE.lock().map(|place| place.clone()).unwrap_or_default();
            Verdict::Failed(
                "panic",
                format!("{place}: {}", text.chars().take(200).collect::<String>()),
            )
        }
        Ok(_) if held > target.memory + 64 * bytes.len() => Verdict::Failed(
            "memory",
            format!("{} MiB held for an input of {} bytes", held >> 20, bytes.len()),
        ),
        Ok(_) if took > LONGEST => Verdict::Failed(
            "slow",
            format!("{} s for an input of {} bytes", took.as_secs(), bytes.len()),
        ),
        Ok(true) => Verdict::Accepted,
        Ok(false) => Verdict::Refused,
    }
}
