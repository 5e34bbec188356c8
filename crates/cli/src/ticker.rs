//! How far a command is that takes longer than a moment: a line that is written over on a terminal,
//! a line now and then elsewhere.

use crate::progress::duration;
use std::io::{IsTerminal, Write};
use std::time::{Duration, Instant};

/// Time until a terminal, and until a log, first hears something; what is over before says nothing.
const FIRST: [Duration; 2] = [Duration::from_secs(1), Duration::from_secs(10)];
/// Time between a terminal's lines, and a log's.
const EVERY: [Duration; 2] = [Duration::from_millis(200), Duration::from_secs(10)];

/// Reports it on standard error.
pub struct Ticker {
    unit: &'static str,
    total: u64,
    began: Instant,
    due: Instant,
    terminal: bool,
    written: bool,
}

impl Ticker {
    /// For work of so many units, such as steps.
    pub fn new(total: u64, unit: &'static str) -> Ticker {
        let (began, terminal) = (Instant::now(), std::io::stderr().is_terminal());
        Ticker {
            unit,
            total,
            began,
            due: began + FIRST[usize::from(!terminal)],
            terminal,
            written: false,
        }
    }

    /// So much is done.
    pub fn at(&mut self, done: u64) {
        let now = Instant::now();
        if now < self.due {
            return;
        }
        self.due = now + EVERY[usize::from(!self.terminal)];
        let text = line(done, self.total, self.unit, now.duration_since(self.began).as_secs_f64());
        if self.terminal {
            self.over(&text);
        } else {
            note!("{text}");
        }
    }

    /// Takes the line away, before something else is printed.
    pub fn clear(&mut self) {
        if self.written {
            self.over("");
        }
    }

    /// Writes over the line at the bottom. A terminal that is gone is no reason to end.
    fn over(&mut self, text: &str) {
        let mut terminal = std::io::stderr().lock();
        let _ = write!(terminal, "\r\u{1b}[2K{text}");
        let _ = terminal.flush();
        self.written = !text.is_empty();
    }
}

impl Drop for Ticker {
    fn drop(&mut self) {
        self.clear();
    }
}

fn line(done: u64, total: u64, unit: &str, seconds: f64) -> String {
    let left = seconds * total.saturating_sub(done) as f64 / done.max(1) as f64;
    let left = if done == 0 { "starting".to_string() } else { format!("{} left", duration(left)) };
    format!("{done} of {total} {unit}, {left}")
}

#[cfg(test)]
mod tests {
    use super::line;

    #[test]
    fn time_left_follows_from_what_is_done() {
        assert_eq!(line(0, 525, "steps", 3.0), "0 of 525 steps, starting");
        assert_eq!(line(105, 525, "steps", 3.0), "105 of 525 steps, 12 s left");
        assert_eq!(line(600, 525, "steps", 3.0), "600 of 525 steps, 0 s left");
    }
}
