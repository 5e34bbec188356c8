//! A claim: what an agent scores in an environment, on episodes that are the same for everybody.
//!
//! A claim is checked by playing its episodes again. The network is computed by the plain kernels,
//! whose bits are those of every processor, and the engine's kernels all agree: so a claim holds to
//! the last bit, or it does not hold.

use std::path::Path;

use hasard_envs::{Env, EnvOptions, Episode, FRAME_SKIP, RuleSet, VecEnv};
use hasard_media::files::{NO_FILE, is_special};
use serde::{Deserialize, Serialize};

use crate::config::{Constraint, EnvConfig, TrainConfig};
use crate::error::LearnError;
use crate::networks::distribution::ActionShape;
use crate::runs::agent::{Choice, TrainedPolicy, Which};
use crate::runs::agent_file::{AgentFile, Card};
use crate::runs::checksum::sha256;
use crate::runs::evaluate::{Evaluation, play};
use crate::runs::temperature::Temperature;

/// Seed of the first episode of every claim. Trainings and evaluations draw theirs elsewhere, and
/// nobody can choose lucky ones.
pub const FIRST_SEED: u64 = 9_000_000;
/// How many episodes the claims of a scoreboard have. Of any number that one likes one could choose
/// the number that comes out best: a policy whose cost is the very budget is surely within it in 1.5 %
/// of claims of 200 episodes, and in 22 % where the best number up to 10,000 is chosen.
pub const LISTED_EPISODES: [u32; 3] = [200, 1_000, 10_000];
/// Most episodes of a claim.
pub const MOST_EPISODES: u32 = 10_000;
/// Layout of the file.
const FORMAT: u32 = 1;
/// Bytes of the largest claim that is read.
const LARGEST: u64 = 1 << 16;

/// What is claimed.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Claim {
    format: u32,
    /// Version of the program that made it.
    pub program: String,
    /// Name on a scoreboard.
    pub name: String,
    /// The agent's file, beside the claim.
    pub agent: String,
    /// SHA-256 of that file, in hexadecimal digits.
    pub agent_sha256: String,
    /// Id of the environment.
    pub environment: String,
    /// The rule set: `paper`, `released` or `tables`.
    pub rules: String,
    /// The hard constraint.
    pub hard: bool,
    /// Algorithm that trained the agent, and its frames.
    pub algorithm: String,
    /// Frames of the training.
    pub frames: u64,
    /// The command that trained it.
    pub how: String,
    /// Seed of the first episode; the others follow it.
    pub first_seed: u64,
    /// Number of episodes.
    pub episodes: u32,
    /// Mean return of the episodes.
    pub return_mean: f64,
    /// Mean cost of the episodes.
    pub cost_mean: f64,
    /// SHA-256 over seed, length, end, return and each cost term of every episode.
    pub digest: String,
}

/// Episodes of an agent under the rules of a claim, and what they come to.
pub struct Measured {
    /// The agent's settings, its environment under the claim's rules.
    pub config: TrainConfig,
    /// The temperature that the agent's file plays at.
    pub temperature: Temperature,
    /// The budget of the environment under these rules.
    pub budget: f64,
    /// Return, cost and tails.
    pub evaluation: Evaluation,
    /// See [`Claim::digest`].
    pub digest: String,
}

/// What came of checking a claim.
pub enum Verdict {
    /// Every word of it is so.
    Holds(Box<Measured>),
    /// What is not so.
    Refused(Vec<String>),
}

/// Most letters of a name, and of a command.
const LONGEST_NAME: usize = 80;
const LONGEST_HOW: usize = 10_000;

/// Whether a letter shows nothing but turns the order of those around it, or hides.
#[must_use]
pub fn is_direction(letter: char) -> bool {
    matches!(letter, '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{2069}' | '\u{feff}')
}

/// What is wrong with a claim's name and the command that it gives, if anything.
#[must_use]
pub fn wrong_words(name: &str, how: &str) -> Option<String> {
    let hidden =
        |text: &str| text.chars().any(|letter| letter.is_control() || is_direction(letter));
    if name.trim().is_empty() || name.chars().count() > LONGEST_NAME || hidden(name) {
        return Some(format!("its name must have 1 to {LONGEST_NAME} letters that all show"));
    }
    if how.chars().count() > LONGEST_HOW || hidden(how) {
        return Some(format!(
            "its command must have at most {LONGEST_HOW} letters that all show, on one line"
        ));
    }
    None
}

