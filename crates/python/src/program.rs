//! The program, and training, for Python.

use crate::errors::INVALID_OPTION;
use hasard_learn::runs::report::Report;
use hasard_learn::runs::trainer::Hooks;
use pyo3::prelude::*;
use std::ffi::OsString;
use std::sync::atomic::{AtomicBool, Ordering};

/// main(words) -> int
///
/// Runs the program `hasard` with these words, the program's name first, and gives its exit code.
#[pyfunction]
pub fn main(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| hasard_cli::main(words))
}

/// train(words, callback, warn) -> (directory, stopped, last report)
///
/// Trains as `hasard train` with these words does. callback is called with every report as a dict; where it gives True the run ends
/// with a checkpoint, as it does when it raises, or at Ctrl-C: what was raised is raised again when the run has ended.
#[pyfunction]
pub fn train(
    py: Python<'_>,
    words: Vec<OsString>,
    callback: Option<Py<PyAny>>,
    warn: Py<PyAny>,
) -> PyResult<(std::path::PathBuf, bool, Py<PyAny>)> {
    let stop = AtomicBool::new(false);
    let mut raised: Option<PyErr> = None;
    let outcome = py.detach(|| {
        let mut report = |report: &Report| {
            let heard = Python::attach(|py| {
                py.check_signals()?;
                match &callback {
                    Some(callback) => callback.bind(py).call1((told(py, report)?,))?.is_truthy(),
                    None => Ok(false),
                }
            });
            match heard {
                Ok(false) => {}
                Ok(true) => stop.store(true, Ordering::SeqCst),
                Err(error) => {
                    stop.store(true, Ordering::SeqCst);
                    raised.get_or_insert(error);
                }
            }
        };
        let mut say = |text: String| {
            // What cannot be said is not worth ending the run for.
            let _ = Python::attach(|py| warn.call1(py, (text,)));
        };
        hasard_cli::train(words, &mut Hooks { stop: &stop, report: &mut report, warn: &mut say })
    });
    if let Some(error) = raised {
        return Err(error);
    }
    let (directory, summary) = outcome.map_err(|line| INVALID_OPTION.error(py, line))?;
    Ok((directory, summary.stopped, told(py, &summary.last)?.unbind()))
}

/// A report as a dict.
fn told<'py>(py: Python<'py>, report: &Report) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (report.row().to_string(),))
}
