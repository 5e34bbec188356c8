//! What a task's own map leaves out, in the line that [`Maps`](super::Maps) has for a folder's.

use crate::error::excerpt;
use crate::registry::scenario::EnvId;
use std::collections::BTreeSet;
use std::sync::{Mutex, OnceLock};

/// Gets the lines; none where nobody asked for them.
static REPORT: OnceLock<fn(&str)> = OnceLock::new();

/// Lines that it got already: a batch and its evaluation make the same world many times.
static SAID: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());

/// From here on `report` gets a line about each task that is played whose map holds what is not
/// played as it says: once a level. The first that is given stays.
pub fn report_tasks_to(report: fn(&str)) {
    let _ = REPORT.set(report);
}

/// Says what the map of an environment's task leaves out.
pub(crate) fn say_of_task(id: EnvId, left_out: &[String]) {
    let (Some(report), Some(file)) = (REPORT.get(), id.scenario.file) else { return };
    if left_out.is_empty() {
        return;
    }
    let level = if id.scenario.levels > 1 { format!("#{}", id.level) } else { String::new() };
    let line = format!("{}{level}: left out: {}", excerpt(file.path), left_out.join(", "));
    if SAID.lock().is_ok_and(|mut said| said.insert(line.clone())) {
        report(&line);
    }
}
