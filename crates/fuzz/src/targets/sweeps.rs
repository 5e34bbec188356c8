//! Descriptions of sweeps.

use super::{Target, assert_presentable, nothing_to_repair};
use hasard_sweep::{State, Sweep};

/// TOML files.
pub const SWEEP: Target = Target {
    name: "sweep",
    samples: || {
        let grid = "out = \"runs/x\"\nparallel = 2\nframes = 2_000_000\nseeds = [1, 2, 3]\nscenarios = [\"RemedyRush\"]\n\
                    levels = [1, 2]\nalgorithms = [\"PPO\", \"PPOLag\"]\n\n[options]\nrules = \"released\"\n\
                    safety-budget = [2.5, 5, 7.5]\nfull-actions = [false, true]\n\n[[grid]]\nalgorithms = [\"PPOCost\"]\n\
                    options.cost-scale = [0.5, 2]\n\n[[grid]]\nscenarios = \"VolcanicVentureLevel3-v0\"\n";
        // Those that train something: the others only say what to do.
        let trained = hasard_sweep::paper::EXPERIMENTS
            .iter()
            .filter(|known| hasard_sweep::paper::advice(known.name).is_none());
        let paper =
            trained.map(|known| format!("experiment = \"{}\"\nframes = 1000\n", known.name));
        std::iter::once(grid.to_string()).chain(paper).map(String::into_bytes).collect()
    },
    words: &[
        "[[grid]]\n",
        "options.",
        "seeds = [",
        "frames = ",
        "experiment = \"main\"\n",
        "levels = [1,2,3]\n",
        "'''",
        "\"\"\"",
        "[options]\n",
    ],
    repair: nothing_to_repair,
    run: |bytes| {
        let text = String::from_utf8_lossy(bytes);
        match Sweep::parse(&text).and_then(|sweep| sweep.jobs()) {
            Ok(jobs) => {
                for job in jobs.iter().take(100) {
                    std::hint::black_box((
                        job.command_line("hasard"),
                        job.arguments_from(State::Unfinished(1)),
                        job.log(),
                    ));
                }
                true
            }
            Err(problem) => {
                assert_presentable(&problem);
                false
            }
        }
    },
    // A hundred thousand runs, the most that a sweep may have.
    memory: 512 << 20,
};
