//! Spoiled files for everything in hasard that reads bytes: none may panic, hang, or take memory
//! without bound.
//!
//! | module | what it holds |
//! |---|---|
//! | [`targets`] | the readers, each with valid samples made by our own writers |
//! | [`mutation`] | how samples are spoiled |
//! | [`coverage`] | which code an input has reached, in programs built to count that |
//! | [`allocation`] | how much memory an input takes |
//! | [`verdict`] | one input against one target, within limits |
//! | [`worker`], [`supervisor`] | the search: a process that tries, and one that outlives its crashes |
//!
//! Everything follows from the seed, so that a search can be repeated. `docs/results/fuzzing.md`
//! says how to search; files that once broke a limit, or try to, lie in `hostile/`, a folder a
//! target, and `tests/hostile.rs` tries them all.

pub mod allocation;
pub mod coverage;
pub mod mutation;
pub mod supervisor;
pub mod targets;
pub mod verdict;
pub mod worker;
