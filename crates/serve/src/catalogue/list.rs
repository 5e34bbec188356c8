//! Which runs there are and how far they are.

use super::columns::Columns;
use super::evaluated::{self, Stamped};
use super::files::{Stamp, at_once, is_held};
use super::notes::{Notes, TRASH};
use hasard_media::files::open_regular;
use hasard_report::run::Config;
use serde_json::{Map, Value, json};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

/// How deep runs are looked for below a folder: sweeps put them at `sweep/env/algo/seed`.
const MAX_DEPTH: usize = 8;
/// Runs that are listed at most.
const MAX_RUNS: usize = 20_000;
/// Time between two looks at how far the runs are, and between two searches for new ones.
const LOOK_EVERY: Duration = Duration::from_millis(700);
const SEARCH_EVERY: Duration = Duration::from_secs(2);
/// A run that wrote something this lately runs, though nobody here holds its lock: another machine
/// may train it, or its folder is copied from there again and again.
const ALIVE: Duration = Duration::from_secs(90);
/// Bytes at a file's end among which its last row is looked for.
const TAIL: u64 = 32 << 10;
/// Runs whose columns are kept in memory.
const KEPT: usize = 200;
/// What the list shows of a run's last row.
const LISTED: [&str; 10] = [
    "frames",
    "fps",
    "wall_s",
    "episodes",
    "return_mean",
    "cost_mean",
    "length_mean",
    "budget",
    "multiplier",
    "multipliers",
];

struct Run {
    path: PathBuf,
    name: String,
    config: Config,
    /// The file that the settings were read from, as it was then.
    settings: Stamp,
    /// Number of the change that brought these settings.
    settled: u64,
    metrics: Stamp,
    last: Map<String, Value>,
    /// What its selected checkpoint is worth, once it has one.
    evaluation: Stamped,
    /// What people say of it.
    notes: Notes,
    /// The folder of those that are served in which it lies.
    top: PathBuf,
    /// How far it is, in a word.
    state: &'static str,
    /// Number of the change that made it what it is.
    change: u64,
}

/// The settings of a run that a search came upon, as they are now.
struct Found {
    config: PathBuf,
    settings: Stamp,
    /// The folder of those that are served in which it lies.
    top: PathBuf,
}

impl Found {
    fn folder(&self) -> &Path {
        self.config.parent().unwrap_or(&self.config)
    }
}

/// All runs below some folders.
pub(crate) struct Catalogue {
    folders: Vec<PathBuf>,
    runs: BTreeMap<String, Run>,
    kept: HashMap<String, (Columns, u64)>,
    uses: u64,
    /// Number of the last change. It begins with the time in milliseconds, so that numbers of a
    /// server that ran before are all smaller than any of this one.
    changes: u64,
    /// Number of the last change since which a page that adds up changes is right: one that runs
    /// went with starts anew.
    whole_since: u64,
    looked: Option<Instant>,
    searched: Option<Instant>,
}

impl Catalogue {
    pub fn new(folders: Vec<PathBuf>) -> Catalogue {
        // Links in the given names are the user's; links below them are not followed.
        let folders =
            folders.into_iter().map(|folder| folder.canonicalize().unwrap_or(folder)).collect();
        let time = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
        let begun = time.as_millis() as u64;
        Catalogue {
            whole_since: begun,
            folders,
            runs: BTreeMap::new(),
            kept: HashMap::new(),
            uses: 0,
            changes: begun,
            looked: None,
            searched: None,
        }
    }

    /// Finds which runs there are now and how far they are, unless that was done just now.
    pub fn refresh(&mut self) {
        let due = |last: Option<Instant>, every| last.is_none_or(|last| last.elapsed() >= every);
        if due(self.searched, SEARCH_EVERY) {
            let there = self.search();
            let known = self.runs.len();
            self.runs.retain(|id, _| there.contains(id));
            self.kept.retain(|id, _| there.contains(id));
            if self.runs.len() < known {
                self.changes += 1;
                self.whole_since = self.changes;
            }
            self.searched = Some(Instant::now());
        }
        if due(self.looked, LOOK_EVERY) {
            let now = SystemTime::now();
            let changed = at_once(self.runs.values_mut().collect(), |run| run.look(now));
            for (run, _) in self.runs.values_mut().zip(changed).filter(|(_, changed)| *changed) {
                self.changes += 1;
                run.change = self.changes;
            }
            self.looked = Some(Instant::now());
        }
    }

