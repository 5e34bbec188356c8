//! The socket and the routes.

use crate::answer::{aside, json_of, refusal};
use crate::catalogue::Catalogue;
use crate::door::{CONNECTIONS, Door};
use crate::shared::{Agents, Shared};
use crate::stages::Stages;
use crate::{episodes, guard, pages, runs, show};
use axum::Router;
use axum::extract::{DefaultBodyLimit, State};
use axum::http::{StatusCode, Uri};
use axum::response::Response;
use axum::routing::{get, post};
use hasard_envs::{EnvId, RuleSet};
use serde_json::{Value, json};
use std::io;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, OnceLock};
use tokio::sync::Semaphore;

/// Viewers and players at a time.
const SHOWS: usize = 64;
/// Fixed policies that the page offers; a link may name any other.
const POLICIES: [&str; 6] =
    ["random", "sticky:4", "sticky:10", "noop", "hold:MOVE_FORWARD", "hold:MOVE_FORWARD+SPEED"];
/// Films and reports in the making at a time: each keeps a core busy.
const LONG_JOBS: usize = 2;

/// What is served, and to whom.
pub struct Settings {
    /// Address to listen at.
    pub address: SocketAddr,
    /// What a visitor must know; `None` lets everybody in who reaches the address.
    pub token: Option<String>,
    /// Folders in which runs are looked for.
    pub folders: Vec<PathBuf>,
    /// Folder in which played episodes are kept.
    pub episodes: PathBuf,
    /// Trained agents.
    pub agents: Arc<dyn Agents>,
    /// Whether a visitor may write notes, and move runs to the trash.
    pub edit: bool,
}

/// A server that listens.
pub struct Server {
    runtime: tokio::runtime::Runtime,
    door: Door,
    address: SocketAddr,
    shared: Arc<Shared>,
}

impl Server {
    /// Begins to listen.
    ///
    /// # Errors
    /// When the address is taken or not ours.
    pub fn bind(settings: Settings) -> io::Result<Server> {
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(2)
            .max_blocking_threads(8)
            .enable_all()
            .build()?;
        let listener = runtime.block_on(tokio::net::TcpListener::bind(settings.address))?;
        let address = listener.local_addr()?;
        let shared = Shared {
            token: settings.token,
            episodes: settings.episodes,
            agents: settings.agents,
            edit: settings.edit,
            catalogue: Mutex::new(Catalogue::new(settings.folders)),
            stages: Stages::default(),
            shows: Arc::new(Semaphore::new(SHOWS)),
            long_jobs: Arc::new(Semaphore::new(LONG_JOBS)),
        };
        let door = Door { listener, places: Arc::new(Semaphore::new(CONNECTIONS)) };
        Ok(Server { runtime, door, address, shared: Arc::new(shared) })
    }

    /// Where it listens.
    #[must_use]
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Answers until the process ends.
    ///
    /// # Errors
    /// Never in practice: what a connection brings ends that connection alone.
    pub fn run(self) -> io::Result<()> {
        let routes = Router::new()
            .route("/api/envs", get(envs))
            .route("/api/runs", get(runs::list))
            .route("/api/run", get(runs::detail))
            .route("/api/edit", post(runs::edit).layer(DefaultBodyLimit::max(16 << 10)))
            .route("/api/settings", get(runs::settings))
            .route("/api/curves", get(runs::curves))
            .route("/api/metrics", get(runs::reported))
            .route("/api/compare", get(runs::compare))
            .route("/api/heatmap", get(runs::heatmap))
            .route("/api/automap", get(runs::automap))
            .route("/api/report", get(runs::report))
            .route("/api/best", get(episodes::best))
            .route("/api/episode", get(episodes::download))
            .route("/api/film", get(show::film))
            .route("/api/episodes", get(show::episodes))
            .route("/api/watch", get(show::watch))
            .route("/api/play", get(show::play))
            .fallback(page)
            .layer(DefaultBodyLimit::max(1024))
            .layer(axum::middleware::from_fn_with_state(Arc::clone(&self.shared), guard::guard))
            .with_state(Arc::clone(&self.shared));
        self.runtime.block_on(self.door.serve(routes))
    }
}

async fn page(uri: Uri) -> Response {
    pages::page(uri.path())
        .unwrap_or_else(|| refusal(StatusCode::NOT_FOUND, "there is no such page"))
}

/// Environments, fixed policies and zoo agents: what can be watched and played without a run.
async fn envs(State(shared): State<Arc<Shared>>) -> Result<Response, Response> {
    static ENVS: OnceLock<Value> = OnceLock::new();
    let envs = aside(|| {
        ENVS.get_or_init(|| {
            let of = |id: EnvId| json!({ "id": id.to_string(), "budget": id.scenario.safety_budget(RuleSet::Paper) });
            EnvId::every().map(of).collect()
        })
    })
    .await?;
    Ok(json_of(
        &json!({ "envs": envs, "policies": POLICIES, "zoo": shared.agents.zoo(), "edit": shared.edit }),
    ))
}
