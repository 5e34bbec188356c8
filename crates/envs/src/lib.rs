//! The HASARD benchmark: scenarios, ids, action spaces, the single environment and the batch of
//! worlds [`VecEnv`].
//!
//! # What can be seen
//!
//! | observation | bytes a pixel | how |
//! |---|---|---|
//! | colours | 3 | [`ObservationKind::Rgb`] |
//! | colours and depth | 4, the last is depth | [`ObservationKind::RgbDepth`] |
//! | one colour a class | 3 | [`ObservationKind::Segmented`]; the published colours by [`EnvOptions::published_colours`] |
//! | luminance | 1 | [`ObservationKind::Grey`] |
//! | any of them, the last `n` frames | `n` times that, oldest first | [`EnvOptions::frame_stack`] |
//! | depth alone: 0 near to 255 far, 7.3 map units a level | 1 | [`Env::render`], then `depth` of the renderer |
//! | labels: which thing each pixel shows, and the list of things in view | 2 | [`Env::render`], then `classes` and `labels` |
//! | the whole map with things, from above | 3 | [`Env::top_down`] |
//!
//! ```
//! use hasard_engine::render::{Buffers, class};
//! use hasard_envs::{Env, EnvOptions, ObservationKind};
//! let options = EnvOptions { observation: ObservationKind::RgbDepth, frame_stack: 2, ..EnvOptions::default() };
//! let mut env = Env::new("RemedyRushLevel1-v0", &options)?;
//! env.reset(1);
//! assert_eq!(env.observation_shape(), [120, 160, 2 * 4]);
//! let seen = env.render(Buffers { depth: true, labels: true });
//! let nearest = seen.depth().iter().zip(seen.classes()).filter(|(_, seen)| **seen >= class::FIRST_ACTOR).min();
//! if let Some((level, thing)) = nearest {
//!     let label = &seen.labels()[usize::from(thing - class::FIRST_ACTOR)];
//!     println!("a {:?}, {:.0} map units away", label.kind, f64::from(*level) * 7.3);
//! }
//! let map = env.top_down(320, 240);
//! let mut picture = vec![0; 320 * 240 * 3];
//! map.draw(env.world(), &mut picture);
//! # Ok::<(), hasard_envs::EnvError>(())
//! ```

// They panic where a stream is closed or its disk is full.
#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

mod bench;
mod error;
mod interface;
mod machine_memory;
pub mod maps;
mod options;
pub mod own;
mod policies;
mod registry;
pub mod scenarios;
mod single;
mod spaces;
mod vec_env;

pub use bench::{BenchReport, bench};
pub use error::EnvError;
/// The world and the renderer beneath, in the version that these environments use.
pub use hasard_engine as engine;
pub use hasard_engine::math::Rng;
pub use hasard_engine::render::FrameSize;
pub use interface::batch::{Batch, Episode, EpisodeCost, episode_costs};
pub use interface::buffer::{Buffer, Memory};
pub use interface::environment::Environment;
pub use interface::happening::{DAMAGE_CAUSES, Happening, HappeningKind};
pub use interface::insight::{self, Insight};
pub use interface::step::{CostTerm, Step};
pub use machine_memory::machine_memory;
pub use options::{EnvOptions, FRAME_SKIP, Layout, ObservationKind};
pub use policies::policy::{Policy, PolicyRun};
pub use policies::rollout::rollout;
pub use registry::scenario::{EnvId, edit_distance};
pub use scenarios::common::rule_set::RuleSet;
pub use scenarios::common::scenario::Scenario;
pub use single::env::Env;
pub use single::snapshot::Snapshot;
pub use spaces::action::{
    ActionGroup, ActionSpace, BUTTONS, Controls, DELTA_DEGREES, DeltaButton, Move, parse_command,
};
pub use vec_env::{
    Autoreset, FinalObservations, LaneState, MixedTask, Mixture, Restart, VecEnv, VecOptions,
};
