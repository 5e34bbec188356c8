//! `config.json`: what was trained and how.
//!
//! Long because it reads the settings of every version of the program.

use super::own::OwnTasks;
use super::{Constraint, Warning};
use crate::escape::one_line;
use hasard_envs::{RuleSet, Scenario};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// Keys, whole or by their beginning, that say where, when and on what machine a run was made or
/// what it writes, and so do not distinguish experiments. (The seed distinguishes runs, but not
/// experiments: runs that differ in it alone are averaged.)
const NOT_IDENTITY: &[&str] = &[
    "seed",
    "out",
    "device",
    "threads",
    "version",
    "env.scenario_file.path",
    "env.scenario_file.text",
    "program",
    "commit",
    "command",
    "host",
    "started",
    "reporting",
    "evaluation",
    "sampling.samplers",
    "sampling.world_threads",
    "sampling.groups",
    "learning.threads",
];

/// Keys that are always shown beside a result if they are not at their usual value. Of the others,
/// such as the learning rate, only those are shown that distinguish what would otherwise look the
/// same.
pub const SHOWN: [&str; 19] = [
    "rules",
    "preset",
    "hard",
    "full_actions",
    "observation",
    "frame_skip",
    "frame_stack",
    "safety_budget",
    "constraints",
    "cost_scale",
    "init_from",
    "curriculum",
    "changed",
    "tasks",
    // What makes another task, or another picture, of the same id.
    "maps",
    "iwad",
    "early_creatures",
    "published_depth",
    "published_colours",
];

/// Where the trainer keeps a value, and other spellings, with the name that this program has for
/// it.
const SPELLINGS: &[(&str, &[&str])] = &[
    ("env", &["env.id"]),
    ("algo", &["algorithm"]),
    ("cost_scale", &["algorithm_settings.penalty_scale"]),
    ("rules", &["env.rules"]),
    ("hard", &["env.hard"]),
    ("full_actions", &["env.full_actions"]),
    ("observation", &["env.observation"]),
    ("frame_skip", &["env.frame_skip"]),
    ("frame_stack", &["env.frame_stack"]),
    ("maps", &["env.maps"]),
    ("iwad", &["env.iwad"]),
    ("early_creatures", &["env.early_creatures"]),
    ("published_depth", &["env.published_depth"]),
    ("published_colours", &["env.published_colours"]),
];

/// The environments' own, as files of results have it: the type of a number in JSON.
pub const FRAME_SKIP: u64 = hasard_envs::FRAME_SKIP as u64;

/// What was trained and how. Everything but the seed is the experiment's identity: runs are
/// averaged only if all of it is equal, known key or not.
#[derive(Clone, PartialEq, Debug)]
pub struct Config {
    /// Id of the environment.
    pub env: String,
    /// The file of a task of one's own, where the run says.
    pub file: Option<String>,
    /// The tasks of one's own among those that it was trained on.
    pub own: OwnTasks,
    /// Name of the scenario, as in the id.
    pub scenario: String,
    /// Its level; the last one of a curriculum.
    pub level: u32,
    /// The algorithm, as the run spells it.
    pub algo: String,
    /// The seed.
    pub seed: u64,
    /// Cost that an episode may have in all; the scenario's own if only named terms are
    /// constrained.
    pub safety_budget: f64,
    /// What costs are held against: each constraint, by its own term.
    pub constraints: Vec<Constraint>,
    /// What PPOCost multiplies costs by before it takes them off the reward; 1 for the others.
    pub cost_scale: f64,
    /// Frames that were asked for, if the run says.
    pub frames: Option<f64>,
    /// Frames that were asked for at first, of a run that was resumed to go on beyond them.
    pub extended_from: Option<f64>,
    /// Every other key that may change results, as text; nested keys are joined by dots.
    /// `safety_budget` is among them only if it is not the scenario's own.
    pub options: BTreeMap<String, String>,
    /// The version of the program that made it, if the run says.
    pub version: Option<String>,
    /// How its checkpoints were judged and one of them selected, as text. It does not change what
    /// is learned, and so is no part of the identity.
    pub selection: BTreeMap<String, String>,
}

impl Config {
    /// Reads the file.
    ///
    /// # Errors
    /// When it cannot be read, is no JSON object, or lacks `env`, `algo` or `seed`.
    pub fn read(path: &Path) -> Result<Config, Warning> {
        Config::parse(&super::read_text(path)?).map_err(|problem| Warning {
            path: path.to_owned(),
            line: 0,
            problem,
        })
    }

    /// Understands the text of the file.
    ///
    /// # Errors
    /// As [`Config::read`], without the path.
    pub fn parse(text: &str) -> Result<Config, String> {
        Config::understand(text).map_err(|problem| one_line(&problem))
    }

