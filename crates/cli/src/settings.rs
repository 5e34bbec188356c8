//! Validated settings made from raw flags.

use crate::args::{EnvArgs, LooksArgs, Observation, ObservationArgs, Rules, Size, View};
use crate::failure::Failure;
use hasard_envs::{
    EnvError, EnvId, EnvOptions, FrameSize, ObservationKind, Policy, RuleSet, Scenario,
};
use hasard_learn::config::EnvConfig;
use hasard_learn::config::place::kept;
use hasard_play::ViewKind;
use std::ffi::OsStr;
use std::path::Path;

impl From<Rules> for RuleSet {
    fn from(rules: Rules) -> RuleSet {
        match rules {
            Rules::Paper => RuleSet::Paper,
            Rules::Released => RuleSet::Released,
            Rules::Tables => RuleSet::Tables,
        }
    }
}

/// The environment id, or the line that names the nearest one.
pub fn env_id(text: &str) -> Result<EnvId, Failure> {
    text.parse().map_err(Failure::bad)
}

/// Most warnings of a task's file that are said before it is played; `hasard check` lists all.
const MOST_WARNINGS: usize = 3;

/// Says what `hasard check` warns of in a task's own file: such as that nothing in it gives a reward.
pub fn warn_of_task(scenario: Scenario) {
    let Some(file) = scenario.file else { return };
    // What a map leaves out is said of each task that is played.
    let is_new = |warning: &&&str| !warning.contains(": warning: left out: ");
    let warnings: Vec<_> = file.warnings.iter().filter(is_new).collect();
    let path = file.path;
    for warning in warnings.iter().take(MOST_WARNINGS) {
        note!("hasard: {path}:{warning}");
    }
    match warnings.len().saturating_sub(MOST_WARNINGS) {
        0 => {}
        more => note!("hasard: {path}: and {more} more; `hasard check {path}` lists them"),
    }
}

/// Refuses episodes seeded `seed`, `seed + 1`, ... that would pass the last seed: they would go on
/// from 0, among those of trainings.
pub fn last_seed(seed: u64, episodes: u32) -> Result<(), Failure> {
    let most = u64::MAX - u64::from(episodes.saturating_sub(1));
    if seed <= most {
        return Ok(());
    }
    Err(Failure::bad(format!(
        "--seed {seed}: {episodes} episodes from there pass the last seed, {}; give {most} or less",
        u64::MAX
    )))
}

/// An environment id without its level, or the whole text if it is none.
pub fn scenario_of(id: &str) -> String {
    id.parse::<EnvId>().map_or_else(|_| id.to_string(), |id| id.scenario.name().to_string())
}

/// Environment options from flags; `default_size` applies where `--size` is absent.
pub fn env_options(args: &EnvArgs, default_size: Size) -> Result<EnvOptions, Failure> {
    Ok(EnvOptions {
        rules: args.rules.into(),
        early_creatures: args.early_creatures,
        hard: args.hard,
        full_actions: args.full_actions,
        frame_skip: args.frame_skip,
        size: args.size.unwrap_or(default_size).into(),
        ..crate::sources::looks(args.maps.as_deref(), args.iwad.as_deref())?
    })
}

/// A policy that looks at nothing, by its text.
pub fn policy(text: &OsStr) -> Result<Policy, Failure> {
    let text = text.to_string_lossy();
    let beside = "; run:DIR is the agent of a training run, FILE.agent one that was exported, \
                  zoo:NAME one that comes with the program";
    text.parse().map_err(|error: EnvError| Failure::bad(format!("{error}{beside}")))
}

/// The options with what a learner sees.
pub fn observed(options: EnvOptions, args: &ObservationArgs) -> EnvOptions {
    let observation = match args.observation {
        Observation::Rgb => ObservationKind::Rgb,
        Observation::RgbDepth => ObservationKind::RgbDepth,
        Observation::Segmented => ObservationKind::Segmented,
        Observation::Grey => ObservationKind::Grey,
    };
    let options = EnvOptions { observation, frame_stack: usize::from(args.frame_stack), ..options };
    looking(options, &args.looks)
}

/// The options with how depth and segmentation look.
pub fn looking(options: EnvOptions, args: &LooksArgs) -> EnvOptions {
    EnvOptions {
        published_depth: args.published_depth,
        published_colours: args.published_colours,
        ..options
    }
}

impl From<Size> for FrameSize {
    fn from(size: Size) -> FrameSize {
        FrameSize { width: size.width, height: size.height }
    }
}

