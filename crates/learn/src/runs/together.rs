//! A run of several workers: what the first sends the others, and what those do.

use std::panic::{AssertUnwindSafe, catch_unwind};

use serde::{Deserialize, Serialize};

use crate::config::TrainConfig;
use crate::error::LearnError;
use crate::networks::device::ComputeDevice;
use crate::runs::checkpoint::Loaded;
use crate::runs::session::{Beginning, MakeWorlds, Session};
use crate::sampling::gather::panic_text;
use crate::team::Team;

/// What the first worker decides once a rollout.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Word {
    /// The run ends.
    pub over: bool,
    /// A checkpoint is taken, of everyone's samplers.
    pub save: bool,
}

impl Word {
    /// Sends it to the others.
    pub fn send(self, team: &Team) -> Result<(), LearnError> {
        team.hear_first(vec![u8::from(self.over), u8::from(self.save)]).map(drop)
    }

    /// Hears it from the first.
    fn hear(team: &Team) -> Result<Word, LearnError> {
        match team.hear_first(Vec::new())?[..] {
            [over, save] => Ok(Word { over: over != 0, save: save != 0 }),
            _ => Err(spoiled()),
        }
    }
}

/// What a run begins with, as it is sent.
#[derive(Serialize, Deserialize)]
enum Sent<L> {
    Nothing,
    Everything(L),
    Weights(L, Option<Vec<usize>>),
    Agent(Vec<u8>, Option<Vec<usize>>),
}

fn spoiled() -> LearnError {
    LearnError::Team(
        "the first worker cannot be understood; start all workers from one version of hasard"
            .into(),
    )
}

/// What workers must have in common so that all of them hold the same bits.
fn alike(team: &Team, config: &TrainConfig) -> Result<(), LearnError> {
    let own = format!(
        "hasard {}, {}",
        env!("CARGO_PKG_VERSION"),
        ComputeDevice::of(config)?.kernels().name()
    );
    let mut all: Vec<String> = team
        .gather(own.into_bytes())?
        .into_iter()
        .map(|one| String::from_utf8_lossy(&one).into_owned())
        .collect();
    all.dedup();
    if all.len() > 1 {
        let problem = format!(
            "the workers compute differently ({}); give them one version, and --portable",
            all.join("; ")
        );
        return Err(LearnError::Config(problem));
    }
    Ok(())
}

/// Sends the others what the run is.
pub fn invite(
    team: &Team,
    config: &TrainConfig,
    beginning: &Beginning<'_>,
) -> Result<(), LearnError> {
    if team.is_alone() {
        return Ok(());
    }
    let beginning = match beginning {
        Beginning::Everything(loaded) => Sent::Everything(&**loaded),
        Beginning::Weights(loaded, order) => Sent::Weights(&**loaded, order.clone()),
        Beginning::Agent(bytes, order) => Sent::Agent(bytes.clone(), order.clone()),
        Beginning::Nothing | Beginning::Lesson(_) => Sent::Nothing,
    };
    let text = serde_json::to_string(config).map_err(|_| spoiled())?;
    team.hear_first(postcard::to_allocvec(&(text, beginning)).map_err(|_| spoiled())?)?;
    alike(team, config)
}

/// What the first worker sends the others.
pub struct Invitation {
    team: Team,
    /// The run's settings.
    pub config: TrainConfig,
    beginning: Beginning<'static>,
}

impl Invitation {
    /// Waits for the first worker.
    pub fn hear(team: Team) -> Result<Invitation, LearnError> {
        let bytes = team.hear_first(Vec::new())?;
        let (text, sent): (String, Sent<Box<Loaded>>) =
            postcard::from_bytes(&bytes).map_err(|_| spoiled())?;
        let config: TrainConfig = serde_json::from_str(&text).map_err(|_| spoiled())?;
        let beginning = match sent {
            Sent::Nothing => Beginning::Nothing,
            Sent::Everything(loaded) => Beginning::Everything(loaded),
            Sent::Weights(loaded, order) => Beginning::Weights(loaded, order),
            Sent::Agent(bytes, order) => Beginning::Agent(bytes, order),
        };
        alike(&team, &config)?;
        Ok(Invitation { team, config, beginning })
    }

    /// Samples and learns with the others until the first worker ends the run.
    pub fn follow(
        self,
        make_worlds: &MakeWorlds<'_>,
        warn: &mut dyn FnMut(String),
    ) -> Result<(), LearnError> {
        let whole = || self.go_along(make_worlds, warn);
        catch_unwind(AssertUnwindSafe(whole))
            .unwrap_or_else(|panic| Err(LearnError::Panic(panic_text("a worker", &*panic))))
    }

    fn go_along(
        self,
        make_worlds: &MakeWorlds<'_>,
        warn: &mut dyn FnMut(String),
    ) -> Result<(), LearnError> {
        let Invitation { team, config, beginning } = self;
        let mut lesson = beginning.progress().map_or(0, |progress| progress.lesson);
        let mut session =
            Session::of(team.clone(), config.lesson(lesson), &beginning, make_worlds)?;
        // As the first worker goes through it, without what only one has to do.
        if session.frames >= config.frames {
            return Ok(());
        }
        loop {
            if config.lesson_at(session.frames) != lesson {
                lesson = config.lesson_at(session.frames);
                session = Session::of(
                    team.clone(),
                    config.lesson(lesson),
                    &Beginning::Lesson(&session),
                    make_worlds,
                )?;
            }
            let before = session.frames;
            let rollout = session.turn(warn)?;
            if config.evaluates(before, session.frames) && Word::hear(&team)?.save {
                session.save_samplers()?;
            }
            let word = Word::hear(&team)?;
            if word.save {
                session.save_samplers()?;
            }
            if word.over {
                return Ok(());
            }
            if config.lesson_at(session.frames) == lesson {
                session.go_on(rollout);
            }
        }
    }
}
