//! The episode file: what is needed to play an episode again, and no pixel.
//!
//! A world is deterministic, so an episode is its environment, options and seed and the actions
//! taken: a few kilobytes from which any view at any size can be drawn later. Files end in
//! `.episode`. Layout, numbers little-endian:
//!
//! | bytes | what |
//! |---|---|
//! | 8 | `HSDEPISO` |
//! | 2 | version of the format, now 1 |
//! | 4 | length of the header |
//! | ... | header: one JSON object, [`Header`]; readers skip keys that they do not know |
//! | 4 | length of the body |
//! | ... | body, compressed with zlib: categorical sub-action 0 of every step, then sub-action 1, ... one byte each; then the continuous ones likewise, as byte planes of 32-bit floats (all lowest bytes first) |
//! | 4 | CRC-32 of all bytes before |

use crate::MediaError;
use crate::files::{read_limited, write_whole};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io::{Read, Write};
use std::path::Path;

const MAGIC: &[u8; 8] = b"HSDEPISO";
/// The version of the format that this program writes, and the newest that it reads.
pub const FORMAT_VERSION: u16 = 1;
/// Bounds on what a file may claim, far above any real episode (an hour of tics is 126,000).
const MAX_STEPS: u32 = 1_000_000;
const MAX_GROUPS: u8 = 32;
const MAX_DELTAS: u8 = 8;
/// With room for an own scenario's text.
const MAX_HEADER: usize = 1 << 20;
const MAX_FILE: u64 = 64 << 20;

/// The option that holds an own scenario's text.
pub const SCENARIO: &str = "scenario";

/// What an episode was, beside its actions.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Header {
    /// Id of the environment, with its version: `RemedyRushLevel1-v0`.
    pub env: String,
    /// The options that it was made with, by the names of the command line without dashes in front:
    /// `rules` = `paper`. Those that change nothing about what happens (frame size, IWAD) may be
    /// left out.
    pub options: BTreeMap<String, String>,
    /// Seed of the reset.
    pub seed: u64,
    /// Version of the program that recorded it. Another version may play it differently; then
    /// `outcome` shows it.
    pub program: String,
    /// Who acted: `human`, `random`, or the run of an agent.
    pub player: String,
    /// Number of policy steps.
    pub steps: u32,
    /// Number of categorical sub-actions.
    pub groups: u8,
    /// Number of continuous sub-actions.
    pub deltas: u8,
    /// How it ended, to check a replay against; `None` if recording stopped in its midst.
    pub outcome: Option<Outcome>,
}

/// How an episode ended.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize)]
pub struct Outcome {
    /// Sum of rewards.
    #[serde(rename = "return")]
    pub episode_return: f64,
    /// Sum of costs.
    pub cost: f64,
    /// Sum of each named cost term.
    #[serde(default)]
    pub costs: BTreeMap<String, f64>,
    /// By death or goal.
    pub terminated: bool,
    /// By time-out.
    pub truncated: bool,
    /// Hash of the world's last state, if the recorder took one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub state_hash: Option<u64>,
}

/// A recorded episode.
#[derive(Clone, PartialEq, Debug)]
pub struct EpisodeFile {
    header: Header,
    /// `[steps, groups]`.
    actions: Vec<u8>,
    /// `[steps, deltas]`.
    deltas: Vec<f32>,
}

impl EpisodeFile {
    /// Begins a recording; `header.steps` is counted by [`EpisodeFile::push`] and may be anything
    /// here.
    ///
    /// # Errors
    /// When the header asks for more sub-actions than the format holds, or is too long.
    pub fn new(mut header: Header) -> Result<EpisodeFile, MediaError> {
        header.steps = 0;
        let name = Path::new("episode");
        check_header(&header, name)?;
        Ok(EpisodeFile { header, actions: Vec::new(), deltas: Vec::new() })
    }

    /// What the episode was.
    #[must_use]
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// Notes how it ended.
    pub fn set_outcome(&mut self, outcome: Outcome) {
        self.header.outcome = Some(outcome);
    }

    /// Adds the action of a step.
    ///
    /// # Errors
    /// When the numbers of sub-actions differ from the header's, a continuous one is not finite, or
    /// the recording is full.
    pub fn push(&mut self, groups: &[u8], deltas: &[f32]) -> Result<(), MediaError> {
        let fits = groups.len() == usize::from(self.header.groups)
            && deltas.len() == usize::from(self.header.deltas);
        if !fits || deltas.iter().any(|delta| !delta.is_finite()) {
            return Err(MediaError::Size(format!(
                "{groups:?} and {deltas:?} are no action of {}",
                self.header.env
            )));
        }
        if self.header.steps == MAX_STEPS {
            return Err(MediaError::Size(format!(
                "an episode file holds at most {MAX_STEPS} steps"
            )));
        }
        self.actions.extend_from_slice(groups);
        self.deltas.extend_from_slice(deltas);
        self.header.steps += 1;
        Ok(())
    }