    /// Takes up runs that are new or have other settings; gives the ids of all that are there.
    fn search(&mut self) -> BTreeSet<String> {
        let mut found = Vec::new();
        self.folders.iter().for_each(|top| folders_of_runs(top, top, 0, &mut found));
        let same = |one: &Found| {
            self.runs.get(&id_of(one.folder())).is_some_and(|run| run.settings == one.settings)
        };
        let (same, fresh): (Vec<Found>, Vec<Found>) = found.into_iter().partition(same);
        let mut there: BTreeSet<String> = same.iter().map(|one| id_of(one.folder())).collect();
        let fresh = fresh.into_iter().take(MAX_RUNS).collect();
        let read =
            at_once(fresh, |one: Found| Config::read(&one.config).map(|config| (one, config)));
        for (one, config) in read.into_iter().flatten() {
            let (folder, top) = (one.folder(), &one.top);
            let id = id_of(folder);
            if !self.runs.contains_key(&id) && self.runs.len() >= MAX_RUNS {
                continue;
            }
            let name = folder.strip_prefix(top).ok().filter(|name| !name.as_os_str().is_empty());
            let name = name
                .or_else(|| folder.file_name().map(Path::new))
                .unwrap_or(folder)
                .display()
                .to_string();
            self.changes += 1;
            let run = Run {
                path: folder.to_owned(),
                name,
                config,
                settings: one.settings,
                settled: self.changes,
                // Of no file: the next look finds out how far it is.
                metrics: Stamp { bytes: u64::MAX, ..Stamp::NONE },
                last: Map::new(),
                evaluation: Stamped::default(),
                notes: Notes::default(),
                top: top.clone(),
                state: "stopped",
                change: self.changes,
            };
            self.runs.insert(id.clone(), run);
            there.insert(id);
            self.looked = None;
        }
        there
    }

    /// The directory of a run.
    pub fn path(&self, id: &str) -> Option<PathBuf> {
        self.runs.get(id).map(|run| run.path.clone())
    }

    /// A run's directory, its name, and the folder of those that are served in which it lies.
    pub fn place(&self, id: &str) -> Option<(PathBuf, String, PathBuf)> {
        self.runs.get(id).map(|run| (run.path.clone(), run.name.clone(), run.top.clone()))
    }

    /// Something was written or moved: the next look is not put off.
    pub fn look_again(&mut self) {
        (self.looked, self.searched) = (None, None);
    }

    /// The runs that changed after a number of changes, and that number now.
    pub fn changed_since(&self, since: u64) -> Value {
        let whole = since < self.whole_since;
        let news = self.runs.iter().filter(|(_, run)| whole || run.change > since);
        let (mut runs, mut experiments) = (Vec::new(), Map::new());
        for (id, run) in news {
            let mut row = run.as_json(id);
            let experiment = run.experiment();
            row["experiment"] = json!(experiment);
            // Runs that differ in their seed alone share their settings: they are sent once.
            experiments.entry(experiment).or_insert_with(|| json!(run.config.options));
            runs.push(row);
        }
        let folders: Vec<String> =
            self.folders.iter().map(|folder| folder.display().to_string()).collect();
        json!({ "change": self.changes, "whole": whole, "runs": runs, "experiments": experiments, "count": self.runs.len(), "folders": folders })
    }

    /// What some runs are worth, in the order of the ids.
    pub fn results_of(&self, ids: &[String]) -> Vec<Value> {
        let known = ids.iter().filter_map(|id| Some((id, self.runs.get(id)?)));
        let rows = known.map(|(id, run)| {
            let mut row = run.as_json(id);
            row["experiment"] = json!(run.experiment());
            row
        });
        rows.collect()
    }

    /// What each run ended with lately, for the table of the best.
    pub fn results(&self) -> Vec<Value> {
        let row = |(id, run): (&String, &Run)| {
            let mut row = run.as_json(id);
            row["own"] = evaluated::by_the_task(run.evaluation.found.as_ref(), &run.config);
            row
        };
        self.runs.iter().map(row).collect()
    }