/// What episodes were, to the bit.
fn digest(episodes: &[Episode]) -> String {
    let mut text = String::new();
    for one in episodes {
        let costs: Vec<String> = one
            .costs
            .iter()
            .map(|term| format!("{}:{:016x}", term.name, term.cost.to_bits()))
            .collect();
        text += &format!(
            "{} {} {} {} {:016x} {:016x} {}\n",
            one.seed,
            one.length,
            u8::from(one.terminated),
            u8::from(one.truncated),
            one.episode_return.to_bits(),
            one.cost.to_bits(),
            costs.join(",")
        );
    }
    sha256(text.as_bytes())
}

/// What makes an agent's task another than its id names; its file says so, and could be made to say
/// what is easier.
fn unusual(env: &EnvConfig) -> Option<&'static str> {
    if env.maps.is_some() || env.iwad.is_some() {
        return Some(
            "was trained in maps or pictures that are not part of the program; a claim is about those that are",
        );
    }
    let other = env.frame_skip != FRAME_SKIP || env.early_creatures;
    other.then_some("plays another task than its id names: a claim's has a frame_skip of 4, and no early_creatures")
}

/// Plays the claim episodes of an agent's file under a rule set, by default its own.
///
/// # Errors
/// When the agent cannot be read, or plays another task than its id names.
pub fn measure(
    agent: &Path,
    rules: Option<RuleSet>,
    episodes: u32,
    threads: usize,
) -> Result<Measured, LearnError> {
    let Card { mut config, temperature, .. } = AgentFile::read(agent)?.card;
    if let Some(problem) = unusual(&config.env) {
        return Err(LearnError::content(agent, problem));
    }
    let own = config.env.rule_set()?;
    config.env.rules = rules.unwrap_or(own).name().into();
    let worlds = |error: hasard_envs::EnvError| LearnError::Worlds(error.to_string());
    // Under other rules the agent keeps the buttons that it was trained with.
    let options = EnvOptions { actions_of: Some((own, config.env.hard)), ..config.env.options()? };
    let id = config.env.env_id()?;
    let env = Env::new(&config.env.id, &options).map_err(worlds)?;
    let action = ActionShape::from(env.action_space());
    let policy =
        TrainedPolicy::load(agent, Which::Selected, env.observation_shape(), action, &mut |_| {})?
            .on_plain_kernels();
    let make = |_: &_, lanes| VecEnv::new(&config.env.id, &options, lanes);
    let seeds: Vec<u64> = (0..u64::from(episodes)).map(|number| FIRST_SEED + number).collect();
    let played = play(&policy, Choice::Sampled, &make, &seeds, threads)?;
    let budget = id.safety_budget(options.rules, options.hard);
    let evaluation = Evaluation::of(&played, &[Constraint { term: None, budget }])?;
    Ok(Measured { digest: digest(&played), config, temperature, budget, evaluation })
}

impl Claim {
    /// The claim that measured episodes make.
    #[must_use]
    pub fn new(name: &str, file: &str, bytes: &[u8], how: &str, measured: &Measured) -> Claim {
        let config = &measured.config;
        Claim {
            format: FORMAT,
            program: env!("CARGO_PKG_VERSION").into(),
            name: name.into(),
            agent: file.into(),
            agent_sha256: sha256(bytes),
            environment: config.env.id.clone(),
            rules: config.env.rules.clone(),
            hard: config.env.hard,
            algorithm: config.algorithm.to_string(),
            frames: config.frames,
            how: how.into(),
            first_seed: FIRST_SEED,
            episodes: measured.evaluation.episodes as u32,
            return_mean: measured.evaluation.episode_return.mean,
            cost_mean: measured.evaluation.cost.mean,
            digest: measured.digest.clone(),
        }
    }