    /// The sub-actions of a step, categorical and continuous; `None` after the last.
    #[must_use]
    pub fn step(&self, index: usize) -> Option<(&[u8], &[f32])> {
        let (groups, deltas) = (usize::from(self.header.groups), usize::from(self.header.deltas));
        (index < self.header.steps as usize).then(|| {
            (&self.actions[index * groups..][..groups], &self.deltas[index * deltas..][..deltas])
        })
    }

    /// Checks that every action exists in an action space, given the number of choices of each
    /// categorical sub-action and the number of continuous ones: do this before playing a file of
    /// unknown origin.
    ///
    /// # Errors
    /// Names the first step that does not fit.
    pub fn check_actions(
        &self,
        sizes: &[usize],
        deltas: usize,
        name: &Path,
    ) -> Result<(), MediaError> {
        if sizes.len() != usize::from(self.header.groups)
            || deltas != usize::from(self.header.deltas)
        {
            return Err(MediaError::format(
                name,
                format!(
                    "has {} + {} sub-actions where {} with its options has {} + {deltas}; was it recorded by another version?",
                    self.header.groups,
                    self.header.deltas,
                    self.header.env,
                    sizes.len()
                ),
            ));
        }
        for (at, &action) in self.actions.iter().enumerate() {
            let group = at % sizes.len().max(1);
            if usize::from(action) >= sizes[group] {
                return Err(MediaError::format(
                    name,
                    format!(
                        "step {}: sub-action {group} is {action}, beyond the {} choices",
                        at / sizes.len(),
                        sizes[group]
                    ),
                ));
            }
        }
        Ok(())
    }

    /// The bytes of the file.
    ///
    /// # Panics
    /// Never: the header was checked and memory takes every write.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let header = serde_json::to_vec(&self.header).expect("a header is plain data");
        let mut bytes = Vec::new();
        bytes.extend_from_slice(MAGIC);
        bytes.extend_from_slice(&FORMAT_VERSION.to_le_bytes());
        bytes.extend_from_slice(&(header.len() as u32).to_le_bytes());
        bytes.extend_from_slice(&header);
        let mut body = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
        body.write_all(&self.planes()).expect("writing to memory does not fail");
        let body = body.finish().expect("writing to memory does not fail");
        bytes.extend_from_slice(&(body.len() as u32).to_le_bytes());
        bytes.extend_from_slice(&body);
        bytes.extend_from_slice(&checksum(&bytes).to_le_bytes());
        bytes
    }

    /// Reads the bytes of a file; `name` is for messages.
    ///
    /// # Errors
    /// When they are no episode, of a newer version, cut off, changed, or claim what no episode
    /// has.
    pub fn from_bytes(bytes: &[u8], name: &Path) -> Result<EpisodeFile, MediaError> {
        let bad = |problem: String| MediaError::format(name, problem);
        let damaged = || {
            bad("is damaged or cut off (its checksum does not fit); copy or record it again".into())
        };
        if bytes.len() < MAGIC.len() + 2 || &bytes[..MAGIC.len()] != MAGIC {
            return Err(bad(
                "is no episode file; `hasard record` and `hasard play` write them".into()
            ));
        }
        let version = u16::from_le_bytes([bytes[8], bytes[9]]);
        if version != FORMAT_VERSION {
            return Err(bad(format!(
                "is an episode file of version {version}, and this program reads version {FORMAT_VERSION}: use the hasard that wrote it"
            )));
        }
        let content = bytes.len().checked_sub(4).filter(|&end| end >= 10).ok_or_else(damaged)?;
        if checksum(&bytes[..content]).to_le_bytes() != bytes[content..] {
            return Err(damaged());
        }
        // From here on the file is as it was written; its writer may still have been hostile.
        let mut rest = &bytes[10..content];
        let header = take_block(&mut rest)
            .filter(|header| header.len() <= MAX_HEADER)
            .ok_or_else(damaged)?;
        let body = take_block(&mut rest).filter(|_| rest.is_empty()).ok_or_else(damaged)?;
        let header: Header = serde_json::from_slice(header)
            .map_err(|e| bad(format!("has a header that is not understood: {e}")))?;
        check_header(&header, name)?;
        let steps = header.steps as usize;
        let expected = steps * (usize::from(header.groups) + 4 * usize::from(header.deltas));
        let mut planes = Vec::new();
        let inflated =
            flate2::read::ZlibDecoder::new(body).take(expected as u64 + 1).read_to_end(&mut planes);
        if inflated.is_err() || planes.len() != expected {
            return Err(bad(format!(
                "does not hold the {steps} steps that its header declares; record it again"
            )));
        }
        let (actions, deltas) =
            from_planes(&planes, steps, usize::from(header.groups), usize::from(header.deltas));
        if let Some(at) = deltas.iter().position(|delta| !delta.is_finite()) {
            return Err(bad(format!(
                "step {}: a continuous sub-action is not a number",
                at / usize::from(header.deltas)
            )));
        }
        Ok(EpisodeFile { header, actions, deltas })
    }

    /// Writes the file, whole or not at all.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), MediaError> {
        write_whole(path, &self.to_bytes())
    }

    /// Reads a file.
    ///
    /// # Errors
    /// When it cannot be read or is no episode, see [`EpisodeFile::from_bytes`].
    pub fn read(path: &Path) -> Result<EpisodeFile, MediaError> {
        EpisodeFile::from_bytes(&read_limited(path, MAX_FILE)?, path)
    }

    /// The actions as one plane a sub-action, where equal bytes lie side by side and compress well.
    fn planes(&self) -> Vec<u8> {
        let (groups, deltas) = (usize::from(self.header.groups), usize::from(self.header.deltas));
        let mut planes = Vec::with_capacity(self.actions.len() + 4 * self.deltas.len());
        for group in 0..groups {
            planes.extend(self.actions.iter().skip(group).step_by(groups));
        }
        for delta in 0..deltas {
            for byte in 0..4 {
                planes.extend(
                    self.deltas
                        .iter()
                        .skip(delta)
                        .step_by(deltas)
                        .map(|value| value.to_le_bytes()[byte]),
                );
            }
        }
        planes
    }
}

