//! Finding runs and recorded episodes below the folders that a user names.

use super::{EpisodeResult, FRAME_SKIP, Run, Warning};
use super::{read_episode_lines, read_text, sorted_files, warning_of};
use hasard_media::episode::EpisodeFile;
use hasard_media::files::{NO_FILE, what_lies_at};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// How deep runs are looked for below a named folder: sweeps put them at `sweep/env/algo/seed`.
const MAX_DEPTH: usize = 8;

/// Where episodes come from.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Origin {
    /// A file of rollouts, a line an episode.
    Rollout,
    /// Episode files, as people's play is.
    Recorded,
    /// Episode files that are to be witnesses: their names, or their folder's, begin with
    /// `witness`.
    Witness,
}

/// Who played what.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct PlayerKey {
    /// The player's name.
    pub player: String,
    /// Id of the environment.
    pub env: String,
    /// Options that are not the usual ones, as text.
    pub options: String,
    /// Where the episodes come from.
    pub origin: Origin,
}

/// What was found.
#[derive(Debug, Default)]
pub struct Found {
    /// Training runs, in the order of their paths.
    pub runs: Vec<Run>,
    /// Number of run directories that are damaged beyond reading; a warning names each.
    pub damaged: usize,
    /// Episodes of humans and other players.
    pub players: BTreeMap<PlayerKey, Vec<EpisodeResult>>,
    /// What was passed over.
    pub warnings: Vec<Warning>,
}

impl Found {
    /// How much of anything was found.
    fn count(&self) -> usize {
        let episodes = self.players.values().map(Vec::len).sum::<usize>();
        self.runs.len() + episodes + self.warnings.len()
    }
}

/// Looks through folders for run directories (those with a `config.json`) and episode files of
/// humans, and reads files of episodes (`hasard rollout --json > random.jsonl`), whose name becomes
/// the player's.
///
/// # Errors
/// When a named path does not exist or cannot be read, when nothing at all is found, or runs of which
/// none can be read.
pub fn discover(paths: &[PathBuf]) -> Result<Found, String> {
    let mut found = Found::default();
    let (mut seen, mut empty) = (Seen::new(), Vec::new());
    for path in paths {
        let Some(kind) = what_lies_at(path).map_err(|error| error.to_string())? else {
            return Err(format!(
                "{}: no such file or folder; name the run directories to report on",
                path.display()
            ));
        };
        if kind.is_dir() {
            let known = (found.count(), seen.len());
            look(path, 0, &mut found, &mut seen);
            // A folder that another one holds was looked at with it.
            if found.count() == known.0 && seen.len() > known.1 {
                let problem = "no run and no episode is here".to_owned();
                empty.push(Warning { path: path.clone(), line: 0, problem });
            }
        } else if kind.is_file() {
            if !is_new(path, &mut seen) {
                continue;
            }
            match path.extension().and_then(|extension| extension.to_str()) {
                Some("episode") => read_episode_file(path, &mut found),
                Some("jsonl") => read_rollout(path, &mut found),
                _ => {
                    return Err(format!(
                        "{}: is neither a folder nor a .jsonl of episodes nor a .episode file",
                        path.display()
                    ));
                }
            }
        } else {
            return Err(format!("{}: {NO_FILE}", path.display()));
        }
    }
    found.runs.sort_by(|a, b| a.path.cmp(&b.path));
    found.warnings.sort();
    found.warnings.dedup();
    let nothing = found.runs.is_empty() && found.players.is_empty();
    if nothing || (found.runs.is_empty() && found.damaged > 0) {
        let names: Vec<String> = paths.iter().map(|path| path.display().to_string()).collect();
        let names = names.join(" ");
        let first =
            found.warnings.first().map_or_else(String::new, |warning| format!(" ({warning})"));
        return Err(if found.damaged > 0 {
            format!(
                "no run below {names} can be read{first}; name whole ones, or episodes by their files"
            )
        } else {
            format!(
                "no run directory (a folder with config.json) and no episode below {names}{first}; name the folder that `hasard train --out` wrote"
            )
        });
    }
    found.warnings.append(&mut empty);
    Ok(found)
}

/// Where `hasard serve --edit` moves the runs that are thrown away. They count nowhere, unless the
/// folder itself is named.
pub const TRASH: &str = ".trash";

/// Files and folders that were looked at, by their real paths: what is named twice, by a link too,
/// counts once.
type Seen = BTreeSet<PathBuf>;

fn is_new(path: &Path, seen: &mut Seen) -> bool {
    seen.insert(path.canonicalize().unwrap_or_else(|_| path.to_owned()))
}

