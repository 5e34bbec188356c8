//! The network on a graphics card against the processor. Needs a build with a card's feature and
//! the card itself: `cargo test --release -p hasard-learn --features vulkan --test graphics_card`.

use hasard_learn::config::{AlgorithmKind, EnvConfig, Preset, TrainConfig};
use hasard_learn::networks::device::ComputeDevice;
use hasard_learn::runs::trainer::{Hooks, Start, train};
use std::io::Write;
use std::sync::atomic::AtomicBool;

const DEVICE: &str = if cfg!(feature = "cuda") {
    "cuda"
} else if cfg!(feature = "vulkan") {
    "vulkan"
} else {
    "wgpu"
};

/// Rows of a short synchronous run on a device: its losses, which follow from every output and
/// gradient.
fn losses(device: &str) -> Vec<f64> {
    let env = EnvConfig { size: (64, 48), ..EnvConfig::new("VolcanicVentureLevel1-v0") };
    let mut config = TrainConfig::new(AlgorithmKind::PpoLag, Preset::Paper, env.clone()).unwrap();
    config.device = device.into();
    (config.sampling.lanes, config.sampling.samplers, config.learning.threads) = (8, 1, 1);
    config.frames = 2 * config.frames_per_rollout();
    config.reporting.report_seconds = 0.0;
    config.network.convolutions.truncate(2);
    let directory =
        std::env::temp_dir().join(format!("hasard-card-{device}-{}", std::process::id()));
    let options = env.options().unwrap();
    let mut losses = Vec::new();
    let mut hear = |report: &hasard_learn::runs::report::Report| {
        losses.push(report.row()["loss"].as_f64().unwrap())
    };
    let stop = AtomicBool::new(false);
    let mut hooks =
        Hooks { stop: &stop, report: &mut hear, warn: &mut |warning| panic!("{warning}") };
    train(
        Start::Fresh(config),
        &directory,
        &|_, worlds| hasard_envs::VecEnv::new("VolcanicVentureLevel1-v0", &options, worlds),
        &mut hooks,
    )
    .unwrap();
    std::fs::remove_dir_all(directory).unwrap();
    losses
}

fn same_losses_as_the_processor(device: &str) {
    let (there, here) = (losses(device), losses("cpu"));
    assert_eq!(there.len(), 2);
    for (a, b) in there.iter().zip(&here) {
        assert!(
            (a - b).abs() < 1e-3 * b.abs().max(0.1),
            "{there:?} on {device}, {here:?} on the processor"
        );
    }
}

#[test]
#[cfg_attr(
    not(any(feature = "vulkan", feature = "cuda", feature = "wgpu")),
    ignore = "built without a graphics card's feature: cargo test -p hasard-learn --features vulkan, on a machine with a card"
)]
fn a_graphics_card_learns_what_the_processor_learns() {
    if let Err(reason) = ComputeDevice::named(DEVICE) {
        // Past the test runner's capture, so that it is seen.
        writeln!(
            std::io::stderr(),
            "skipped a_graphics_card_learns_what_the_processor_learns: {reason}"
        )
        .unwrap();
        return;
    }
    same_losses_as_the_processor(DEVICE);
}

/// The same through burn's backend for processors, so that the portable path is held to it without
/// a card.
#[test]
#[cfg_attr(not(feature = "graphics"), ignore = "built without a graphics card's feature")]
fn the_portable_path_learns_what_the_processor_learns() {
    same_losses_as_the_processor("flex");
}
