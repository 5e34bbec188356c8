//! The program `hasard`.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(hasard_cli::main(std::env::args_os()))
}