    /// A run's columns as far as its file goes now.
    pub fn columns(&mut self, id: &str) -> Option<&Columns> {
        let path = self.runs.get(id)?.path.join("metrics.jsonl");
        if !self.kept.contains_key(id)
            && self.kept.len() >= KEPT
            && let Some(oldest) =
                self.kept.iter().min_by_key(|(_, (_, used))| *used).map(|(id, _)| id.clone())
        {
            self.kept.remove(&oldest);
        }
        self.uses += 1;
        let (columns, used) = self.kept.entry(id.to_owned()).or_default();
        *used = self.uses;
        // A run without rows has no columns yet.
        let _ = columns.catch_up(&path);
        Some(columns)
    }
}

impl Run {
    /// Looks at the end of its rows; whether anything changed.
    fn look(&mut self, now: SystemTime) -> bool {
        let path = self.path.join("metrics.jsonl");
        let metrics = Stamp::of(&path).unwrap_or(Stamp::NONE);
        if metrics != self.metrics {
            // Without rows it is a run that has none: those of one that was here before are not its
            // own.
            self.last = last_row(&path, metrics.bytes).unwrap_or_default();
        }
        let lately = || {
            metrics.bytes > 0 && now.duration_since(metrics.modified).unwrap_or_default() < ALIVE
        };
        // A long evaluation writes no rows, and a training that has its frames still closes.
        let state = if self.config.frames.is_some_and(|frames| self.frames() >= frames) {
            if is_held(&self.path) { "evaluating" } else { "done" }
        } else if lately() || is_held(&self.path) {
            "running"
        } else {
            "stopped"
        };
        let evaluated = self.evaluation.look(&self.path);
        let evaluated = self.notes.look(&self.path) || evaluated;
        let changed = evaluated || (metrics, state) != (self.metrics, self.state);
        (self.metrics, self.state) = (metrics, state);
        changed
    }

    fn frames(&self) -> f64 {
        self.last.get("frames").and_then(Value::as_f64).unwrap_or(0.0)
    }

    fn as_json(&self, id: &str) -> Value {
        let config = &self.config;
        let last: Map<String, Value> = LISTED
            .iter()
            .filter_map(|name| Some(((*name).to_owned(), self.last.get(*name)?.clone())))
            .collect();
        json!({
            "id": id, "settled": self.settled, "name": self.name, "env": config.env, "algo": config.algo, "seed": config.seed.to_string(),
            "budget": config.safety_budget, "preset": config.options.get("preset"), "total": config.frames, "state": self.state, "last": last,
            "notes": self.notes.as_json(),
            "evaluation": self.evaluation.found.as_ref().map(|one| evaluated::as_json(one, config)),
        })
    }

    /// Names the experiment: all that the configuration says but for the seed.
    fn experiment(&self) -> String {
        let config = &self.config;
        let mut hasher = DefaultHasher::new();
        format!(
            "{:?}",
            (
                &config.env,
                &config.algo,
                config.frames,
                &config.constraints,
                config.cost_scale,
                &config.options
            )
        )
        .hash(&mut hasher);
        format!("{:016x}", hasher.finish())
    }
}

/// Runs in a folder and below it, but those in the trash.
fn folders_of_runs(top: &Path, folder: &Path, depth: usize, found: &mut Vec<Found>) {
    let config = folder.join("config.json");
    if let Some(settings) = Stamp::of(&config) {
        found.push(Found { config, settings, top: top.to_owned() });
        return;
    }
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let trash = entry.file_name() == TRASH;
        if !trash && depth < MAX_DEPTH && entry.file_type().is_ok_and(|kind| kind.is_dir()) {
            folders_of_runs(top, &entry.path(), depth + 1, found);
        }
    }
}

/// The last whole row of a file.
fn last_row(path: &Path, bytes: u64) -> Option<Map<String, Value>> {
    let mut file = open_regular(path).ok()?;
    file.seek(SeekFrom::Start(bytes.saturating_sub(TAIL))).ok()?;
    let mut tail = Vec::new();
    file.take(TAIL).read_to_end(&mut tail).ok()?;
    let end = tail.iter().rposition(|byte| *byte == b'\n')?;
    tail[..end]
        .split(|byte| *byte == b'\n')
        .rev()
        .find_map(|line| serde_json::from_slice(line).ok())
}

/// A name of a path that says nothing of it and stays the same.
fn id_of(path: &Path) -> String {
    let mut hasher = DefaultHasher::new();
    path.hash(&mut hasher);
    format!("{:016x}", hasher.finish())
}
