//! The program `hasard` with a scenario more: `EastSide-v0` trains, is evaluated, reported and
//! shown in the page as the benchmark's six are.
//!
//! ```text
//! cargo run --release -- train EastSide --frames 200k --out runs/east
//! cargo run --release -- report runs
//! cargo run --release -- serve runs --open
//! ```

mod scenario;

use hasard_envs::Scenario;
use std::process::ExitCode;

fn main() -> ExitCode {
    if let Err(error) = Scenario::register(&scenario::SPEC) {
        eprintln!("{error}");
        return ExitCode::from(2);
    }
    ExitCode::from(hasard_cli::main(std::env::args_os()))
}
