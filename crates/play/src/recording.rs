//! Episodes into files and back.

use crate::{PlayError, Stage};
use hasard_envs::{ActionSpace, Env, EnvId, EnvOptions, RuleSet, own};
use hasard_media::MediaError;
use hasard_media::episode::{EpisodeFile, Header, Outcome, SCENARIO};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What a recording says of its maps where they were not the built-in ones. Which files those were
/// is the player's to know.
const FROM_FILES: &str = "from files";

/// The path that an own scenario was read from.
const SCENARIO_PATH: &str = "scenario-path";

/// The options that change what happens in an episode, by their names on the command line.
#[must_use]
pub fn option_names(options: &EnvOptions) -> BTreeMap<String, String> {
    let maps = options.maps.as_ref().map(|_| ("maps", FROM_FILES.to_owned()));
    let always = [
        ("rules", options.rules.name().to_owned()),
        ("hard", options.hard.to_string()),
        ("full-actions", options.full_actions.to_string()),
        ("frame-skip", options.frame_skip.to_string()),
    ];
    let early = options.early_creatures.then(|| ("early-creatures", "true".to_owned()));
    // The action space of other rules than the world's; an agent keeps its own.
    let actions = options.actions_of.filter(|&whose| whose != (options.rules, options.hard));
    let actions = actions.map(|(rules, hard)| {
        ("actions-of", format!("{rules} {}", if hard { "hard" } else { "soft" }))
    });
    let together = options.together.as_ref().map(|space| ("together", space.names()));
    // An own scenario goes with the file that describes it.
    let own = options.scenario.and_then(|scenario| scenario.file);
    let own = own
        .into_iter()
        .flat_map(|file| [(SCENARIO, file.text.to_owned()), (SCENARIO_PATH, file.path.to_owned())]);
    always
        .into_iter()
        .chain(own)
        .chain(early)
        .chain(actions)
        .chain(together)
        .chain(maps)
        .map(|(name, value)| (name.to_owned(), value))
        .collect()
}

/// The options that an episode file names, over those that only concern looks (size, pictures),
/// which `looks` gives.
///
/// # Errors
/// When the file names an option that this version does not know, or a value that it cannot take.
pub fn options_from_names(
    names: &BTreeMap<String, String>,
    looks: &EnvOptions,
    file: &Path,
) -> Result<EnvOptions, PlayError> {
    let plain = EnvOptions::default();
    let mut options = EnvOptions {
        rules: plain.rules,
        early_creatures: false,
        hard: plain.hard,
        full_actions: plain.full_actions,
        actions_of: None,
        together: None,
        frame_skip: plain.frame_skip,
        frame_stack: 1,
        ..looks.clone()
    };
    if names.contains_key("maps") != looks.maps.is_some() {
        let problem = match looks.maps {
            None => "was recorded on maps from files: name them by --maps",
            Some(_) => "was recorded on the built-in maps: leave --maps out",
        };
        return Err(
            MediaError::Format { path: file.to_owned(), problem: problem.to_owned() }.into()
        );
    }
    options.scenario = None;
    if let Some(text) = names.get(SCENARIO) {
        let path = names.get(SCENARIO_PATH).map_or("scenario.toml", String::as_str);
        options.scenario =
            Some(own::recall(path, text).map_err(|error| in_file(file, &error.into()))?);
    }
    for (name, value) in names {
        let unknown = || {
            let problem = format!(
                "was recorded with {name} = {value}, which this version does not know: use the hasard that recorded it"
            );
            MediaError::Format { path: file.to_owned(), problem }
        };
        match name.as_str() {
            "rules" => options.rules = value.parse().map_err(|_| unknown())?,
            "early-creatures" => options.early_creatures = value.parse().map_err(|_| unknown())?,
            "actions-of" => {
                let (rules, constraint) = value.split_once(' ').ok_or_else(unknown)?;
                let hard = ["soft", "hard"]
                    .iter()
                    .position(|name| *name == constraint)
                    .ok_or_else(unknown)?
                    == 1;
                options.actions_of = Some((rules.parse().map_err(|_| unknown())?, hard));
            }
            "together" => {
                options.together = Some(ActionSpace::named(value).ok_or_else(unknown)?);
            }
            "maps" if value == FROM_FILES => {}
            SCENARIO | SCENARIO_PATH => {}
            "hard" => options.hard = value.parse().map_err(|_| unknown())?,
            "full-actions" => options.full_actions = value.parse().map_err(|_| unknown())?,
            "frame-skip" => {
                let skip = value.parse().ok().filter(|skip| (1..=35).contains(skip));
                options.frame_skip = skip.ok_or_else(unknown)?;
            }
            _ => return Err(unknown().into()),
        }
    }
    Ok(options)
}

