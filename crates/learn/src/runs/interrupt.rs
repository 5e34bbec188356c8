//! Ctrl-C.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::error::LearnError;

/// A flag that the first Ctrl-C (or SIGTERM) raises, so that a run ends with a checkpoint; the second ends the program.
pub fn stop_on_interrupt() -> Result<Arc<AtomicBool>, LearnError> {
    let flag = Arc::new(AtomicBool::new(false));
    let raised = Arc::clone(&flag);
    ctrlc::set_handler(move || {
        if raised.swap(true, Ordering::SeqCst) {
            std::process::exit(130);
        }
        eprintln!("stopping after this rollout, with a checkpoint; once more to stop at once");
    })
    .map_err(|error| LearnError::Config(format!("Ctrl-C cannot be caught: {error}")))?;
    Ok(flag)
}
