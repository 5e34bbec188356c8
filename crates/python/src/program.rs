//! The program, and training, for Python.

use crate::errors::INVALID_OPTION;
use hasard_learn::runs::report::Report;
use hasard_learn::runs::trainer::Hooks;
use hasard_learn::team::{Exchange, Team};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use std::ffi::OsString;
use std::sync::atomic::{AtomicBool, Ordering};

/// main(words) -> int
///
/// Runs the program `hasard` with these `words`, the program's name first, and returns its exit
/// code.
#[pyfunction]
pub fn main(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| hasard_cli::main(words))
}

/// What carries bytes between the workers of a run: a Python function that takes an array of bytes
/// and gives everyone's, in the order of ranks.
struct Carrier(Py<PyAny>);

impl Exchange for Carrier {
    fn gather(&mut self, bytes: Vec<u8>) -> Result<Vec<Vec<u8>>, String> {
        Python::attach(|py| -> PyResult<Vec<Vec<u8>>> {
            let all = self.0.bind(py).call1((PyArray1::from_vec(py, bytes),))?;
            all.try_iter()?
                .map(|one| Ok(one?.extract::<PyReadonlyArray1<'_, u8>>()?.as_array().to_vec()))
                .collect()
        })
        .map_err(|error: PyErr| error.to_string())
    }
}

fn team(exchange: Option<Py<PyAny>>, rank: usize, ranks: usize) -> Team {
    exchange
        .map_or_else(Team::default, |exchange| Team::new(rank, ranks, Box::new(Carrier(exchange))))
}

/// follow(exchange, rank, ranks, warn)
///
/// Trains with the first worker of a team until that ends the run.
///
/// Args:
///     exchange: takes uint8 [bytes] and gives a list of everyone's, in the order of ranks.
///     rank: of this worker, 1 to ranks - 1.
///     ranks: number of workers.
///     warn: is called with each warning, a str.
///
/// Raises:
///     InvalidOption, with the one line of what went wrong.
#[pyfunction]
pub fn follow(
    py: Python<'_>,
    exchange: Py<PyAny>,
    rank: usize,
    ranks: usize,
    warn: Py<PyAny>,
) -> PyResult<()> {
    let team = team(Some(exchange), rank, ranks);
    let mut say = |text: String| {
        // What cannot be said is not worth ending the run for.
        let _ = Python::attach(|py| warn.call1(py, (text,)));
    };
    py.detach(|| hasard_cli::follow(team, &mut say)).map_err(|line| INVALID_OPTION.error(py, line))
}

/// train(words, callback, warn, exchange=None, ranks=1) -> (directory, stopped, last report)
///
/// Trains as `hasard train` does; `hasard_rs.train` is what to use.
///
/// Args:
///     words: of the command line after `hasard train`.
///     callback: is called with every report, a dict; where it gives True the run ends with a
///         checkpoint, as it does when it raises, or at
///         Ctrl-C: what was raised is raised again when the run has ended. Or None.
///     warn: is called with each warning, a str.
///     exchange: takes uint8 [bytes] and gives a list of everyone's: this is the first of so many
///         workers, and the others `follow`.
///     ranks: number of workers.
///
/// Returns:
///     The directory, whether the run was ended by the callback, and the last report.
///
/// Raises:
///     InvalidOption, with the one line of what went wrong.
#[pyfunction]
#[pyo3(signature = (words, callback, warn, exchange=None, ranks=1))]
pub fn train(
    py: Python<'_>,
    words: Vec<OsString>,
    callback: Option<Py<PyAny>>,
    warn: Py<PyAny>,
    exchange: Option<Py<PyAny>>,
    ranks: usize,
) -> PyResult<(std::path::PathBuf, bool, Py<PyAny>)> {
    let team = team(exchange, 0, ranks);
    let stop = AtomicBool::new(false);
    let mut raised: Option<PyErr> = None;
    let outcome = py.detach(|| {
        let mut report = |report: &Report| {
            let heard = Python::attach(|py| {
                py.check_signals()?;
                match &callback {
                    Some(callback) => callback.bind(py).call1((as_dict(py, report)?,))?.is_truthy(),
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
        hasard_cli::train(
            &team,
            words,
            &mut Hooks { stop: &stop, report: &mut report, warn: &mut say },
        )
    });
    if let Some(error) = raised {
        return Err(error);
    }
    let (directory, summary) = outcome.map_err(|line| INVALID_OPTION.error(py, line))?;
    Ok((directory, summary.stopped, as_dict(py, &summary.last)?.unbind()))
}

/// A report as a dict.
fn as_dict<'py>(py: Python<'py>, report: &Report) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (report.row().to_string(),))
}
