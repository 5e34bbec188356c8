//! `hasard-fuzz [TARGET...] --seconds N --seed S --findings DIR`: searches each target (all if none
//! is named) for N seconds and prints a line each: inputs tried, accepted, kept, edges reached,
//! processor seconds, findings. `--try FILE TARGET` tries one file.

use hasard_fuzz::targets::{self, Target};
use hasard_fuzz::verdict::{listen, try_input};
use hasard_fuzz::{supervisor, worker};
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Default)]
struct Arguments {
    targets: Vec<&'static Target>,
    seconds: f64,
    seed: u64,
    findings: PathBuf,
    notebook: PathBuf,
    file: Option<PathBuf>,
    worker: bool,
}

fn parse() -> Result<Arguments, String> {
    let mut parsed = Arguments {
        seconds: 60.0,
        seed: 1,
        findings: PathBuf::from("findings"),
        ..Arguments::default()
    };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value"));
        match word.as_str() {
            "--worker" => parsed.worker = true,
            "--seconds" => {
                parsed.seconds = value()?.parse().map_err(|_| "--seconds needs a number")?
            }
            "--seed" => {
                parsed.seed = value()?.parse().map_err(|_| "--seed needs a whole number")?
            }
            "--findings" => parsed.findings = value()?.into(),
            "--notebook" => parsed.notebook = value()?.into(),
            "--try" => parsed.file = Some(value()?.into()),
            name => {
                let names: Vec<&str> = targets::ALL.iter().map(|target| target.name).collect();
                let target = targets::ALL.iter().find(|target| target.name == name);
                parsed
                    .targets
                    .push(target.ok_or(format!("no target {name}; use {}", names.join(", ")))?);
            }
        }
    }
    if parsed.targets.is_empty() {
        parsed.targets = targets::ALL.iter().collect();
    }
    Ok(parsed)
}

/// Processor seconds of this process so far.
fn processor_seconds() -> f64 {
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let after_name = text.rsplit(") ").next().unwrap_or_default();
    let ticks = after_name.split(' ').skip(11).take(2).filter_map(|word| word.parse::<f64>().ok());
    ticks.sum::<f64>() / 100.0
}

fn run() -> Result<bool, String> {
    let arguments = parse()?;
    let mut clean = true;
    for target in arguments.targets {
        let fault = |error: std::io::Error| format!("{}: {error}", target.name);
        if let Some(file) = &arguments.file {
            let bytes =
                std::fs::read(file).map_err(|error| format!("{}: {error}", file.display()))?;
            listen();
            println!("{}: {:?}", target.name, try_input(target, &bytes));
        } else if arguments.worker {
            let (seconds, seed) = (arguments.seconds, arguments.seed);
            let tally =
                worker::search(target, seconds, seed, &arguments.notebook, &arguments.findings)
                    .map_err(fault)?;
            println!(
                "{}: {} inputs, {} accepted, {} kept, {} edges, {:.0} s, {:.0} processor s, {} findings",
                target.name,
                tally.executions,
                tally.accepted,
                tally.corpus,
                tally.reached,
                seconds,
                processor_seconds(),
                tally.findings.len()
            );
            for (kind, text) in tally.findings {
                println!("{}: {kind}: {}", target.name, text.escape_debug());
            }
        } else {
            let outcome = supervisor::supervise(
                target,
                arguments.seconds,
                arguments.seed,
                &arguments.findings,
            )
            .map_err(fault)?;
            clean &= outcome.deaths.is_empty()
                && outcome.lines.iter().all(|line| line.ends_with(" 0 findings"));
            outcome.lines.iter().for_each(|line| println!("{line}"));
        }
    }
    Ok(clean)
}

fn main() -> ExitCode {
    match run() {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(problem) => {
            eprintln!("hasard-fuzz: {problem}");
            ExitCode::from(2)
        }
    }
}
