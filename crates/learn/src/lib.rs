//! Training of safe reinforcement learning agents on the worlds of the HASARD benchmark.
//!
//! The rooms, in the order in which an agent passes through them; each imports only from those
//! before it:
//!
//! 1. [`config`]: the settings of a run, presets and curricula.
//! 2. [`networks`]: policy and critics, on the processor and on graphics cards, and the
//!    distribution of actions.
//! 3. [`sampling`]: worlds, the policy acting in them, rollouts.
//! 4. [`learning`]: advantages, normalisers, optimiser, the learner.
//! 5. [`algorithms`]: an algorithm a file, on top of the learner.
//! 6. [`runs`]: the trainer, checkpoints, evaluation, reports, measurements.
//!
//! Below them all are [`error`], [`random`], [`threads`] and [`statistics`]; and [`team`]: a run of
//! several workers is the same run with a [`team::Team`], and what they exchange is there.

// They panic where a stream is closed or its disk is full.
#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

pub mod algorithms;
pub mod config;
pub mod error;
pub mod learning;
pub mod networks;
pub mod random;
pub mod runs;
pub mod sampling;
pub mod statistics;
pub mod team;
pub mod threads;
