//! The raw flags: each declared once, feeding `--help`, parsing and the tests.

mod cli;
mod common;
mod pictures;
mod results;
mod training;
mod worlds;

pub use cli::{Cli, Command, CompletionsArgs};
pub use common::{EnvArgs, LooksArgs, Observation, ObservationArgs, Rules, Size};
pub use pictures::{
    ContactSheetArgs, FilmArgs, HighlightsArgs, PlayArgs, RecordArgs, RenderArgs, ReplayArgs, View,
};
pub use results::{ClaimArgs, ReportArgs, ScoreboardArgs, ServeArgs, SiteArgs, VerifyArgs};
pub use training::{EvalArgs, ExportAgentArgs, MetricsArgs, SettingsArgs, SweepArgs, TrainArgs};
pub use worlds::{BenchArgs, CheckArgs, EnvsArgs, ExportWadArgs, NewArgs, RolloutArgs, TraceArgs};