fn from_planes(planes: &[u8], steps: usize, groups: usize, deltas: usize) -> (Vec<u8>, Vec<f32>) {
    let (action_planes, delta_planes) = planes.split_at(steps * groups);
    let actions =
        (0..steps * groups).map(|at| action_planes[at % groups * steps + at / groups]).collect();
    let value = |at: usize| {
        let (step, delta) = (at / deltas, at % deltas);
        f32::from_le_bytes([0, 1, 2, 3].map(|byte| delta_planes[(delta * 4 + byte) * steps + step]))
    };
    (actions, (0..steps * deltas).map(value).collect())
}

/// Splits a block that is preceded by its length off the front.
fn take_block<'a>(rest: &mut &'a [u8]) -> Option<&'a [u8]> {
    let (length, after) = rest.split_first_chunk::<4>()?;
    let (block, after) = after.split_at_checked(u32::from_le_bytes(*length) as usize)?;
    *rest = after;
    Some(block)
}

fn checksum(bytes: &[u8]) -> u32 {
    let mut crc = flate2::Crc::new();
    crc.update(bytes);
    crc.sum()
}

fn check_header(header: &Header, name: &Path) -> Result<(), MediaError> {
    let printable = |text: &str, limit: usize| {
        !text.is_empty() && text.len() <= limit && !text.contains(char::is_control)
    };
    if !printable(&header.env, 128)
        || !printable(&header.program, 128)
        || !printable(&header.player, 4096)
    {
        return Err(MediaError::format(
            name,
            "has a header with an empty, overlong or unprintable name",
        ));
    }
    let options = &header.options;
    // An own scenario's text is a file of many lines; nobody prints it.
    let text = |key: &str, value: &str| key == SCENARIO && value.len() <= MAX_HEADER / 2;
    let fits =
        |key: &str, value: &str| value.is_empty() || printable(value, 4096) || text(key, value);
    if options.len() > 256
        || !options.iter().all(|(key, value)| printable(key, 128) && fits(key, value))
    {
        return Err(MediaError::format(
            name,
            "has a header with too many, overlong or unprintable options",
        ));
    }
    if header.steps > MAX_STEPS || header.groups > MAX_GROUPS || header.deltas > MAX_DELTAS {
        return Err(MediaError::format(
            name,
            format!(
                "declares {} steps of {} + {} sub-actions, beyond the {MAX_STEPS} of {MAX_GROUPS} + {MAX_DELTAS} that a file may hold",
                header.steps, header.groups, header.deltas
            ),
        ));
    }
    if header.groups == 0 && header.deltas == 0 && header.steps > 0 {
        return Err(MediaError::format(name, "declares steps without any sub-action"));
    }
    Ok(())
}

#[cfg(test)]
mod tests;