    fn understand(text: &str) -> Result<Config, String> {
        let value: Value = serde_json::from_str(text)
            .map_err(|e| format!("is no JSON ({e}); restore it or leave the run out"))?;
        let Value::Object(object) = &value else {
            return Err("is not a JSON object; restore it or leave the run out".into());
        };
        let mut flat = BTreeMap::new();
        let mut constraints = Vec::new();
        let mut extended_from = None;
        for (key, value) in object {
            if key == "changes" {
                extended_from = read_changes(value, &mut flat);
            } else if key == "constraints" {
                constraints = read_constraints(value, &mut flat)?;
            } else if key == "init_from" {
                flat.extend(
                    read_init_from(value, object.get("seed").unwrap_or(&Value::Null))
                        .map(|short| (key.clone(), short)),
                );
            } else if key == "curriculum"
                && value.as_array().is_some_and(|lessons| lessons.iter().all(Value::is_object))
            {
                read_curriculum(value, &mut flat)?;
            } else {
                flatten(key, value, &mut flat);
            }
        }
        let mut options = BTreeMap::new();
        for (key, value) in flat {
            let name = SPELLINGS
                .iter()
                .find(|(_, others)| others.contains(&key.as_str()))
                .map_or(key.as_str(), |(name, _)| name);
            options.insert(name.to_owned(), value);
        }
        let mut take = |key: &str| {
            options.remove(key).ok_or_else(|| {
                format!("lacks the key \"{key}\"; is it the config.json of a hasard training run?")
            })
        };
        let env = take("env")?;
        let own = OwnTasks::read(object.get("env").unwrap_or(&Value::Null));
        let usual_of_task = |one: &Constraint| {
            let task = one.term.as_deref().filter(|term| env.split(',').any(|id| id == *term));
            task.is_some_and(|task| {
                one.budget == own.budget(&scenario_and_level(task).0, RuleSet::Paper)
            })
        };
        let algo = take("algo")?;
        let seed = take("seed")?;
        let seed = seed
            .parse()
            .map_err(|_| format!("has the seed {seed}, which is no whole number from 0 on"))?;
        // A damped multiplier of older versions was a PID controller, whatever it was called.
        let damping = options
            .remove("algorithm_settings.multiplier_damping")
            .and_then(|damping| damping.parse::<f64>().ok());
        let algo = match algo.as_str() {
            "PPOLag" if damping > Some(0.0) => "PPOPID".into(),
            "TRPOLag" if damping > Some(0.0) => "TRPOPID".into(),
            _ => algo,
        };
        // The budgets that several tasks have of themselves need not be said.
        if constraints.iter().all(usual_of_task) {
            options.remove("constraints");
        }
        let (scenario, mut level) = scenario_and_level(&env);
        // A curriculum ends in its last level, and that is what its results are results of.
        if let Some(last) = options
            .get("curriculum")
            .and_then(|levels| levels.rsplit(',').next()?.split(':').next()?.trim().parse().ok())
        {
            level = last;
        }
        let file = options.get("env.scenario_file.path").cloned();
        let version = options.get("version").cloned();
        let judged = options.iter().filter(|(key, _)| below(key, "evaluation"));
        let selection = judged.map(|(key, value)| (key.clone(), value.clone())).collect();
        options.retain(|key, _| !NOT_IDENTITY.iter().any(|beginning| below(key, beginning)));
        let rules = rule_set(options.get("rules"));
        let hard = options.get("hard").is_some_and(|hard| hard == "true");
        let own_budget = if hard { 0.0 } else { own.budget(&scenario, rules) };
        let given = options.get("safety_budget").map(|text| text.parse::<f64>());
        let safety_budget = match given {
            None => own_budget,
            Some(Ok(budget)) if budget.is_finite() && budget >= 0.0 => budget,
            Some(_) => {
                return Err(format!(
                    "has the safety_budget {}, which is no cost",
                    options["safety_budget"]
                ));
            }
        };
        // The budgets of the paper (50) and of the released code (5) for Armament Burden are both
        // "the scenario's own".
        let of_paper = own.budget(&scenario, RuleSet::Paper);
        if safety_budget == own_budget || (!hard && safety_budget == of_paper) {
            options.remove("safety_budget");
        }
        let known = Scenario::every().into_iter().find(|known| known.name == scenario);
        let own_scale =
            known.map_or(1.0, |known| known.penalty_scales[rules as usize][usize::from(hard)]);
        let scale_applies = algo.eq_ignore_ascii_case("PPOCost");
        let cost_scale = match options
            .get("cost_scale")
            .filter(|_| scale_applies)
            .map(|text| text.parse::<f64>())
        {
            None => {
                if scale_applies {
                    own_scale
                } else {
                    1.0
                }
            }
            Some(Ok(scale)) if scale.is_finite() => scale,
            Some(_) => {
                return Err(format!(
                    "has the cost_scale {}, which is no number",
                    options["cost_scale"]
                ));
            }
        };
        if cost_scale == own_scale || !scale_applies {
            options.remove("cost_scale");
        }
        // What is left at its usual value need not be shown, and older runs may lack the key.
        let frame_skip = FRAME_SKIP.to_string();
        for (key, usual) in [
            ("hard", "false"),
            ("full_actions", "false"),
            ("observation", "rgb"),
            ("frame_skip", frame_skip.as_str()),
            ("frame_stack", "1"),
            ("early_creatures", "false"),
            ("published_depth", "false"),
            ("published_colours", "false"),
            ("learning.products", "float32"),
            ("learning.recompute_advantages", "false"),
            ("learning.value_phase_passes", "6"),
            ("learning.value_phase_clone", "1"),
            ("learning.auxiliary_depth", "0"),
            ("learning.auxiliary_labels", "0"),
            ("network.policy_scale", "1"),
            ("network.mirror", "false"),
            ("learning.advantage_floor", "0"),
            ("budget_margin", "0"),
        ] {
            if options.get(key).is_some_and(|value| value.eq_ignore_ascii_case(usual)) {
                options.remove(key);
            }
        }
        if constraints.is_empty() {
            constraints.push(Constraint { term: None, budget: safety_budget });
        }
        let frames = options
            .remove("frames")
            .and_then(|text| text.parse::<f64>().ok())
            .filter(|frames| frames.is_finite());
        Ok(Config {
            env,
            file,
            own,
            scenario,
            level,
            algo,
            seed,
            safety_budget,
            constraints,
            cost_scale,
            frames,
            extended_from,
            options,
            version,
            selection,
        })
    }

