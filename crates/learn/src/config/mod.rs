//! Everything that a run is made of. A run's `config.json` is this, and resuming or evaluating
//! needs nothing else.

mod aim;
mod algorithm;
mod budgets;
mod change;
pub mod constraint;
pub mod curriculum;
mod environment;
mod evaluation;
mod evaluation_times;
pub mod explained;
mod former;
mod init_from;
mod learning;
mod lessons;
mod names;
mod network;
pub mod numbers;
mod own_scenario;
pub mod place;
mod presets;
mod quick;
mod ranges;
pub mod readers;
mod reflection;
mod reporting;
mod sampling;
mod second_order;
mod set_value;
pub mod settings;
mod tasks;
mod train_config;

pub use algorithm::{AlgorithmConfig, AlgorithmKind, MultiplierUpdate};
pub use constraint::{Constraint, ConstraintStatistic};
pub use environment::EnvConfig;
pub use evaluation::EvaluationConfig;
pub use init_from::InitFrom;
pub use learning::{
    CriticInput, Exploration, LearningConfig, Optimiser, Products, ReturnNormaliser,
};
pub use network::{Convolution, Initialisation, NetworkConfig, RecurrentCell};
pub use reflection::{Reflected, reflections};
pub use reporting::ReportingConfig;
pub use sampling::SamplingConfig;
pub use train_config::{Preset, TrainConfig};
