//! The progress of a run for people.

use std::io::Write;

use indicatif::{ProgressBar, ProgressStyle};

use crate::runs::report::Report;

/// A line at the bottom of the terminal: frames, speed, return, cost, budget, multiplier.
pub struct Bar {
    bar: ProgressBar,
}

impl Bar {
    /// A bar for a run of some frames; nothing is drawn where no terminal is.
    #[must_use]
    pub fn new(frames: u64) -> Bar {
        let bar = ProgressBar::new(frames);
        bar.set_style(style("{bar:24} {percent:>3} % {msg}"));
        bar.set_message("starting");
        Bar { bar }
    }

    /// Shows a report.
    pub fn show(&self, report: &Report) {
        self.bar.set_length(report.total_frames);
        self.bar.set_position(report.frames.min(report.total_frames));
        self.bar.set_message(line(report));
        // How long it takes is known from the first report on, and not before it is shown.
        self.bar.set_style(style("{bar:24} {percent:>3} % {msg}  {eta} left"));
    }

    /// Prints a line above the bar.
    pub fn print(&self, line: &str) {
        // A terminal that is gone is no reason to end.
        self.bar.suspend(|| drop(writeln!(std::io::stderr(), "{line}")));
    }

    /// Ends the bar, leaving it as it is.
    pub fn finish(&self) {
        self.bar.abandon();
    }
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}

/// A report in a line.
#[must_use]
pub fn line(report: &Report) -> String {
    let mut text = format!("{} frames at {:.0}/s", report.frames, report.frames_per_second);
    match report.means {
        Some((episode_return, cost, _)) => {
            text.push_str(&format!("  return {episode_return:.2}  cost {cost:.1}"))
        }
        None => text.push_str("  no episode has ended yet"),
    }
    if let Some(budget) = report.budgets.first() {
        if let Some(Some(term)) = report.terms.first() {
            // Of one of several tasks, no episode may have ended yet.
            let cost = report.constraint_costs.first().filter(|cost| !cost.is_nan());
            text.push_str(&format!(
                "  {term} {}",
                cost.map_or("-".into(), |cost| format!("{cost:.1}"))
            ));
        }
        text.push_str(&format!("  budget {budget}"));
    }
    if let Some(multiplier) = report.multipliers.first() {
        text.push_str(&format!("  multiplier {multiplier:.4}"));
    }
    text
}