/// An error that concerns what a file says.
fn in_file(name: &Path, error: &PlayError) -> PlayError {
    MediaError::Format {
        path: name.to_owned(),
        problem: format!("was recorded otherwise than this version can play: {error}"),
    }
    .into()
}

/// Writes down an episode while it is played.
pub struct Recorder {
    file: EpisodeFile,
}

impl Recorder {
    /// Resets the environment to the episode of a seed and begins to record it.
    ///
    /// # Errors
    /// When the player's name is empty, overlong or unprintable.
    pub fn begin(env: &mut Env, seed: u64, player: &str) -> Result<Recorder, PlayError> {
        env.reset(seed);
        Recorder::of(env, seed, player)
    }

    /// Begins to record an episode that was just reset with `seed`.
    ///
    /// # Errors
    /// As [`Recorder::begin`].
    pub fn of(env: &Env, seed: u64, player: &str) -> Result<Recorder, PlayError> {
        let space = env.action_space();
        let file = EpisodeFile::new(Header {
            env: env.id().to_string(),
            options: option_names(env.options()),
            seed,
            program: env!("CARGO_PKG_VERSION").to_owned(),
            player: player.to_owned(),
            steps: 0,
            groups: space.groups.len() as u8,
            deltas: space.deltas.len() as u8,
            outcome: None,
        })?;
        Ok(Recorder { file })
    }

    /// Notes the action of a step.
    ///
    /// # Errors
    /// When it is no action of the environment.
    pub fn push(&mut self, actions: &[u8], deltas: &[f32]) -> Result<(), PlayError> {
        Ok(self.file.push(actions, deltas)?)
    }

    /// Ends the recording with how far the episode came.
    #[must_use]
    pub fn finish(mut self, env: &Env) -> EpisodeFile {
        let episode = env.episode();
        self.file.set_outcome(Outcome {
            episode_return: episode.episode_return,
            cost: episode.cost,
            costs: episode.costs.iter().map(|one| (one.name.to_owned(), one.cost)).collect(),
            terminated: episode.terminated,
            truncated: episode.truncated,
            state_hash: Some(env.state_hash()),
        });
        self.file
    }
}

/// Ends a recording and keeps it in a folder, as `ENV-seedN.episode` or, since an episode played
/// again is another result, under the next free name. Gives its path.
///
/// # Errors
/// When it cannot be written.
pub fn keep_episode(
    folder: &Path,
    env: &Env,
    seed: u64,
    recorder: Recorder,
) -> Result<PathBuf, PlayError> {
    let mut path = folder.join(format!("{}-seed{seed}.episode", env.id()));
    for attempt in 2..100_000 {
        if !path.exists() {
            break;
        }
        path = folder.join(format!("{}-seed{seed}-{attempt}.episode", env.id()));
    }
    recorder.finish(env).write(&path)?;
    Ok(path)
}

/// Results within the budget of the episodes of an environment that a folder keeps.
#[must_use]
pub fn kept_results(folder: &Path, env: &str, hard: bool) -> Vec<crate::Rival> {
    let result = |path: PathBuf| {
        let file = EpisodeFile::read(&path).ok()?;
        let (header, outcome) = (file.header(), file.header().outcome.as_ref()?);
        let said = |name: &str| header.options.get(name).map(String::as_str);
        let rules = said("rules").map_or(Ok(RuleSet::Paper), str::parse).ok()?;
        let is_hard = said("hard") == Some("true");
        let budget = header.env.parse::<EnvId>().ok()?.safety_budget(rules, is_hard);
        let fits = header.env == env && is_hard == hard && outcome.cost <= budget;
        fits.then(|| crate::Rival {
            who: header.player.clone(),
            episode_return: outcome.episode_return,
        })
    };
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let paths = entries.map(|entry| entry.path());
    paths
        .filter(|path| path.extension().is_some_and(|it| it == "episode"))
        .filter_map(result)
        .collect()
}