    /// The budget of the whole cost, if that is constrained.
    #[must_use]
    pub fn budget(&self) -> Option<f64> {
        self.constraints.iter().find(|one| one.term.is_none()).map(|one| one.budget)
    }

    /// What a command takes for the environment: its id, or the file of a task of one's own.
    #[must_use]
    pub fn task(&self) -> &str {
        self.file.as_deref().unwrap_or(&self.env)
    }

    /// The rule set that it was run under, if the file says.
    #[must_use]
    pub fn rules(&self) -> Option<&str> {
        self.options.get("rules").map(String::as_str)
    }

    /// The budget that a scenario has in this run if nobody asks for another.
    #[must_use]
    pub fn usual_budget(&self, scenario: &str) -> f64 {
        if self.hard() {
            0.0
        } else {
            self.own.budget(scenario, rule_set(self.options.get("rules")))
        }
    }

    /// Whether it acts in the full action space.
    #[must_use]
    pub fn full_actions(&self) -> bool {
        self.options.get("full_actions").is_some_and(|full| full == "true")
    }

    /// Tics that each action is held.
    #[must_use]
    pub fn frame_skip(&self) -> u64 {
        self.options.get("frame_skip").and_then(|tics| tics.parse().ok()).unwrap_or(FRAME_SKIP)
    }

    /// Whether it meets the creatures of the paper's first runs.
    #[must_use]
    pub fn early_creatures(&self) -> bool {
        self.options.get("early_creatures").is_some_and(|early| early == "true")
    }

    /// Whether the constraint is hard.
    #[must_use]
    pub fn hard(&self) -> bool {
        self.options.get("hard").is_some_and(|hard| hard == "true")
    }
}

/// The rule set of that name; the paper's where there is none, or one of another version.
fn rule_set(name: Option<&String>) -> RuleSet {
    name.and_then(|name| name.to_lowercase().parse().ok()).unwrap_or_default()
}

/// What a run began with: the end of its place, and enough of its checksum to tell it from others.
/// Seeds that each began with a run of their own seed are one experiment.
fn read_init_from(value: &Value, seed: &Value) -> Option<String> {
    let (place, sha256) = (value["place"].as_str().unwrap_or("?"), value["sha256"].as_str()?);
    let own = format!("seed{seed}");
    let is_of_its_seed = place
        .match_indices(&own)
        .any(|(at, _)| !place[at + own.len()..].starts_with(|next: char| next.is_ascii_digit()));
    if is_of_its_seed {
        return Some(place.replace(&own, "seed*"));
    }
    let name = place.trim_end_matches('/').rsplit('/').next().unwrap_or(place);
    Some(format!("{name} {}", sha256.get(..8).unwrap_or(sha256)))
}

