//! How far a training is: a bar on a terminal, a plain line now and then in a log, or nothing.

use crate::failure::presentable;
use hasard_learn::runs::progress_bar::Bar;
use hasard_learn::runs::report::Report;
use std::io::IsTerminal;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Time until a log that has no report yet says so, and between its further lines.
const FIRST: Duration = Duration::from_secs(10);
const EVERY: Duration = Duration::from_secs(30);

/// What shows it.
pub enum Progress {
    /// On a terminal.
    Bar(Bar),
    /// In a log: standard error is no terminal.
    Log(Log),
    /// Nothing but warnings.
    Silent,
}

impl Progress {
    /// The one that fits standard error.
    pub fn of(frames: u64) -> Progress {
        if std::io::stderr().is_terminal() {
            Progress::Bar(Bar::new(frames))
        } else {
            Progress::Log(Log::new())
        }
    }

    /// Whether it says anything of itself.
    pub fn is_shown(&self) -> bool {
        !matches!(self, Progress::Silent)
    }

    /// Shows a report.
    pub fn show(&self, report: &Report) {
        match self {
            Progress::Bar(bar) => bar.show(report),
            Progress::Log(log) => log.show(report),
            Progress::Silent => {}
        }
    }

    /// Prints a line.
    pub fn print(&self, line: &str) {
        match self {
            Progress::Bar(bar) => bar.print(&presentable(line)),
            _ => note!("{line}"),
        }
    }

    /// Ends it.
    pub fn finish(&mut self) {
        match self {
            Progress::Bar(bar) => bar.finish(),
            Progress::Log(log) => log.finish(),
            Progress::Silent => {}
        }
    }
}

/// Lines of a log: the first report at once, then the latest one twice a minute, on a thread of its
/// own: they come while the training is busy with an evaluation too.
pub struct Log {
    reports: Option<Sender<Report>>,
    thread: Option<JoinHandle<()>>,
}

impl Log {
    fn new() -> Log {
        let (reports, heard) = channel();
        // Where the system gives no thread, the training goes on without its lines.
        let thread = std::thread::Builder::new().spawn(move || print(&heard)).ok();
        Log { reports: Some(reports), thread }
    }

    fn show(&self, report: &Report) {
        if let Some(reports) = &self.reports {
            let _ = reports.send(report.clone());
        }
    }

    fn finish(&mut self) {
        self.reports = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

impl Drop for Log {
    fn drop(&mut self) {
        self.finish();
    }
}

fn print(heard: &Receiver<Report>) {
    let mut due = Instant::now() + FIRST;
    let mut pace = Pace::default();
    // The latest report, and whether it was printed.
    let mut latest: Option<(Report, Instant, bool)> = None;
    loop {
        match heard.recv_timeout(due.saturating_duration_since(Instant::now())) {
            Ok(report) => {
                let first = latest.is_none();
                let now = Instant::now();
                pace.note(&report, now);
                if first {
                    note!("{}", line(&report, pace.left(&report)));
                    due = now + EVERY;
                }
                latest = Some((report, now, first));
            }
            Err(RecvTimeoutError::Timeout) => {
                match &mut latest {
                    None => note!("starting: no rollout has ended yet"),
                    Some((report, _, printed @ false)) => {
                        note!("{}", line(report, pace.left(report)));
                        *printed = true;
                    }
                    Some((report, when, true)) => note!(
                        "{} of {} frames for {}: an evaluation, or a long rollout",
                        grouped(report.frames),
                        grouped(report.total_frames),
                        duration(when.elapsed().as_secs_f64())
                    ),
                }
                due = Instant::now() + EVERY;
            }
            Err(RecvTimeoutError::Disconnected) => return,
        }
    }
}

/// Frames a second since the first report, evaluations included.
#[derive(Default)]
struct Pace {
    first: Option<(u64, Instant)>,
    rate: f64,
}

impl Pace {
    fn note(&mut self, report: &Report, now: Instant) {
        let (frames, since) = *self.first.get_or_insert((report.frames, now));
        let seconds = now.duration_since(since).as_secs_f64();
        self.rate = if report.frames > frames && seconds > 0.0 {
            (report.frames - frames) as f64 / seconds
        } else {
            report.frames_per_second
        };
    }

    fn left(&self, report: &Report) -> f64 {
        report.total_frames.saturating_sub(report.frames) as f64 / self.rate.max(1e-9)
    }
}

/// A report as a line of a log.
fn line(report: &Report, seconds_left: f64) -> String {
    // The last rollout may go beyond the end.
    let share = (100.0 * report.frames as f64 / report.total_frames.max(1) as f64).min(100.0);
    let mut text = format!(
        "{} of {} frames ({share:.1} %), {} frames/s, {} left",
        grouped(report.frames),
        grouped(report.total_frames),
        grouped(report.frames_per_second.round() as u64),
        duration(seconds_left)
    );
    match report.means {
        Some((episode_return, cost, _)) => {
            text += &format!("; return {episode_return:.2}, cost {cost:.1}");
            let constraints =
                report.terms.iter().zip(&report.constraint_costs).zip(&report.budgets);
            for ((term, cost), budget) in constraints {
                match term {
                    // One of several tasks, none of whose episodes has ended yet.
                    Some(term) if cost.is_nan() => text += &format!(", {term} - of {budget}"),
                    Some(term) => text += &format!(", {term} {cost:.1} of {budget}"),
                    None => text += &format!(" of {budget}"),
                }
            }
        }
        None => text += "; no episode has ended yet",
    }
    if let Some(multiplier) = report.multipliers.first() {
        text += &format!(", multiplier {multiplier:.4}");
    }
    text
}

/// A number with a comma before each three digits.
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let (first, rest) = digits.split_at((digits.len() - 1) % 3 + 1);
    let mut text = first.to_string();
    for three in rest.as_bytes().chunks(3) {
        text.push(',');
        text.extend(three.iter().map(|digit| char::from(*digit)));
    }
    text
}

/// A time in its two largest units.
pub fn duration(seconds: f64) -> String {
    let seconds = seconds.round().clamp(0.0, 1e15) as u64;
    match seconds {
        0..60 => format!("{seconds} s"),
        60..600 => format!("{} min {:02} s", seconds / 60, seconds % 60),
        600..3600 => format!("{} min", seconds / 60),
        3600..86_400 => format!("{} h {:02} min", seconds / 3600, seconds / 60 % 60),
        _ => format!("{} d {} h", seconds / 86_400, seconds / 3600 % 24),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_times_are_written_for_people() {
        let numbers = [0, 7, 999, 1000, 20_480, 123_456_789].map(grouped);
        assert_eq!(numbers, ["0", "7", "999", "1,000", "20,480", "123,456,789"]);
        let times = [0.4, 59.0, 61.0, 3599.0, 7500.0, 86_400.0 * 12.5, f64::INFINITY].map(duration);
        assert_eq!(times[..6], ["0 s", "59 s", "1 min 01 s", "59 min", "2 h 05 min", "12 d 12 h"]);
    }
}