fn look(folder: &Path, depth: usize, found: &mut Found, seen: &mut Seen) {
    if !is_new(folder, seen) {
        return;
    }
    let settings = folder.join("config.json");
    // Whatever it is makes a run, if a damaged one: what lies beside it is no play of anybody's.
    let is_run = match what_lies_at(&settings) {
        _ if settings.is_symlink() => true,
        Ok(kind) => kind.is_some(),
        Err(error) => return found.warnings.push(warning_of(&settings, &error)),
    };
    if is_run {
        match Run::read(folder, &mut found.warnings) {
            Ok(run) => found.runs.extend(run.by_task()),
            Err(warning) => {
                found.damaged += 1;
                found.warnings.push(warning);
            }
        }
        return;
    }
    if depth == MAX_DEPTH {
        return;
    }
    if let Err(error) = std::fs::read_dir(folder) {
        let problem = format!("cannot be listed: {error}; passed over");
        return found.warnings.push(Warning { path: folder.to_owned(), line: 0, problem });
    }
    for path in sorted_files(folder) {
        if path.file_name().is_some_and(|name| name == TRASH) {
            continue;
        }
        if path.is_dir() {
            look(&path, depth + 1, found, seen);
        } else if !is_new(&path, seen) {
            // It was read by another name.
        } else if path.extension().is_some_and(|extension| extension == "episode") {
            read_episode_file(&path, found);
        } else if holds_episodes(&path) {
            read_rollout(&path, found);
        }
    }
}

fn read_episode_file(path: &Path, found: &mut Found) {
    let problem = match EpisodeFile::read(path) {
        Ok(file) => {
            let header = file.header();
            if let Some(outcome) = &header.outcome {
                let is = |key: &str| header.options.get(key).is_some_and(|value| value == "true");
                let result = EpisodeResult {
                    env: header.env.clone(),
                    episode_return: outcome.episode_return,
                    cost: outcome.cost,
                    costs: Vec::new(),
                    stats: Vec::new(),
                    rules: header.options.get("rules").cloned(),
                    hard: header.options.get("hard").map(|hard| hard == "true"),
                    full_actions: is("full-actions"),
                    frame_skip: header
                        .options
                        .get("frame-skip")
                        .and_then(|tics| tics.parse().ok())
                        .unwrap_or(FRAME_SKIP),
                    maps: header.options.contains_key("maps"),
                    early_creatures: is("early-creatures"),
                    length: Some(f64::from(header.steps)),
                    seed: None,
                };
                let usual = |key: &str, value: &str| {
                    matches!((key, value), ("hard" | "full-actions", "false") | ("frame-skip", "4"))
                };
                let given = header
                    .options
                    .iter()
                    .filter(|(key, value)| !usual(key, value) && !key.starts_with("scenario"));
                let options: Vec<String> =
                    given.map(|(key, value)| format!("{key} {value}")).collect();
                let key = PlayerKey {
                    player: header.player.clone(),
                    env: header.env.clone(),
                    options: options.join(", "),
                    origin: origin_of(path),
                };
                found.players.entry(key).or_default().push(result);
                return;
            }
            "ends in the midst of an episode; left out".to_owned()
        }
        Err(error) => error.to_string().replacen(&format!("{}: ", path.display()), "", 1),
    };
    found.warnings.push(Warning { path: path.to_owned(), line: 0, problem });
}

/// An episode file's origin, by its name and its folder's.
fn origin_of(path: &Path) -> Origin {
    let begins = |part: Option<&std::ffi::OsStr>| {
        part.and_then(|name| name.to_str())
            .is_some_and(|name| name.to_ascii_lowercase().starts_with("witness"))
    };
    if begins(path.file_name()) || begins(path.parent().and_then(Path::file_name)) {
        Origin::Witness
    } else {
        Origin::Recorded
    }
}

/// Whether a file beside the runs is one of rollouts: its first line is an episode.
fn holds_episodes(path: &Path) -> bool {
    use std::io::{BufRead, Read};
    let rollouts = path.extension().is_some_and(|extension| extension == "jsonl");
    // A pipe that nobody writes to would be waited for.
    if !rollouts || !path.is_file() {
        return false;
    }
    let Ok(file) = std::fs::File::open(path) else { return false };
    let mut line = String::new();
    let read = || std::io::BufReader::new(file.take(1 << 16)).read_line(&mut line).is_ok();
    read() && read_episode_lines(&line, path, &mut Vec::new()).len() == 1
}

fn read_rollout(path: &Path, found: &mut Found) {
    let text = match read_text(path) {
        Ok(text) => text,
        Err(warning) => return found.warnings.push(warning),
    };
    let player = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or("rollout").to_owned();
    for episode in read_episode_lines(&text, path, &mut found.warnings) {
        let hard = episode.hard.filter(|hard| *hard).map(|_| "hard true".to_owned());
        let rules = episode.rules.as_ref().map(|rules| format!("rules {rules}"));
        let options = hard.into_iter().chain(rules).collect::<Vec<_>>().join(", ");
        let key = PlayerKey {
            player: player.clone(),
            env: episode.env.clone(),
            options,
            origin: Origin::Rollout,
        };
        found.players.entry(key).or_default().push(episode);
    }
}
