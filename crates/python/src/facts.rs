//! What is fixed about worlds once they are made.

use hasard_envs::{ActionSpace, Autoreset, CostTerm, EnvId, EnvOptions};

/// What is fixed about worlds once they are made.
pub struct Facts {
    /// The tasks: one, or several that the lanes take in turn.
    pub tasks: Vec<Task>,
    pub lanes: usize,
    pub groups: usize,
    pub autoreset: Autoreset,
    pub space: ActionSpace,
    pub shape: [usize; 3],
    pub terms: &'static [CostTerm],
    pub statistics: Vec<&'static str>,
    /// Seed of the first episodes, where a reset names none.
    pub seed: Option<u64>,
    /// What saved lanes must have been saved from.
    pub kind: String,
}

/// One of the tasks of worlds.
pub struct Task {
    pub id: EnvId,
    pub safety_budget: f64,
    pub episode_steps: u32,
    pub extent: [i32; 4],
    /// Of each choice of each sub-action, whether it does something.
    pub mask: Vec<bool>,
}

impl Facts {
    /// The lanes of a slot: of a group, or all of them.
    pub fn lanes_of(&self, slot: usize) -> std::ops::Range<usize> {
        let Facts { lanes, groups, .. } = *self;
        if slot >= groups { 0..lanes } else { lanes * slot / groups..lanes * (slot + 1) / groups }
    }

    /// Which task a lane has.
    pub fn task_of(&self, lane: usize) -> usize {
        lane % self.tasks.len()
    }
}

/// Everything that decides what a saved lane's actions lead to, as text.
pub fn kind(ids: &[EnvId], options: &EnvOptions, autoreset: Autoreset) -> String {
    let EnvOptions {
        rules,
        early_creatures,
        test_seeds,
        hard,
        full_actions,
        frame_skip,
        max_episode_steps,
        maps,
        map,
        ..
    } = options;
    let early = if *early_creatures { " early" } else { "" };
    let named = |id: &EnvId| {
        let file = id.scenario.file.map_or(String::new(), |file| format!(" {}", file.hash));
        format!("{id}{file}")
    };
    let ids = ids.iter().map(named).collect::<Vec<_>>().join(",");
    // As before where there are none, so that what was saved without is still taken.
    let mut of_map = String::new();
    if *test_seeds {
        of_map += " test_seeds";
    }
    if let Some(maps) = maps {
        let place = maps.place().canonicalize().unwrap_or_else(|_| maps.place().to_owned());
        of_map += &format!(" maps={}", place.display());
    }
    if let Some(map) = map {
        of_map += &format!(" map={}", hasard_envs::own::fingerprint(&format!("{map:?}")));
    }
    format!(
        "{ids} {rules:?}{early}{of_map} hard={hard} full={full_actions} skip={frame_skip} limit={max_episode_steps:?} {autoreset:?}"
    )
}

/// What saved worlds begin with.
const HEAD: &[u8; 8] = b"hsworld\x01";

/// Saved lanes, with what they were saved from.
pub fn pack(kind: &str, lanes: &[u8]) -> Vec<u8> {
    let length = (kind.len() as u32).to_le_bytes();
    [HEAD, &length[..], kind.as_bytes(), lanes].concat()
}

/// The lanes in saved bytes, if they were saved from worlds of this kind; else what is wrong.
pub fn unpack<'a>(kind: &str, bytes: &'a [u8]) -> Result<&'a [u8], String> {
    let spoiled = || "these bytes are no saved worlds".to_string();
    let rest = bytes.strip_prefix(HEAD).ok_or_else(spoiled)?;
    let (length, rest) = rest.split_first_chunk::<4>().ok_or_else(spoiled)?;
    let (saved, lanes) =
        rest.split_at_checked(u32::from_le_bytes(*length) as usize).ok_or_else(spoiled)?;
    if saved == kind.as_bytes() {
        return Ok(lanes);
    }
    let saved: String =
        String::from_utf8_lossy(saved).chars().take(200).flat_map(char::escape_debug).collect();
    Err(format!("these bytes were saved from other worlds ({saved}); these are {kind}"))
}
