//! Measures how fast worlds step: `cargo run --release -p hasard-envs --example speed -- ID [LANES] [THREADS] [SECONDS]`.

use hasard_envs::{EnvOptions, FrameSize, bench};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let id = arguments.first().map_or("VolcanicVentureLevel1-v0", String::as_str);
    let number = |i: usize, default: usize| arguments.get(i).map_or(Ok(default), |text| text.parse());
    let options = EnvOptions { size: FrameSize::LEARNER, ..EnvOptions::default() };
    let report = bench(id, &options, number(1, 16)?, number(2, 1)?, number(3, 5)? as f64)?;
    println!("{id}: {:.0} policy steps/s, {} resets", report.steps_per_second, report.resets);
    Ok(())
}