impl From<View> for ViewKind {
    fn from(view: View) -> ViewKind {
        match view {
            View::Rgb => ViewKind::Colour,
            View::Depth => ViewKind::Depth,
            View::Segmented => ViewKind::Segmented,
            View::Labels => ViewKind::Labels,
            View::Grey => ViewKind::Grey,
            View::Phase => ViewKind::Phase,
            View::Automap => ViewKind::Automap,
        }
    }
}

/// A view and those beside it.
pub fn views(first: View, beside: &[View]) -> Vec<ViewKind> {
    std::iter::once(first).chain(beside.iter().copied()).map(ViewKind::from).collect()
}

/// The id of a run's environment; of several tasks the first.
pub fn first_task(env: &EnvConfig) -> String {
    env.id.split(',').next().unwrap_or_default().to_string()
}

/// Where the maps and the pictures of a run are now, if elsewhere than its settings say.
#[derive(Clone, Copy, Default)]
pub struct Elsewhere<'a> {
    /// The maps; of a run in the built-in maps, others to play in.
    pub maps: Option<&'a Path>,
    /// The IWAD.
    pub iwad: Option<&'a Path>,
}

impl<'a> Elsewhere<'a> {
    /// The same only for what is no longer where the run's settings say.
    #[must_use]
    pub fn where_missing(self, env: &EnvConfig) -> Elsewhere<'a> {
        let lost = |kept: Option<&Path>| kept.is_some_and(|kept| !is_there(kept));
        Elsewhere {
            maps: self.maps.filter(|_| lost(env.maps.as_deref())),
            iwad: self.iwad.filter(|_| lost(env.iwad.as_deref())),
        }
    }
}

fn is_there(path: &Path) -> bool {
    path == Path::new("auto") || path.exists()
}

/// The place of a run's maps or pictures, or the line that says how to name where they are now.
fn place<'a>(
    kept: Option<&'a Path>,
    elsewhere: Option<&'a Path>,
    flag: &str,
) -> Result<Option<&'a Path>, Failure> {
    match (elsewhere, kept) {
        (None, Some(kept)) if !is_there(kept) => Err(Failure::bad(format!(
            "{}: the run was trained with this, and it is not there; name where it is now with {flag}",
            kept.display()
        ))),
        _ => Ok(elsewhere.or(kept)),
    }
}

/// Cores that this process may use.
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// The options of the environment that a run was trained in, its maps and pictures among them.
pub fn trained_options(env: &EnvConfig, elsewhere: Elsewhere<'_>) -> Result<EnvOptions, Failure> {
    let options = env.options().map_err(Failure::bad)?;
    for file in env.scenario_file.iter().chain(&env.scenario_files) {
        if let Some(changed) = file.changed() {
            note!("hasard: {changed}");
        }
    }
    let maps = place(env.maps.as_deref(), elsewhere.maps, "--maps")?;
    let iwad = place(env.iwad.as_deref(), elsewhere.iwad, "--iwad")?;
    let sources = crate::sources::looks(maps, iwad)?;
    // A map that cannot be read stops a run before it is announced.
    if let Some(maps) = &sources.maps {
        for id in env.tasks().iter().filter_map(|task| task.env_id().ok()) {
            maps.level(id, options.rules, options.hard).map_err(Failure::bad)?;
        }
    }
    Ok(EnvOptions { maps: sources.maps, assets: sources.assets, ..options })
}

/// The environment of a training run from flags, in the words of its `config.json`.
pub fn env_config(id: &str, args: &EnvArgs, observation: &ObservationArgs) -> EnvConfig {
    let mut env = EnvConfig::new(id);
    env.rules = RuleSet::from(args.rules).name().into();
    env.early_creatures = args.early_creatures;
    env.observation = match observation.observation {
        Observation::Rgb => "rgb",
        Observation::RgbDepth => "rgb+depth",
        Observation::Segmented => "segmented",
        Observation::Grey => "grey",
    }
    .into();
    (env.hard, env.full_actions, env.frame_skip) = (args.hard, args.full_actions, args.frame_skip);
    env.frame_stack = usize::from(observation.frame_stack);
    let looks = &observation.looks;
    (env.published_depth, env.published_colours) = (looks.published_depth, looks.published_colours);
    env.iwad = args.iwad.as_deref().map(kept);
    env.maps = args.maps.as_deref().map(kept);
    if let Some(size) = args.size {
        env.size = (size.width, size.height);
    }
    env
}
