//! Which code an input has reached.
//!
//! The stable compiler can count how often each edge of the program is taken, if it is asked to:
//!
//! ```sh
//! RUSTFLAGS="-Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=3 -Cllvm-args=-sanitizer-coverage-inline-8bit-counters" \
//!     cargo build --release -p hasard-fuzz --target x86_64-unknown-linux-gnu
//! ```
//!
//! Then inputs that reach something new are kept and spoiled further. Without, only the valid
//! samples are.

use std::sync::Mutex;

/// The counters of each linked part of the program: start and length.
static COUNTERS: Mutex<Vec<(usize, usize)>> = Mutex::new(Vec::new());

/// Called by instrumented code before `main`, once a part.
#[unsafe(no_mangle)]
extern "C" fn __sanitizer_cov_8bit_counters_init(start: *mut u8, stop: *mut u8) {
    if let Ok(mut counters) = COUNTERS.lock() {
        let part = (start as usize, stop as usize - start as usize);
        if part.1 > 0 && !counters.contains(&part) {
            counters.push(part);
        }
    }
}

/// What has been reached so far.
#[derive(Default)]
pub struct Coverage {
    parts: Vec<(usize, usize)>,
    /// Of each counter a bit for each order of magnitude that it has had.
    seen: Vec<u8>,
    /// Number of bits in `seen`.
    reached: usize,
}

impl Coverage {
    /// Finds the program's counters.
    #[must_use]
    pub fn new() -> Coverage {
        let parts = COUNTERS.lock().map(|parts| parts.clone()).unwrap_or_default();
        let length = parts.iter().map(|part| part.1).sum();
        Coverage { parts, seen: vec![0; length], reached: 0 }
    }

    /// Edges with an order of magnitude of how often, reached so far; 0 where nothing is counted.
    #[must_use]
    pub fn reached(&self) -> usize {
        self.reached
    }

    /// Sets the counters to nothing.
    pub fn clear(&mut self) {
        for &(start, length) in &self.parts {
            // SAFETY: the linker's bounds of memory that lives as long as the program; only
            // counting code writes to it, and a lost count is acceptable.
            unsafe { std::ptr::write_bytes(start as *mut u8, 0, length) };
        }
    }

    /// Notes what was reached since [`Coverage::clear`], and says whether anything of it is new.
    pub fn note(&mut self) -> bool {
        let before = self.reached;
        let mut at = 0;
        for &(start, length) in &self.parts {
            // SAFETY: as in `clear`.
            let counters = unsafe { std::slice::from_raw_parts(start as *const u8, length) };
            for (counter, seen) in counters.iter().zip(&mut self.seen[at..at + length]) {
                if *counter != 0 {
                    let bit = 1 << counter.ilog2();
                    if *seen & bit == 0 {
                        *seen |= bit;
                        self.reached += 1;
                    }
                }
            }
            at += length;
        }
        self.reached > before
    }
}