/// Plays a recorded episode again.
pub struct Replay {
    file: EpisodeFile,
    name: PathBuf,
    stage: Stage,
    /// Steps whose action was chosen.
    begun: usize,
}

impl Replay {
    /// Makes the episode's environment. Of `looks`, only what concerns pictures counts.
    ///
    /// # Errors
    /// When the file's environment, options or actions are unknown to this version.
    pub fn new(file: EpisodeFile, name: &Path, looks: &EnvOptions) -> Result<Replay, PlayError> {
        let options = options_from_names(&file.header().options, looks, name)?;
        let mut stage =
            Stage::new(&file.header().env, &options).map_err(|error| in_file(name, &error))?;
        let space = stage.env().action_space();
        file.check_actions(&space.sizes(), space.deltas.len(), name)?;
        stage.reset(file.header().seed);
        let mut replay = Replay { file, name: name.to_owned(), stage, begun: 0 };
        replay.choose()?;
        Ok(replay)
    }

    /// The recorded episode.
    #[must_use]
    pub fn file(&self) -> &EpisodeFile {
        &self.file
    }

    /// The stage as of the last tic.
    #[must_use]
    pub fn stage(&self) -> &Stage {
        &self.stage
    }

    /// Whether all recorded actions are played or the episode is over.
    #[must_use]
    pub fn over(&self) -> bool {
        self.stage.ended()
            || self.stage.wants_action() && self.begun > self.file.header().steps as usize
    }

    /// Goes on to the end of a policy step, counted from 1, or to where the recording ends before
    /// it.
    pub fn skip_to(&mut self, step: u32) {
        while self.stage.env().episode().length < step && self.tic() {}
    }

    /// Goes on by a tic; `false` when there is no more to play.
    pub fn tic(&mut self) -> bool {
        if self.over() {
            return false;
        }
        if self.stage.tic().is_some() {
            // Actions were checked when the file was opened.
            let _ = self.choose();
        }
        !self.over()
    }

    /// Chooses the action of the next step; past the last, only counts on.
    fn choose(&mut self) -> Result<(), PlayError> {
        if let Some((actions, deltas)) = self.file.step(self.begun) {
            self.stage.act(actions, deltas)?;
        }
        self.begun += 1;
        Ok(())
    }

    /// After the replay: how it differs from what was recorded, as one line; `None` if it does not,
    /// or if nothing is known of the recorded end.
    #[must_use]
    pub fn difference(&self) -> Option<String> {
        let outcome = self.file.header().outcome.as_ref()?;
        let episode = self.stage.env().episode();
        let hash = self.stage.env().state_hash();
        let name = self.name.display();
        if episode.episode_return != outcome.episode_return || episode.cost != outcome.cost {
            return Some(format!(
                "{name}: was recorded by version {} with return {} and cost {}, and plays now with return {} and cost {}",
                self.file.header().program,
                outcome.episode_return,
                outcome.cost,
                episode.episode_return,
                episode.cost
            ));
        }
        // Of a term that has another name by now the total has to do.
        for now in &episode.costs {
            if let Some(&cost) = outcome.costs.get(now.name).filter(|cost| **cost != now.cost) {
                return Some(format!(
                    "{name}: was recorded with a cost of {cost} by {}, and plays now with {}",
                    now.name, now.cost
                ));
            }
        }
        let (steps, length) = (self.file.header().steps, episode.length);
        if self.stage.ended() && length < steps {
            return Some(format!("{name}: ends after {length} of its {steps} recorded steps"));
        }
        if (episode.terminated, episode.truncated) != (outcome.terminated, outcome.truncated) {
            return Some(format!("{name}: ends in another way than was recorded"));
        }
        (outcome.state_hash.is_some_and(|recorded| recorded != hash)).then(|| {
            format!(
                "{name}: ends in another state than version {} recorded",
                self.file.header().program
            )
        })
    }
}
