//! The process that outlives crashes and hangs of its workers.

use crate::targets::Target;
use crate::worker::{Notebook, keep};
use std::io;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A worker that tries one input for so long hangs.
const HANGS_AFTER: Duration = Duration::from_secs(60);

/// What the workers of one target said, and how they died.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// The lines that workers printed at their ends.
    pub lines: Vec<String>,
    /// Files of inputs that a worker died of.
    pub deaths: Vec<String>,
}

/// Searches one target for so long, starting another worker whenever one dies.
///
/// # Errors
/// When a worker cannot be started, or a finding not be written.
pub fn supervise(target: &Target, seconds: f64, seed: u64, findings: &Path) -> io::Result<Outcome> {
    let mut outcome = Outcome::default();
    let notebook =
        std::env::temp_dir().join(format!("hasard-fuzz-{}-{}", std::process::id(), target.name));
    let started = Instant::now();
    let mut round = 0;
    while started.elapsed().as_secs_f64() < seconds {
        let left = (seconds - started.elapsed().as_secs_f64()).max(1.0);
        let mut worker = Command::new(std::env::current_exe()?)
            .args([
                "--worker",
                target.name,
                "--seconds",
                &left.to_string(),
                "--seed",
                &(seed + round).to_string(),
            ])
            .arg("--findings")
            .arg(findings)
            .arg("--notebook")
            .arg(&notebook)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()?;
        let (mut last, mut since) = (0, Instant::now());
        let died = loop {
            if let Some(status) = worker.try_wait()? {
                break (!status.success()).then_some("crash");
            }
            let number = Notebook::read(&notebook).map_or(0, |(number, _)| number);
            if number != last {
                (last, since) = (number, Instant::now());
            } else if since.elapsed() > HANGS_AFTER {
                worker.kill()?;
                worker.wait()?;
                break Some("hang");
            }
            std::thread::sleep(Duration::from_millis(500));
        };
        if let Some(mut pipe) = worker.stdout.take() {
            let mut text = String::new();
            io::Read::read_to_string(&mut pipe, &mut text)?;
            outcome.lines.extend(text.lines().map(String::from));
        }
        if let Some(kind) = died {
            let (number, input) = Notebook::read(&notebook)?;
            let path = keep(findings, target.name, kind, &input)?;
            outcome.deaths.push(path.display().to_string());
            outcome.lines.push(format!(
                "{}: {kind} at input {number} of seed {}: {}",
                target.name,
                seed + round,
                path.display()
            ));
        }
        round += 1;
    }
    let _ = std::fs::remove_file(&notebook);
    Ok(outcome)
}