/// Settings that changed when the run was resumed, as the trainer lists them: those that
/// distinguish experiments go among the options. Gives the first number of frames that was asked
/// for, if the run went on beyond it.
fn read_changes(value: &Value, flat: &mut BTreeMap<String, String>) -> Option<f64> {
    let mut first = None;
    let mut changes = Vec::new();
    for change in value.as_array().into_iter().flatten() {
        let Some(setting) = change.get("setting").and_then(Value::as_str) else { continue };
        let text = |key: &str| change.get(key).map(plain).unwrap_or_default();
        if setting == "frames" {
            let frames = |key: &str| change.get(key).and_then(Value::as_f64);
            if let (None, Some(from), Some(to)) = (first, frames("from"), frames("to")) {
                first = Some(from).filter(|from| *from < to);
            }
        } else if !NOT_IDENTITY.iter().any(|beginning| below(setting, beginning)) {
            changes.push(format!("{setting} {} from {} frames on", text("to"), text("frames")));
        }
    }
    if !changes.is_empty() {
        flat.insert("changed".into(), changes.join("; "));
    }
    first
}

/// Whether a key is one that begins so, or below it.
fn below(key: &str, beginning: &str) -> bool {
    key.strip_prefix(beginning).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// Constraints as the trainer lists them, each a cost term (or the whole cost) with its budget.
fn read_constraints(
    value: &Value,
    flat: &mut BTreeMap<String, String>,
) -> Result<Vec<Constraint>, String> {
    let unusable = || "has constraints that are no list of {\"term\", \"budget\"}".to_owned();
    let mut terms = Vec::new();
    let mut constraints = Vec::new();
    for constraint in value.as_array().ok_or_else(unusable)? {
        let budget = constraint
            .get("budget")
            .filter(|budget| budget.is_number())
            .map(plain)
            .ok_or_else(unusable)?;
        let term = constraint.get("term").and_then(Value::as_str).map(String::from);
        constraints.push(Constraint {
            term: term.clone(),
            budget: budget.parse().map_err(|_| unusable())?,
        });
        match term {
            None => drop(flat.insert("safety_budget".into(), budget)),
            Some(term) => terms.push(format!("{term}:{budget}")),
        }
    }
    if !terms.is_empty() {
        flat.insert("constraints".into(), terms.join(","));
    }
    Ok(constraints)
}

/// Lessons as the trainer lists them: their levels, and their frames too where they differ (by more
/// than what an equal share leaves over).
fn read_curriculum(value: &Value, flat: &mut BTreeMap<String, String>) -> Result<(), String> {
    let unusable = || "has a curriculum that is no list of {\"level\", \"frames\"}".to_owned();
    let lessons = value.as_array().ok_or_else(unusable)?;
    let numbers = |key: &str| -> Result<Vec<u64>, String> {
        lessons
            .iter()
            .map(|lesson| lesson.get(key).and_then(Value::as_u64).ok_or_else(unusable))
            .collect()
    };
    let (levels, frames) = (numbers("level")?, numbers("frames")?);
    let least = frames.iter().min().copied().unwrap_or(0);
    let equal = frames.iter().all(|frames| frames - least < lessons.len() as u64);
    let text = |(level, frames): (&u64, &u64)| {
        if equal { level.to_string() } else { format!("{level}:{frames}") }
    };
    if !lessons.is_empty() {
        flat.insert(
            "curriculum".into(),
            levels.iter().zip(&frames).map(text).collect::<Vec<_>>().join(","),
        );
    }
    Ok(())
}

/// Writes a value as text under its key, and an object's values under their own; nulls and empty
/// lists are left out.
fn flatten(key: &str, value: &Value, options: &mut BTreeMap<String, String>) {
    match value {
        Value::Null => {}
        Value::Object(object) => {
            for (inner, value) in object {
                flatten(&format!("{key}.{inner}"), value, options);
            }
        }
        Value::Array(items) if items.is_empty() => {}
        Value::Array(items) => {
            // A list of objects (the network's layers) stays as it is written.
            let plain_items = items.iter().all(|item| !item.is_object() && !item.is_array());
            let text: Vec<String> = items.iter().map(plain).collect();
            options.insert(
                key.to_owned(),
                if plain_items { text.join(",") } else { value.to_string() },
            );
        }
        _ => {
            options.insert(key.to_owned(), plain(value));
        }
    }
}

/// A scalar as people write it: 50, not 50.0.
fn plain(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Number(number) => match (number.as_u64(), number.as_f64()) {
            (None, Some(float)) => format!("{float}"),
            _ => number.to_string(),
        },
        other => other.to_string(),
    }
}

/// Splits `RemedyRushLevel2-v0` into `RemedyRush` and 2; an id of another shape is its own
/// scenario, level 1.
#[must_use]
pub fn scenario_and_level(env: &str) -> (String, u32) {
    let name = env.split("-v").next().unwrap_or(env);
    if let Some((scenario, level)) = name.rsplit_once("Level")
        && let Some(digit) = level.chars().next().and_then(|c| c.to_digit(10))
    {
        return (format!("{scenario}{}", &level[1..]), digit);
    }
    (name.to_owned(), 1)
}
