//! The worlds for Python: the extension module `hasard_rs._core`.
//!
//! | module | what it holds |
//! |---|---|
//! | `worlds` | the class `Worlds`: every call lets the interpreter go while the worlds work |
//! | `inner`, `lane` | the worlds behind it, without Python |
//! | `batch`, `events`, `pool` | results as arrays; observations stay in the memory that they were drawn in |
//! | `bind`, `memory` | results written into the caller's arrays |
//! | `actions`, `resets`, `arguments` | what Python gives, checked before any world moves |
//! | `facts`, `registry` | what is fixed about worlds, and the 18 environments |
//! | `program`, `agent` | the program `hasard`, training, and trained agents |
//! | `errors` | errors as exceptions of `hasard_rs.errors` |
//!
//! Unsafe code is in `pool`, `memory` (memory shared with NumPy) and `inner` (the end of worlds
//! after a fork), each with its reason.

// They panic where a stream is closed or its disk is full.
#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

mod actions;
mod agent;
mod arguments;
mod batch;
mod bind;
mod errors;
mod events;
mod facts;
mod inner;
mod lane;
mod memory;
mod pool;
mod program;
mod registry;
mod resets;
mod worlds;

use pyo3::prelude::*;
use std::path::PathBuf;

/// The compiled part of `hasard_rs`.
#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    // Packages named `auto` are this interpreter's, whatever `python3` on the path has.
    if let Ok(interpreter) = module.py().import("sys")?.getattr("executable")?.extract::<PathBuf>()
        && interpreter.is_file()
    {
        hasard_envs::maps::ask(&interpreter);
    }
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<worlds::Worlds>()?;
    module.add_class::<batch::Batch>()?;
    module.add_class::<agent::TrainedAgent>()?;
    module.add_class::<agent::AgentState>()?;
    module.add_function(wrap_pyfunction!(agent::checkpoint_of, module)?)?;
    module.add_function(wrap_pyfunction!(program::main, module)?)?;
    module.add_function(wrap_pyfunction!(program::train, module)?)?;
    module.add_function(wrap_pyfunction!(program::follow, module)?)?;
    module.add_function(wrap_pyfunction!(arguments::frame_size, module)?)?;
    module.add_function(wrap_pyfunction!(events::event_names, module)?)?;
    module.add_function(wrap_pyfunction!(registry::ids, module)?)?;
    module.add_function(wrap_pyfunction!(registry::describe, module)?)?;
    module.add_function(wrap_pyfunction!(registry::published_stats, module)?)?;
    module.add_function(wrap_pyfunction!(registry::check_scenario, module)?)?;
    module.add_function(wrap_pyfunction!(registry::read_scenario, module)?)?;
    module.add_function(wrap_pyfunction!(registry::register_scenario, module)?)?;
    Ok(())
}
