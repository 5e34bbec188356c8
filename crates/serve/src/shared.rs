//! What the routes share.

use crate::catalogue::Catalogue;
use crate::stages::Stages;
use hasard_envs::{Env, EnvOptions};
use hasard_learn::runs::evaluate::{Agent, Choice};
use hasard_learn::runs::zoo_results::ZooResult;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use tokio::sync::Semaphore;

/// Trained agents, which only the program knows how to find and to equip.
pub trait Agents: Send + Sync {
    /// Options of the environment that the agent of a run was trained in, and its id.
    ///
    /// # Errors
    /// One line that names the run and the remedy.
    fn options(&self, run: &Path) -> Result<(String, EnvOptions), String>;
    /// The agent of a run for one world like this one: the newest checkpoint, or the best.
    ///
    /// # Errors
    /// As above.
    fn load(&self, run: &Path, best: bool, choice: Choice, env: &Env) -> Result<Agent, String>;
    /// Names of agents that come with the program.
    fn zoo(&self) -> Vec<String>;
    /// The directory of one of those.
    ///
    /// # Errors
    /// As above.
    fn zoo_run(&self, name: &str) -> Result<PathBuf, String>;
    /// What those are worth.
    fn zoo_results(&self) -> Vec<ZooResult> {
        Vec::new()
    }
}

/// What the routes share.
pub(crate) struct Shared {
    pub token: Option<String>,
    pub episodes: PathBuf,
    pub agents: Arc<dyn Agents>,
    pub edit: bool,
    pub catalogue: Mutex<Catalogue>,
    pub stages: Stages,
    pub shows: Arc<Semaphore>,
    pub long_jobs: Arc<Semaphore>,
}