    /// Reads a claim.
    ///
    /// # Errors
    /// One line that names the file and what is wrong with it.
    pub fn read(path: &Path) -> Result<Claim, LearnError> {
        let kind = std::fs::metadata(path).map_err(LearnError::file(path, "read"))?;
        if is_special(&kind) {
            return Err(LearnError::content(path, NO_FILE));
        }
        let length = kind.len();
        if length > LARGEST {
            return Err(LearnError::content(
                path,
                format!("is no claim: it has {length} bytes, a claim at most {LARGEST}"),
            ));
        }
        let text = std::fs::read_to_string(path).map_err(LearnError::file(path, "read"))?;
        let wrong = |error: serde_json::Error| {
            let why = if error.is_data() { error.to_string() } else { "it is no JSON".into() };
            LearnError::content(path, format!("is no claim: {why}; `hasard claim` writes one"))
        };
        let claim: Claim = serde_json::from_str(&text).map_err(wrong)?;
        if claim.format != FORMAT {
            return Err(LearnError::content(
                path,
                format!("has format {}; this program reads {FORMAT}", claim.format),
            ));
        }
        if let Some(problem) = wrong_words(&claim.name, &claim.how) {
            return Err(LearnError::content(path, format!("is no claim: {problem}")));
        }
        Ok(claim)
    }

    /// Checks a claim that lies in `folder`, by playing its episodes again on so many threads.
    ///
    /// # Errors
    /// When its agent cannot be read or played at all.
    pub fn check(&self, folder: &Path, threads: usize) -> Result<Verdict, LearnError> {
        let mut wrong = Vec::new();
        if Path::new(&self.agent).file_name().is_none_or(|name| name != self.agent.as_str()) {
            return Ok(Verdict::Refused(vec![format!(
                "the agent '{}' is no plain name of a file beside the claim",
                self.agent
            )]));
        }
        if self.first_seed != FIRST_SEED {
            wrong.push(format!(
                "its episodes begin with seed {}, those of all claims with {FIRST_SEED}",
                self.first_seed
            ));
        }
        if !(1..=MOST_EPISODES).contains(&self.episodes) {
            wrong.push(format!(
                "it has {} episodes; a claim has 1 to {MOST_EPISODES}",
                self.episodes
            ));
        }
        let path = folder.join(&self.agent);
        if std::fs::symlink_metadata(&path).is_ok_and(|kind| kind.is_symlink()) {
            return Ok(Verdict::Refused(vec![format!(
                "the agent '{}' is a link; put the file itself beside the claim",
                self.agent
            )]));
        }
        let (bytes, file) = AgentFile::read_whole(&path)?;
        let found = sha256(&bytes);
        if found != self.agent_sha256 {
            wrong.push(format!("{} is another agent: its SHA-256 is {found}", self.agent));
        }
        let config = &file.card.config;
        wrong.extend(unusual(&config.env).map(|problem| format!("its agent {problem}")));
        for (what, claimed, agents) in [
            ("environment", self.environment.clone(), config.env.id.clone()),
            ("hard", self.hard.to_string(), config.env.hard.to_string()),
            ("algorithm", self.algorithm.clone(), config.algorithm.to_string()),
            ("frames", self.frames.to_string(), config.frames.to_string()),
        ] {
            if claimed != agents {
                wrong.push(format!("it says {what} {claimed}, the agent {agents}"));
            }
        }
        let Ok(rules) = self.rules.parse::<RuleSet>() else {
            wrong.push(format!(
                "there are no rules '{}'; use paper, released or tables",
                self.rules
            ));
            return Ok(Verdict::Refused(wrong));
        };
        if !wrong.is_empty() {
            return Ok(Verdict::Refused(wrong));
        }
        let measured = measure(&path, Some(rules), self.episodes, threads)?;
        let means = (measured.evaluation.episode_return.mean, measured.evaluation.cost.mean);
        for (what, claimed, found) in
            [("return", self.return_mean, means.0), ("cost", self.cost_mean, means.1)]
        {
            if claimed.to_bits() != found.to_bits() {
                wrong.push(format!("it says {what} {claimed}, its episodes come to {found}"));
            }
        }
        if self.digest != measured.digest {
            wrong.push(format!("its episodes were others: their digest is {}", measured.digest));
        }
        Ok(if wrong.is_empty() {
            Verdict::Holds(Box::new(measured))
        } else {
            Verdict::Refused(wrong)
        })
    }
}
